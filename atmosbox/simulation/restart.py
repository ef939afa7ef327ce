"""The state of a run inside its file, from which the run continues bit for bit.

The engine supplies the state of its box, see `atmosbox.engine.core.saved_state`. With it are stored the values that the
instruments hold: a tree of plain numbers, and all arrays as `numpy.savez` writes them. Reading them cannot run code: it
makes only numbers, texts and lists, and no object that the scene does not build itself.
"""

from __future__ import annotations

import functools
import hashlib
import io
import json
import platform
import warnings
import zipfile
from enum import Enum
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import RefusedError
from atmosbox.engine.core.kernel_cache import cache_folder, source_digest
from atmosbox.engine.core.saved_state import SavedState
from atmosbox.errors import Command, FileError, Option
from atmosbox.simulation.preparation import Prepared
from atmosbox.version import __version__

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.simulation.recording import Recording

FORMAT = 2
"""Version of the format that is written here."""

_KEPT = {"kept": 0}
_COUNTED: dict[str, type] = {"sampled": int, "turned": int, "busy": float, "seconds": float}
"""The numbers of a `Recording` that are stored with the state of its box and its instruments."""
_DAMAGE = (RefusedError, ArithmeticError, AttributeError, EOFError, LookupError, MemoryError, OSError, RuntimeError,
           TypeError, ValueError, zipfile.BadZipFile)  # fmt: skip
"""What a state raises that is damaged, or that of another run."""


class Restart(NamedTuple):
    """The contents of a file from which a run continues.

    Attributes
    ----------
    source
        The file.
    about
        What determines the run: see `described`.
    tree
        The state of box and instruments; in it stand the numbers of its arrays.
    content
        The arrays, as `numpy.savez` writes them.
    attributes
        The global attributes of the file.
    """

    source: Path
    about: dict[str, Any]
    tree: dict[str, Any]
    content: bytes
    attributes: dict[str, Any]


class UnkeptError(Exception):
    """An instrument of a user's own holds a value that no file can hold; the text names it."""


def described(prepared: Prepared) -> dict[str, Any]:
    """Return all that must be the same for a run to continue bit for bit, by its name in messages.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import prepare
    >>> sorted(described(prepare("temperature", {})))
    ['content of the scene', 'format of the state', 'processor', 'settings', 'sources of the engine', 'version']
    """
    package = Path(__file__).parents[1]
    own = getattr(prepared.module, "__file__", None)
    files = [*sorted((package / "scene").rglob("*.py")), Path(__file__).with_name("recording.py")]
    scene = hashlib.sha256(b"".join(file.read_bytes() for file in [*files, *([Path(own)] if own else [])]))
    return {
        "format of the state": FORMAT,
        "version": __version__,
        "sources of the engine": _sources(),
        "content of the scene": scene.hexdigest()[:16],
        "processor": platform.machine(),
        "settings": {name: value for name, value in prepared.parameters.items() if name != "version"},
    }


@functools.cache
def _sources() -> str:
    """Return the digest of the engine's sources from the name of the kernel cache: to compute it again takes 0.2 s."""
    folder = cache_folder()
    return source_digest() if folder is None else folder.name


def with_state(dataset: xr.Dataset, recording: Recording) -> xr.Dataset:
    """Return a dataset of what a run has measured so far with the state from which it continues.

    If an instrument of a user's own holds a value that no file can hold, warn and return the dataset as it is.
    """
    import xarray as xr

    from atmosbox.file.netcdf import STATE

    parcel = recording.setup.parcel  # whose state contains that of its driver already
    coder = _Coder({*map(id, (parcel, recording.setup, getattr(parcel, "_driver", None)))}, recording.prepared.module)
    try:
        state = parcel.state()
        tree = {
            "box": {"text": state.text, "memory": {name: coder.keep(piece) for name, piece in state.memory.items()}},
            "instruments": [coder.attributes(one, f"instrument {k}") for k, one in enumerate(recording.instruments, 1)],
            "times": [coder.code(time, "times") for time in recording.times],
            **{name: getattr(recording, name) for name in _COUNTED},
        }
    except (RefusedError, UnkeptError) as error:
        warnings.warn(f"this run cannot be resumed, for {error} cannot be stored in a file", stacklevel=2)
        return dataset
    head = json.dumps({"about": described(recording.prepared), "tree": tree}).encode()
    arrays = io.BytesIO()
    np.savez(arrays, *coder.arrays)
    blob = np.frombuffer(len(head).to_bytes(8, "little") + head + arrays.getbuffer(), np.uint8)
    words = {"long_name": "state of the run, from which atmosbox run --resume goes on"}
    return dataset.assign({STATE: xr.Variable((f"{STATE}_byte",), blob, words, {"dtype": "u1"})})


def read_state(path: str | Path) -> Restart:
    """Return the state that a file holds; refuse a file without one, or with a damaged one."""
    from atmosbox.file import netcdf

    found = netcdf.read(path)
    content = netcdf.read_state(path)
    if content is None:
        why = "holds no state of its run, so that it cannot go on"
        if found.attrs.get("atmosbox_status") == "complete":
            why = "is finished"
        raise FileError(f"{path} {why}", from_file(path), " to run it again")
    try:
        size = int.from_bytes(content[:8].tobytes(), "little")
        head = json.loads(content[8 : 8 + size].tobytes())
        attributes = {**found.attrs, "history": str(found.attrs["history"])}
        return Restart(Path(path), dict(head["about"]), dict(head["tree"]), content[8 + size :].tobytes(), attributes)
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise FileError(f"The state in {path} is damaged", from_file(path), " to run it again") from error


def from_file(path: str | Path) -> Command:
    """Return the command that makes the run of a file from its beginning."""
    return Command("run", (Option("from", str(path)),))


def check_alike(restart: Restart, prepared: Prepared) -> None:
    """Refuse to continue if anything that determines the run has changed."""
    now = described(prepared)
    for name, value in now.items():
        before = restart.about.get(name)
        if before != json.loads(json.dumps(value)):
            said = f" ({before}, now {value})" if isinstance(before, str | int) else ""
            problem = f"{restart.source} cannot go on bit for bit, because the {name}{said} changed since"
            raise FileError(problem, from_file(restart.source), " to begin again")


def put_back(restart: Restart, recording: Recording) -> None:
    """Restore the state of a file into a run that was just built."""
    tree = restart.tree
    try:
        with np.load(io.BytesIO(restart.content), allow_pickle=False) as stored:
            arrays = list(stored.values())
        memory = {str(name): arrays[place] for name, place in tree["box"]["memory"].items()}
        recording.setup.parcel.restore(SavedState(tree["box"]["text"], memory))
        for each, codes in zip(recording.instruments, tree["instruments"], strict=True):
            _into(vars(each), codes, arrays)
        recording.times = [float(time) for time in tree["times"]]
        for name, kind in _COUNTED.items():
            setattr(recording, name, kind(tree[name]))
    except _DAMAGE as error:
        problem = f"The state in {restart.source} is damaged or that of another run ({error})"
        raise FileError(problem, from_file(restart.source), " to begin again") from error


class _Coder:
    """Encodes the values that instruments hold as plain numbers, and collects their arrays."""

    def __init__(self, known: set[int], module: ModuleType) -> None:
        self.arrays: list[NDArray[Any]] = []
        self._seen = set(known)
        self._own = module.__name__

    def keep(self, array: NDArray[Any]) -> int:
        self.arrays.append(array)
        return len(self.arrays) - 1

    def attributes(self, thing: object, path: str) -> dict[str, Any]:
        self._seen.add(id(thing))
        return {name: self.code(value, f"{path}.{name}") for name, value in vars(thing).items()}

    def code(self, value: Any, path: str, *, nested: bool = False) -> Any:
        """Return the code of a value; a value nested in a list or dictionary must consist of plain numbers alone."""
        named = getattr(value, "_fields", None)
        if value is None or type(value) in (bool, int, float, str):
            return value
        if isinstance(value, np.generic):
            return {"scalar": [value.dtype.str, value.tobytes().hex()]}
        if isinstance(value, np.ndarray) and not value.dtype.hasobject:
            return {"array": self.keep(value)}
        if isinstance(value, list):
            return [self.code(each, path, nested=True) for each in value]
        if isinstance(value, tuple) and not (nested and named):
            return {"tuple": [self.code(each, path, nested=True) for each in value], "named": named}
        if isinstance(value, dict) and all(isinstance(key, str) for key in value):
            return {"dict": {key: self.code(each, path, nested=True) for key, each in value.items()}}
        if nested or isinstance(value, np.ndarray | tuple | dict):
            raise UnkeptError(path)
        if isinstance(value, np.random.Generator):
            return {"generator": value.bit_generator.state}
        constant = isinstance(value, slice | Enum | ModuleType | type) or callable(value)
        if constant or id(value) in self._seen:
            return _KEPT
        module = type(value).__module__
        if hasattr(value, "__dict__") and (module.startswith("atmosbox.") or module == self._own):
            return {"object": self.attributes(value, path)}
        if module == "builtins":
            raise UnkeptError(path)
        return _KEPT  # an object of another library is taken for a constant of the scene


def _into(held: dict[str, Any], codes: dict[str, Any], arrays: list[NDArray[Any]]) -> None:
    for name, code in codes.items():
        held[name] = _value(code, held.get(name), arrays)


def _value(code: Any, old: Any, arrays: list[NDArray[Any]]) -> Any:
    """Return the value that a code stands for; ``old`` is the object of the new run in its place."""
    match code:
        case list():
            return [_value(each, None, arrays) for each in code]
        case {"scalar": inside}:
            return np.frombuffer(bytes.fromhex(inside[1]), np.dtype(inside[0]))[0]
        case {"array": place}:
            return arrays[place]
        case {"dict": inside}:
            return {key: _value(each, None, arrays) for key, each in inside.items()}
        case {"tuple": inside}:
            parts, named = [_value(each, None, arrays) for each in inside], code["named"]
            if not named:
                return tuple(parts)
            if list(getattr(old, "_fields", ())) != named:
                raise ValueError("a tuple with names")
            return old._make(parts)
        case dict() if old is None:
            raise ValueError("an object that the scene does not build")
        case {"generator": inside}:
            old.bit_generator.state = inside
        case {"object": inside}:
            _into(vars(old), inside, arrays)
    return old if isinstance(code, dict) else code
