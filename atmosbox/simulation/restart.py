"""The state of a run inside its file, from which the run continues bit for bit.

The engine's way of saving a box, `atmosbox.engine.core.saved_state`, saves the instruments of the run with it: numbers
and texts as JSON, and all arrays as `numpy.savez` writes them. Reading them cannot run code: it makes only numbers,
texts and lists, and no object that the scene does not build itself.
"""

from __future__ import annotations

import functools
import hashlib
import io
import json
import platform
import warnings
import zipfile
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from atmosbox.engine import RefusedError
from atmosbox.engine.core.kernel_cache import cache_folder, source_digest
from atmosbox.engine.core.saved_state import SavedState, restore, save
from atmosbox.errors import Command, FileError, Option
from atmosbox.simulation.preparation import Prepared
from atmosbox.version import __version__

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.simulation.recording import Recording

FORMAT = 3
"""Version of the format that is written here."""

_KEPT = ("instruments", "times", "sampled", "turned", "busy", "seconds")
"""What a `Recording` holds that changes with time, beside its box."""
_DAMAGE = (RefusedError, ArithmeticError, AttributeError, EOFError, LookupError, MemoryError, OSError, RuntimeError,
           TypeError, ValueError, zipfile.BadZipFile)  # fmt: skip
"""What a state raises that is damaged, or that of another run."""


class Restart(NamedTuple):
    """The contents of a file from which a run continues: what determines the run, see `described`, and its state."""

    source: Path
    about: dict[str, Any]
    state: SavedState
    attributes: dict[str, Any]


def described(prepared: Prepared) -> dict[str, Any]:
    """Return all that must be the same for a run to continue bit for bit, by its name in messages.

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
    """Return the digest of the engine's sources, which the kernel cache has as its name: to compute it takes 0.4 s."""
    folder = cache_folder()
    return source_digest() if folder is None else folder.name


def _held(recording: Recording) -> SimpleNamespace:
    """Return all of a run that changes with time: its box, its instruments and its times."""
    return SimpleNamespace(box=recording.setup.parcel, **{name: getattr(recording, name) for name in _KEPT})


def with_state(dataset: xr.Dataset, recording: Recording) -> xr.Dataset:
    """Return a dataset of what a run has measured so far with the state from which it continues.

    If an instrument of a user's own holds a value that no file can hold, warn and return the dataset as it is.
    """
    import xarray as xr

    from atmosbox.file.netcdf import STATE

    try:
        state = save(_held(recording))
    except RefusedError as error:
        warnings.warn(f"this run cannot be resumed, for {error}", stacklevel=2)
        return dataset
    head = json.dumps({"about": described(recording.prepared), "text": state.text}).encode()
    content = io.BytesIO()
    np.savez(content, np.frombuffer(head, np.uint8), **state.memory)  # type: ignore[arg-type]  # no name is a parameter
    words = {"long_name": "state of the run, from which atmosbox run --resume goes on"}
    blob = np.frombuffer(content.getbuffer(), np.uint8)
    return dataset.assign({STATE: xr.Variable((f"{STATE}_byte",), blob, words, {"dtype": "u1"})})


def read_state(path: str | Path) -> Restart:
    """Return the state that a file holds; refuse a file without one, or with a damaged one."""
    from atmosbox.file import netcdf

    found = netcdf.read(path)
    content = netcdf.read_state(path)
    if content is None:
        finished = found.attrs.get("atmosbox_status") == "complete"
        why = "is finished" if finished else "holds no state of its run, so that it cannot go on"
        raise FileError(f"{path} {why}", from_file(path), " to run it again")
    try:
        with np.load(io.BytesIO(content.tobytes()), allow_pickle=False) as stored:
            memory = dict(stored)
        head = json.loads(memory.pop("arr_0").tobytes())
        attributes = {**found.attrs, "history": str(found.attrs["history"])}
        return Restart(Path(path), dict(head["about"]), SavedState(head["text"], memory), attributes)
    except _DAMAGE as error:
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
    held = _held(recording)
    try:
        codes = json.loads(restart.state.text)[1]["instruments"]["tuple"]
        for instrument, code in zip(held.instruments, codes, strict=True):
            for name, rows in vars(instrument).items():
                if isinstance(rows, list):  # the values of each frame by name; only what is there is restored
                    rows.extend({} for _ in code["object"][name][len(rows) :])
        restore(held, restart.state)
        held.box.restore(held.box.state())  # which also finds the kernels for its memory
    except _DAMAGE as error:
        problem = f"The state in {restart.source} is damaged or that of another run ({error})"
        raise FileError(problem, from_file(restart.source), " to begin again") from error
    for name in _KEPT:
        setattr(recording, name, getattr(held, name))
