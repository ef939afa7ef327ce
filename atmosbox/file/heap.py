"""The heaps of an HDF5 file, which hold its texts, and a kind of damage to them on which the HDF5 library hangs."""

from __future__ import annotations

import mmap
import os
from pathlib import Path

__all__ = ["has_endless_heap"]

_HEAP = b"GCOL\1\0\0\0"
_HEAD = 16


def has_endless_heap(path: str | os.PathLike[str]) -> bool:
    """Return whether a file has a heap with a piece of free space of length zero.

    HDF5 (seen in 2.2) steps through a heap by the lengths of its pieces, so it never comes to the end of such a heap,
    and Python cannot handle a signal such as Ctrl-C meanwhile. An undamaged file has no such heap.

    Parameters
    ----------
    path
        A file of any kind that is not empty.

    References
    ----------
    .. [1] HDF5 File Format Specification, section III.E, global heap.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "damaged.nc"
    ...     _ = file.write_bytes(_HEAP + (48).to_bytes(8, "little") + bytes(32))
    ...     has_endless_heap(file)
    True
    """
    with Path(path).open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
        heap = content.find(_HEAP)
        while heap >= 0:
            size = int.from_bytes(content[heap + 8 : heap + _HEAD], "little")
            place, end = heap + _HEAD, min(heap + size, len(content))
            # an object has a number, a length and its content, padded to eight bytes; number 0 marks free space
            while place + _HEAD <= end:
                number = int.from_bytes(content[place : place + 2], "little")
                length = int.from_bytes(content[place + 8 : place + _HEAD], "little")
                step = _HEAD + (length + 7) // 8 * 8 if number else length
                if step == 0:
                    return True
                place += step
            heap = content.find(_HEAP, heap + len(_HEAP))
    return False
