"""Compilation of the kernels before a first run: its progress, its expected time, and compilation in advance."""

from __future__ import annotations

import contextlib
import json
import os
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from atmosbox.engine.core.kernel_cache import cache_folder, compilations
from atmosbox.simulation.preparation import Prepared, build

__all__ = ["cache_home", "compile_kernels", "compiled_here", "expected_seconds", "remember", "remembered", "told"]

_USUAL = 15.0  # seconds, if this machine has not compiled the scene yet
_BREATH = 0.2
_NEVER_DONE = 0.97
_FILE = "seconds.json"


@contextlib.contextmanager
def told(prepared: Prepared, tell: Callable[[float, str], None]) -> Iterator[None]:
    """Report the progress of compilation while a block runs, if anything is compiled in the block.

    The expected time is that of the last compilation of the scene on this machine.

    Parameters
    ----------
    prepared
        The scene that is run.
    tell
        Called with the completed share and a sentence, from a separate thread while the compiler works.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import prepare
    >>> with told(prepare("temperature", {}), print):
    ...     pass
    """
    expected, sentence = _USUAL, ""
    spent, began, depth = 0.0, 0.0, 0
    over = threading.Event()
    teller: threading.Thread | None = None

    def go_on_telling() -> None:
        while not over.wait(_BREATH):
            if depth:
                tell(min((spent + time.process_time() - began) / expected, _NEVER_DONE), sentence)

    def watch(name: str, begins: bool) -> None:
        nonlocal expected, sentence, spent, began, depth, teller
        if begins:
            began = began if depth else time.process_time()
            depth += 1
            if teller is None:
                expected = expected_seconds(prepared)
                sentence = f"compiling the engine, once on this computer: about {expected:.0f} s"
                tell(0.0, sentence)
                teller = threading.Thread(target=go_on_telling, daemon=True)
                teller.start()
        elif depth:
            depth -= 1
            spent += 0.0 if depth else time.process_time() - began

    try:
        with compilations(watch):
            yield
    finally:
        over.set()
        if teller is not None:
            teller.join()
            _remember(prepared, spent)


def expected_seconds(prepared: Prepared) -> float:
    """Return the expected time to compile the kernels of a scene on this computer [s]."""
    return float(_known().get(_name(prepared), _USUAL))


def compile_kernels(prepared: Prepared) -> float:
    """Compile the kernels of a scene unless they are stored already; return the processor time that it took [s].

    The box is built as for a run, since the kernels depend on it, and advanced by a very short time.
    """
    spent, began = 0.0, 0.0

    def watch(name: str, begins: bool) -> None:
        nonlocal spent, began
        now = time.process_time()
        spent, began = (spent, now) if begins else (spent + now - began, now)

    with compilations(watch):
        setup = build(prepared)
        setup.parcel.advance(0.0)
        step = getattr(setup.parcel, "time_step", 0.0)
        setup.parcel.advance(max(2.0 * step, 1e-4 * setup.frame))
    if spent:
        _remember(prepared, spent)
    return spent


def cache_home() -> Path | None:
    """Return the folder in which machine code is stored, None if there is none."""
    folder = cache_folder()
    return None if folder is None else folder.parent


def compiled_here() -> int:
    """Return the number of bytes of machine code that are stored for the present engine."""
    folder = cache_folder()
    return 0 if folder is None else sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())


def _name(prepared: Prepared) -> str:
    return f"{prepared.scene} {prepared.engine.name}"


def _known() -> dict[str, float]:
    """Return the seconds that compilations took, by scene and engine."""
    known = remembered(_FILE)
    return {k: float(v) for k, v in known.items() if isinstance(v, int | float)} if isinstance(known, dict) else {}


def _remember(prepared: Prepared, seconds: float) -> None:
    """Store how long a compilation took."""
    if seconds > 1.0:
        remember(_FILE, _known() | {_name(prepared): round(seconds, 1)})


def remembered(name: str) -> Any:
    """Return what a file beside the machine code holds; None if it cannot be read."""
    home = cache_home()
    try:
        return json.loads((home / name).read_text(encoding="utf-8")) if home else None
    except (OSError, ValueError):
        return None


def remember(name: str, held: object) -> None:
    """Store something beside the machine code; an error is ignored, because nothing depends on these files."""
    home = cache_home()
    if home is not None:
        new = home / f"{name}.{os.getpid()}"
        with contextlib.suppress(OSError):
            new.write_text(json.dumps(held), encoding="utf-8")
            new.replace(home / name)
