"""Two molecules meet when their distance says so, and keep momentum and energy."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from atmosbox.engine.core.hard_sphere import resolve_contact, share_energy
from atmosbox.engine.core.pair import approach, predict
from tests.engine.boxes import random_state

NUMBERS = st.floats(-10.0, 10.0)
VECTORS = st.tuples(NUMBERS, NUMBERS, NUMBERS)
MASSES = st.floats(1e-2, 1e3)


def time_to_contact(rx, ry, rz, vx, vy, vz, diameter):
    """Return when a pair meets, as the engine asks for it: a discriminant above zero and an approach, or never."""
    discriminant, slope, gap = approach(rx, ry, rz, vx, vy, vz, diameter)
    return predict(discriminant, slope, gap) if discriminant > 0.0 and slope < 0.0 else math.inf


@given(VECTORS, VECTORS, st.floats(0.1, 2.0))
def test_at_the_predicted_time_two_molecules_touch_and_still_close(r, v, diameter):
    r, v = np.array(r), np.array(v)
    assume(r @ r > diameter**2 * (1.0 + 1e-9))
    time = time_to_contact(*r, *v, diameter)
    assert time >= 0.0
    if time == math.inf:
        closest = r + v * max(-(r @ v) / (v @ v), 0.0) if v @ v > 0.0 else r
        assert math.sqrt(closest @ closest) >= diameter * (1.0 - 1e-9)
    else:
        touching = r + v * time
        assert math.sqrt(touching @ touching) == pytest.approx(diameter, rel=1e-7)
        assert touching @ v <= 1e-6 * math.sqrt(v @ v)


def test_an_overlap_by_rounding_touches_at_once_while_closing_and_never_while_parting():
    assert time_to_contact(1.0 - 1e-15, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0) == 0.0
    assert time_to_contact(1.0 - 1e-15, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0) == math.inf


@given(VECTORS, VECTORS, VECTORS, MASSES, MASSES)
def test_a_contact_keeps_momentum_energy_and_the_motion_across_the_line_of_centres(r, v, w, mass, other_mass):
    r, v, w = np.array(r), np.array(v), np.array(w)
    assume(r @ r > 1e-2)
    change = np.array(resolve_contact(*r, *(v - w), mass, other_mass))
    after, other_after = v + change, w - change * mass / other_mass
    scale = mass * (v @ v) + other_mass * (w @ w) + 1e-300
    assert mass * (after @ after) + other_mass * (other_after @ other_after) == pytest.approx(scale, rel=1e-11)
    momentum = mass * v + other_mass * w
    assert mass * after + other_mass * other_after == pytest.approx(momentum, abs=1e-10 * (mass + other_mass))
    assert r @ (after - other_after) == pytest.approx(-(r @ (v - w)), abs=1e-9)
    assert np.cross(r, change) == pytest.approx(np.zeros(3), abs=1e-9)


def test_shared_energy_is_kept_and_divided_by_degrees_of_freedom():
    for dimensions in [2.0, 3.0]:
        for rotations in [(0.0, 0.0), (2.0, 0.0), (0.0, 3.0), (2.0, 2.0), (2.0, 3.0)]:
            state = random_state(3)
            number = 10_000
            shares = np.array([share_energy(5.0, dimensions, *rotations, state) for _ in range(number)])
            assert shares.sum(axis=1) == pytest.approx(np.full(number, 5.0))
            assert (shares >= 0.0).all()
            # shares of gamma variates are Dirichlet: their means are as the degrees of freedom, with one more for the
            # relative motion; 30 means held to 4 standard errors: a false alarm in 500 seeds
            degrees = np.array([dimensions + 1.0, *rotations])
            error = shares.std(axis=0) / math.sqrt(number)
            assert (np.abs(shares.mean(axis=0) - 5.0 * degrees / degrees.sum()) <= 4.0 * error + 1e-12).all()
