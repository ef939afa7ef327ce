"""Time series of a long session, kept to a number of points that a graph can show."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

__all__ = ["Trace", "plain"]

MOST = 4000
"""Largest number of points of a series that are kept."""


def plain(values: ArrayLike) -> list[float | None]:
    """Return numbers as JSON can hold them, with seven digits; numbers that are not finite become null.

    Examples
    --------
    >>> plain([1.0, math.nan, 1.0 / 3.0])
    [1.0, None, 0.3333333]
    """
    numbers = np.atleast_1d(np.asarray(values, np.float64)).ravel()
    return [float(f"{x:.7g}") if math.isfinite(x) else None for x in numbers.tolist()]


class Trace:
    """Values against time; whenever there are too many, every second one is dropped.

    Examples
    --------
    >>> trace = Trace(most=4)
    >>> trace.append([1.0, 2.0, 3.0, 4.0, 5.0, 6.0], {"warmth": [1, 2, 3, 4, 5, 6]})
    True
    >>> trace.message(reset=True)["time"]
    [2.0, 4.0, 6.0]
    """

    def __init__(self, most: int = MOST) -> None:
        self._most = most
        self._time: list[float] = []
        self._values: dict[str, list[float | None]] = {}
        self._every = 1
        self._count = 0

    def __len__(self) -> int:
        return len(self._time)

    def append(self, time: Sequence[float], values: Mapping[str, Sequence[float | None]]) -> bool:
        """Append points; return whether earlier ones were dropped, so that all must be sent anew."""
        for name in values:
            self._values.setdefault(name, [None] * len(self._time))
        for k, moment in enumerate(time):
            self._count += 1
            if self._count % self._every:
                continue
            self._time.append(moment)
            for name, column in self._values.items():
                column.append(values[name][k] if name in values else None)
        thinned = False
        while len(self._time) > self._most:
            self._time = self._time[1::2]
            self._values = {name: column[1::2] for name, column in self._values.items()}
            self._every *= 2
            thinned = True
        return thinned

    def message(self, *, reset: bool, since: int = 0) -> dict[str, Any]:
        """Return the points from number `since` on as a message to the page."""
        values = {name: column[since:] for name, column in self._values.items()}
        return {"type": "series", "reset": reset, "time": self._time[since:], "values": values}
