"""One run among many that continues from where an earlier process, which was killed, has left it."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from atmosbox.errors import FileError
from atmosbox.simulation.preparation import Prepared
from atmosbox.simulation.restart import read_state
from atmosbox.simulation.runner import Outcome, execute

if TYPE_CHECKING:
    from atmosbox.file.run_states import StateCheckpoint

__all__ = ["execute_from"]

_PATIENCE = 10.0
"""Longest time to wait until the process that had the run before ends [s]: it ends when the engine allows it."""


def execute_from(
    prepared: Prepared, path: str | os.PathLike[str] | None, progress: Callable[[float, str], None] | None = None
) -> Outcome:
    """Run a prepared scenario, from its stored state if there is one, and store its state on the way.

    A state that is damaged, or of another version or other settings, is ignored: the run begins anew. If no file can be
    written, or another process has the same run, the run begins anew, too, and stores no state.

    Parameters
    ----------
    prepared
        From `atmosbox.simulation.preparation.prepare`.
    path
        Path that its file would have, see `atmosbox.file.run_states.StateCheckpoint`; None stores no state.
    progress
        Called with the completed share and a word on the present activity.

    Raises
    ------
    Interrupted
        After Ctrl-C.
    EngineError
        If the engine cannot continue.
    """
    from atmosbox.file.run_states import StateCheckpoint

    if path is None:
        return execute(prepared, progress=progress)
    try:
        checkpoint = StateCheckpoint(path)
        _take(checkpoint)
    except FileError:
        return execute(prepared, progress=progress)
    if checkpoint.part.exists():
        try:
            return execute(prepared, checkpoint=checkpoint, progress=progress, restart=read_state(checkpoint.part))
        except FileError:
            checkpoint.begin()
    return execute(prepared, checkpoint=checkpoint, progress=progress)


def _take(checkpoint: StateCheckpoint) -> None:
    """Take a state for this process alone; wait for a process that is about to end.

    Raises
    ------
    FileError
        If the other process does not end in time.
    """
    until = time.monotonic() + _PATIENCE
    while True:
        try:
            checkpoint.begin()
        except FileError:
            if time.monotonic() > until:
                raise
            time.sleep(0.05)
        else:
            return
