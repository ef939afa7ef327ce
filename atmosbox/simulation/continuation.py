"""One run among many that goes on where an earlier call of the same, which was killed, has left it."""

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
"""For how long the process that was at the run before may take to end [s]: it does, once the engine lets it."""


def execute_from(
    prepared: Prepared, path: str | os.PathLike[str] | None, progress: Callable[[float, str], None] | None = None
) -> Outcome:
    """Run a prepared scenario, from where its state stands if there is one; its state is kept as it goes on.

    A state that is damaged, or of another version or other settings, counts for nothing: the run begins anew. So it
    does without keeping any where no file can be written, or where another process is at the same run.

    Parameters
    ----------
    prepared
        From `atmosbox.simulation.preparation.prepare`.
    path
        What its file would be if it had one, see `atmosbox.file.run_states.StateCheckpoint`; None keeps no state.
    progress
        Called with the share that is done and a word on what is being done.

    Raises
    ------
    Interrupted
        After Ctrl-C.
    EngineError
        If the engine cannot go on.
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
    """Take a state for this process alone, as soon as a process that is about to end lets it go.

    Raises
    ------
    FileError
        If the other process goes on.
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
