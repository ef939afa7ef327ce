"""Vapour and liquid come to the balance of statistical mechanics, for any number of molecules, one even.

Means allow 4 standard errors from 40 blocks: a false alarm once in 4 000 for a fresh seed, never for these. The
molecules are so small that they hardly ever meet each other or take room; what they exchange they exchange through
the liquid.
"""

import math

import numpy as np
import pytest
from scipy import special

from atmosbox.engine._jit import COMPILED
from atmosbox.engine.liquid import Mist, Pool, Substance
from atmosbox.engine.moist_parcelset import MoistParcelSet
from atmosbox.engine.scatter import random_positions
from atmosbox.engine.walls import HeatBath, Periodic, Specular
from atmosbox.statistics import block_average

pytestmark = pytest.mark.skipif(not COMPILED, reason="so many events take minutes without numba")

SMALL, MASS, AIR_MASS, PHI, C_L = 1e-3, 0.62, 1.0, 3.0, 5.0
BLOCKS = 40


def water(volatility, binding_energy=PHI):
    """Return water whose saturation pressure at kT = 1 is ``volatility`` times exp(-binding energy)."""
    return Substance(MASS, SMALL, binding_energy, C_L, volatility, rotation=3.0)


def moist_box(liquid, air, *, side=1.0, vapour=0, seed=1, kT=1.0, air_diameter=SMALL, height=None, **options):
    """Return a box of air and vapour at random places, with its liquid."""
    rng = np.random.default_rng(seed)
    number = vapour + air
    mass = np.r_[np.full(vapour, MASS), np.full(air, AIR_MASS)]
    rotation = np.r_[np.full(vapour, 3.0), np.full(air, 2.0)]
    length = np.array([side, side, height or side])
    margin = 0.5 * air_diameter
    return MoistParcelSet(
        margin + rng.uniform(size=(number, 3)) * (length - 2.0 * margin),
        rng.standard_normal((number, 3)) * np.sqrt(kT / mass)[:, None],
        length=length,
        mass=mass,
        diameter=np.r_[np.full(vapour, SMALL), np.full(air, air_diameter)],
        rotation=rotation,
        rotational_energy=kT * rng.standard_gamma(0.5 * rotation),
        liquid=liquid,
        seed=seed,
        **options,
    )


def open_volume(box, diameter=SMALL):
    return float(np.prod(box.length - diameter))


def microcanonical(total_energy, molecules, air, nuclei, volume, substance):
    """Return the probability of n molecules in the liquid, n = 0, 1, ..., and their mean energy and its variance.

    The states of n molecules in the liquid, of energy U, are U^(C - 1) / Gamma(C) with C = c_l n + C_n; those of a gas
    of F degrees of freedom are z^v / v! (E - phi v - U)^(F / 2 - 1) / Gamma(F / 2). Their product is a beta density:
    its sum over U is M^(C + F / 2 - 1) / Gamma(C + F / 2), M = E - phi v, and U / M is Beta(C, F / 2). In a heat bath
    the same states give a mean of z T^(F_v / 2 - c_l) exp(-phi / T) molecules of vapour, which must be V e_s / T: so z
    is V times the volatility, since c_p - 1 = F_v / 2.
    """
    n = np.arange(molecules + 1)
    v = molecules - n
    capacity = substance.heat_capacity * n + nuclei
    half = 0.5 * ((3.0 + substance.rotation) * v + 5.0 * air)
    left = total_energy - substance.binding_energy * v
    possible = left > 0.0
    left = np.where(possible, left, 1.0)
    log_weight = v * math.log(volume * substance.volatility) - special.gammaln(v + 1.0)
    log_weight += (capacity + half - 1.0) * np.log(left) - special.gammaln(capacity + half)
    log_weight = np.where(possible, log_weight, -np.inf)
    weight = np.exp(log_weight - log_weight.max())
    share = capacity / (capacity + half)
    variance = left**2 * share * (1.0 - share) / (capacity + half + 1.0)
    return weight / weight.sum(), left * share, variance


def sampled(box, warm_up, step, samples):
    """Return the number in the liquid and its energy at even times."""
    box.advance(warm_up)
    rows = np.empty((samples, 2))
    for k in range(samples):
        box.advance(warm_up + (k + 1) * step)
        rows[k] = box.liquid, box.liquid_energy
    return rows


def mean_where(chosen, values):
    """Return the mean of the chosen values and its standard error, from the means of blocks."""
    sums, error = block_average(np.stack([chosen, chosen * values], axis=1), BLOCKS)
    ratio = sums[1] / sums[0]
    _, error = block_average(chosen * (values - ratio), BLOCKS)
    return ratio, error / sums[0]


def holds_the_balance(box, molecules, air, nuclei, substance, *, step, samples):
    """Hold the probability of each number in the liquid, and the mean and variance of its energy, to theory."""
    total = sum(box.energy()) + box.condensed_energy
    chance, energy, variance = microcanonical(total, molecules, air, nuclei, open_volume(box), substance)
    count, liquid_energy = sampled(box, 50.0, step, samples).T
    assert box.ledger() < 1e-11
    assert min(box.condensed, box.evaporated) > 1000
    compared = []
    for n in np.flatnonzero(chance > 0.01):
        here = (count == n).astype(float)
        mean, error = block_average(here, BLOCKS)
        assert error < 0.01
        compared.append((f"probability of {n}", mean, error, chance[n]))
        if variance[n] > 0.0:
            compared.append((f"energy of {n}", *mean_where(here, liquid_energy), energy[n]))
            squares = (liquid_energy - energy[n]) ** 2
            compared.append((f"variance of {n}", *mean_where(here, squares), variance[n]))
        else:
            assert liquid_energy[count == n] == pytest.approx(energy[n], abs=1e-11 * total)
    assert len(compared) >= 6
    assert not [row for row in compared if not abs(row[1] - row[3]) <= 4.0 * row[2]]


CASES = {
    "mist": (Mist, {"nuclei": 10.0, "area": 8.0}),
    "mist without nuclei": (Mist, {"nuclei": 0.0, "area": 8.0}),
    "mist of which a third sticks": (Mist, {"nuclei": 10.0, "area": 8.0, "sticking": 0.3}),
    "pool": (Pool, {"nuclei": 10.0}),
    "pool without nuclei": (Pool, {"nuclei": 0.0}),
    "pool of which a third sticks": (Pool, {"nuclei": 10.0, "sticking": 0.3}),
}


@pytest.mark.parametrize("name", CASES)
def test_an_isolated_box_visits_all_states_alike(name):
    # 10 numbers a case: a false alarm once in 60 for six fresh seeds
    kind, options = CASES[name]
    substance = water(2.0 * math.exp(PHI))
    box = moist_box(kind(substance, number=3, kT=1.4, **options), 2, seed=3)
    step = 1.0 if kind is Mist else 4.0
    holds_the_balance(box, 3, 2, options["nuclei"], substance, step=step, samples=25_000)


@pytest.mark.validate
@pytest.mark.parametrize("air", [2, 0])
@pytest.mark.parametrize("name", CASES)
def test_an_isolated_box_visits_all_states_alike_for_very_long(name, air):
    # errors of a thousandth; some 100 numbers in all: a false alarm once in 8 for a fresh seed
    kind, options = CASES[name]
    substance = water(2.0 * math.exp(PHI))
    vapour = 0 if air else 2
    box = moist_box(kind(substance, number=3 - vapour, kT=1.4, **options), air, vapour=vapour, seed=13)
    step = 1.0 if kind is Mist else 4.0
    holds_the_balance(box, 3, air, options["nuclei"], substance, step=step, samples=250_000)


@pytest.mark.parametrize("name", ["mist without nuclei", "pool"])
def test_an_isolated_box_without_air_visits_all_states_alike(name):
    kind, options = CASES[name]
    substance = water(2.0 * math.exp(PHI))
    box = moist_box(kind(substance, number=1, kT=1.4, **options), 0, vapour=2, seed=3)
    step = 1.0 if kind is Mist else 4.0
    holds_the_balance(box, 3, 0, options["nuclei"], substance, step=step, samples=25_000)


@pytest.mark.parametrize(
    ("kind", "air", "air_diameter"), [(Mist, 2, SMALL), (Mist, 1, 0.3), (Pool, 2, SMALL), (Pool, 1, 0.3)]
)
def test_the_liquid_shares_its_energy_evenly_with_air_of_any_size(kind, air, air_diameter):
    # a ball of a third of the box: the vapour, which is small, would have three times its room
    nuclei, substance = 10.0, water(1e-9, 40.0)
    liquid = kind(substance, number=1, nuclei=nuclei, **({"area": 8.0} if kind is Mist else {}))
    box = moist_box(liquid, air, air_diameter=air_diameter, seed=5)
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


def vapour_number(saturated, molecules):
    """Return the mean of a Poisson number of mean ``saturated`` that cannot exceed the number of molecules."""
    v = np.arange(molecules + 1)
    weight = np.exp(v * math.log(saturated) - special.gammaln(v + 1.0))
    return float(np.sum(v * weight) / weight.sum())


@pytest.mark.parametrize(("molecules", "saturated"), [(120, 20.0), (5, 2.0)])
@pytest.mark.parametrize(("nuclei", "sticking"), [(10.0, 1.0), (0.0, 0.4)])
def test_between_heat_baths_the_vapour_has_the_saturation_pressure(molecules, saturated, nuclei, sticking):
    substance = water(saturated * math.exp(PHI))
    vapour = round(saturated)
    mist = Mist(substance, number=molecules - vapour, nuclei=nuclei, sticking=sticking, area=8.0)
    box = moist_box(mist, 2, vapour=vapour, seed=6, walls=(HeatBath(1.0),) * 6)
    volume = open_volume(box)
    exact = vapour_number(substance.saturation_pressure(1.0) * volume, molecules)
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


def test_a_pool_under_heat_baths_gives_vapour_and_takes_the_pressure():
    saturated, molecules = 20.0, 120
    substance = water(saturated * math.exp(PHI))
    pool = Pool(substance, number=100, nuclei=10.0)
    walls = (*(HeatBath(1.0),) * 4, Specular(), HeatBath(1.0))
    box = moist_box(pool, 2, vapour=20, seed=6, walls=walls)
    volume, area = open_volume(box), (1.0 - SMALL) ** 2
    exact = vapour_number(substance.saturation_pressure(1.0) * volume, molecules)
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


def test_a_liquid_between_heat_baths_has_their_temperature():
    substance, kT, nuclei = water(20.0 * math.exp(PHI)), 1.0, 50.0
    box = moist_box(Mist(substance, number=60, kT=0.7, nuclei=nuclei, area=8.0), 2, seed=7, walls=(HeatBath(kT),) * 6)
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


# ------------------------------------------------------------------ where molecules take room


def carnahan_starling(filled):
    return (1.0 + filled + filled**2 - filled**3) / (1.0 - filled) ** 3


BATHS = (HeatBath(1.0),) * 6


@pytest.mark.parametrize(
    ("kind", "walls", "options"),
    [
        (Mist, (Periodic(),) * 6, {"nuclei": 1e5, "area": 400.0}),
        (Mist, BATHS, {"nuclei": 500.0, "area": 400.0}),
        (Pool, (*BATHS[:4], Specular(), HeatBath(1.0)), {"nuclei": 500.0}),
    ],
    ids=["mist in a periodic box", "mist between walls", "pool"],
)
def test_in_dense_air_the_partial_pressure_is_that_of_saturation(kind, walls, options):
    # a seventh of the space is filled; without the factor Z, which is 1.8 there, the vapour would be as much too many
    saturation, length, margin = 0.12, np.array([9.0, 9.0, 8.0]), 2.0
    substance = Substance(MASS, 1.0, PHI, C_L, saturation * math.exp(PHI))
    liquid = kind(substance, number=120, **options)
    periodic = walls[0] == Periodic()
    rng = np.random.default_rng(11)
    air, vapour = 130, 40
    rotation = np.r_[np.full(vapour, 3.0), np.full(air, 2.0)]
    mass = np.r_[np.full(vapour, MASS), np.full(air, AIR_MASS)]
    box = MoistParcelSet(
        random_positions(length, np.ones(air + vapour), rng, periodic=(periodic,) * 3),
        rng.standard_normal((air + vapour, 3)) / np.sqrt(mass)[:, None],
        length=length,
        walls=walls,
        mass=mass,
        rotation=rotation,
        rotational_energy=rng.standard_gamma(0.5 * rotation),
        liquid=liquid,
        seed=11,
    )
    # at a wall they crowd: count where none is near
    low, high = (0.0, length) if periodic else (margin, length - margin)
    room = np.prod(high - low)
    box.advance(100.0)
    rows = []
    for k in range(6000):
        box.advance(101.0 + k)
        position, is_vapour = box.snapshot().position, box.mass < 0.5 * (MASS + AIR_MASS)
        here = ((position >= low) & (position <= high)).all(axis=1)
        rows.append([here.sum() / room, (here & is_vapour).sum() / room])
    mean, error = block_average(rows, BLOCKS)
    crowding = carnahan_starling(math.pi / 6.0 * mean[0])
    accuracy = error[1] / mean[1]
    assert crowding > 1.7
    assert accuracy < 0.02
    assert abs(mean[1] * crowding / saturation - 1.0) <= 4.0 * accuracy
