"""The memory of a module: every array of a box at its address, and after them the arguments of each kernel.

::

    0           stack and constants of the module
    BASE        arrays, each at a multiple of 64 bytes; views of one piece of memory keep their distance
    ...         for each kernel a block: 128 bytes for what it returns, 128 unused, then its arguments,
                8 bytes each, as numba passes them
    size        the end

An array is passed as seven or more words: two that only Python needs, its number of elements, the size of an element,
its address, then its shape and its strides. A NamedTuple is passed as its fields. Memory that is all zero, such as the
rows of cells before the molecules have been placed, is not stored.
"""

from __future__ import annotations

import ctypes
import inspect
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.lab.box import LabBox
from atmosbox.lab.kernels.kernel_table import kernels

BASE = 0x20000
_LINE = 64
_HEAD = 256
_SET = (".highest", ".gravity")
"""Numbers inside arguments that a page sets, besides whole arguments: the end of the scale of speeds, and gravity."""


class Image(NamedTuple):
    """The memory of a module before its first call.

    ``pieces`` are those that are not zero, with their addresses; ``size`` is the number of bytes, including those
    before ``BASE``. ``blocks`` has the address of the arguments of each kernel, ``slots`` for each kernel the address
    of each number that a page may set, by its path: the name of an argument, or of its part. ``arrays`` has address,
    number of elements and type of each array, by the path of its name: "gas.molecules".
    """

    pieces: list[tuple[int, bytes]]
    size: int
    blocks: dict[str, int]
    slots: dict[str, dict[str, int]]
    arrays: dict[str, tuple[int, int, str]]


def parts(value: Any, name: str) -> Iterator[tuple[str, Any, str]]:
    """Yield the parts of an argument that numba passes, in order: kind, value, and path of the name."""
    if isinstance(value, np.ndarray):
        yield from (("word", number, name) for number in (0, 0, value.size, value.itemsize))
        yield "array", value, name
        yield from (("word", number, name) for number in (*value.shape, *value.strides))
    elif isinstance(value, tuple | dict):
        names = value if isinstance(value, dict) else getattr(value, "_fields", range(len(value)))
        for field, part in zip(names, value.values() if isinstance(value, dict) else value, strict=True):
            yield from parts(part, f"{name}.{field}" if name else str(field))
    elif isinstance(value, float | np.floating):
        yield "number", float(value), name
    else:
        yield "word", int(value), name


def _pieces_of_memory(arrays: list[NDArray[Any]]) -> list[tuple[int, int]]:
    """Return the pieces of memory, as first address and end, that hold all arrays; views of one buffer share one.

    They are in the order of the arrays, for where Python puts them is chance.
    """
    spans = sorted((np.lib.array_utils.byte_bounds(each) for each in arrays if each.size), key=lambda s: (s[0], -s[1]))
    found: list[tuple[int, int]] = []
    for low, high in spans:
        if found and low < found[-1][1]:
            found[-1] = found[-1][0], max(found[-1][1], high)
        else:
            found.append((low, high))
    turn = [each.ctypes.data for each in arrays if each.size]
    return sorted(found, key=lambda piece: next(k for k, at in enumerate(turn) if piece[0] <= at < piece[1]))


def image(works: Mapping[str, Mapping[str, Any]]) -> Image:
    """Return the memory image for these kernels: their arguments, by the names of both.

    >>> made = image({"scale": {"values": np.arange(3.0), "by": 2}})
    >>> made.blocks["scale"] % 64, made.slots["scale"], made.arrays
    (0, {'by': 131448}, {'values': (131072, 3, 'float64')})
    """
    known = {path: part for given in works.values() for kind, part, path in parts(given, "") if kind == "array"}
    place: dict[tuple[int, int], int] = {}
    at = BASE
    for low, high in _pieces_of_memory([*known.values()]):
        at = -(-at // _LINE) * _LINE
        place[low, high] = at
        at += high - low

    def where(array: NDArray[Any]) -> int:
        at = array.ctypes.data
        return next((to + at - low for (low, high), to in place.items() if low <= at < high), BASE)

    seen = {name: array.view(np.uint8) if array.dtype.names else array for name, array in known.items()}
    table = {name: (where(array), array.size, str(array.dtype)) for name, array in seen.items()}
    stored = ((to, ctypes.string_at(low, high - low)) for (low, high), to in place.items())
    pieces = [(to, content) for to, content in stored if any(content)]
    blocks: dict[str, int] = {}
    slots: dict[str, dict[str, int]] = {}
    for name, given in works.items():
        at = -(-at // _LINE) * _LINE
        blocks[name], slots[name] = at, {}
        words = bytearray(_HEAD)
        for kind, part, path in parts(given, ""):
            if isinstance(given.get(path), int | float) or path.endswith(_SET):
                slots[name][path] = at + len(words)
            number = np.float64(part) if kind == "number" else np.int64(where(part) if kind == "array" else part)
            words += number.tobytes()
        pieces.append((at, bytes(words)))
        at += len(words)
    return Image(pieces, at, blocks, slots, table)


def arguments(box: LabBox) -> dict[str, dict[str, Any]]:
    """Return the arguments of the kernels of a box, by the names of the kernels and of their parameters."""
    numbers = {"until": 0.0, "most": 0, "seed": 0, "towards": 0.0, "kT": 1.0, "strength": 1.0, "share": 1.0}
    first, last = box.warmed
    given = box._asdict() | numbers | {"begun": box.start, "gravity": 0.0, "first": first, "last": last}
    works = kernels(box.modes, wells=box.attracts)
    return {name: {each: given[each] for each in inspect.signature(work).parameters} for name, work in works.items()}
