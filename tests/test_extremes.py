"""Boxes that break simulations, and what only the exact engine promises of them.

Those that every engine is put into stand in `atmosbox.trade.extremes` and are run by test_assessment.py.

Every wait is bounded twice: `within` gives a run so many events and no more, and a run that does not come back at
all ends the whole suite with a traceback.
"""

import faulthandler
import itertools
import math
import sys

import numpy as np
import pytest

from atmosbox import theory
from atmosbox.engine import (
    HeatBath,
    PackingError,
    ParcelSet,
    Periodic,
    Piston,
    RefusedError,
    Specular,
    StalledError,
    lattice_positions,
    maxwell_velocities,
    packing_fraction,
    random_positions,
)
from atmosbox.engine.core.measure import layer_sample, mean_free_path, temperature
from atmosbox.scene.statistics import block_average

S, P = Specular(), Periodic()


@pytest.fixture(autouse=True)
def nothing_hangs():
    faulthandler.dump_traceback_later(1800.0, exit=True, file=sys.__stderr__)
    yield
    faulthandler.cancel_dump_traceback_later()


def within(box, until, events=4_000_000):
    """Let time pass, but not more than so many events (the watch is called every 200 000)."""
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


def deepest_overlap(box):
    """Return by how much the closest pair overlaps, in diameters of the pair."""
    x, diameter = box.snapshot().position, box.diameter
    i, j = np.triu_indices(box.number, 1)
    apart = x[i] - x[j]
    apart -= np.where(box.periodic, box.length * np.rint(apart / box.length), 0.0)
    return np.max(1.0 - np.sqrt(np.sum(apart**2, axis=1)) / (0.5 * (diameter[i] + diameter[j])), initial=-np.inf)


def outermost(box):
    """Return how far a molecule reaches through a wall, in box lengths."""
    x, radius = box.snapshot().position, 0.5 * box.diameter[:, None]
    return np.max(np.maximum(radius - x, x - (box.length - radius)) / box.length, initial=-np.inf)


@pytest.mark.parametrize(("packing", "periodic"), [(0.494, True), (0.55, True), (0.5, False)])
def test_a_dense_box_starts_at_random_without_overlap(packing, periodic):
    number = 500
    side = (number * math.pi / 6.0 / packing) ** (1.0 / 3.0)
    box = sphere_box(number, (side,) * 3, walls=(P if periodic else S,) * 6)
    assert packing_fraction(box.length, box.diameter) == pytest.approx(packing)
    within(box, 2.0)
    assert box.contacts > 5_000
    assert deepest_overlap(box) <= 1e-9
    assert sum(box.energy()) == pytest.approx(1.5 * number, rel=1e-12)


def test_a_crystal_starts_from_a_lattice_and_stays_one():
    number, packing = 500, 0.7
    side = (number * math.pi / 6.0 / packing) ** (1.0 / 3.0)
    sites = lattice_positions((side,) * 3, np.ones(number), periodic=(True,) * 3)
    rng = np.random.default_rng(2)
    velocity = maxwell_velocities(1.0, np.ones(number), rng, exact=True)
    box = ParcelSet(sites, velocity, length=(side,) * 3, walls=(P,) * 6)
    within(box, 1.0)
    factors = []
    for _ in range(20):
        before, time = box.virial.sum(), box.time
        within(box, time + 0.5)
        factors.append(1.0 + (box.virial.sum() - before) / (3.0 * number * (box.time - time)))
    mean, error = block_average(factors)
    # the pressure of the crystal, after Speedy (1998), J. Phys. Condens. Matter 10, 4387
    share = packing / (math.pi / math.sqrt(18.0))
    factor = 3.0 / (1.0 - share) - 0.5921 * (share - 0.7072) / (share - 0.601)
    assert error / factor < 0.005
    assert abs(mean - factor) <= 4.0 * error + 1.5 * factor / number
    moved = box.snapshot().position - sites
    moved -= side * np.rint(moved / side)
    moved -= moved.mean(axis=0)
    assert np.sqrt(np.sum(moved**2, axis=1)).max() < 0.7
    assert deepest_overlap(box) <= 1e-9
    assert sum(box.energy()) == pytest.approx(1.5 * number, rel=1e-12)


@pytest.mark.parametrize("packing", [0.66, 0.72])
def test_too_dense_a_random_start_is_refused(packing):
    side = (300 * math.pi / 6.0 / packing) ** (1.0 / 3.0)
    with pytest.raises(PackingError, match=r"300 molecules fill 0\.\d+ of the space, too much for a random start"):
        random_positions((side,) * 3, np.ones(300), np.random.default_rng(3), periodic=(True,) * 3)


@pytest.mark.parametrize("start", [random_positions, lattice_positions])
@pytest.mark.parametrize("packing", [0.75, 0.99, 30.0])
def test_a_packing_that_no_spheres_have_is_refused(start, packing):
    side = (300 * math.pi / 6.0 / packing) ** (1.0 / 3.0)
    arguments = (np.random.default_rng(4),) if start is random_positions else ()
    with pytest.raises(PackingError, match="no packing of spheres fills more than"):
        start((side,) * 3, np.ones(300), *arguments, periodic=(True,) * 3)


def test_a_molecule_larger_than_its_box_is_refused():
    with pytest.raises(PackingError, match=r"diameter 3 does not fit into a box of side 2"):
        random_positions((10.0, 2.0, 10.0), [3.0], np.random.default_rng(5))


def test_molecules_that_touch_at_rest_without_gravity_stay_so():
    where = [[5.0, 5.0, 0.5], [5.0, 5.0, 1.5], [6.0, 5.0, 1.5]]
    box = within(ParcelSet(where, np.zeros((3, 3)), length=(10, 10, 10)), 1e6)
    assert box.snapshot().position.tolist() == where
    assert box.energy() == (0.0, 0.0, 0.0)


def test_an_empty_box_has_no_temperature_and_everything_else():
    box = within(ParcelSet(np.zeros((0, 3)), np.zeros((0, 3)), length=(4, 4, 4)), 10.0)
    assert math.isnan(temperature(box, box.snapshot()))
    assert box.energy() == (0.0, 0.0, 0.0)
    assert box.ledger() == 0.0
    assert box.open_density == 0.0
    assert box.degrees_of_freedom == 3.0
    assert layer_sample(box, box.snapshot(), 3).number.tolist() == [0.0, 0.0, 0.0]
    assert mean_free_path(0, 0.0) == math.inf
    assert box.memory() < 1_000_000
    assert "0 molecules" in repr(box)


FEW = [
    # one alone between periodic sides needs kernels of its own
    pytest.param(
        walls, number, marks=pytest.mark.validate if (name, number) == ("periodic", 1) else (), id=f"{name}-{number}"
    )
    for name, walls in {"walls": (S,) * 6, "periodic": (P,) * 6, "baths": (HeatBath(1.0),) * 6}.items()
    for number in (1, 2, 3)
]


@pytest.mark.parametrize(("walls", "number"), FEW)
def test_one_two_or_three_molecules_are_a_gas_too(number, walls):
    rng = np.random.default_rng(7)
    where = [[1.5, 2.0, 3.5], [3.5, 2.5, 1.5], [2.0, 4.0, 1.0]][:number]
    velocity = rng.standard_normal((number, 3))
    box = ParcelSet(where, velocity, length=(5, 5, 5), walls=walls)
    kinetic = box.energy()[0]
    for k in range(1, 11):
        within(box, 100.0 * k)
        assert deepest_overlap(box) <= 1e-9
        assert box.ledger() <= 1e-12
    assert temperature(box, box.snapshot()) > 0.0
    assert (box.contacts > 10) == (number > 1)
    if walls[0] != HeatBath(1.0):
        assert box.energy()[0] == pytest.approx(kinetic, rel=1e-12)


@pytest.mark.validate  # kernels of its own; physics/test_periodic_pair would meet too often
def test_one_molecule_meets_not_its_own_image():
    box = within(ParcelSet([[1, 1, 1]], [[1.0, 0.7, 0.3]], length=(2.4, 2.4, 2.4), walls=(P,) * 6), 1000.0)
    assert box.contacts == 0
    assert box.snapshot().velocity.tolist() == [[1.0, 0.7, 0.3]]


def many(number):
    side = (number * math.pi / 6.0 / 0.05) ** (1.0 / 3.0)
    box = sphere_box(number, (side,) * 3)
    before = sum(box.energy())
    # pushed apart at the start, they must first forget it
    within(box, 2.0, 40 * number)
    contacts = box.contacts
    within(box, 3.0, 40 * number)
    rate = 0.5 * number * float(theory.collision_rate(number / (side - 1.0) ** 3, 1.0, 1.0, 1.0))
    rate *= theory.contact_share([side - 1.0] * 3, 1.0, number)
    assert abs((box.contacts - contacts) / rate - 1.0) <= 4.0 / math.sqrt(rate) + 0.005
    assert sum(box.energy()) == pytest.approx(before, rel=1e-12)
    return box.memory() / number


def test_a_hundred_thousand_molecules_take_no_more_memory_each_than_few():
    assert many(100_000) <= 320.0


def test_a_lattice_where_everything_happens_at_the_same_time_keeps_energy_and_places():
    number, side = 256, 12.0
    where = lattice_positions((side,) * 3, np.ones(number))
    velocity = np.where(np.arange(number)[:, None] % 2 == 0, 1.0, -1.0) * np.ones((number, 3))
    boxes = [ParcelSet(where, velocity, length=(side,) * 3) for _ in range(2)]
    for box in boxes:
        within(box, 50.0)
        assert box.contacts > 1000
        assert sum(box.energy()) == pytest.approx(1.5 * number, rel=1e-12)
        assert deepest_overlap(box) <= 1e-9
        assert outermost(box) <= 1e-12
    assert (boxes[0].snapshot().position == boxes[1].snapshot().position).all()


@pytest.mark.parametrize(
    ("number", "side", "rotation"),
    [
        (4, 4.0, 0),
        (20, 4.0, 0),
        (4, 4.0, 2),
        (20, 4.0, 2),
        (100, 6.0, 2),
        pytest.param(100, 6.0, 0, marks=pytest.mark.validate),
    ],
)
def test_a_piston_that_would_crush_the_molecules_is_refused_before_it_does(number, side, rotation):
    walls = (S,) * 5 + (Piston(-2.0),)
    energy = np.full(number, 0.5 * rotation)
    box = sphere_box(number, (side, side, 12.0), walls=walls, rotation=rotation, rotational_energy=energy)
    with pytest.raises(StalledError, match=r"the piston has come down to .* where it would crush the molecules"):
        within(box, 6.0, 50_000_000)
    assert deepest_overlap(box) <= 1e-9
    assert outermost(box) <= 1e-9
    assert box.ledger() <= 1e-10
    assert packing_fraction(box.length, box.diameter) <= 0.6 + 1e-9
    assert box.time <= 6.0
    # and it does not go on from there
    with pytest.raises(StalledError, match="crush"):
        within(box, 7.0)
    # but it may go back; the gas is by now hot beyond measure, so a short while will do
    box.set_piston_velocity(0.5)
    ceiling, speed = box.ceiling, math.sqrt(sum(box.energy()) / number)
    within(box, box.time + 0.01 / speed)
    assert box.ceiling > ceiling
    assert box.ledger() <= 1e-10


@pytest.mark.parametrize("velocity", [1.0, 100.0])
def test_a_piston_that_flies_away_leaves_a_gas_that_expands_into_nothing(velocity):
    box = sphere_box(100, (6.0, 6.0, 10.0), walls=(S,) * 5 + (Piston(velocity),))
    before = sum(box.energy())
    for k in range(1, 20):
        within(box, 50.0 * k)
        assert outermost(box) <= 1e-9
        assert deepest_overlap(box) <= 1e-9
    assert box.ceiling == pytest.approx(10.0 + 950.0 * velocity)
    assert box.ledger() <= 1e-10
    if velocity > 10.0:
        # nobody catches up with it: no work, as Joule found
        assert sum(box.energy()) == pytest.approx(before, rel=1e-12)


def test_after_a_thousand_million_units_of_time_nothing_has_drifted():
    where = [[2, 5, 5], [7, 5.3, 5.2], [5, 2, 8]]
    velocity = [[0.013, 0.007, 0.003], [-0.011, -0.002, 0.009], [0.003, 0.008, -0.01]]
    box = ParcelSet(where, velocity, length=(10, 10, 10))
    before = sum(box.energy())
    # few events to a look: 1e9 units of time, of which each molecule crosses the box in a thousand
    for k in range(1, 11):
        within(box, 1e8 * k, 100_000_000)
        assert deepest_overlap(box) <= 1e-9
        assert outermost(box) <= 1e-12
    events = sum(box.events.values())
    assert box.time == 1e9
    assert events > 1_000_000
    assert abs(sum(box.energy()) / before - 1.0) <= 1e-12 * math.sqrt(events)


def test_a_clock_that_has_run_for_long_has_lost_none_of_its_digits():
    # a lone molecule comes back to its place after each period, 18 in time; a float of 1e9 has 1e-7 left
    box = ParcelSet([[3, 5, 5]], [[1.0, 0, 0]], length=(10, 10, 10))
    periods = 18 * 1_000_000
    within(box, float(periods), 20_000_000)
    assert box.snapshot().position[0, 0] == pytest.approx(3.0, abs=1e-7)
    assert box.wall_hits[:2].tolist() == [1_000_000, 1_000_000]


def mixed_box(seed=8):
    number = 200
    walls = (HeatBath(1.2), HeatBath(0.8, 0.5), P, P, S, Piston(0.05))
    energy = np.ones(number)
    return sphere_box(
        number,
        (8.0, 8.0, 8.0),
        seed=seed,
        diameter=0.7,
        mass=np.tile([1.0, 1.5], number // 2),
        walls=walls,
        rotation=2,
        rotational_energy=energy,
        collision_number=3.0,
        gravity=0.1,
    )


def test_a_run_is_the_same_to_the_last_bit_however_it_is_cut_and_looked_at():
    whole = within(mixed_box(), 40.0)
    pieces = mixed_box()
    for time in np.sort(np.random.default_rng(9).random(300)) * 40.0:
        within(pieces, float(time))
        pieces.energy()
        pieces.snapshot()
        layer_sample(pieces, pieces.snapshot(), 4)
    within(pieces, 40.0)
    one, other = whole.snapshot(), pieces.snapshot()
    assert one.position.tobytes() == other.position.tobytes()
    assert one.velocity.tobytes() == other.velocity.tobytes()
    assert one.rotational_energy.tobytes() == other.rotational_energy.tobytes()
    assert whole.events == pieces.events
    assert whole.wall_heat.tobytes() == pieces.wall_heat.tobytes()
    assert whole.contacts > 1000


def test_another_seed_is_another_run():
    one, other = (within(mixed_box(seed), 5.0).snapshot() for seed in (8, 9))
    assert (one.position != other.position).any(axis=1).all()


GOOD = {"position": [[1, 2, 2], [3, 2, 2]], "velocity": [[1, 0, 0], [-1, 0, 0]], "length": (4, 4, 4)}
BAD = [
    ("mass", [[1, 2, 3]]),
    ("rotation", [1, -2, math.nan, "x"]),
    ("rotational_energy", [-1, math.nan, math.inf]),
    ("layers", [-3]),
    ("seed", ["x"]),
    ("length", [(4, 4, -4), (4, 4, "x"), 4.0]),
    ("position", [[[1, 2, 2]], [["a", 2, 2], [3, 2, 2]]]),
    ("velocity", [[["a", 0, 0], [0, 0, 0]]]),
]


@pytest.mark.parametrize(("name", "value"), [(name, value) for name, values in BAD for value in values])
def test_what_no_box_can_have_is_refused_by_its_name(name, value):
    arguments = dict(GOOD)
    arguments[name] = value
    words = {"position": "position", "velocity": "velocit", "rotation": "rotational degrees|rotation"}
    with pytest.raises(RefusedError, match=words.get(name, name)):
        ParcelSet(arguments.pop("position"), arguments.pop("velocity"), **arguments)


@pytest.mark.parametrize(
    ("walls", "words"),
    [
        ((S,) * 5, "5 walls are given: give six"),
        (None, "0 walls are given: give six"),
        ((S,) * 5 + (None,), "wall z_high = None is no law"),
        ((S,) * 5 + (P,), "walls z_low and z_high must both be periodic or neither"),
        ((Piston(),) + (S,) * 5, "wall x_low cannot be a piston"),
        ((S,) * 5 + (Piston(math.nan),), "velocity of the piston = nan is not finite"),
        ((S,) * 5 + (Piston("x"),), "velocity of the piston = 'x' is not finite"),
        ((S,) * 5 + (HeatBath("x"),), "kT of wall z_high = 'x' is not a number"),
        ((S,) * 5 + (HeatBath(1.0, 2.0),), "the accommodation of wall z_high = 2.0 is no number from 0 to 1"),
        ((S,) * 5 + (HeatBath(1.0, None),), "the accommodation of wall z_high = None is no number from 0 to 1"),
    ],
)
def test_walls_that_no_box_can_have_are_refused_by_their_names(walls, words):
    with pytest.raises(RefusedError, match=words):
        ParcelSet(GOOD["position"], GOOD["velocity"], length=(4, 4, 4), walls=walls)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"walls": (P,) * 6, "gravity": 1.0}, "periodic along z cannot have gravity"),
        ({"planar": True, "velocity": [[1, 1, 0], [0, 0, 0]]}, "a plane gas has no velocity along y"),
        ({"planar": True, "position": [[1, 2, 2], [3, 2.5, 2]]}, "the centres of a plane gas lie in one plane"),
    ],
)
def test_boxes_that_contradict_themselves_are_refused(options, words):
    arguments = GOOD | options
    with pytest.raises(RefusedError, match=words):
        ParcelSet(arguments.pop("position"), arguments.pop("velocity"), **arguments)


@pytest.mark.parametrize("until", [math.nan, math.inf, -1.0, "x", None])
def test_a_time_that_is_none_or_past_is_refused(until):
    box = ParcelSet(GOOD["position"], GOOD["velocity"], length=(4, 4, 4))
    with pytest.raises(RefusedError, match="until"):
        box.advance(until)


def test_molecules_without_size_are_an_ideal_gas_and_not_a_mistake():
    box = sphere_box(100, (5.0,) * 3, diameter=0.0)
    within(box, 100.0)
    assert box.contacts == 0
    assert box.wall_hits.sum() > 1000
    assert sum(box.energy()) == pytest.approx(150.0, rel=1e-13)


@pytest.mark.parametrize("collision_number", [1.0, 1e12, math.inf])
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
