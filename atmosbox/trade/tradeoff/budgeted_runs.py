"""The order of runs, so that all together take no longer than a budget of time."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from atmosbox.errors import AtmosboxError

__all__ = ["BudgetedRuns", "Progress"]

MOST_RUNS = 64
FIRST_SHARE = 0.25
"""A first run that would take more than this share of the budget waits until all other ways have run once."""
TELLING = 0.02
"""Share of a run after which the time of the rest can be estimated."""

Progress = Callable[[float, str], None]
Result = TypeVar("Result")


class _TooLong(Exception):
    """A run takes more time than is allowed."""


@dataclass
class BudgetedRuns(Generic[Result]):
    """Runs of several ways of doing something, each repeated as often as a budget of time allows.

    First, every way is compiled and run once. Then come the ways whose first run was too long for its share of the
    budget, the shortest first, if they still fit. Then all ways are repeated, those with the fewest runs first. The
    time of compiling counts, too, and a run that is under way when the budget ends is stopped.

    Parameters
    ----------
    budget
        Time for everything [s].
    labels
        Name of each way.
    compile_way
        Called before the first run of a way with its number and the time that is left [s]; returns whether the way is
        compiled.
    run_way
        Called with the number of a way, the number of its earlier runs, and a function that takes the share that is
        done and the word "running"; returns the result.
    tell
        Called with the share of the budget that is spent and the name of the present way.
    clock
        Returns the time [s].
    keep
        Called with the number of a way, the number of its earlier runs, the result, and the spent part of the budget
        [s].
    results
        The results of each way; at the beginning those that an earlier call has saved.
    spent
        Part of the budget that an earlier call has spent [s].
    """

    budget: float
    labels: list[str]
    compile_way: Callable[[int, float], bool]
    run_way: Callable[[int, int, Progress], Result]
    tell: Progress
    clock: Callable[[], float] = time.perf_counter
    keep: Callable[[int, int, Result, float], None] = lambda k, done, result, spent: None
    results: list[list[Result]] = field(default_factory=list)
    spent: float = 0.0
    left_out: list[str] = field(init=False)

    def __post_init__(self) -> None:
        self.results = self.results or [[] for _ in self.labels]
        self.left_out = ["" for _ in self.labels]
        self._seconds = [math.inf for _ in self.labels]
        self._began = self.clock() - self.spent

    def left(self) -> float:
        """Return the rest of the budget [s]."""
        return self.budget - (self.clock() - self._began)

    def run(self) -> None:
        """Run all ways; ``results`` and ``left_out`` hold the outcome, also after an interruption."""
        ways, compiling = range(len(self.labels)), 0.0
        for k in ways:
            again = f"; compiling took {compiling:.0f} s of it, and takes none next time" if compiling > 1.0 else ""
            if self.left() <= 0.0:
                if not self.results[k]:
                    self.left_out[k] = f"left out: the budget was spent before its turn{again}"
                continue
            before = self.clock()
            try:
                done = self.compile_way(k, self.left())
            except AtmosboxError as error:
                self.left_out[k] = str(error)
                continue
            if not done:
                self.left_out[k] = f"left out: the budget ended while its engine was compiled{again}"
                continue
            compiling += self.clock() - before
            if self.results[k]:
                self._seconds[k] = 0.0  # saved by an earlier call: the next run will measure the time
                continue
            self._attempt(k, min(FIRST_SHARE * self.budget, self.left()))
        waiting = [k for k in ways if not self.results[k] and not self.left_out[k]]
        for k in sorted(waiting, key=lambda k: self._seconds[k]):
            if self._seconds[k] <= self.left():
                self._attempt(k, self.left())
            if not self.results[k] and not self.left_out[k]:
                known = math.isfinite(self._seconds[k])
                why = (
                    f"one run takes about {max(self._seconds[k], 1.0):.0f} s"
                    if known
                    else "the budget ended while it ran"
                )
                self.left_out[k] = f"left out: {why}"
        while fit := [
            k for k in ways
            if self.results[k] and len(self.results[k]) < MOST_RUNS and self._seconds[k] <= 0.9 * self.left()
        ]:  # fmt: skip
            self._attempt(min(fit, key=lambda k: (len(self.results[k]), self._seconds[k])), self.left())

    def _attempt(self, k: int, allowed: float) -> None:
        """Run a way once, if it takes no longer than allowed [s]."""
        start = self.clock()
        begun: list[float] = []  # the time and the share at the end of preparation, when the run itself began

        def watch(share: float, word: str) -> None:
            now = self.clock()
            if word == "running" and not begun:
                begun[:] = now, share
            needed = now - start
            if begun and share > begun[1] and (share - begun[1] > TELLING or needed > allowed):
                needed += (now - begun[0]) * (1.0 - share) / (share - begun[1])
                self._seconds[k] = needed
            # an estimate may be wrong by a half; the time that has passed is certain
            if now - start > allowed or needed > 1.5 * allowed:
                raise _TooLong
            self.tell(min(1.0 - self.left() / self.budget, 1.0), self.labels[k])

        try:
            done = len(self.results[k])
            result = self.run_way(k, done, watch)
            self.results[k].append(result)
            self._seconds[k] = self.clock() - start
            self.keep(k, done, result, self.budget - self.left())
        except _TooLong:
            if self.results[k]:
                self._seconds[k] = math.inf  # it was short enough before: other programs have slowed it down
        except AtmosboxError as error:
            self.left_out[k] = str(error)
            self._seconds[k] = math.inf
