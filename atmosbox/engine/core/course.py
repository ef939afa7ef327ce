"""How far along its planned ascent a parcel is: as planned, or moved by hand."""

import math

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.inputs import number
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.refusal import RefusedError

__all__ = ["Course", "interpolate"]


@kernel(plain=True)
def interpolate(x, xs, ys):
    """Return y at x, interpolated linearly between the points (xs, ys) and constant beyond both ends.

    Examples
    --------
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


class Course:
    """The moment of its plan that a parcel has reached, as a function of time.

    A plan gives the environment at each moment from 0 to its end. By default a parcel follows the plan: at time t it
    is at the moment t. When led by hand it goes to another moment, forwards or backwards, always at the pace of the
    plan, and stays there. So it never moves faster than planned.

    Parameters
    ----------
    end
        The last moment of the plan [time].

    Examples
    --------
    >>> course = Course(10.0)
    >>> course.moment(3.0)
    3.0
    >>> course.lead(4.0, towards=1.0)
    >>> course.moment(4.0), course.moment(5.0), course.moment(9.0)
    (4.0, 3.0, 1.0)
    """

    def __init__(self, end: float = math.inf) -> None:
        self.end = end
        self._time = [0.0]
        self._moment = [0.0]
        self._changed = 0.0

    @property
    def led(self) -> bool:
        """Whether `lead` has been called."""
        return len(self._time) > 1

    def moment(self, time: float) -> float:
        """Return the moment of the plan [time] at a time [time]."""
        if not self.led:
            return min(time, self.end)
        return float(interpolate(time, np.array(self._time), np.array(self._moment)))

    def corners(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the times and moments between which the moment is linear in time; it is constant after the last.

        Examples
        --------
        >>> [corner.tolist() for corner in Course(10.0).corners()]
        [[0.0, 10.0], [0.0, 10.0]]
        """
        if self.led or not 0.0 < self.end < math.inf:
            return np.array(self._time), np.array(self._moment)
        return np.array([0.0, self.end]), np.array([0.0, self.end])

    def lead(self, time: float, towards: float) -> None:
        """Go to another moment of the plan, and stay there.

        Parameters
        ----------
        time
            The time now [time]; earlier parts of the course stay as they were.
        towards
            The moment to go to [time].

        Raises
        ------
        RefusedError
            If a number is not finite, the moment is not in the plan, or the time lies before that of the last call.
        """
        time, towards = number(time, "time"), number(towards, "the moment", least=0.0, most=self.end)
        if time < self._changed:
            raise RefusedError(f"time = {time} lies before the last change, at {self._changed}: give a later time")
        here = self.moment(time)
        if not self.led and time > self.end:  # it reached the end of the plan earlier
            self._time.append(self.end)
            self._moment.append(self.end)
        while self._time[-1] > time:
            self._time.pop()
            self._moment.pop()
        self._changed = time
        for when, where in ((time, here), (time + math.fabs(towards - here), towards)):
            if when > self._time[-1]:
                self._time.append(when)
                self._moment.append(where)
