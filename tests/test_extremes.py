"""Boxes that break simulations: each either comes out right or is refused, in a sentence and in bounded time.

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


# 2, 20: corners and edges


def test_a_molecule_in_a_corner_turns_round_whole_and_hits_three_walls():
    box = ParcelSet([[5, 5, 5]], [[1, 1, 1]], length=(10, 10, 10))
    within(box, 9.0)
    assert box.snapshot().velocity.tolist() == [[-1.0, -1.0, -1.0]]
    assert box.snapshot().position.tolist() == [[5.0, 5.0, 5.0]]
    assert box.wall_hits.tolist() == [0, 1, 0, 1, 0, 1]


def test_a_molecule_in_an_edge_for_ever_stays_on_its_diagonal():
    box = ParcelSet([[2, 2, 5]], [[1, 1, 0.1]], length=(10, 10, 10))
    within(box, 10_000.0)
    (x, y, _), (u, v, _) = box.snapshot().position[0], box.snapshot().velocity[0]
    assert x == pytest.approx(y, abs=1e-9)
    assert u == v
    assert outermost(box) <= 1e-12
    # each crossing of the 9 that the centre can go takes 9
    assert abs(box.wall_hits[0] - 10_000 / 18) <= 1.0


def test_molecules_so_fast_that_they_cross_the_box_a_thousand_times_between_two_looks_stay_in_it():
    box = sphere_box(20, (5.0, 5.0, 5.0), kT=1e6)
    for k in range(1, 6):
        within(box, 5.0 * k)
        assert outermost(box) <= 1e-12
        assert deepest_overlap(box) <= 1e-9
    assert box.wall_hits.min() > 10_000


# 5, 18: nearly touching, grazing


@pytest.mark.parametrize("gap", [1e-15, 1e-12, 1e-9, 1e-6])
def test_a_hair_between_two_molecules_is_crossed_in_the_time_that_it_takes(gap):
    box = ParcelSet([[4, 5, 5], [5 + gap, 5, 5]], [[1, 0, 0], [-1, 0, 0]], length=(10, 10, 10))
    true_gap = (5 + gap) - 4 - 1
    within(box, 1.0)
    assert box.contacts == 1
    here = box.snapshot()
    assert here.velocity[:, 0].tolist() == [-1.0, 1.0]
    assert here.position[0, 0] == pytest.approx(4.0 + true_gap - 1.0, abs=1e-14)


@pytest.mark.parametrize("off", [0.0, 1e-16, -1e-16, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9])
def test_two_molecules_that_graze_pass_each_other_in_peace(off):
    box = ParcelSet([[2, 5, 5], [6, 6 * (1 + off), 5]], [[1, 0, 0], [0, 0, 0]], length=(20, 20, 20))
    within(box, 8.0)
    here = box.snapshot()
    assert np.isfinite(here.velocity).all()
    assert box.contacts <= 1
    # the impulse of a grazing contact goes with the root of what they overlap
    assert np.abs(here.velocity - [[1, 0, 0], [0, 0, 0]]).max() <= 10.0 * math.sqrt(12.0 * abs(off) + 1e-15)
    assert sum(box.energy()) == pytest.approx(0.5, rel=1e-14)


# 6: as dense as can be, and denser


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


@pytest.mark.parametrize("packing", [0.6, 0.64, 0.7])
def test_a_crystal_starts_from_a_lattice_and_stays_one(packing):
    number = 500
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


# 7, 8: very unlike molecules


def test_molecules_a_million_times_as_heavy_as_the_others_keep_the_energy():
    mass = np.where(np.arange(100) < 10, 1e6, 1.0)
    box = sphere_box(100, (8.0, 8.0, 8.0), mass=mass)
    light = np.sum(box.snapshot().velocity[10:] ** 2)
    within(box, 500.0)
    assert box.contacts > 10_000
    assert box.ledger() <= 1e-12
    assert deepest_overlap(box) <= 1e-9
    # the heavy ones are walls to the light ones, whose energy has not changed much
    assert np.sum(box.snapshot().velocity[10:] ** 2) == pytest.approx(light, rel=0.3)


def test_a_light_molecule_rattles_between_a_wall_and_a_heavy_one_as_often_as_mechanics_says():
    # Galperin's count: with masses 100^k : 1 there are so many hits as pi has to k + 1 digits
    for k, hits in enumerate([3, 31, 314, 3141]):
        box = ParcelSet([[5, 5, 5], [8, 5, 5]], [[0, 0, 0], [-1, 0, 0]], length=(300, 10, 10), mass=[1.0, 100.0**k])
        within(box, 100.0)
        assert box.contacts + box.wall_hits[0] == hits
        assert box.wall_hits[1:].max() == 0
        assert sum(box.energy()) == pytest.approx(0.5 * 100.0**k, rel=1e-12)


def test_molecules_a_hundred_times_as_large_as_the_others_meet_as_often_as_theory_says():
    number = 400
    diameter = np.where(np.arange(number) < 4, 10.0, 0.1)
    side = 40.0
    box = sphere_box(number, (side,) * 3, diameter=diameter, walls=(P,) * 6)
    members = np.array([number - 4.0, 4.0])
    rate = theory.collision_rate_between(members / side**3, [0.1, 10.0], [1.0, 1.0], 1.0)
    rate *= 1.0 - np.eye(2) / members
    expected = 0.5 * float(np.sum(members[:, None] * rate))
    within(box, 200.0)
    rates = []
    for _ in range(20):
        before = box.contacts
        within(box, box.time + 1000.0)
        rates.append((box.contacts - before) / 1000.0)
    mean, error = block_average(rates)
    assert error / expected < 0.03
    # four giants in a periodic box are few: 2 parts in 100
    assert abs(mean - expected) <= 4.0 * error + 0.02 * expected
    assert deepest_overlap(box) <= 1e-9


# 9, 10: walls very hot and very cold


def test_walls_a_million_times_as_hot_as_others_are_no_trouble():
    box = sphere_box(200, (10.0,) * 3, walls=(HeatBath(1e6), HeatBath(1.0), S, S, S, S))
    for k in range(1, 20):
        within(box, 0.2 * k)
        assert outermost(box) <= 1e-12
        assert deepest_overlap(box) <= 1e-9
        assert box.ledger() <= 1e-10
    assert 10.0 < temperature(box, box.snapshot()) < 1e6
    assert box.wall_heat[0] > 0.0 > box.wall_heat[1]


@pytest.mark.parametrize("kT", [0.0, -1.0, math.nan, math.inf])
def test_a_wall_without_a_temperature_above_zero_is_refused(kT):
    with pytest.raises(RefusedError, match="kT of wall z_low"):
        sphere_box(2, (5.0,) * 3, walls=(S, S, S, S, HeatBath(kT), S))


def test_walls_at_hardly_any_temperature_freeze_the_gas_and_nothing_else_happens():
    box = sphere_box(50, (10.0,) * 3, walls=(HeatBath(1e-300),) * 6)
    before, refusals = sum(box.energy()), []
    for until in (10.0, 1e3, 1e5):
        try:
            within(box, until)
        except StalledError as refusal:
            # somebody is caught between a wall's slow molecule and the others
            refusals.append(str(refusal))
        assert box.ledger() <= 1e-10
    assert all("is too cold: warm it" in refusal for refusal in refusals)
    assert np.isfinite(box.snapshot().position).all()
    assert sum(box.energy()) < 0.9 * before
    assert outermost(box) <= 1e-12


def test_a_floor_too_cold_for_its_gravity_is_refused():
    box = sphere_box(50, (10.0,) * 3, gravity=1.0, walls=(S, S, S, S, HeatBath(1e-300), S))
    with pytest.raises(
        StalledError, match=r"wall z_low at kT = 1e-300 is too cold: warm it, or reduce the gravity of 1"
    ):
        within(box, 1000.0)


# 11, 12: at rest


@pytest.mark.parametrize("gravity", [1e3, 1e6])
def test_gravity_a_thousand_times_too_strong_is_only_a_denser_floor(gravity):
    box = sphere_box(100, (10.0,) * 3, gravity=gravity)
    before = sum(box.energy())
    duration = 20.0 / math.sqrt(gravity)
    for k in range(1, 11):
        within(box, duration * k / 10.0)
        assert outermost(box) <= 1e-12
        assert deepest_overlap(box) <= 1e-9
    assert box.wall_hits[4] > 100
    assert abs(sum(box.energy()) / before - 1.0) <= 1e-12


@pytest.mark.parametrize("heights", [[0.5], [0.5, 1.5], [0.5, 1.5, 2.5]])
def test_molecules_at_rest_on_the_floor_in_gravity_are_refused(heights):
    where = [[5.0, 5.0, z] for z in heights]
    with pytest.raises(
        StalledError, match=r"molecules come to rest: reduce the gravity of 1, or give them more energy"
    ):
        within(ParcelSet(where, np.zeros((len(where), 3)), length=(10, 10, 10), gravity=1.0), 10.0)


def test_molecules_that_touch_at_rest_without_gravity_stay_so():
    where = [[5.0, 5.0, 0.5], [5.0, 5.0, 1.5], [6.0, 5.0, 1.5]]
    box = within(ParcelSet(where, np.zeros((3, 3)), length=(10, 10, 10)), 1e6)
    assert box.snapshot().position.tolist() == where
    assert box.energy() == (0.0, 0.0, 0.0)


def test_a_ball_dropped_on_the_floor_bounces_back_to_its_height_for_ever():
    height, gravity = 4.0, 1.0
    box = ParcelSet([[5, 5, 0.5 + height]], np.zeros((1, 3)), length=(10, 10, 10), gravity=gravity)
    period = 2.0 * math.sqrt(2.0 * height / gravity)
    within(box, 1000.0 * period)
    assert box.wall_hits[4] in (1000, 999)
    assert box.snapshot().position[0, 2] == pytest.approx(0.5 + height, abs=1e-6)
    assert sum(box.energy()) == pytest.approx(0.5 + height, rel=1e-13)


# 13: very tall


@pytest.mark.parametrize("height", [6e3, 6e8])
def test_a_box_much_taller_than_its_atmosphere_costs_no_memory_and_holds_it_all_below(height):
    rng = np.random.default_rng(6)
    number, length = 100, (6.0, 6.0, height)
    x = random_positions(length, np.ones(number), rng, top=60.0)
    box = ParcelSet(x, maxwell_velocities(1.0, np.ones(number), rng), length=length, gravity=1.0)
    before = sum(box.energy())
    within(box, 200.0)
    assert box.memory() < 10_000_000
    assert abs(sum(box.energy()) / before - 1.0) <= 1e-12
    z = box.snapshot().position[:, 2]
    assert z.max() < before
    assert box.wall_hits[5] == 0
    assert deepest_overlap(box) <= 1e-9


# 14, 15: nothing, and hardly anything


@pytest.mark.parametrize("number", [0, 2, 100])
def test_a_box_where_nothing_moves_is_at_its_end_at_once(number):
    length = (10.0, 10.0, 10.0)
    where = lattice_positions(length, np.ones(number))
    box = within(ParcelSet(where, np.zeros((number, 3)), length=length), 1e9)
    assert box.time == 1e9
    assert set(box.events.values()) == {0}
    assert (box.snapshot().position == where).all()


def test_an_empty_box_has_no_temperature_and_everything_else():
    box = within(ParcelSet(np.zeros((0, 3)), np.zeros((0, 3)), length=(4, 4, 4), gravity=1.0), 10.0)
    assert math.isnan(temperature(box, box.snapshot()))
    assert box.energy() == (0.0, 0.0, 0.0)
    assert box.ledger() == 0.0
    assert box.open_density == 0.0
    assert box.degrees_of_freedom == 3.0
    assert layer_sample(box, box.snapshot(), 3).number.tolist() == [0.0, 0.0, 0.0]
    assert mean_free_path(0, 0.0) == math.inf
    assert box.memory() < 1_000_000
    assert "0 molecules" in repr(box)


@pytest.mark.parametrize("number", [1, 2, 3])
@pytest.mark.parametrize("walls", [(S,) * 6, (P,) * 6, (HeatBath(1.0),) * 6], ids=["walls", "periodic", "baths"])
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


def test_one_molecule_meets_not_its_own_image():
    box = within(ParcelSet([[1, 1, 1]], [[1.0, 0.7, 0.3]], length=(2.4, 2.4, 2.4), walls=(P,) * 6), 1000.0)
    assert box.contacts == 0
    assert box.snapshot().velocity.tolist() == [[1.0, 0.7, 0.3]]


# 16: very many


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
    assert many(100_000) <= 250.0


@pytest.mark.validate
def test_a_million_molecules_take_no_more_memory_each_than_few():
    assert many(1_000_000) <= 250.0


# 17: at exactly the same time


@pytest.mark.parametrize("moving", [1, 2, 3, 4])
def test_as_many_balls_leave_a_newton_cradle_as_come(moving):
    # touching, but for the gap through which they come: each contact hands the velocity on
    x = [[2.0 + i + (2.0 if i >= moving else 0.0), 5.0, 5.0] for i in range(5)]
    v = [[1.0 if i < moving else 0.0, 0.0, 0.0] for i in range(5)]
    box = within(ParcelSet(x, v, length=(20, 10, 10)), 4.0)
    assert box.snapshot().velocity[:, 0].tolist() == [0.0] * (5 - moving) + [1.0] * moving
    assert box.contacts == moving * (5 - moving)


def test_two_balls_that_hit_a_third_at_once_from_both_sides_go_back():
    where = [[2, 5, 5], [5, 5, 5], [8, 5, 5]]
    for order in itertools.permutations(range(3)):
        velocity = np.array([[1.0, 0, 0], [0, 0, 0], [-1.0, 0, 0]])
        box = ParcelSet(np.array(where)[list(order)], velocity[list(order)], length=(10, 10, 10))
        within(box, 3.0)
        after = box.snapshot().velocity[np.argsort(order), 0]
        assert after.tolist() == [-1.0, 0.0, 1.0]


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


# 19: impossible starts


def test_molecules_that_touch_at_the_start_are_welcome_and_those_that_overlap_are_not():
    still = np.zeros((2, 3))
    within(ParcelSet([[1, 2, 2], [2, 2, 2]], [[1, 0, 0], [0, 0, 0]], length=(4, 4, 4)), 1.0)
    with pytest.raises(RefusedError, match=r"molecules 0 and 1 overlap at the start, by 0\.5 of their diameter"):
        ParcelSet([[1, 2, 2], [1.5, 2, 2]], still, length=(4, 4, 4))
    # through a periodic wall, too
    with pytest.raises(RefusedError, match="molecules 0 and 1 overlap at the start"):
        ParcelSet([[0.2, 2, 2], [3.8, 2, 2]], still, length=(4, 4, 4), walls=(P,) * 6)


@pytest.mark.parametrize(("place", "wall"), [([-1, 2, 2], "x_low"), ([2, 3.6, 2], "y_high"), ([2, 2, 0.4], "z_low")])
def test_a_molecule_that_reaches_through_a_wall_at_the_start_is_refused(place, wall):
    with pytest.raises(RefusedError, match=f"reaches through wall {wall}: its centre must lie between 0.5 and 3.5"):
        ParcelSet([place], [[0, 0, 0]], length=(4, 4, 4))


# 21: crushed


@pytest.mark.parametrize(("number", "side"), [(4, 4.0), (20, 4.0), (100, 6.0)])
@pytest.mark.parametrize("rotation", [0, 2])
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


def test_a_piston_on_points_stops_at_a_thousandth_of_the_box():
    box = sphere_box(100, (6.0, 6.0, 10.0), diameter=0.0, walls=(S,) * 5 + (Piston(-0.5),))
    with pytest.raises(StalledError, match=r"the piston has come down to 0\.01 at t = 19\.98"):
        within(box, 40.0)
    assert box.ledger() <= 1e-10


@pytest.mark.parametrize("velocity", [1.0, 100.0, 1e6])
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


# 22: very long


@pytest.mark.parametrize("number", [2, 3])
def test_after_a_thousand_million_units_of_time_nothing_has_drifted(number):
    where = [[2, 5, 5], [7, 5.3, 5.2], [5, 2, 8]][:number]
    velocity = [[0.013, 0.007, 0.003], [-0.011, -0.002, 0.009], [0.003, 0.008, -0.01]][:number]
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


# 23: the same again


def mixed_box(seed=8):
    number = 200
    walls = (HeatBath(1.2), HeatBath(0.8, 0.5), S, S, S, Piston(0.05))
    energy = np.ones(number)
    return sphere_box(
        number,
        (8.0, 8.0, 8.0),
        seed=seed,
        diameter=0.7,
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


# 24: what is no number


GOOD = {"position": [[1, 2, 2], [3, 2, 2]], "velocity": [[1, 0, 0], [-1, 0, 0]], "length": (4, 4, 4)}
BAD = [
    ("mass", [0, -1, math.nan, math.inf, "x", None, [1, 2, 3]]),
    ("diameter", [-1, math.nan, math.inf, "x", None]),
    ("rotation", [1, -2, math.nan, "x"]),
    ("rotational_energy", [-1, math.nan, math.inf]),
    ("gravity", [-1, math.nan, math.inf, "x", None]),
    ("collision_number", [0.5, -1, math.nan, "x", None]),
    ("layers", [0, -3, 2.5, math.nan, "x", None]),
    ("seed", [-1, 1.5, "x", None]),
    ("length", [(1, 2), (4, 4, 0), (4, 4, -4), (4, 4, math.nan), (4, 4, math.inf), (4, 4, "x"), "x", None, 4.0]),
    ("position", [[[1, 2, 2]], [[1, 2], [3, 2]], [[math.nan, 2, 2], [3, 2, 2]], [["a", 2, 2], [3, 2, 2]], None]),
    ("velocity", [[[math.inf, 0, 0], [0, 0, 0]], [["a", 0, 0], [0, 0, 0]], None]),
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


# 26: rotation at its extremes


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


# 28: rounding


def test_rounding_errors_of_energy_are_a_random_walk_and_no_drift():
    box = sphere_box(200, (9.0,) * 3)
    before = sum(box.energy())
    for k in range(1, 21):
        within(box, 20.0 * k)
        events = sum(box.events.values())
        assert abs(sum(box.energy()) / before - 1.0) <= 1e-12 * math.sqrt(events) * 1e-2 + 1e-14
    assert box.contacts > 100_000
