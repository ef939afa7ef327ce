"""Drops keep energy, water and momentum at every event, stay in the box, and merge."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from atmosbox.engine import Drops, Periodic, Substance
from atmosbox.engine.liquid.drop_parcelset import DropParcelSet
from atmosbox.engine.liquid.reservoir import AIR_MET
from tests.engine.boxes import SMOOTH, TURNING, WARM, apart, many_events

PHI, MASS, DIAMETER = 8.0, 0.62, 0.5
CENTRES = ((2.0, 2.0, 2.0), (5.0, 2.0, 6.0), (3.5, 6.0, 4.0))


def water(saturation=0.1, **changes):
    """Return water of a saturation pressure at kT = 1."""
    facts = {"mass": MASS, "diameter": DIAMETER, "binding_energy": PHI, "heat_capacity": 9.0} | changes
    return Substance(**facts, volatility=saturation * math.exp(facts["binding_energy"]))


def nuclei(number=30, centres=CENTRES, substance=None, **changes):
    """Return drops with something in them."""
    facts = {"nuclei": 30.0, "nucleus": 0.5, "nucleus_mass": 4.0, "molecule_radius": 0.3, "sticking": 0.8} | changes
    return Drops(substance or water(), number=number, position=centres, **facts)


def damp(drops, air=20, vapour=10, *, sides=(8.0, 8.0, 8.0), walls=SMOOTH, kT=1.0, seed=9, **options):
    """Return a box of air and vapour at random places, with drops in it."""
    rng = np.random.default_rng(seed)
    substance, periodic = drops.substance, [isinstance(wall, Periodic) for wall in walls[::2]]
    mass = np.r_[np.full(vapour, substance.mass), np.ones(air)]
    diameter = np.r_[np.full(vapour, substance.diameter), np.full(air, 0.6)]
    rotation = np.r_[np.full(vapour, substance.rotation), np.full(air, 2.0)]
    share = math.ceil(drops.number / len(drops.position))
    radius = 1e-9 + (drops.nucleus**3 + share * drops.molecule_radius**3) ** (1.0 / 3.0)
    position = np.zeros((0, 3))
    while len(position) < air + vapour:
        d = diameter[len(position)]
        place = 0.5 * d + rng.uniform(size=(1, 3)) * (np.array(sides) - d)
        touching = 0.5 * (d + diameter[: len(position)])
        if (apart(place, drops.position, sides, periodic) > 0.5 * d + radius).all() and (
            apart(place, position, sides, periodic) > touching
        ).all():
            position = np.vstack([position, place])
    facts = {
        "mass": mass,
        "diameter": diameter,
        "rotation": rotation,
        "rotational_energy": kT * rng.standard_gamma(0.5 * rotation),
        "length": sides,
        "walls": walls,
        "seed": seed,
    } | options
    position = facts.pop("position", position)
    velocity = facts.pop("velocity", rng.standard_normal((air + vapour, 3)) * np.sqrt(kT / mass)[:, None])
    return DropParcelSet(position, velocity, liquid=drops, **facts)


def box(name, drops=None, **changes):
    """Return a box by the name of its special feature."""
    return damp(
        drops or nuclei(), walls={"smooth": SMOOTH, "between heat baths": WARM, "periodic": TURNING}[name], **changes
    )


own_kernels = pytest.mark.nightly  # no scene has drops in a periodic box
by_name = pytest.mark.parametrize("name", ["smooth", "between heat baths", pytest.param("periodic", marks=own_kernels)])


def flying(parcel):
    """Return masses and velocities of the present drops."""
    alive = parcel._drops.alive == 1
    m = parcel._fields[parcel._drops.record[alive]]
    return parcel._kinds.table["mass"][parcel._first_drop :][alive], np.stack([m["vx"], m["vy"], m["vz"]], axis=1)


def momentum(parcel):
    """Return the momentum of molecules and drops."""
    mass, velocity = flying(parcel)
    return parcel.mass @ parcel.snapshot().velocity + mass @ velocity


def happened(parcel):
    """Return the numbers of condensations, evaporations, hits with immediate return, and mergers of two drops."""
    return np.array([parcel.condensed, parcel.evaporated, parcel._reservoir.count[AIR_MET], parcel.merged])


def deepest_overlap(parcel):
    """Return the deepest overlap of two molecules, and that of a molecule and a drop or of two drops [length]."""
    x, (centre, radius, _) = parcel.snapshot().position, parcel.drops()
    facts = parcel.length, parcel.periodic
    r = 0.5 * parcel.diameter
    between = r[:, None] + r[None, :] - apart(x, x, *facts)
    np.fill_diagonal(between, -math.inf)
    drops = radius[:, None] + radius[None, :] - apart(centre, centre, *facts)
    np.fill_diagonal(drops, -math.inf)
    inside = r[:, None] + radius[None, :] - apart(x, centre, *facts)
    return between.max(initial=-math.inf), max(inside.max(initial=-math.inf), drops.max(initial=-math.inf))


def is_lawful(parcel, waters, drops):
    """Assert what must hold of every box at every time, ``drops`` being what there was in it at the start."""
    now, (centre, radius, held) = parcel.snapshot(), parcel.drops()
    assert np.isfinite(now.position).all()
    assert np.isfinite(now.velocity).all()
    assert (now.rotational_energy >= 0.0).all()
    assert parcel.escaped() == 0
    assert parcel.liquid + parcel.vapour == waters
    assert held.sum() == parcel.liquid
    assert (held >= 0).all()
    assert len(now.position) == parcel.number == len(parcel.mass)
    assert len(centre) == len(drops.position) - parcel.merged >= 1
    # the rounding error that is left when the last molecule takes all energy
    assert parcel.liquid_energy >= -1e-11
    assert parcel.ledger() < 1e-10
    # size and mass follow what they hold, and nothing is lost where two become one
    assert np.sum(radius**3) == pytest.approx(
        len(drops.position) * drops.nucleus**3 + parcel.liquid * drops.molecule_radius**3, rel=1e-12
    )
    assert flying(parcel)[0].sum() == pytest.approx(
        len(drops.position) * drops.nucleus_mass + parcel.liquid * drops.substance.mass, rel=1e-12
    )
    walled = ~np.array(parcel.periodic)
    low, high = radius[:, None] - 1e-9, parcel.length - radius[:, None] + 1e-9
    assert ((centre >= low) & (centre <= high))[:, walled].all()
    between, inside = deepest_overlap(parcel)
    assert between < 1e-9
    if not parcel.merged:
        assert inside < 1e-9
        cores, balls = drops.nucleus**3, drops.molecule_radius**3
        np.testing.assert_allclose(radius**3, cores + held * balls, rtol=1e-12)
        np.testing.assert_allclose(flying(parcel)[0], drops.nucleus_mass + held * drops.substance.mass, rtol=1e-12)


# ------------------------------------------------------------------ their balances, event by event


@many_events
@by_name
def test_energy_water_and_momentum_close_at_every_event(name, by_single_events):
    parcel, drops = box(name), nuclei()
    start = sum(parcel.energy()) + parcel.condensed_energy
    moving = momentum(parcel)
    seen = [happened(parcel)]

    def check(time):
        now = happened(parcel)
        if (now == seen[-1]).all():
            return
        assert np.sum(now - seen[-1]) == 1
        seen.append(now)
        mass, velocity = flying(parcel)
        kinetic, rotational, potential = parcel.energy()
        inside = kinetic + rotational + parcel.liquid_energy + PHI * parcel.vapour
        inside += 0.5 * float(mass @ np.sum(velocity**2, axis=1))
        assert potential == 0.0
        assert inside - parcel.wall_heat.sum() - parcel.work == pytest.approx(start, rel=1e-10)
        assert parcel.number == 20 + parcel.vapour
        if name == "periodic":
            np.testing.assert_allclose(momentum(parcel), moving, atol=1e-10)
        is_lawful(parcel, 40, drops)

    end = 0.0
    while (seen[-1] < [8, 8, 8, 1]).any():
        end += 5.0
        assert end < 2000.0
        parcel.advance(end, watch=check)
    assert len(seen) - 1 == seen[-1].sum()


@many_events
@by_name
def test_a_drop_that_was_hit_flies_off_and_turns_at_walls(name):
    # one molecule of vapour hits it along x and stays; one of air rests in a corner
    drops = nuclei(0, ((4.0, 4.0, 4.0),), water(1e-30), sticking=1.0)
    position = np.array([[4.0, 4.0, 4.0], [0.5, 0.5, 0.5]])
    position[0, 0] = 1.0
    velocity = np.zeros((2, 3))
    velocity[0, 0] = 3.0
    parcel = box(name, drops=drops, air=1, vapour=1, position=position, velocity=velocity, kT=0.0)
    energy, before = sum(parcel.energy()) + parcel.condensed_energy, momentum(parcel)
    parcel.advance(3.0)
    assert (parcel.condensed, parcel.number) == (1, 1)
    mass, flight = flying(parcel)
    assert mass == pytest.approx(4.0 + MASS, rel=1e-14)
    np.testing.assert_allclose(momentum(parcel), before, atol=1e-12)
    assert flight[0, 0] == pytest.approx(3.0 * MASS / (4.0 + MASS), rel=1e-12)
    parcel.advance(300.0)
    kinetic = parcel.condensed_energy - parcel.liquid_energy
    gained = parcel.wall_heat.sum() + parcel.work
    assert sum(parcel.energy()) + parcel.condensed_energy - gained == pytest.approx(energy, rel=1e-12)
    if name == "periodic":
        assert parcel.wall_hits.sum() == 0
        np.testing.assert_allclose(momentum(parcel), before, atol=1e-12)
    else:
        assert parcel.wall_hits.sum() >= 2
    if name == "smooth":
        assert kinetic == pytest.approx(0.5 * float(mass[0]) * flight[0, 0] ** 2, rel=1e-12)
        assert parcel.wall_impulse[0] == pytest.approx(2.0 * before[0] * parcel.wall_hits[0], rel=1e-12)
    assert (parcel.wall_heat.sum() != 0.0) == (name == "between heat baths")
    is_lawful(parcel, 1, drops)


@many_events
def test_drops_that_grow_at_walls_and_in_corners_stay_inside(by_single_events):
    radius = 0.5
    centres = ((radius, radius, radius), (8.0 - radius, 4.0, 4.0), (4.0, 4.0, 8.0 - radius))
    drops = nuclei(0, centres, water(1e-3), nuclei=200.0, sticking=1.0)
    parcel = damp(drops, 5, 40, seed=4)
    seen = []

    def check(time):
        if parcel.condensed > len(seen):
            seen.append(time)
            is_lawful(parcel, 40, drops)

    parcel.advance(60.0, watch=check)
    assert len(seen) > 20


# ------------------------------------------------------------------ two become one


@many_events
def test_a_drop_that_has_swallowed_another_is_where_all_meet_it():
    # it is at the centre of mass of both, a radius away, among so many molecules that there are many cells
    drops = nuclei(60, ((3.0, 4.0, 4.0), (5.2, 4.0, 4.0)), water(1e-12), nucleus_mass=1.0)
    parcel = damp(drops, 200, 10, seed=4)
    while not parcel.merged:
        parcel.advance(parcel.time + 0.05)
        assert parcel.time < 400.0
    # molecules within the larger radius fly out, and from then on no molecule comes in
    parcel.advance(parcel.time + 20.0)
    assert parcel.arrays().gas.cells.number_x > 2
    for _ in range(100):
        parcel.advance(parcel.time + 0.1)
        centre, radius, _ = parcel.drops()
        away = apart(parcel.snapshot().position, centre, parcel.length, parcel.periodic)[:, 0]
        assert (away > radius + 0.5 * parcel.diameter - 1e-9).all()
    is_lawful(parcel, 70, drops)


@many_events
def test_the_surface_that_two_drops_lose_warms_them_and_their_salts_add_up(by_single_events):
    drops = nuclei(30, surface_tension=1.5, dissolved=(5.0, 0.0, 7.0))
    parcel = box("smooth", drops)
    before = []

    def check(time):
        assert parcel.ledger() < 1e-12
        assert parcel.dissolved.sum() == 12.0
        assert parcel.surface_energy == pytest.approx(6.0 * math.pi * np.sum(parcel.drops()[1] ** 2), rel=1e-12)
        before.append((parcel.merged, parcel.surface_energy, parcel.liquid_energy))

    while not parcel.merged:
        parcel.advance(parcel.time + 5.0, watch=check)
        assert parcel.time < 2000.0
    numbers, surface, warm = np.array(before).T
    (last,) = np.flatnonzero(np.diff(numbers) > 0)[:1]
    assert surface[last] - surface[last + 1] > 1.0
    assert warm[last + 1] - warm[last] >= surface[last] - surface[last + 1]


# ------------------------------------------------------------------ very few molecules


@many_events
@settings(max_examples=60)
@given(
    centres=st.sampled_from([CENTRES[:1], CENTRES[:2], CENTRES]),
    number=st.integers(0, 3),
    vapour=st.integers(0, 3),
    air=st.integers(1, 5),
    heat=st.sampled_from([0.0, 30.0]),
    ball=st.sampled_from([0.0, 0.3]),
    core=st.sampled_from([0.1, 4.0]),
    sticking=st.sampled_from([0.3, 1.0]),
    seed=st.integers(0, 10_000),
    walls=st.sampled_from([SMOOTH, WARM]),
)
def test_a_box_may_hold_hardly_any_water_and_air(centres, number, vapour, air, heat, ball, core, sticking, seed, walls):
    assume(number + vapour >= 1)
    substance = water(0.05, binding_energy=2.0)
    facts = {"nuclei": heat, "molecule_radius": ball, "nucleus_mass": core, "sticking": sticking}
    drops = nuclei(number, centres, substance, **facts)
    parcel = damp(drops, air, vapour, seed=seed, walls=walls)
    for time in (0.3, 3.0, 30.0, 300.0):
        parcel.advance(time)
        is_lawful(parcel, number + vapour, drops)


@many_events
def test_drops_that_boil_leave_their_nuclei():
    drops = nuclei(20, substance=water(1e4))
    parcel = damp(drops, 20, 0, walls=WARM)
    while parcel.liquid and parcel.time < 300.0:
        parcel.advance(parcel.time + 1.0)
    assert (parcel.liquid, parcel.vapour, parcel.number) == (0, 20, 40)
    assert (parcel.drops()[2] == 0).all()
    is_lawful(parcel, 20, drops)
