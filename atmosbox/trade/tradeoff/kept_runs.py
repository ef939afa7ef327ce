"""The saved runs of a tradeoff, and the saved states of runs under way, from which a killed measurement continues."""

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
    """The files beside the file of a tradeoff during its measurement: ``NAME.part.jsonl`` and ``NAME.part.states``.

    Parameters
    ----------
    path
        The file of the tradeoff; if None, nothing is saved.
    request
        All that determines the measurement, by names for messages.
    command
        The command that the user typed.
    force
        Whether the saved runs of another tradeoff are deleted.

    Attributes
    ----------
    spent
        Part of the budget that earlier calls have spent [s].
    history
        A line for each command that took part; empty if nothing is saved.

    Raises
    ------
    FileError
        If there is a journal of another request, or if another program is writing it.
    """

    def __init__(self, path: Path | None, request: Mapping[str, Any], command: str, *, force: bool = False) -> None:
        self._journal: Journal | None = None
        self.spent = 0.0
        self.history: list[str] = []
        if path is not None:
            # costs measured on another computer or with other sources of the engine cannot be compared
            asked = {**request, "sources of the engine": source_digest(), "computer": platform.node()}
            self._journal = Journal(path, asked, history_line(command), force=force, kind="tradeoff")
            self.history = self._journal.history
            self.spent = max((float(each["spent"]) for each in self._journal.records.values()), default=0.0)
        self._states = RunStates(path, () if self._journal is None else self._journal.records)

    def trials(self, ways: int) -> list[list[Trial]]:
        """Return the runs of earlier calls, by way of running."""
        made: list[list[Trial]] = [[] for _ in range(ways)]
        records = {} if self._journal is None else self._journal.records
        for (k, _), record in sorted(records.items()):
            made[k - 1].append(_trial(record["trial"]))
        return made

    def place(self, k: int, done: int) -> str | None:
        """Return the path of the saved state of a run; None if nothing is saved."""
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
        """Release the files for other programs; only those that a next call needs remain."""
        self._states.close()
        if self._journal is not None:
            self._journal.__exit__()

    @staticmethod
    def remove(path: Path) -> None:
        """Remove the saved runs and states after the file of the tradeoff has been written."""
        RunStates(path).close(everything=True)
        Journal.place(path).unlink(missing_ok=True)


def _plain(trial: Trial) -> dict[str, Any]:
    """Return a trial in types that JSON can hold."""
    held = trial._asdict()
    held["quantities"] = [list(each) for each in trial.quantities.values()]
    return held | {part: {name: values.tolist() for name, values in held[part].items()} for part in _CURVES}


def _trial(held: Mapping[str, Any]) -> Trial:
    made = dict(held)
    made["quantities"] = {entry[0]: Quantity(*entry) for entry in held["quantities"]}
    return Trial(**made | {part: {name: np.array(values) for name, values in held[part].items()} for part in _CURVES})
