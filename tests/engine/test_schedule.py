"""A schedule is piecewise linear in time: its corners, and what is refused."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

from atmosbox.engine import HeatBath, Ramp, RefusedError, Specular
from atmosbox.engine.core.schedule import as_schedule
from atmosbox.engine.core.walls import new_walls, wall_kT


def kT_at(schedule, times):
    """Return the schedule as a wall stores it."""
    walls = new_walls((*(Specular(),) * 4, HeatBath(schedule), Specular()), 1.0)
    return [float(wall_kT(walls, 4, time)) for time in times]


@dataclass(frozen=True)
class Zigzag:
    """A user's own schedule."""

    corners: tuple = ((1.0, 1.0), (2.0, 3.0), (4.0, 2.0))

    def points(self):
        return list(self.corners)


def test_a_number_is_a_schedule_that_never_changes():
    assert as_schedule(2.5, "kT") == [(0.0, 2.5)]
    assert kT_at(2.5, [-1.0, 0.0, 1e9]) == [2.5, 2.5, 2.5]


def test_a_ramp_is_constant_before_and_after_and_even_between():
    assert kT_at(Ramp(1.0, 3.0, start=2.0, end=6.0), [0.0, 2.0, 3.0, 5.0, 6.0, 99.0]) == [1.0, 1.0, 1.5, 2.5, 3.0, 3.0]


def test_two_corners_at_one_time_are_a_step():
    steps = Zigzag(((0.0, 1.0), (5.0, 1.0), (5.0, 2.0), (7.0, 2.0), (7.0, 4.0)))
    times = [-1.0, 0.0, math.nextafter(5.0, 0.0), 5.0, 6.9, 7.0, 1e6]
    assert kT_at(steps, times) == [1.0, 1.0, 1.0, 2.0, 2.0, 4.0, 4.0]


def test_a_schedule_of_somebodys_own_is_a_polygon_too():
    times = [0.0, 1.0, 1.25, 2.0, 3.0, 4.0, 9.0]
    corner_times, values = zip(*Zigzag().points(), strict=True)
    assert kT_at(Zigzag(), times) == pytest.approx(np.interp(times, corner_times, values))


def test_an_impossible_temperature_is_refused():
    cases = [0.0, -1.0, math.nan, "warm", None, [1.0, 2.0], Zigzag(()), Zigzag(((1.0, 1.0), (0.0, 2.0)))]
    cases += [Ramp(1.0, last, start=0.0, end=end) for last, end in ((0.0, 1.0), (2.0, 0.0), (2.0, math.nan))]
    for value in cases:
        with pytest.raises(RefusedError):
            as_schedule(value, "kT of wall z_low")
