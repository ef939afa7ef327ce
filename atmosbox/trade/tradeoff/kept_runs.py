"""The runs of a tradeoff that are complete, and the states of those under way: what is killed goes on."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from atmosbox.engine.core.kernel_cache import source_digest
from atmosbox.file.journal import Journal
from atmosbox.file.provenance import history_line
from atmosbox.file.run_states import RunStates
from atmosbox.trade.tradeoff.timed_run import Quantity, Trial

__all__ = ["KeptRuns"]

_CURVES = ("error", "noise")


class KeptRuns:
    """What is kept beside the file of a tradeoff while it is measured: ``NAME.part.jsonl`` and ``NAME.part.states``.

    Parameters
    ----------
    path
        The file; None keeps nothing.
    request
        All that was asked for, by what a sentence calls it.
    command
        What the user typed.
    force
        Whether what is kept of another tradeoff is thrown away.

    Attributes
    ----------
    spent
        How much of the budget earlier calls have spent [s].
    history
        The lines of all commands that took part; none if nothing is kept.

    Raises
    ------
    FileError
        If there is a journal of another request, or another program writes it right now.
    """

    def __init__(self, path: Path | None, request: Mapping[str, Any], command: str, *, force: bool = False) -> None:
        self._journal: Journal | None = None
        self.spent = 0.0
        self.history: list[str] = []
        if path is not None:
            # costs that were measured on another computer, or of other sources, are other costs
            asked = {**request, "sources of the engine": source_digest(), "computer": platform.node()}
            self._journal = Journal(path, asked, history_line(command), force=force, kind="tradeoff")
            self.history = self._journal.history
            self.spent = max((float(each["spent"]) for each in self._journal.records.values()), default=0.0)
        self._states = RunStates(path, () if self._journal is None else self._journal.records)

    def trials(self, ways: int) -> list[list[Trial]]:
        """Return what earlier calls have measured, by way."""
        made: list[list[Trial]] = [[] for _ in range(ways)]
        records = {} if self._journal is None else self._journal.records
        for (k, _), record in sorted(records.items()):
            made[k - 1].append(_trial(record["trial"]))
        return made

    def place(self, k: int, done: int) -> str | None:
        """Return where a run keeps its state."""
        return self._states.place(k + 1, done + 1)

    def drop(self, k: int, done: int) -> None:
        """Remove the state of a run that was given up."""
        self._states.remove(k + 1, done + 1)

    def keep(self, k: int, done: int, trial: Trial, spent: float) -> None:
        """Save a run; when this returns, it is on the disk."""
        if self._journal is not None:
            self._journal.append({"point": k + 1, "member": done + 1, "spent": spent, "trial": _plain(trial)})
        self.drop(k, done)

    def close(self) -> None:
        """Let other programs have the files, and leave nothing but what a next call needs."""
        self._states.close()
        if self._journal is not None:
            self._journal.__exit__()

    @staticmethod
    def remove(path: Path) -> None:
        """Remove what is kept: the file of the tradeoff is written."""
        RunStates(path).close(everything=True)
        Journal.place(path).unlink(missing_ok=True)


def _plain(trial: Trial) -> dict[str, Any]:
    """Return a trial as JSON can hold it."""
    held = trial._asdict()
    held["quantities"] = [list(each) for each in trial.quantities.values()]
    return held | {part: {name: values.tolist() for name, values in held[part].items()} for part in _CURVES}


def _trial(held: Mapping[str, Any]) -> Trial:
    made = dict(held)
    made["quantities"] = {entry[0]: Quantity(*entry) for entry in held["quantities"]}
    return Trial(**made | {part: {name: np.array(values) for name, values in held[part].items()} for part in _CURVES})
