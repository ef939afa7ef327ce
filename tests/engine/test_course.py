"""The position of a parcel on its planned ascent, left alone and moved by hand."""

import math

import numpy as np
import pytest

from atmosbox.engine import (
    Course,
    FollowPressure,
    ParcelSet,
    Piston,
    RefusedError,
    Specular,
    maxwell_velocities,
    random_positions,
)


def test_left_alone_it_keeps_to_the_plan_and_rests_at_its_end():
    course = Course(10.0)
    assert not course.led
    assert [course.moment(t) for t in (0.0, 3.3, 10.0, 25.0)] == [0.0, 3.3, 10.0, 10.0]


def test_led_by_hand_it_goes_at_the_pace_of_the_plan():
    course = Course(10.0)
    course.lead(4.0, 1.0)
    times = np.linspace(4.0, 12.0, 33)
    moments = np.array([course.moment(t) for t in times])
    assert np.abs(np.diff(moments) / np.diff(times)).max() <= 1.0 + 1e-12
    assert moments[-1] == 1.0
    assert course.moment(2.0) == pytest.approx(2.0)


def test_what_no_plan_knows_is_refused():
    for time, towards in [(1.0, 2.0), (9.0, -1.0), (9.0, 10.5), (math.nan, 1.0), (9.0, math.inf)]:
        course = Course(10.0)
        course.lead(5.0, 3.0)
        with pytest.raises(RefusedError):
            course.lead(time, towards)
        assert course.moment(20.0) == 3.0


def test_a_parcel_that_is_led_up_and_down_follows_the_pressure_both_ways():
    rng = np.random.default_rng(3)
    n, length = 400, (20.0, 20.0, 20.0)
    follow = FollowPressure([0.0, 300.0], [0.05, 0.025], mean_free_time=1.0)
    parcel = ParcelSet(
        random_positions(length, np.ones(n), rng),
        maxwell_velocities(1.0, np.ones(n), rng, exact=True),
        length=length,
        walls=(Specular(),) * 5 + (Piston(),),
        driver=follow,
        rotation=2.0,
        seed=3,
    )
    parcel.advance(150.0)
    follow.course.lead(150.0, 0.0)
    half_way = follow.pressure(parcel)
    parcel.advance(320.0)
    assert half_way == pytest.approx(0.05 * math.sqrt(0.5), rel=0.05)
    assert follow.pressure(parcel) == pytest.approx(0.05, rel=0.05)
    assert parcel.ledger() < 1e-12
