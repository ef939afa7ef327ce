"""Schedules: numbers that may change with time, such as the temperature of a heat bath."""

import itertools
from dataclasses import dataclass
from typing import Protocol

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.refusal import LARGEST, RefusedError, number


class Schedule(Protocol):
    """A number as a function of time."""

    def points(self) -> list[tuple[float, float]]:
        """Return points (time, value); straight lines connect them, and outside the value stays constant."""


@dataclass(frozen=True)
class Ramp:
    """A linear change from ``first`` to ``last`` between the times ``start`` and ``end``; constant before and after.

    Examples
    --------
    >>> Ramp(1.0, 2.0, start=0.0, end=10.0).points()
    [(0.0, 1.0), (10.0, 2.0)]
    """

    first: float
    last: float
    start: float
    end: float

    def points(self) -> list[tuple[float, float]]:
        """Return the two corners."""
        if not self.end > self.start:
            raise RefusedError(f"a ramp that starts at {self.start} must end later, not at {self.end}")
        return [(float(self.start), float(self.first)), (float(self.end), float(self.last))]


def as_schedule(value: "float | Schedule", name: str) -> list[tuple[float, float]]:
    """Return the corners of a number or a schedule; refuse what is not finite and above 0, and times that decrease.

    >>> as_schedule(1.5, "kT of a wall")
    [(0.0, 1.5)]
    """
    corners = list(value.points()) if hasattr(value, "points") else [(0.0, number(value, name))]
    if not corners:
        raise RefusedError(f"{name} = {value!r} has no points: give at least one (time, value)")
    for time, level in corners:
        number(time, f"a time of {name}")
        number(level, name, above=0.0, most=LARGEST)
    if any(later < earlier for (earlier, _), (later, _) in itertools.pairwise(corners)):
        raise RefusedError(f"the times of {name} must not decrease: give its points in order of time")
    return corners


@kernel(plain=True)
def interpolate(x, xs, ys):
    """Return y at x, interpolated linearly between the points (xs, ys) and constant beyond both ends.

    >>> import numpy as np
    >>> float(interpolate(1.5, np.array([1.0, 2.0]), np.array([0.0, 4.0])))
    2.0
    """
    if x <= xs[0]:
        return ys[0]
    high = xs.size - 1
    if x >= xs[high]:
        return ys[high]
    low = 0
    while high - low > 1:
        middle = (low + high) >> 1
        if xs[middle] <= x:
            low = middle
        else:
            high = middle
    return ys[low] + (ys[high] - ys[low]) * ((x - xs[low]) / (xs[high] - xs[low]))
