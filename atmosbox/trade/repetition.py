"""The order of runs: every way of running once, then again and again, while a budget of time lasts."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TypeVar

from atmosbox.errors import AtmosboxError

__all__ = ["MOST_RUNS", "Progress", "repeat"]

MOST_RUNS = 64
FIRST_SHARE = 0.25
"""A first run that would take more than this share of the budget waits until all other ways have run once."""
TELLING = 0.02
"""Share of a run after which the time of the rest can be estimated."""

Progress = Callable[[float, str], None]
Result = TypeVar("Result")


class _TooLong(Exception):
    """A run takes more time than is allowed."""


def repeat(
    budget: float,
    results: Sequence[list[Result]],
    run: Callable[[int, Progress], Result],
    tell: Callable[[float, int], None] = lambda share, k: None,
    ended: Callable[[], None] = lambda: None,
    clock: Callable[[], float] = time.perf_counter,
) -> list[str]:
    """Run all ways of doing something as often as a budget of time allows, those with the fewest runs first.

    A run that takes too long is stopped. As long as there is no result at all, a run may take the whole budget,
    whatever was spent on others.

    Parameters
    ----------
    budget
        Time for everything [s].
    results
        The results of each way, to which new ones are added.
    run
        Called with the number of a way and a function that takes the share that is done and the word "running";
        returns the result.
    tell
        Called with the share of the budget that is spent and the number of the present way.
    ended
        Called after each run.
    clock
        Returns the time [s].

    Returns
    -------
    list of str
        For each way, why it has no result, or why its runs failed; empty if there is nothing to say.
    """
    began = clock()
    seconds = [0.0] * len(results)  # the time of a run, as far as it is known
    failed = [""] * len(results)

    def left() -> float:
        return budget - (clock() - began) if any(results) else budget

    def attempt(k: int, allowed: float) -> None:
        start = clock()
        begun: list[float] = []  # the time and the share at the end of preparation, when the run itself began

        def watch(share: float, word: str) -> None:
            now = clock()
            if word == "running" and not begun:
                begun[:] = now, share
            needed = now - start
            if begun and share > begun[1] and (share - begun[1] > TELLING or needed > allowed):
                needed += (now - begun[0]) * (1.0 - share) / (share - begun[1])
            # an estimate may be wrong by a half; the time that has passed is certain
            if now - start > allowed or needed > 1.5 * allowed:
                seconds[k] = needed
                raise _TooLong
            tell(min((now - began) / budget, 1.0), k)

        try:
            results[k].append(run(k, watch))
        except _TooLong:
            return
        except AtmosboxError as error:
            failed[k] = str(error)
            return
        seconds[k] = clock() - start
        ended()

    def waits(k: int) -> tuple[int, float]:
        return len(results[k]), seconds[k]

    while fit := [
        k for k in range(len(results))
        if not failed[k] and len(results[k]) < MOST_RUNS and 1.1 * seconds[k] < left()
    ]:  # fmt: skip
        k = min(fit, key=waits)
        attempt(k, left() if seconds[k] else min(FIRST_SHARE * budget, left()))
    for k, done in enumerate(results):
        if not done and not failed[k]:
            long = (
                f"one run takes about {max(seconds[k], 1.0):.0f} s"
                if seconds[k]
                else "the budget was spent before it began"
            )
            failed[k] = f"left out: {long}"
    return failed
