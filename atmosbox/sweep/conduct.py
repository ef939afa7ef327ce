"""A sweep from its first run to its file: every run is saved when it ends, and saved runs are not computed again."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from pathlib import Path
from typing import NamedTuple

import xarray as xr

from atmosbox.errors import SettingError
from atmosbox.file.checkpoint import Checkpoint
from atmosbox.file.journal import Journal
from atmosbox.file.provenance import history_line
from atmosbox.file.run_states import RunStates
from atmosbox.simulation.recording import uninterrupted
from atmosbox.sweep import local
from atmosbox.sweep.member import FAILED, Record
from atmosbox.sweep.plan import Plan, Task
from atmosbox.sweep.result import assemble

__all__ = ["SweepInterrupted", "Swept", "sweep"]

_EVERY = 10.0
"""Shortest time between two writings of the partial dataset [s]."""

Progress = Callable[[float, str], None]


class Swept(NamedTuple):
    """The result of a sweep."""

    dataset: xr.Dataset
    failures: tuple[tuple[int, int, str], ...]
    """Point, member and reason of every run that failed."""
    ledger: float
    """The largest residual of the energy ledger of any run."""
    computed: int
    """Number of runs that this call has computed."""
    recalled: int
    """Number of runs that an earlier call had saved."""


class SweepInterrupted(KeyboardInterrupt):
    """A sweep was stopped by Ctrl-C; ``swept`` holds the runs that have ended, None if there are none."""

    def __init__(self, swept: Swept | None, exit_code: int = 130) -> None:
        super().__init__("the sweep was interrupted")
        self.swept = swept
        self.exit_code = exit_code


def sweep(
    plan: Plan,
    out: str | os.PathLike[str] | None = None,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    force: bool = False,
    progress: Progress | None = None,
    note: Callable[[str], None] | None = None,
    command: str = "",
) -> Swept:
    """Run all members of a sweep, on the cores of this machine or on a cluster.

    Every run is saved when it ends, in ``NAME.part.jsonl`` beside the file; runs under way save their states in the
    folder ``NAME.part.states``. The same call continues where an earlier one stopped, for whatever reason, and its
    results are the same, bit for bit.

    Parameters
    ----------
    plan
        The sweep.
    out
        The netCDF file to write; by default nothing is written.
    jobs
        Number of processes on this machine; by default one for each core. With 1, the runs are made in this process
        itself.
    scheduler
        Address of a Dask scheduler, whose workers run the members instead.
    force
        Whether a file of that name may be replaced, and a journal of another sweep deleted.
    progress
        Called with the share that is done and a short text on the present step.
    note
        Called with remarks: how many runs are taken from an earlier call, and the warnings of runs.
    command
        The command that the user typed, for the history in the file.

    Returns
    -------
    Swept
        The dataset, and the runs that failed.

    Raises
    ------
    SweepInterrupted
        After Ctrl-C, with the runs that have ended.
    AtmosboxError
        If a file cannot be written, its journal belongs to another sweep, or the workers cannot be reached.

    Examples
    --------
    >>> from atmosbox.simulation.runner import LEDGER_LIMIT
    >>> from atmosbox.sweep.plan import plan
    >>> discs = plan("elastic-collisions", ["molecules=20,40"], settings={"duration": 5.0})
    >>> swept = sweep(discs, jobs=1)
    >>> dict(swept.dataset.sizes), swept.failures, swept.ledger < LEDGER_LIMIT
    ({'molecules': 2, 'member': 1}, (), True)
    """
    if jobs is not None and jobs < 1:
        raise SettingError("jobs", jobs, "is no number of processes", f"give --jobs {local.cores()}")
    if jobs is not None and scheduler is not None:
        raise SettingError("jobs", jobs, "is for this machine, and --scheduler for another", "leave one of them out")
    line = history_line(command or f"atmosbox.sweep.sweep({plan.scene!r}, ...)")
    if out is None:
        return _Conductor(plan, None, None, [line], progress, note).conduct(jobs, scheduler)
    checkpoint = Checkpoint(Path(out), _EVERY, force=force)
    with uninterrupted():
        checkpoint.load_libraries()
    checkpoint.begin()
    try:
        with Journal(checkpoint.path, plan.request(), line, force=force) as journal:
            return _Conductor(plan, journal, checkpoint, journal.history, progress, note).conduct(jobs, scheduler)
    finally:
        checkpoint.release()


class _Conductor:
    """A sweep under way."""

    def __init__(
        self,
        plan: Plan,
        journal: Journal | None,
        checkpoint: Checkpoint | None,
        history: Sequence[str],
        progress: Progress | None,
        note: Callable[[str], None] | None,
    ) -> None:
        self.plan, self.journal, self.checkpoint = plan, journal, checkpoint
        self.records: dict[tuple[int, int], Record] = {} if journal is None else dict(journal.records)
        self.recalled = len(self.records)
        self.history = history
        self.tell = progress or (lambda share, word: None)
        self.note = note or (lambda text: None)
        self.warned: set[str] = set()
        self.states = RunStates(None if checkpoint is None else checkpoint.path, self.records)

    def conduct(self, jobs: int | None, scheduler: str | None) -> Swept:
        """Run the members that have no record yet, and write the file."""
        tasks = [task for task in self.plan.tasks() if (task.point, task.member) not in self.records]
        tasks = [task._replace(state=self.states.place(task.point, task.member)) for task in tasks]
        if self.journal is not None and (self.recalled or self.states.begun):
            begun = f" and {self.states.begun} begun" if self.states.begun else ""
            self.note(
                f"{self.recalled} of {self.plan.runs} runs are saved in {self.journal.path}{begun}: going on with the "
                "rest"
            )
        try:
            if tasks:
                with closing(self._stream(tasks, jobs, scheduler)) as stream:
                    for record in stream:
                        self._keep(record)
            swept = self._swept("complete")
        except KeyboardInterrupt as stop:
            with uninterrupted():
                saved = self._stopped()
            raise SweepInterrupted(saved, getattr(stop, "exit_code", 130)) from None
        if self.checkpoint is not None and self.journal is not None:
            with uninterrupted():
                self.checkpoint.finish(swept.dataset)
                self.journal.remove()
                self.states.close(everything=True)
        self.tell(1.0, "done")
        return swept

    def _stream(self, tasks: list[Task], jobs: int | None, scheduler: str | None) -> Generator[Record]:
        """Yield the records of some runs when they end, from a cluster or from this machine."""
        if scheduler is not None:
            from atmosbox.sweep.cluster import remote

            return remote(tasks, scheduler, self._watch)
        jobs = min(jobs or local.cores(), len(tasks))
        return local.here(tasks, self._watch) if jobs == 1 else local.processes(tasks, jobs, self._watch)

    def _watch(self, share: float, word: str) -> None:
        self.tell(min((len(self.records) + share) / self.plan.runs, 1.0), word)

    def _keep(self, record: Record) -> None:
        """Save a run that has ended."""
        with uninterrupted():
            if self.journal is not None:
                self.journal.append(record)
            self.states.remove(record["point"], record["member"])
            self.records[record["point"], record["member"]] = record
        for text in record.get("warnings", ()):
            if text not in self.warned:
                self.warned.add(text)
                self.note(f"warning: {text}")
        if self.checkpoint is not None:
            self.checkpoint(lambda: self._dataset("partial"))
        self._watch(0.0, "running")

    def _stopped(self) -> Swept | None:
        """Write the dataset of the runs that have ended, and return it; None if there are none."""
        self.states.close()
        if not self.records:
            return None
        swept = self._swept("interrupted")
        if self.checkpoint is not None:
            self.checkpoint.save(swept.dataset)
        return swept

    def _dataset(self, status: str) -> xr.Dataset:
        return assemble(self.plan, self.records.values(), history=self.history, status=status)

    def _swept(self, status: str) -> Swept:
        failed = [
            (point, member, why)
            for point, why in self.plan.refused.items()
            for member in range(1, self.plan.members + 1)
        ]
        failed += [(*key, record["reason"]) for key, record in self.records.items() if record["status"] == FAILED]
        ledger = max((record["ledger"] for record in self.records.values() if "ledger" in record), default=0.0)
        computed = len(self.records) - self.recalled
        return Swept(self._dataset(status), tuple(sorted(failed)), ledger, computed, self.recalled)
