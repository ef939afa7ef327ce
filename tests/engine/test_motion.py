"""Free flight reaches planes at the right times, with full precision where terms nearly cancel."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from atmosbox.engine.core.motion import time_to_ceiling, time_to_leave, time_to_leave_in_gravity

SHARES = st.floats(0.0, 1.0)
SPEEDS = st.floats(-10.0, 10.0).filter(lambda v: v == 0.0 or abs(v) > 1e-6)
GRAVITIES = st.floats(1e-3, 1e3)


@given(SHARES, SPEEDS)
def test_uniform_motion_leaves_at_the_end_it_heads_for(share, v):
    low, high = -1.0, 2.0
    x = low + share * (high - low)
    time, end = time_to_leave(x, v, low, high)
    if v == 0.0:
        assert time == math.inf
    else:
        assert end == (v > 0.0)
        assert x + v * time == pytest.approx(high if end else low, abs=1e-12)


def test_a_molecule_outside_by_rounding_leaves_at_once():
    assert time_to_leave(2.0 + 1e-15, 1.0, 0.0, 2.0) == (0.0, 1)
    assert time_to_leave(-1e-15, -1.0, 0.0, 2.0) == (0.0, 0)
    assert time_to_leave_in_gravity(-1e-15, -1.0, 0.0, 2.0, 1.0) == (0.0, 0)


@given(SHARES, SPEEDS, GRAVITIES)
def test_a_parabola_leaves_at_the_end_it_reaches_first(share, v, gravity):
    low, high = 0.0, 3.0
    z = low + share * (high - low)
    time, end = time_to_leave_in_gravity(z, v, low, high, gravity)
    assert time >= 0.0
    reached = z + v * time - 0.5 * gravity * time**2
    assert reached == pytest.approx(high if end else low, abs=1e-9)
    on_the_way = np.linspace(0.0, time, 50)
    heights = z + v * on_the_way - 0.5 * gravity * on_the_way**2
    assert heights.min() > low - 1e-9
    assert heights.max() < high + 1e-9


def test_a_throw_that_just_reaches_the_top_touches_it_at_its_apex():
    gravity, gap = 2.0, 4.0
    assert time_to_leave_in_gravity(1.0, math.sqrt(2 * gravity * gap), 0.0, 5.0, gravity) == (pytest.approx(2.0), 1)
    assert time_to_leave_in_gravity(1.0, 0.999 * math.sqrt(2 * gravity * gap), 0.0, 5.0, gravity)[1] == 0


def test_a_tiny_gap_below_fast_flight_keeps_all_its_digits():
    gap = 1e-12
    time, end = time_to_leave_in_gravity(1.0 - gap, 5.0, 0.0, 1.0, 1.0)
    assert (time, end) == (pytest.approx((1.0 - (1.0 - gap)) / 5.0, rel=1e-12), 1)
    time, end = time_to_leave_in_gravity(gap, -5.0, 0.0, 1.0, 1.0)
    assert (time, end) == (pytest.approx(gap / 5.0, rel=1e-12), 0)


@given(st.floats(0.0, 5.0), SPEEDS, st.sampled_from([0.0, 0.1, 1.0]))
def test_the_ceiling_is_met_on_the_way_up_or_never(gap, closing_speed, gravity):
    time = time_to_ceiling(gap, closing_speed, gravity)
    if closing_speed <= 0.0 or closing_speed**2 < 2.0 * gravity * gap:
        assert time == math.inf
    else:
        assert closing_speed * time - 0.5 * gravity * time**2 == pytest.approx(gap, abs=1e-10)
        assert closing_speed - gravity * time >= -1e-6
