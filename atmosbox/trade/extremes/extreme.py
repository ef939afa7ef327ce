"""An extreme: a box that breaks simulations, and how to tell what an engine makes of it."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType

from atmosbox.trade.extremes.guarded_run import Trial
from atmosbox.trade.extremes.verdict import Verdict

__all__ = ["Extreme", "extreme", "extremes_of"]

ANY = ("exact", "stepped", "dsmc", "classic")


@dataclass(frozen=True)
class Extreme:
    """One row of the assessment.

    Parameters
    ----------
    name
        Its name, in words joined by hyphens.
    title
        What stands in a table.
    asked
        What the engine is asked to do, and what a right engine does.
    examine
        Takes a `Trial` and returns what came out; what it does not catch is judged by the assessment.
    long
        Whether it takes more than some seconds.
    may_refuse
        The engines for which a refusal is an answer; of the others it is wrong.
    """

    name: str
    title: str
    asked: str
    examine: Callable[[Trial], Verdict]
    long: bool = False
    may_refuse: tuple[str, ...] = ()


def extreme(
    name: str, title: str, *, long: bool = False, may_refuse: tuple[str, ...] = ()
) -> Callable[[Callable[[Trial], Verdict]], Extreme]:
    """Make an extreme of a function; what is asked is its docstring."""

    def make(examine: Callable[[Trial], Verdict]) -> Extreme:
        return Extreme(name, title, inspect.cleandoc(examine.__doc__ or ""), examine, long, may_refuse)

    return make


def extremes_of(module: ModuleType) -> list[Extreme]:
    """Return the extremes of a file, in the order in which they stand there."""
    return [value for value in vars(module).values() if isinstance(value, Extreme)]
