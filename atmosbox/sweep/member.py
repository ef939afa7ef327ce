"""One run of a sweep: it writes a netCDF file, or tells why it could not."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from typing import NamedTuple

from atmosbox import scenarios
from atmosbox.errors import AtmosboxError, FileError
from atmosbox.file.checkpoint import Checkpoint
from atmosbox.file.output_lock import BusyError
from atmosbox.scene.settings import Value
from atmosbox.simulation.preparation import Prepared, build, prepare
from atmosbox.simulation.restart import check_alike, read_state
from atmosbox.simulation.runner import execute

__all__ = ["Done", "Task", "compile_first", "run"]

PATIENCE = 30.0
"""Longest time to wait for another process that is at the same run [s]."""


class Task(NamedTuple):
    """One run of a sweep, as it is sent to the process that computes it.

    ``point`` and ``member`` count from 1; the last of the varied settings varies fastest from point to point. ``path``
    is the file that the run writes.
    """

    point: int
    member: int
    scene: str
    settings: dict[str, Value]
    engine: str | None
    accuracy: str | None
    path: str

    def prepared(self) -> Prepared:
        """Return the scene, ready to run."""
        return prepare(self.scene, self.settings, engine=self.engine, accuracy=self.accuracy)


class Done(NamedTuple):
    """A run that has ended: the reason if it failed, empty if it is complete, and its warnings."""

    task: Task
    reason: str = ""
    warnings: tuple[str, ...] = ()


def run(task: Task, progress: Callable[[float, str], None] | None = None) -> Done:
    """Run one member and write its file; go on from the state that an earlier call has saved, if there is one.

    Raises
    ------
    FileError
        If the file cannot be written: then no other member can be saved either.
    KeyboardInterrupt
        After Ctrl-C; what is complete is saved in the part of the file.
    """
    reason = ""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            prepared = task.prepared()
            checkpoint, restart = Checkpoint(task.path, force=True), None
            if checkpoint.part.exists():
                try:
                    restart = read_state(checkpoint.part)
                    check_alike(restart, prepared)
                except FileError:  # damaged, or of another version: the run begins again
                    restart = None
            _begin(checkpoint)
            execute(prepared, checkpoint=checkpoint, progress=progress, restart=restart)
        except FileError:
            raise
        except AtmosboxError as error:
            reason = str(error)
        except MemoryError:
            reason = "The computer has not enough memory for it."
        except Exception as error:
            where = scenarios.place(error)
            what = "This is a bug in atmosbox" if where is None else f"{where} cannot be run"
            reason = f"{what} ({type(error).__name__}: {error})."
    return Done(task, " ".join(reason.split()), tuple(sorted({str(each.message) for each in caught})))


def _begin(checkpoint: Checkpoint) -> None:
    """Take the file of a run; wait for a worker of a sweep that was stopped, which may still be at it."""
    until = time.monotonic() + PATIENCE
    while True:
        try:
            checkpoint.begin()
        except BusyError:
            if time.monotonic() > until:
                raise
            time.sleep(0.1)
        else:
            return


def compile_first(task: Task) -> None:
    """Build the box of a run, so that its kernels are compiled once and not by all processes at the same time."""
    try:
        build(task.prepared()).parcel.advance(0.0)
    except Exception:
        return  # the run itself tells what is wrong
