"""Properties in extreme boxes that only the exact engine promises; `cases` has what every engine is tested in."""

import itertools
import math

import numpy as np
import pytest

from atmosbox.engine import (
    HeatBath,
    ParcelSet,
    Periodic,
    Specular,
    maxwell_velocities,
    random_positions,
)
from tests.extremes.cases import Run

S, P, RUN = Specular(), Periodic(), Run("exact")


def within(box, until, events=4_000_000):
    """Advance, but by no more than this number of events (the watch is called every 200 000 events)."""
    start = sum(box.events.values())
    calls = itertools.count(1)

    def watch(time):
        assert next(calls) * 200_000 <= events, f"more than {events} events by t = {time}"

    box.advance(until, watch)
    assert sum(box.events.values()) - start <= events + 200_000
    return box


def sphere_box(number, length, *, seed=1, kT=1.0, diameter=1.0, mass=1.0, walls=(S,) * 6, **options):
    rng = np.random.default_rng(seed)
    diameter, mass = diameter * np.ones(number), mass * np.ones(number)
    periodic = tuple(isinstance(wall, Periodic) for wall in walls[::2])
    x = random_positions(length, diameter, rng, periodic=periodic)
    v = maxwell_velocities(kT, mass, rng, exact=True)
    return ParcelSet(x, v, length=length, diameter=diameter, mass=mass, walls=walls, seed=seed, **options)


def lone(place, velocity):
    """Return a box with a molecule that meets nobody: a box of one alone would need kernels of its own."""
    return ParcelSet([place, [8, 2, 8]], [velocity, [0, 0, 0]], length=(10, 10, 10))


@pytest.mark.parametrize("speed", [1e-49, 1e-30, 1e-13, 1e40])
def test_two_molecules_meet_however_slow_or_fast_they_are(speed):
    pair = [[3, 5, 5], [7, 5, 5]]
    box = within(ParcelSet(pair, [[speed, 0, 0], [-speed, 0, 0]], length=(10, 10, 10)), 2.0 / speed)
    assert box.contacts == 1
    assert box.snapshot().velocity[:, 0].tolist() == [-speed, speed]


def test_a_clock_that_has_run_for_long_has_lost_none_of_its_digits():
    # a lone molecule comes back to its place after each period, 18 in time; a float of 1e9 has 1e-7 left
    box = lone([3, 5, 5], [1.0, 0, 0])
    periods = 18 * 1_000_000
    within(box, float(periods), 20_000_000)
    assert box.snapshot().position[0, 0] == pytest.approx(3.0, abs=1e-7)
    assert box.wall_hits[:2].tolist() == [1_000_000, 1_000_000]


@pytest.mark.parametrize("collision_number", [1.0, math.inf])
def test_rotation_that_is_exchanged_always_or_never_keeps_the_energy(collision_number):
    number = 100
    walls = (HeatBath(1.0), HeatBath(1.0, 0.0), S, S, S, S)
    box = sphere_box(
        number,
        (8.0,) * 3,
        walls=walls,
        rotation=3,
        rotational_energy=np.zeros(number),
        collision_number=collision_number,
    )
    within(box, 300.0)
    assert box.contacts > 5000
    assert box.ledger() <= 1e-11
    # also without exchange, the one wall brings rotation to its temperature
    assert box.energy()[1] / number == pytest.approx(1.5, abs=4.0 * math.sqrt(1.5 / number))
    assert box.snapshot().rotational_energy.min() >= 0.0


def test_rounding_errors_of_energy_are_a_random_walk_and_no_drift():
    box = sphere_box(200, (9.0,) * 3)
    before = sum(box.energy())
    for k in range(1, 21):
        within(box, 20.0 * k)
        events = sum(box.events.values())
        assert abs(sum(box.energy()) / before - 1.0) <= 1e-12 * math.sqrt(events) * 1e-2 + 1e-14
    assert box.contacts > 100_000
