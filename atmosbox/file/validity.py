"""Checks of a file before its numbers are loaded: they fit into memory, are as declared, and HDF5 can read them."""

from __future__ import annotations

import contextlib
import json
import math
import mmap
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox.errors import FileError, shown
from atmosbox.file.variables import known

if TYPE_CHECKING:
    import netCDF4

DENSEST = 1100
"""Largest number of bytes in memory for one byte of a file: deflate packs at most 1032 into one."""

SMALL = 50_000_000
"""Size in bytes up to which a file is not checked, because it fits into the memory of any computer."""

_HEAP = b"GCOL\1\0\0\0"
_HEAD = 16
_JSON: dict[str, type | tuple[type, ...]] = {
    "atmosbox_parameters": dict,
    "atmosbox_headlines": list,
    "atmosbox_panels": (dict, list),
}


def free_memory() -> float:
    """Return the number of bytes of free memory; infinite if the system does not say."""
    with contextlib.suppress(OSError, ValueError):
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return 1024.0 * int(line.split()[1])
    return math.inf


def check_valid(file: netCDF4.Dataset, source: Path) -> None:
    """Refuse an open file that does not fit into memory, or is not as atmosbox writes it; load nothing.

    It may not declare more numbers than it can hold; attributes that should hold JSON must do so; a headline needs its
    variable; and a variable of atmosbox its dimensions, its units, and numbers or text as it is declared.
    """
    declared = float(sum(_bytes(each) for each in file.variables.values()))
    much = f"{declared / 1e9:.3g} GB of numbers"
    if declared > max(SMALL, DENSEST * source.stat().st_size):
        problem = f"{source} declares {much}, more than a file of its size can hold"
        raise FileError(f"{problem}: it is damaged, so run the scene again.")
    if declared > max(SMALL, 0.5 * free_memory()):
        problem = f"{source} holds {much}, for which {free_memory() / 1e9:.3g} GB of free memory are too few"
        raise FileError(f"{problem}: run the scene with fewer molecules or frames.")
    held = {name: _parsed(file.getncattr(name)) for name in _JSON if name in file.ncattrs()}
    for name, content in held.items():
        if not isinstance(content, _JSON[name]):
            raise FileError(f"The attribute {name} of {source} is not as atmosbox writes it: run the scene again.")
    for name in held.get("atmosbox_headlines", ()):
        if not isinstance(name, str) or name not in file.variables:
            raise FileError(f"{source} lacks {shown(name)}, which its headlines name: run the scene again.")
    for name, variable in file.variables.items():
        _check_variable(name, variable, source)


def _bytes(held: netCDF4.Variable[Any]) -> float:
    """Return the memory that a variable takes [bytes]; for texts of unknown length a lower bound."""
    size = np.dtype(held.dtype).itemsize if isinstance(held.dtype, np.dtype) else 8
    return float(math.prod(held.shape)) * size


def _parsed(text: object) -> Any:
    try:
        return json.loads(text) if isinstance(text, str) else None
    except (ValueError, RecursionError):
        return None


def _check_variable(name: str, held: netCDF4.Variable[Any], source: Path) -> None:
    """Refuse a declared variable that does not agree with its declaration."""
    declared = known(name)
    if declared is None:
        return
    numeric = isinstance(held.dtype, np.dtype) and held.dtype.kind in "iuf"
    dims = held.dimensions[: None if numeric else -1]  # the last one of a text is its length
    sizes = held.group().dimensions
    empty = numeric and any(not sizes[dim].size for dim in dims if dim not in ("elapsed_time", "drop"))
    # a headline is one number, and the axis of a sweep; both may have the name of a variable, as gravity has
    if empty or numeric == (declared.dtype == "U") or dims not in (declared.dims, (), (name,)):
        raise FileError(f"{source} holds {name}, and not as atmosbox writes it: run the scene again.")
    for needed in {"units", "flag_meanings"} & declared.attributes().keys():
        if not isinstance(getattr(held, needed, None), str):
            raise FileError(f"{source} does not say the {needed} of {name}: run the scene again.")


def has_endless_heap(path: str | os.PathLike[str]) -> bool:
    """Return whether an HDF5 file has a heap, which holds its texts, with a piece of free space of length zero.

    HDF5 (seen in 2.2) steps through a heap by the lengths of its pieces, so it never comes to the end of such a heap,
    and Python cannot handle a signal such as Ctrl-C meanwhile. An undamaged file has no such heap.

    References
    ----------
    .. [1] HDF5 File Format Specification, section III.E, global heap.

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
