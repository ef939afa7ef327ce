"""The exact engine agrees with a reference implementation: the same events in the same order, and the same velocities.

Hard spheres are chaotic, so two correct programs diverge after some tens of contacts per molecule. How far they
can be compared is found case by case: the reference is run twice, once with all velocities nudged by one part in
10^14 after each event, and the engine is compared with it for as long as the nudged run agrees.
"""

import dataclasses
import itertools
import math
from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from atmosbox.engine import HeatBath, ParcelSet, Periodic, Piston, Ramp, Specular
from atmosbox.engine.exact.reference import Reference, time_to_close

MOST_EVENTS = 90
TOGETHER = 1e-6  # events closer in time than this part of a run's mean interval are compared as one


LOWEST = 0.7  # how far a piston may come down, as a part of the height: below, it would crush a dense gas


@dataclasses.dataclass(frozen=True)
class Family:
    """Boxes that need the same kernels: every new combination of these costs seconds of compilation."""

    mixed: bool = False
    any_size: bool = False  # a sphere up to the size of the box, three of any size down to 0, and points
    gravity: bool = False
    rotation: bool = False
    periodic: str = ""
    piston: bool = False
    sides: tuple[float, float] = (2.5, 6.0)  # in diameters of the largest molecule
    numbers: tuple[int, ...] = (2, 3, 4, 6, 8, 10, 12)  # a single molecule needs further kernels


CROWDS = (2, 8, 12, 16)  # in a box without walls few molecules have few events
FAMILIES = {
    "equal": Family(),
    "equal, gravity, piston": Family(gravity=True, piston=True),
    "any size": Family(mixed=True, any_size=True, sides=(1.02, 3.0)),
    "any size, periodic, piston": Family(
        mixed=True, any_size=True, periodic="xy", piston=True, sides=(2.0, 3.9), numbers=(12, 30, 40)
    ),
    "mixed, periodic, rotation": Family(mixed=True, rotation=True, periodic="xyz", sides=(2.0, 3.9), numbers=CROWDS),
    "mixed, rotation, gravity, piston, periodic": Family(
        mixed=True, gravity=True, rotation=True, periodic="xy", piston=True, sides=(4.1, 6.0), numbers=CROWDS
    ),
}


def places(random, sides, diameter, periodic, planar):
    """Return centres without overlap for as many molecules as find a place at random."""
    centres = []
    for sigma in diameter:
        low = np.where(periodic, 0.0, 0.5 * sigma)
        for _ in range(200):
            centre = low + random.random(3) * (sides - 2.0 * low)
            if planar:
                centre[1] = 0.0 if periodic[1] else 0.5 * sides[1]
            apart = [centre - other for other in centres]
            apart = [r - periodic * sides * np.rint(r / sides) for r in apart]
            if all(math.sqrt(r @ r) > 0.5 * (sigma + s) for r, s in zip(apart, diameter, strict=False)):
                centres.append(centre)
                break
        else:
            break
    return np.array(centres).reshape(-1, 3)


@st.composite
def boxes(draw, family):
    """Return the arguments that `ParcelSet` and `Reference` share."""
    random = np.random.default_rng(draw(st.integers(0, 2**32)))
    number = draw(st.sampled_from(family.numbers)) + family.mixed
    planar = draw(st.booleans())
    if family.mixed:
        diameter = 10.0 ** random.uniform(-1.0, 0.0, number)
        diameter[:2] = 1.0, 0.4
        mass = 10.0 ** random.uniform(0.0, 3.0, number)
        if family.any_size:
            few = 10.0 ** random.uniform(-15.0, 0.0, 3) * random.choice([0.0, 1.0], 3, p=[0.2, 0.8])
            diameter = np.concatenate([[1.0], few, np.zeros(number)])[:number]
            mass = 10.0 ** random.uniform(0.0, 6.0, number)
    else:
        diameter = np.ones(number)
        mass = np.full(number, 10.0 ** random.uniform(-1.0, 1.0))
    sides = random.uniform(*family.sides, 3)
    periodic = np.array([axis in family.periodic for axis in "xyz"])
    position = places(random, sides, diameter, periodic, planar)
    number = len(position)
    velocity = random.normal(size=(number, 3)) / np.sqrt(mass[:number, None])
    if planar:
        velocity[:, 1] = 0.0
    speed = 1.0 / math.sqrt(mass.min())
    bath = st.builds(
        HeatBath,
        st.sampled_from([0.3, 1.0, 3.0, Ramp(0.5, 4.0, start=1.0, end=8.0)]),
        accommodation=st.sampled_from([0.0, 0.5, 1.0]),
    )
    solid = st.one_of(st.just(Specular()), bath)
    walls = [Periodic() if periodic[wall // 2] else draw(solid) for wall in range(6)]
    if family.piston:
        walls[5] = Piston(draw(st.sampled_from([-0.2, -0.05, 0.0, 0.05, 0.5])) * speed)
    rotation, spin, collision_number = np.zeros(number), np.zeros(number), 1.0
    if family.rotation:
        rotation = random.choice([0.0, 2.0, 3.0], number)
        rotation[:1] = 2.0
        spin = np.where(rotation > 0.0, random.exponential(size=number), 0.0)
        collision_number = draw(st.sampled_from([1.0, 3.0, math.inf]))
    return {
        "position": position,
        "velocity": velocity,
        "length": tuple(sides),
        "walls": tuple(walls),
        "mass": mass[:number],
        "diameter": diameter[:number],
        "rotation": rotation,
        "rotational_energy": spin,
        "gravity": draw(st.sampled_from([0.1, 1.0, 4.0])) * speed**2 / sides[2] if family.gravity else 0.0,
        "planar": planar,
        "collision_number": collision_number,
        "seed": draw(st.integers(0, 2**63)),
    }


def comparable(box):
    """Return the events of the reference, each with the state right after it, as far as they can be compared."""
    reference, nudged = Reference(**box), Reference(**box)
    random = np.random.default_rng(1)
    history = []
    for _ in range(4 * MOST_EVENTS):
        nudged.velocity *= 1.0 + 1e-14 * random.normal(size=nudged.velocity.shape)
        event, other = reference.step(), nudged.step()
        if event is None or other is None or event[1:] != other[1:] or len(history) == MOST_EVENTS:
            break
        if reference.place(5) < LOWEST * box["length"][2]:
            break
        parted = np.abs(reference.velocity - nudged.velocity).max() / np.abs(reference.velocity).max()
        if max(parted, abs(event.time - other.time) / event.time) > 1e-8:
            break
        if event.kind != "crossing":
            state = reference.position, reference.velocity, reference.rotational_energy
            history.append((event, *(values.copy() for values in state)))
    return history


def participants(event):
    return {event.first, event.second} if event.kind == "contact" else {event.first}


def agree(box):
    """Compare the engine with the reference, event by event; return the number of events that could be compared."""
    history = comparable(box)
    parcel = ParcelSet(**box)
    sides, gravity = np.array(box["length"]), np.array([0.0, 0.0, box["gravity"]])
    periodic = np.array([isinstance(wall, Periodic) for wall in box["walls"][::2]])
    contacts, wall_hits, velocity, time = 0, parcel.wall_hits, parcel.snapshot().velocity, 0.0
    together = TOGETHER * history[-1][0].time / len(history) if history else 0.0
    pending, compared = [], 0
    for (event, *state), (following, *_) in itertools.pairwise(history):
        pending.append(event)
        if following.time - event.time < together:
            continue
        middle = 0.5 * (event.time + following.time)
        parcel.advance(middle)
        now = parcel.snapshot()
        seen_at_walls = Counter(dict(enumerate(parcel.wall_hits - wall_hits)))
        assert parcel.contacts - contacts == sum(e.kind == "contact" for e in pending), pending
        assert seen_at_walls == Counter(e.second for e in pending if e.kind == "wall hit"), pending
        unless_met = velocity - (middle - time) * gravity
        changed = (np.abs(now.velocity - unless_met) > 1e-12 * np.abs(velocity).max()).any(axis=1)
        assert set(np.flatnonzero(changed)) <= set().union(*map(participants, pending)), pending
        if len(pending) == 1 and event.kind == "contact":
            assert changed.sum() == 2, pending
        position, velocity, spin = state
        flight = middle - event.time
        velocity = velocity - flight * gravity
        away = now.position - (position + flight * velocity + 0.5 * flight**2 * gravity)
        away -= periodic * sides * np.rint(away / sides)
        assert np.abs(now.velocity - velocity).max() < 1e-6 * np.abs(velocity).max(), pending
        assert np.abs(away).max() < 1e-6 * sides.max(), pending
        assert now.rotational_energy == pytest.approx(spin, rel=1e-6, abs=1e-9), pending
        assert parcel.ledger() < 1e-12, pending
        contacts, wall_hits, velocity, time = parcel.contacts, parcel.wall_hits, now.velocity, middle
        compared += len(pending)
        pending = []
    return compared


LATER = ["any size", "any size, periodic, piston"]  # no scene needs their kernels


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.nightly if name in LATER else ()) for name in FAMILIES]
)
def test_the_engine_meets_the_same_events_as_the_reference(name, pytestconfig):
    compared, more = [], pytestconfig.getoption("--fuzz")

    @settings(max_examples=16 * more, derandomize=more == 1)
    @given(boxes(FAMILIES[name]))
    def the_same_events(box):
        compared.append(agree(box))

    the_same_events()
    print(name, len(compared), sum(compared), sorted(compared))
    assert sum(compared) > 250


def test_a_gap_closes_where_it_is_zero_and_shrinks():
    for coefficients, time in [
        ((0.0, -2.0, 3.0), 1.5),  # a wall approached at constant speed
        ((0.0, 2.0, 3.0), math.inf),
        ((0.0, 0.0, 3.0), math.inf),
        ((1.0, -3.0, 2.0), 1.0),  # a sphere: it is entered at the first root
        ((1.0, 3.0, 2.0), math.inf),
        ((1.0, -1.0, 2.0), math.inf),
        ((-1.0, 1.0, 2.0), 2.0),  # the floor in gravity: it is reached at the last root
        ((-1.0, -1.0, 2.0), 1.0),
        ((1.0, -2.0, -1e-18), 0.0),  # in contact by rounding: touch at once if closing
        ((1.0, 2.0, -1e-18), math.inf),
        ((-1.0, 0.0, -1e-18), 0.0),
        ((-1.0, 2.0, 0.0), 2.0),
    ]:
        assert time_to_close(*coefficients) == pytest.approx(time, abs=1e-15)


def test_contacts_keep_energy_when_they_share_it_with_rotation():
    random = np.random.default_rng(5)
    position = np.stack(np.meshgrid(*[[1.0, 3.0]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    gas = Reference(position, random.normal(size=(8, 3)), length=(4, 4, 4), rotation=2.0, mass=random.uniform(1, 9, 8))
    before = gas.energy()
    shared = 0
    for _ in range(60):
        shared += gas.step().kind == "contact"
        assert gas.energy() == pytest.approx(before, rel=1e-13)
    assert shared > 5
    assert (gas.rotational_energy > 0.0).any()
