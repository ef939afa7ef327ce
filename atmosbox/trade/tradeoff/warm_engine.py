"""Compilation of an engine in a process of its own, which can be stopped when a budget of time ends.

A compiler cannot be interrupted otherwise.
"""

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
    """Return text that tells what is compiled for a rung: its engine, and its settings that are not numbers.

    Examples
    --------
    >>> kind(Rung("stepped:delta=0.1", {"plane": True, "duration": 50.0}, 0, 0.1))
    'stepped plane=True'
    """
    words: Mapping[str, Any] = {name: value for name, value in rung.settings.items() if isinstance(value, bool | str)}
    return " ".join([rung.engine.partition(":")[0], *(f"{name}={value}" for name, value in sorted(words.items()))])


def compile_within(scene: str, rung: Rung, seconds: float) -> bool:
    """Compile what a rung needs, unless that takes too long, and return whether it is compiled.

    Another process compiles, and this one loads the machine code from the disk. A file beside the machine code marks
    what has been compiled before; then no other process is started.

    Parameters
    ----------
    scene
        The name of a scene, or the path of one.
    rung
        The way of running it.
    seconds
        Longest time that it may take [s].

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
    timed_run.warm_up(scene, rung)  # if the other process has failed, this raises the same error
    if mark is not None:
        mark.parent.mkdir(parents=True, exist_ok=True)
        mark.touch()
    return True


def _mark(folder: Path, scene: str, rung: Rung) -> Path:
    """Return the file that marks an engine as compiled; other sources of the engine have another folder."""
    name = hashlib.sha256(f"{scene} {kind(rung)}".encode()).hexdigest()[:16]
    return folder / f"{name}.compiled"
