"""Molecules that attract each other: events as in the reference, conserved energy, and the count of wells.

Thermodynamics of the square well are in tests/physics/test_square_well.py.
"""

import itertools
import math

import numpy as np
import pytest
from scipy.spatial import cKDTree

from atmosbox.engine import (
    AttractingParcelSet,
    HeatBath,
    Periodic,
    RandomBath,
    Specular,
    SquareWell,
    random_positions,
)  # fmt: skip
from atmosbox.engine.wells.attracting_reference import AttractingReference

ROUND = (Periodic(),) * 6


def few(seed, *, mixed, gravity, periodic, planar):
    """Return random arguments for a box of a few molecules, for engine and reference."""
    random = np.random.default_rng(seed)
    number = int(random.choice([2, 3, 5, 8, 12]))
    sides = random.uniform(4.3, 6.5, 3)
    diameter = random.uniform(0.6, 1.0, number) if mixed else np.ones(number)
    walls = [Periodic() if axis in periodic else Specular() for axis in "xxyyzz"]
    if "z" not in periodic:
        walls[4] = HeatBath(1.0)
    around = tuple(axis in periodic for axis in "xyz")
    position = random_positions(tuple(sides), diameter, random, periodic=around, planar=planar)
    velocity = random.normal(size=(number, 3)) * random.choice([0.3, 1.0, 2.0])
    if planar:
        velocity[:, 1] = 0.0
    well = SquareWell(random.uniform(1.05, 1.9), random.uniform(0.2, 3.0))
    if mixed:
        well = SquareWell(
            [[1.5, 1.2, 1.0], [1.2, 2.0, 1.7], [1.0, 1.7, 1.3]], [[1.0, 2.0, 1.0], [2.0, 0.5, 0.0], [1, 0, 4]]
        )
    return {
        "position": position,
        "velocity": velocity,
        "length": tuple(sides),
        "walls": tuple(walls),
        "mass": random.uniform(0.5, 5.0, number) if mixed else 1.0,
        "diameter": diameter,
        "gravity": 0.3 if gravity else 0.0,
        "planar": planar,
        "well": well,
        "species": random.integers(0, 3, number) if mixed else 0,
        "bath": RandomBath(1.0, 0.3) if seed % 2 else None,
        "seed": seed,
    }


FAMILIES = {
    "a periodic box": {"mixed": False, "gravity": False, "periodic": "xyz", "planar": False},
    "walls, gravity, several kinds": {"mixed": True, "gravity": True, "periodic": "xy", "planar": False},
    "a plane": {"mixed": True, "gravity": True, "periodic": "", "planar": True},
}


def steps(box, most):
    """Return the events of the reference with the velocities after each, while a nudge of 1e-14 does not matter."""
    reference, nudged = AttractingReference(**box), AttractingReference(**box)
    random = np.random.default_rng(1)
    history = []
    while len(history) < most:
        nudged.velocity *= 1.0 + 1e-14 * random.normal(size=nudged.velocity.shape)
        event, other = reference.step(), nudged.step()
        if event is None or other is None or event[1:] != other[1:]:
            break
        parted = np.abs(reference.velocity - nudged.velocity).max() / np.abs(reference.velocity).max()
        if parted > 1e-8 or abs(event.time - other.time) > 1e-8 * event.time:
            break
        history.append((event, reference.velocity.copy(), set(reference.inside)))
    return history


@pytest.mark.parametrize(
    "family", [pytest.param(name, marks=pytest.mark.nightly if name == "a plane" else ()) for name in FAMILIES]
)
def test_the_engine_meets_the_same_events_as_the_reference(family):
    seen = dict.fromkeys(("contact", "capture", "release", "wall hit", "drawn"), 0)
    for seed in range(8):
        box = few(seed, **FAMILIES[family])
        parcel = AttractingParcelSet(**box)
        history = steps(box, 60)
        for (event, velocity, inside), (following, _, _) in itertools.pairwise(history):
            seen[event.kind] = seen.get(event.kind, 0) + 1
            if following.time - event.time < 1e-9:
                continue
            middle = 0.5 * (event.time + following.time)
            parcel.advance(middle)
            velocity = velocity - [0.0, 0.0, box["gravity"] * (middle - event.time)]
            found = parcel.snapshot().velocity
            assert np.abs(found - velocity).max() < 1e-6 * np.abs(velocity).max(), (seed, event)
            assert set(map(tuple, parcel.pairs().tolist())) == inside, (seed, event)
            assert parcel.ledger() < 1e-12
    assert min(seen[kind] for kind in ("contact", "capture", "release", "drawn")) > 20, seen


def gas(number, density, kT, *, seed=1, bath=0.0, **more):
    """Return a periodic cube of molecules at a density and temperature."""
    random = np.random.default_rng(seed)
    length = ((number / density) ** (1.0 / 3.0),) * 3
    position = random_positions(length, np.ones(number), random, periodic=(True,) * 3)
    velocity = random.normal(size=(number, 3)) * math.sqrt(kT)
    return AttractingParcelSet(
        position, velocity - velocity.mean(axis=0), length=length, walls=ROUND, well=SquareWell(),
        bath=RandomBath(kT, bath) if bath else None, seed=seed, **more,
    )  # fmt: skip


def near(parcel):
    """Return the pairs that are in their wells by position alone."""
    tree = cKDTree(np.mod(parcel.snapshot().position, parcel.length), boxsize=parcel.length)
    return set(map(tuple, tree.query_pairs(1.5)))


@pytest.mark.parametrize("density", [0.02, 0.3, 0.8])
def test_energy_and_momentum_are_kept_and_wells_are_where_molecules_are_near(density):
    box = gas(200, density, 1.0)
    start = box.snapshot().velocity.sum(axis=0)
    for until in (10.0, 20.0, 30.0):
        box.advance(until)
        assert set(map(tuple, box.pairs().tolist())) == near(box)
        assert box.number_of_wells == len(near(box)) == box.neighbours().sum() // 2
    events = box.well_events
    assert min(box.contacts, events["captures"], events["releases"], events["bounces"]) > 500
    assert box.ledger() < 1e-13
    assert np.abs(box.snapshot().velocity.sum(axis=0) - start).max() < 1e-10


def test_the_heat_of_the_bath_is_in_the_energy_budget_and_it_keeps_its_temperature():
    box = gas(200, 0.1, 1.0, bath=1.0)
    kinetic = []
    for frame in range(200):
        box.advance(5.0 + frame)
        kinetic.append(box.energy()[0])
    assert box.well_events["drawn"] == pytest.approx(200 * 204, abs=4.0 * math.sqrt(200 * 204))
    assert box.ledger() < 1e-13
    assert abs(box.bath_heat) > 1.0
    # independent to a good part after one mean time of the bath: 4 standard errors, twice widened for correlation
    error = math.sqrt(1.5 * 200) * math.sqrt(2.0 / 200)
    assert np.mean(kinetic) == pytest.approx(1.5 * 200, abs=4.0 * error)


def test_a_change_of_strength_or_gravity_is_in_the_energy_budget():
    box = gas(200, 0.3, 1.0)
    box.advance(5.0)
    deep = box.well_energy
    box.set_strength(0.25)
    assert box.well_energy == pytest.approx(0.25 * deep)
    assert box.attraction_work == pytest.approx(-0.75 * deep)
    box.advance(10.0)
    assert box.well_energy > 0.25 * deep  # a weaker attraction holds fewer
    box.set_strength(0.0)
    box.advance(15.0)
    box.set_strength(1.0)
    box.advance(20.0)
    assert box.ledger() < 1e-12
