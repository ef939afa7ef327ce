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
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.lab.box import LabBox
from atmosbox.lab.kernels.knobs import can_set_gravity, has_moist_knobs
from atmosbox.lab.kernels.starting import can_start

BASE = 0x20000
_LINE = 64
_HEAD = 256
_SET = (".highest", ".gravity")
"""Numbers inside arguments that a page sets, besides whole arguments: the end of the scale of speeds, and gravity."""

Works = Mapping[str, tuple[Any, ...]]


class Image(NamedTuple):
    """The memory of a module before its first call.

    Attributes
    ----------
    pieces : list of (int, bytes)
        The pieces of memory that are not zero, with their addresses.
    size : int
        Number of bytes, including those before ``BASE``.
    blocks : dict of str to int
        Address of the arguments of each kernel.
    slots : dict of str to dict of str to int
        Address of each number that a page may set, by its path: "4" is the fifth argument of a kernel.
    arrays : dict of str to (int, int, str)
        Address, number of elements and type of each array, by the path of its name: "gas.molecules".
    """

    pieces: list[tuple[int, bytes]]
    size: int
    blocks: dict[str, int]
    slots: dict[str, dict[str, int]]
    arrays: dict[str, tuple[int, int, str]]


def parts(value: Any, name: str) -> Iterator[tuple[str, Any, str]]:
    """Yield the parts of an argument that numba passes, in order: kind, value, and path of the name."""
    if isinstance(value, np.ndarray):
        yield "word", 0, name
        yield "word", 0, name
        yield "word", value.size, name
        yield "word", value.itemsize, name
        yield "array", value, name
        for number in (*value.shape, *value.strides):
            yield "word", number, name
    elif isinstance(value, tuple):
        for field, part in zip(getattr(value, "_fields", range(len(value))), value, strict=True):
            yield from parts(part, f"{name}.{field}" if name else str(field))
    elif isinstance(value, float | np.floating):
        yield "number", float(value), name
    else:
        yield "word", int(value), name


def _address(array: NDArray[Any]) -> int:
    return int(array.__array_interface__["data"][0])


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
    turn = [_address(each) for each in arrays if each.size]
    return sorted(found, key=lambda piece: next(k for k, at in enumerate(turn) if piece[0] <= at < piece[1]))


def image(works: Works, named: Mapping[str, Any]) -> Image:
    """Return the memory image for these kernels.

    Parameters
    ----------
    works
        The arguments of the kernels, by their names.
    named
        Arrays, or NamedTuples of arrays, whose addresses are listed by name.

    Examples
    --------
    >>> made = image({"double": (np.arange(3.0), 2)}, {"numbers": np.arange(1)})
    >>> made.blocks["double"] % 64, made.slots["double"]
    (0, {'1': 131512})
    """
    arrays = [part for given in works.values() for kind, part, _ in parts(given, "") if kind == "array"]
    known = [(name, part) for kind, part, name in parts(tuple(named.values()), "") if kind == "array"]
    titles = list(named)
    held = _pieces_of_memory([*arrays, *(part for _, part in known)])
    place: dict[tuple[int, int], int] = {}
    at = BASE
    for low, high in held:
        at = -(-at // _LINE) * _LINE
        place[low, high] = at
        at += high - low

    def where(array: NDArray[Any]) -> int:
        low = _address(array)
        return next((to + low - first for (first, last), to in place.items() if first <= low < last), BASE)

    table: dict[str, tuple[int, int, str]] = {}
    for name, array in known:
        first, _, rest = name.partition(".")
        title = ".".join(part for part in (titles[int(first)], rest) if part)
        kind = "uint8" if array.dtype.names else str(array.dtype)
        table[title] = where(array), array.nbytes if array.dtype.names else array.size, kind
    stored = ((to, ctypes.string_at(low, high - low)) for (low, high), to in place.items())
    pieces = [(to, content) for to, content in stored if any(content)]
    blocks: dict[str, int] = {}
    slots: dict[str, dict[str, int]] = {}
    for name, given in works.items():
        at = -(-at // _LINE) * _LINE
        blocks[name], slots[name] = at, {}
        words = bytearray(_HEAD)
        for kind, part, path in parts(given, ""):
            whole = path.isdigit() and not isinstance(given[int(path)], np.ndarray)
            if kind != "array" and (whole or path.endswith(_SET)):
                slots[name][path] = at + len(words)
            number = np.float64(part) if kind == "number" else np.int64(where(part) if kind == "array" else part)
            words += number.tobytes()
        pieces.append((at, bytes(words)))
        at += len(words)
    return Image(pieces, at, blocks, slots, table)


def arguments(box: LabBox) -> dict[str, tuple[Any, ...]]:
    """Return the arguments of the kernels of a box by name.

    Examples
    --------
    >>> from atmosbox.lab.box import lab_box
    >>> from atmosbox.lab.kernels.kernel_table import kernels
    >>> from atmosbox.simulation.preparation import prepare
    >>> box = lab_box(prepare("temperature", {"molecules": 20}))
    >>> set(arguments(box)) == set(kernels(box.modes, wells=box.attracts))
    True
    """
    gas, ascent, book, layout, gauges = box.gas, box.ascent, box.book, box.layout, box.gauges
    found: dict[str, tuple[Any, ...]] = {}
    if box.modes.ascends:
        found["lead"] = (gas, ascent, book, 0.0)
    if can_start(box.modes):
        found["start"] = (gas, ascent, book, box.start, 0)
    if can_set_gravity(box.modes) and not box.attracts:
        found["set_gravity"] = (gas, book, box.start, gauges, gas.box.gravity)
    found |= {
        "place": (gas, book, layout),
        "pass_time": (gas, ascent, book, layout, 0.0, 0),
        "begin": (gas, ascent, book, gauges),
        "sample": (gas, ascent, book, gauges),
        "end_frame": (gas, ascent, book, gauges),
        "note_frame": (gas, gauges, box.speeds, box.layers),
        "begin_averages_anew": (box.speeds, box.layers),
        "look": (gas, book, box.picture),
    } | (_knobs(box) if box.modes.phases else {"warm_walls": (gas.walls, 0, 6, 1.0)})
    if box.attracts:
        found |= {
            "begin": (gas, ascent, book, gauges, box.crowd),
            "end_frame": (gas, ascent, book, gauges, layout, box.crowd),
            "look": (gas, book, layout, box.crowd, box.picture),
            "attract": (gas, book, layout, 1.0),
            "warm_bath": (gas.bath, 1.0),
        }
    return found


def _knobs(box: LabBox) -> dict[str, tuple[Any, ...]]:
    """Return the arguments of the kernels that the knobs of a box with liquid call."""
    if not has_moist_knobs(box.modes):
        return {}
    gas, book = box.gas, box.book
    found: dict[str, tuple[Any, ...]] = {
        "warm_walls": (gas, book, *box.warmed, 1.0),
        "smooth_walls": (gas, *box.warmed),
    }
    return found | ({"cover_pool": (gas, book, 1.0)} if box.modes.pool else {})
