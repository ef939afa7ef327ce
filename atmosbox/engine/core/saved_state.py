"""Saving the state of a box as named arrays and plain numbers, and restoring it.

An engine's arrays are often views of one another: the slots of a molecule are six bytes within its event, and the
columns of many molecules are parts of one piece of memory. If each array were copied by itself, the copies would no
longer share memory, and what a kernel writes into one would be missing in the other. So memory is saved piece by piece,
and for every array it is noted in which piece it lies, and where::

    memory    | events ........................ |   | molecules ................ |
    arrays      _events: all of it                    _molecules, _fields: all of it
                _cells.slot: six bytes of each

A restored piece begins at the same offset within a cache line, on which the speed of a kernel depends. A restored array
has the same type, strides and writability, by which its compiled kernel is found.
"""

import copyreg
import ctypes
import json
import math
from collections import namedtuple
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.refusal import RefusedError

_LINE = 64

Pieces = dict[str, NDArray[np.uint8]]


class SavedState(NamedTuple):
    """The state of an object in a form that a file can hold.

    ``text`` is JSON: all numbers, and for every array its piece of memory and its place there. ``memory`` holds the
    pieces, each ``(byte,)`` of uint8, by the name of the first array that lies in it. Neither can run code.
    """

    text: str
    memory: Pieces


class _View(namedtuple("_View", "piece line at dtype shape strides writable records")):
    """The place of an array: its piece of memory, the offset there, and its other properties in numpy."""


class _Memory:
    """Pieces of memory, collected from arrays."""

    def __init__(self) -> None:
        self.pieces: Pieces = {}
        self._names: dict[tuple[int, int], str] = {}
        self._owners: list[NDArray[Any]] = []  # kept alive, so that no other array gets the same memory

    def view(self, array: NDArray[Any], path: str) -> _View:
        """Return the place of an array, and copy its piece of memory if that is not yet copied."""
        if array.dtype.hasobject:
            raise RefusedError(f"{path} is an array of Python objects: keep an array of numbers")
        owner = _owner(array)
        low, high = np.lib.array_utils.byte_bounds(owner)
        if (low, high) not in self._names:
            self._names[low, high] = path
            self.pieces[path] = _bytes(owner)
            self._owners.append(owner)
        return _View(
            piece=self._names[low, high],
            line=low % _LINE,
            at=array.__array_interface__["data"][0] - low,
            dtype=np.lib.format.dtype_to_descr(array.dtype),
            shape=list(array.shape),
            strides=list(array.strides),
            writable=bool(array.flags.writeable),
            records=isinstance(array, np.recarray),
        )


class _Room:
    """New memory for saved pieces, and the arrays in it."""

    def __init__(self, pieces: Pieces) -> None:
        self._pieces = pieces
        self._laid_out: Pieces = {}

    def array(self, view: _View, _: str = "") -> NDArray[Any]:
        """Return the array at a place, copying its piece of memory when it is first needed."""
        piece = self._laid_out.get(view.piece)
        if piece is None:
            kept = self._pieces[view.piece]
            room = np.empty(kept.size + _LINE, np.uint8)
            start = (view.line - room.ctypes.data) % _LINE
            piece = self._laid_out[view.piece] = room[start : start + kept.size]
            piece[:] = kept
        dtype = np.lib.format.descr_to_dtype(view.dtype)
        array: NDArray[Any] = np.ndarray(view.shape, dtype, piece.data, view.at, view.strides)
        array = array.view(np.recarray) if view.records else array
        array.flags.writeable = view.writable
        return array


def _owner(array: NDArray[Any]) -> NDArray[Any]:
    """Return the contiguous array that owns the memory of an array; the array itself if there is none."""
    owner: Any = array
    base: Any = array.base
    while base is not None:
        base = base.obj if isinstance(base, memoryview) else base
        if isinstance(base, np.ndarray) and (base.flags.c_contiguous or base.flags.f_contiguous):
            owner = base
        base = getattr(base, "base", None)
    return np.asarray(owner)


def _bytes(owner: NDArray[Any]) -> NDArray[np.uint8]:
    """Return a copy of the memory between the first and the last byte of an array."""
    low, high = np.lib.array_utils.byte_bounds(owner)
    return np.array((ctypes.c_ubyte * (high - low)).from_address(low), np.uint8)


# ---------------------------------------------------------------------- for pickle and copy


def pack(attributes: dict[str, Any]) -> tuple[dict[str, Any], Pieces]:
    """Return the attributes with every array replaced by a note of its place, and the pieces of memory.

    Functions are left out: compiled ones cannot be copied; the box finds them again from its modes.

    >>> whole = np.zeros(4)
    >>> noted, memory = pack({"whole": whole, "half": whole[2:]})
    >>> list(memory), unpack(noted, memory)["half"].shape
    (['whole'], (2,))
    """
    memory = _Memory()
    kept = {name: value for name, value in attributes.items() if not callable(value)}
    return {name: _changed(np.ndarray, memory.view, value, name) for name, value in kept.items()}, memory.pieces


def unpack(noted: dict[str, Any], memory: Pieces) -> dict[str, Any]:
    """Return the attributes from the output of `pack`; arrays that shared memory share it again."""
    room = _Room(memory)
    return {name: _changed(_View, room.array, note, name) for name, note in noted.items()}


def _changed(kind: type, change: Callable[[Any, str], Any], value: Any, path: str) -> Any:
    """Return a value in which all parts of one kind are changed, also those in lists and tuples."""
    if isinstance(value, kind):
        return change(value, path)
    if isinstance(value, list | tuple):
        return _alike(value, [_changed(kind, change, part, f"{path}.{name}") for name, part in _parts(value)])
    return value


def _parts(value: Any) -> list[tuple[str, Any]]:
    """Return the parts of a list or tuple, each with its name or number."""
    names = getattr(value, "_fields", range(len(value)))
    return [(str(name), part) for name, part in zip(names, value, strict=True)]


def _alike(value: Any, parts: list[Any]) -> Any:
    """Return a list or tuple of the same type as ``value``, made of other parts."""
    return value._make(parts) if hasattr(value, "_fields") else type(value)(parts)


# ---------------------------------------------------------------------- for files


def save(thing: Any) -> SavedState:
    """Return the state of an object, and of the objects that it holds, in a form that a file can hold, for `restore`.

    Its attributes may be numbers, texts, arrays, lists, tuples, dictionaries with text keys, generators of random
    numbers, or plain objects of these; anything else is refused by name. Functions are left out: they do not change
    with time.

    >>> from atmosbox.engine import Course
    >>> course = Course(10.0)
    >>> at_rest = save(course)
    >>> course.lead(4.0, towards=1.0)
    >>> restore(course, at_rest)
    >>> course.led
    False
    """
    memory = _Memory()
    seen = {id(thing): ""}

    def attributes(value: Any, path: str) -> dict[str, Any]:
        held = value if isinstance(value, dict) else vars(value)
        inside = f"{path}." if path else ""
        return {str(name): code(part, f"{inside}{name}") for name, part in held.items() if not callable(part)}

    def code(value: Any, path: str) -> Any:
        if value is None or type(value) in (bool, int, str):
            return value
        if type(value) is float:
            return value if math.isfinite(value) else {"float": repr(value)}
        if isinstance(value, np.ndarray | np.generic):
            tag = "array" if isinstance(value, np.ndarray) else "scalar"
            return {tag: memory.view(np.asanyarray(value), path)}
        if isinstance(value, list):
            return [code(part, f"{path}.{name}") for name, part in _parts(value)]
        if isinstance(value, tuple):
            return {"tuple": [code(part, f"{path}.{name}") for name, part in _parts(value)]}
        if isinstance(value, np.random.Generator):
            return {"generator": value.bit_generator.state}
        if id(value) in seen:
            return {"same": seen[id(value)]}
        seen[id(value)] = path
        if not ((isinstance(value, dict) and all(isinstance(key, str) for key in value)) or _is_plain(value)):
            raise RefusedError(
                f"{path} is a {type(value).__name__}, which cannot be saved: keep numbers, arrays, lists and tuples"
            )
        return {"object": attributes(value, path)}

    return SavedState(json.dumps([type(thing).__name__, attributes(thing, "")]), memory.pieces)


def restore(thing: Any, saved: SavedState) -> None:
    """Put an object back into a saved state: its own, or that of an object made in the same way; refuse any other."""
    room = _Room(saved.memory)

    def into(held: dict[str, Any], codes: dict[str, Any]) -> None:
        for name, code in codes.items():
            held[name] = value(code, held.get(name))

    def value(code: Any, old: Any) -> Any:
        if isinstance(code, list):
            before = old if isinstance(old, list) else []
            return [value(part, before[k] if k < len(before) else None) for k, part in enumerate(code)]
        if not isinstance(code, dict):
            return code
        ((tag, inside),) = code.items()
        if tag == "float":
            return float(inside)
        if tag == "same":
            return old
        if tag in ("array", "scalar"):
            array = room.array(_view(inside))
            return array if tag == "array" else array[()]
        if tag == "tuple":
            like = old if isinstance(old, tuple) and len(old) == len(inside) else (None,) * len(inside)
            return _alike(like, [value(part, each) for part, each in zip(inside, like, strict=True)])
        if old is None or (tag == "generator") != isinstance(old, np.random.Generator):
            raise RefusedError("this state is that of another object: make one in the same way, then restore it")
        if tag == "generator":
            old.bit_generator.state = inside
        else:
            into(old if isinstance(old, dict) else vars(old), inside)
        return old

    name, codes = json.loads(saved.text)
    if name != type(thing).__name__:
        raise RefusedError(f"this state is that of a {name}, not of a {type(thing).__name__}: restore it into a {name}")
    into(vars(thing), codes)


def _is_plain(value: Any) -> bool:
    """Return whether an object is fully described by its attributes; an open file, say, is not."""
    try:
        return hasattr(value, "__dict__") and value.__reduce_ex__(4)[0] is copyreg.__newobj__  # type: ignore[attr-defined]
    except TypeError:
        return False


def _view(inside: list[Any]) -> _View:
    """Return a `_View` from the list that JSON has made of it."""
    view = _View(*inside)
    fields = view.dtype
    if isinstance(fields, list):  # the fields of a record, which must be tuples
        fields = [(name, kind, *map(tuple, shape)) for name, kind, *shape in fields]
    return view._replace(dtype=fields)
