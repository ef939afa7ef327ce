"""An engine compiled in a process of its own, so that a budget of time can end it: a compiler cannot be interrupted."""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.core.kernel_cache import cache_folder
from atmosbox.trade.tradeoff import timed_run
from atmosbox.trade.tradeoff.rung import Rung

__all__ = ["compile_within", "kind"]

_PROGRAM = """
import json, sys
from atmosbox.trade.tradeoff import timed_run
from atmosbox.trade.tradeoff.rung import Rung
scene, engine, settings = json.loads(sys.argv[1])
timed_run.warm_up(scene, Rung(engine, settings, 0, 0.0))
"""


def kind(rung: Rung) -> str:
    """Return what is compiled for a rung: its engine, and the settings that are no numbers, as a plane or drops are.

    Examples
    --------
    >>> kind(Rung("stepped:delta=0.1", {"plane": True, "duration": 50.0}, 0, 0.1))
    'stepped plane=True'
    """
    words: Mapping[str, Any] = {name: value for name, value in rung.settings.items() if isinstance(value, bool | str)}
    return " ".join([rung.engine.partition(":")[0], *(f"{name}={value}" for name, value in sorted(words.items()))])


def compile_within(scene: str, rung: Rung, seconds: float) -> bool:
    """Compile what a rung needs, unless that takes longer than it may, and tell whether it is done.

    Another process compiles, and this one loads the machine code that it has left. Where that has been done before,
    which a file beside the machine code says, no other process is begun.

    Parameters
    ----------
    scene
        The name of a scene, or the path of one.
    rung
        The way of running it.
    seconds
        How long it may take.

    Raises
    ------
    AtmosboxError
        If the engine refuses the scene.

    Examples
    --------
    >>> compile_within("elastic-collisions", Rung("exact", {}, 0, 0.0), 600.0)
    True
    """
    folder = cache_folder() if COMPILED else None
    mark = _mark(folder, scene, rung) if folder else None
    if mark is not None and not mark.exists():
        asked = json.dumps([scene, rung.engine, dict(rung.settings)])
        with subprocess.Popen(
            [sys.executable, "-c", _PROGRAM, asked],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        ) as other:  # fmt: skip
            try:
                other.wait(max(seconds, 0.0))
            except subprocess.TimeoutExpired:
                return False
            finally:
                other.kill()
    timed_run.warm_up(scene, rung)  # if the other has failed, this says why
    if mark is not None:
        mark.parent.mkdir(parents=True, exist_ok=True)
        mark.touch()
    return True


def _mark(folder: Path, scene: str, rung: Rung) -> Path:
    """Return the file that says that an engine is compiled; a new engine has a new folder."""
    name = hashlib.sha256(f"{scene} {kind(rung)}".encode()).hexdigest()[:16]
    return folder / f"{name}.compiled"
