"""Vapour and liquid reach the equilibrium of statistical mechanics, for any number of molecules, even one.

Means allow 4 standard errors from 40 blocks: a false alarm once in 4 000 for a fresh seed, never for these. The
molecules are so small that they hardly ever collide and have almost no excluded volume; they exchange energy through
the liquid.
"""

import math

import numpy as np
import pytest

from atmosbox.engine import HeatBath, Mist, Periodic, Pool, Specular, Substance, random_positions
from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from atmosbox.scene.statistics import block_average

pytestmark = pytest.mark.skipif(not COMPILED, reason="so many events take minutes without numba")

SMALL, MASS, AIR_MASS, PHI, C_L = 1e-3, 0.62, 1.0, 3.0, 5.0
BLOCKS = 40


QUICK = {
    "mist": (Mist, {"nuclei": 10.0, "area": 8.0}),
    "mist without nuclei of which a third sticks": (Mist, {"nuclei": 0.0, "area": 8.0, "sticking": 0.3}),
    "pool": (Pool, {"nuclei": 10.0}),
    "pool without nuclei of which a third sticks": (Pool, {"nuclei": 0.0, "sticking": 0.3}),
}
CASES = {
    "mist": (Mist, {"nuclei": 10.0, "area": 8.0}),
    "mist without nuclei": (Mist, {"nuclei": 0.0, "area": 8.0}),
    "mist of which a third sticks": (Mist, {"nuclei": 10.0, "area": 8.0, "sticking": 0.3}),
    "pool": (Pool, {"nuclei": 10.0}),
    "pool without nuclei": (Pool, {"nuclei": 0.0}),
    "pool of which a third sticks": (Pool, {"nuclei": 10.0, "sticking": 0.3}),
}


@pytest.mark.parametrize("name", QUICK)
def test_an_isolated_box_visits_all_states_alike(wet, name):
    # 10 numbers a case: a false alarm once in 100 for four fresh seeds
    kind, options = QUICK[name]
    substance = wet.water(2.0 * math.exp(PHI))
    box = wet.box(kind(substance, number=3, kT=1.4, **options), 2, seed=3)
    step = 1.0 if kind is Mist else 4.0
    wet.holds_the_balance(box, 3, 2, options["nuclei"], substance, step=step, samples=25_000)


@pytest.mark.validate
@pytest.mark.parametrize("air", [2, 0])
@pytest.mark.parametrize("name", CASES)
def test_an_isolated_box_visits_all_states_alike_for_very_long(wet, name, air):
    # errors of a thousandth; some 100 numbers in all: a false alarm once in 8 for a fresh seed
    kind, options = CASES[name]
    substance = wet.water(2.0 * math.exp(PHI))
    vapour = 0 if air else 2
    box = wet.box(kind(substance, number=3 - vapour, kT=1.4, **options), air, vapour=vapour, seed=13)
    step = 1.0 if kind is Mist else 4.0
    wet.holds_the_balance(box, 3, air, options["nuclei"], substance, step=step, samples=250_000)


# no scene has a pool without air, so it needs further kernels
@pytest.mark.parametrize("name", ["mist without nuclei", pytest.param("pool", marks=pytest.mark.validate)])
def test_an_isolated_box_without_air_visits_all_states_alike(wet, name):
    kind, options = CASES[name]
    substance = wet.water(2.0 * math.exp(PHI))
    box = wet.box(kind(substance, number=1, kT=1.4, **options), 0, vapour=2, seed=3)
    step = 1.0 if kind is Mist else 4.0
    wet.holds_the_balance(box, 3, 0, options["nuclei"], substance, step=step, samples=25_000)


@pytest.mark.parametrize(
    ("kind", "air", "air_diameter"),
    [
        (Mist, 2, SMALL),
        (Pool, 1, 0.3),
        *(pytest.param(*case, marks=pytest.mark.validate) for case in ((Mist, 1, 0.3), (Pool, 2, SMALL))),
    ],
)
def test_the_liquid_shares_its_energy_evenly_with_air_of_any_size(wet, kind, air, air_diameter):
    # a ball of a third of the box: the vapour, which is small, would have three times its room
    nuclei, substance = 10.0, wet.water(1e-9, 40.0)
    liquid = kind(substance, number=1, nuclei=nuclei, **({"area": 8.0} if kind is Mist else {}))
    box = wet.box(liquid, air, air_diameter=air_diameter, seed=5)
    total = sum(box.energy()) + box.condensed_energy
    reach = 0.5 * air_diameter, 1.0 - 0.5 * air_diameter
    box.advance(50.0)
    rows = []
    for k in range(20_000):
        box.advance(54.0 + 4.0 * k)
        here = box.snapshot()
        along = 0.5 * AIR_MASS * np.sum(here.velocity**2, axis=0) / total
        height = np.mean((here.position[:, 2] - reach[0]) / (reach[1] - reach[0]))
        share = box.liquid_energy / total
        rows.append([share, share**2, *along, here.rotational_energy.sum() / total, height])
    mean, error = block_average(rows, BLOCKS)
    # beta distributed: one k for each degree of freedom of the liquid, and half a k for each of the air
    capacity, all_of_it = nuclei + C_L, nuclei + C_L + 2.5 * air
    share = capacity / all_of_it
    exact = [share, share * (capacity + 1.0) / (all_of_it + 1.0), *[0.5 * air / all_of_it] * 3, air / all_of_it, 0.5]
    assert box.liquid == 1
    assert (error < 0.003).all()
    assert (np.abs(mean - exact) <= 4.0 * error).all()


# ------------------------------------------------------------------ between heat baths


@pytest.mark.parametrize(
    ("molecules", "saturated", "nuclei", "sticking"),
    [
        (120, 20.0, 10.0, 1.0),
        (5, 2.0, 0.0, 0.4),
        *(pytest.param(*case, marks=pytest.mark.validate) for case in ((120, 20.0, 0.0, 0.4), (5, 2.0, 10.0, 1.0))),
    ],
)
def test_between_heat_baths_the_vapour_has_the_saturation_pressure(wet, molecules, saturated, nuclei, sticking):
    substance = wet.water(saturated * math.exp(PHI))
    vapour = round(saturated)
    mist = Mist(substance, number=molecules - vapour, nuclei=nuclei, sticking=sticking, area=8.0)
    box = wet.box(mist, 2, vapour=vapour, seed=6, walls=(HeatBath(1.0),) * 6)
    volume = wet.open_volume(box)
    exact = wet.vapour_number(substance.saturation_pressure(1.0) * volume, molecules)
    box.advance(50.0)
    rows, samples = [], 500
    for _ in range(BLOCKS):
        condensed, evaporated, mean, time = box.condensed, box.evaporated, 0.0, box.time
        for k in range(samples):
            box.advance(time + k + 1.0)
            mean += box.vapour / samples
        rows.append([mean, (box.condensed - condensed) / samples, (box.evaporated - evaporated) / samples])
    mean, error = block_average(rows, BLOCKS)
    # each molecule of the vapour meets the mist at the rate A w / 4 V
    rate = exact * sticking * mist.area / volume / math.sqrt(2.0 * math.pi * MASS)
    if molecules > 100:
        e = substance.saturation_pressure(1.0)
        assert rate == pytest.approx(sticking * mist.area * e / math.sqrt(2.0 * math.pi * MASS), rel=1e-6)
    expected = np.array([exact, rate, rate])
    assert (error / expected < 0.01).all()
    assert (np.abs(mean - expected) <= 4.0 * error).all()
    assert box.ledger() < 1e-11


def test_a_pool_under_heat_baths_gives_vapour_and_takes_the_pressure(wet):
    saturated, molecules = 20.0, 120
    substance = wet.water(saturated * math.exp(PHI))
    pool = Pool(substance, number=100, nuclei=10.0)
    walls = (*(HeatBath(1.0),) * 4, Specular(), HeatBath(1.0))
    box = wet.box(pool, 2, vapour=20, seed=6, walls=walls)
    volume, area = wet.open_volume(box), (1.0 - SMALL) ** 2
    exact = wet.vapour_number(substance.saturation_pressure(1.0) * volume, molecules)
    box.advance(50.0)
    rows, samples = [], 1000
    for _ in range(BLOCKS):
        condensed, evaporated, impulse = box.condensed, box.evaporated, box.wall_impulse
        mean, time = 0.0, box.time
        for k in range(samples):
            box.advance(time + k + 1.0)
            mean += box.vapour / samples
        felt = (box.wall_impulse - impulse)[[4, 5]] / (area * samples)
        rows.append([mean, (box.condensed - condensed) / samples, (box.evaporated - evaporated) / samples, *felt])
    mean, error = block_average(rows, BLOCKS)
    rate = exact * area / volume / math.sqrt(2.0 * math.pi * MASS)
    expected = np.array([exact, rate, rate, *[(exact + 2.0) / volume] * 2])
    assert (error / expected < 0.01).all()
    assert (np.abs(mean - expected) <= 4.0 * error).all()
    assert box.ledger() < 1e-11


def test_a_liquid_between_heat_baths_has_their_temperature(wet):
    substance, kT, nuclei = wet.water(20.0 * math.exp(PHI)), 1.0, 50.0
    box = wet.box(Mist(substance, number=60, kT=0.7, nuclei=nuclei, area=8.0), 2, seed=7, walls=(HeatBath(kT),) * 6)
    box.advance(100.0)
    values = []
    for k in range(8000):
        box.advance(101.0 + k)
        capacity = nuclei + C_L * box.liquid
        values.append([box.liquid_kT, (box.liquid_energy - capacity * kT) ** 2 / capacity])
    mean, error = block_average(values, BLOCKS)
    # its energy is a gamma variate of as many degrees as it has: of that variance
    assert (error < 0.1).all()
    assert (np.abs(mean - kT) <= 4.0 * error).all()


# ------------------------------------------------------------------ with excluded volume


def carnahan_starling(filled):
    return (1.0 + filled + filled**2 - filled**3) / (1.0 - filled) ** 3


BATHS = (HeatBath(1.0),) * 6


POOL = (Pool, (*BATHS[:4], Specular(), HeatBath(1.0)), {"nuclei": 500.0})
SIDES = np.array([9.0, 9.0, 8.0])


def dense_vapour(kind, walls, options, seed):
    """Return packing fraction, n kT Z of the vapour over e_s, and its error, for a packing fraction of a seventh."""
    saturation, margin = 0.12, 2.0
    substance = Substance(MASS, 1.0, PHI, C_L, saturation * math.exp(PHI))
    liquid = kind(substance, number=120, **options)
    periodic = np.array([wall == Periodic() for wall in walls[::2]])
    rng = np.random.default_rng(seed)
    air, vapour = 130, 40
    rotation = np.r_[np.full(vapour, 3.0), np.full(air, 2.0)]
    mass = np.r_[np.full(vapour, MASS), np.full(air, AIR_MASS)]
    box = MoistParcelSet(
        random_positions(SIDES, np.ones(air + vapour), rng, periodic=tuple(periodic)),
        rng.standard_normal((air + vapour, 3)) / np.sqrt(mass)[:, None],
        length=SIDES,
        walls=walls,
        mass=mass,
        rotation=rotation,
        rotational_energy=rng.standard_gamma(0.5 * rotation),
        liquid=liquid,
        seed=seed,
    )
    # density is higher at a wall: count far from walls
    low = np.where(periodic, 0.0, margin)
    high = SIDES - low
    room = np.prod(high - low)
    box.advance(100.0)
    rows = []
    for k in range(6000):
        box.advance(101.0 + k)
        position, is_vapour = box.snapshot().position, box.mass < 0.5 * (MASS + AIR_MASS)
        here = ((position >= low) & (position <= high)).all(axis=1)
        rows.append([here.sum() / room, (here & is_vapour).sum() / room])
    mean, error = block_average(rows, BLOCKS)
    filled = math.pi / 6.0 * mean[0]
    return filled, mean[1] * carnahan_starling(filled) / saturation, error[1] / mean[1]


def thinned_by_edges(filled):
    """Return the factor by which vapour is thinner over a pool between walls: 1 / (1 - 4 gamma / p L).

    The molecules that hit the floor are those of the bulk, n Z, and besides those that crowd where the floor meets
    a wall. Their force on it is what a longer box would gain: p for each area that centres can reach, minus gamma for
    each length of its rim, with the tension of a gas at a hard wall of scaled particle theory, kT / sigma^2 times
    (-9 / 2 pi) phi^2 (1 + phi) / (1 - phi)^3; its lowest order is exact. As many must hit the floor in equilibrium as
    without walls: so there is less vapour.
    """
    tension = -4.5 / math.pi * filled**2 * (1.0 + filled) / (1.0 - filled) ** 3
    pressure = 6.0 / math.pi * filled * carnahan_starling(filled)
    return 1.0 / (1.0 - 4.0 * tension / (pressure * (SIDES[0] - 1.0)))


@pytest.mark.parametrize(
    ("kind", "walls", "options"),
    [
        # needs further kernels
        pytest.param(Mist, (Periodic(),) * 6, {"nuclei": 1e5, "area": 400.0}, marks=pytest.mark.validate),
        (Mist, BATHS, {"nuclei": 500.0, "area": 400.0}),
        POOL,
    ],
    ids=["mist in a periodic box", "mist between walls", "pool"],
)
def test_in_dense_air_the_partial_pressure_is_that_of_saturation(kind, walls, options):
    # without the factor Z, which is 1.8 there, the vapour would be as much too many; one run resolves 7 % of it
    filled, ratio, accuracy = dense_vapour(kind, walls, options, 13)
    assert carnahan_starling(filled) > 1.7
    assert accuracy < 0.02
    assert abs(ratio / (thinned_by_edges(filled) if kind is Pool else 1.0) - 1.0) <= 4.0 * accuracy


@pytest.mark.validate
def test_over_a_pool_in_dense_air_the_vapour_is_thinner_by_the_crowd_at_the_edges_of_the_floor():
    kind, walls, options = POOL
    open_sides = ((Periodic(),) * 4 + walls[4:], lambda filled: 1.0)
    for sides, expected in ((walls, thinned_by_edges), open_sides):
        runs = np.array([dense_vapour(kind, sides, options, 100 + seed)[:2] for seed in range(16)])
        apart = runs[:, 1] / [expected(filled) for filled in runs[:, 0]] - 1.0
        error = apart.std(ddof=1) / 4.0
        assert error < 0.01
        assert abs(apart.mean()) <= 4.0 * error  # between walls it is 5.6 % thinner, eight errors
