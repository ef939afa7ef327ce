"""Vapour and liquid reach the equilibrium of statistical mechanics, for any number of molecules, even one.

Means allow 4 standard errors from 40 blocks: a false alarm once in 4 000 for a fresh seed, never for these. The
molecules are so small that they hardly ever collide and have almost no excluded volume; they exchange energy through
the liquid. On dsmc a step of free flight, the liquid's turn and the collisions each leave that balance as it is, so no
length of step changes it.
"""

import math

import numpy as np
import pytest
from scipy import special

from atmosbox.engine import HeatBath, Mist, Periodic, Piston, Pool, Specular, Substance, random_positions
from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.dsmc.moist_dsmc_parcel import MoistDsmcParcel
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from atmosbox.scene.statistics import block_average

pytestmark = pytest.mark.skipif(not COMPILED, reason="so many events take minutes without numba")

SMALL, MASS, AIR_MASS, PHI, C_L = 1e-3, 0.62, 1.0, 3.0, 5.0
BLOCKS = 40
BATHS = (HeatBath(1.0),) * 6
OVER_POOL = (*BATHS[:4], Specular(), HeatBath(1.0))
CASES = {
    "mist": (Mist, {"nuclei": 10.0, "area": 8.0}),
    "mist without nuclei": (Mist, {"nuclei": 0.0, "area": 8.0}),
    "mist without nuclei of which a third sticks": (Mist, {"nuclei": 0.0, "area": 8.0, "sticking": 0.3}),
    "mist of which a third sticks": (Mist, {"nuclei": 10.0, "area": 8.0, "sticking": 0.3}),
    "pool": (Pool, {"nuclei": 10.0}),
    "pool without nuclei": (Pool, {"nuclei": 0.0}),
    "pool without nuclei of which a third sticks": (Pool, {"nuclei": 0.0, "sticking": 0.3}),
    "pool of which a third sticks": (Pool, {"nuclei": 10.0, "sticking": 0.3}),
}


def water(volatility, binding_energy=PHI):
    """Return water whose saturation pressure at kT = 1 is ``volatility`` times exp(-binding energy)."""
    return Substance(MASS, SMALL, binding_energy, C_L, volatility, rotation=3.0)


def moist(
    liquid,
    air,
    *,
    parcel=MoistParcelSet,
    side=1.0,
    vapour=0,
    seed=1,
    kT=1.0,
    air_diameter=SMALL,
    height=None,
    **options,
):
    """Return a box of air and vapour at random places, with its liquid."""
    rng = np.random.default_rng(seed)
    number = vapour + air
    mass = np.r_[np.full(vapour, MASS), np.full(air, AIR_MASS)]
    rotation = np.r_[np.full(vapour, 3.0), np.full(air, 2.0)]
    length = np.array([side, side, height or side])
    margin = 0.5 * air_diameter
    return parcel(
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
    """Return the number of molecules in the liquid and its energy, at equal intervals of time."""
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


def holds_the_balance(box, molecules, air, nuclei, substance, *, step, samples, diameter=SMALL):
    """Check the probability of each number in the liquid, and the mean and variance of its energy, against theory."""
    total = sum(box.energy()) + box.condensed_energy
    chance, energy, variance = microcanonical(total, molecules, air, nuclei, open_volume(box, diameter), substance)
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


def vapour_number(saturated, molecules):
    """Return the mean of a Poisson number of mean ``saturated`` that cannot exceed the number of molecules."""
    v = np.arange(molecules + 1)
    weight = np.exp(v * math.log(saturated) - special.gammaln(v + 1.0))
    return float(np.sum(v * weight) / weight.sum())


QUICK = [
    *((name, None, 2, 25_000) for name in ("mist", "mist without nuclei of which a third sticks")),
    *((name, 0.2, 2, 15_000) for name in ("mist", "pool")),
    *((name, 2.0, 2, 40_000) for name in ("mist of which a third sticks", "pool")),
]
"""Name, step of dsmc or None for the exact engine, molecules of air, number of samples."""
LONG = [
    *((name, None, air, 250_000) for name in CASES for air in (2, 0)),
    *((name, dt, 2, 40_000) for name in CASES for dt in (0.2, 2.0)),
]


@pytest.mark.parametrize(
    ("name", "dt", "air", "samples"),
    [*QUICK, *(pytest.param(*case, marks=pytest.mark.nightly) for case in LONG)],
)
def test_an_isolated_box_visits_all_states_alike(name, dt, air, samples):
    # 10 numbers a case: a false alarm once in 30 for all quick cases of fresh seeds
    kind, options = CASES[name]
    substance, vapour = water(2.0 * math.exp(PHI)), 0 if air else 2
    engine = {} if dt is None else {"parcel": MoistDsmcParcel, "dt": dt}
    seed = 3 if samples == 25_000 else 13
    box = moist(kind(substance, number=3 - vapour, kT=1.4, **options), air, vapour=vapour, seed=seed, **engine)
    step = (1.0 if kind is Mist else 4.0) * (1.0 if dt is None else 1.25)
    holds_the_balance(box, 3, air, options["nuclei"], substance, step=step, samples=samples)


# ------------------------------------------------------------------ between heat baths


@pytest.mark.parametrize(
    ("parcel", "kind", "number", "nuclei", "sticking"),
    [
        (MoistParcelSet, Mist, 120, 10.0, 1.0),
        (MoistParcelSet, Mist, 5, 0.0, 0.4),
        (MoistDsmcParcel, Mist, 120, 10.0, 1.0),
        (MoistDsmcParcel, Mist, 5, 0.0, 0.4),
        (MoistDsmcParcel, Pool, 120, 0.0, 0.4),
        *(
            pytest.param(parcel, *case, marks=pytest.mark.nightly)
            for parcel in (MoistParcelSet, MoistDsmcParcel)
            for case in ((Mist, 120, 0.0, 0.4), (Mist, 5, 10.0, 1.0), (Pool, 120, 10.0, 1.0))
        ),
    ],
)
def test_between_heat_baths_the_vapour_has_the_saturation_pressure(parcel, kind, number, nuclei, sticking):
    saturated = 20.0 if number > 100 else 2.0
    substance = water(saturated * math.exp(PHI))
    facts = {"number": number - round(saturated), "nuclei": nuclei, "sticking": sticking}
    liquid = Mist(substance, area=8.0, **facts) if kind is Mist else Pool(substance, **facts)
    walls = BATHS if kind is Mist else OVER_POOL
    box = moist(liquid, 2, parcel=parcel, vapour=round(saturated), seed=6, walls=walls)
    volume, floor = open_volume(box), (1.0 - SMALL) ** 2
    area = liquid.area if kind is Mist else floor
    exact = vapour_number(substance.saturation_pressure(1.0) * volume, number)
    box.advance(50.0)
    rows, samples = [], 250 if kind is Mist else 500
    for _ in range(BLOCKS):
        condensed, evaporated, impulse, time = box.condensed, box.evaporated, box.wall_impulse, box.time
        mean = 0.0
        for k in range(samples):
            box.advance(time + k + 1.0)
            mean += box.vapour / samples
        lasted = box.time - time
        felt = (box.wall_impulse - impulse)[[4, 5]] / (floor * lasted)
        rows.append([mean, (box.condensed - condensed) / lasted, (box.evaporated - evaporated) / lasted, *felt])
    mean, error = block_average(rows, BLOCKS)
    # each molecule of the vapour meets the liquid at the rate A w / 4 V, and each molecule presses on floor and ceiling
    rate = exact * sticking * area / volume / math.sqrt(2.0 * math.pi * MASS)
    if number > 100:
        e = substance.saturation_pressure(1.0)
        assert rate == pytest.approx(sticking * area * e / math.sqrt(2.0 * math.pi * MASS), rel=1e-6)
    expected = np.array([exact, rate, rate, *[(exact + 2.0) / volume] * 2])
    assert (error / expected < 0.015).all()
    assert (np.abs(mean - expected) <= 4.0 * error).all()
    assert box.ledger() < 1e-11


# ------------------------------------------------------------------ with excluded volume


def carnahan_starling(filled):
    return (1.0 + filled + filled**2 - filled**3) / (1.0 - filled) ** 3


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
    for k in range(4000):
        box.advance(101.0 + k)
        position, is_vapour = box.snapshot().position, box.mass < 0.5 * (MASS + AIR_MASS)
        here = ((position >= low) & (position <= high)).all(axis=1)
        rows.append([here.sum() / room, (here & is_vapour).sum() / room])
    mean, error = block_average(rows, BLOCKS)
    filled = math.pi / 6.0 * mean[0]
    return filled, mean[1] * carnahan_starling(filled) / saturation, error[1] / mean[1]


@pytest.mark.parametrize(
    ("walls", "area"), [(BATHS, 400.0), pytest.param((Periodic(),) * 6, 400.0, marks=pytest.mark.nightly)]
)
def test_in_dense_air_the_partial_pressure_is_that_of_saturation(walls, area):
    # without the factor Z, which is 1.8 there, the vapour would be as much too many; one run resolves 7 % of it
    nuclei = 1e5 if walls[0] == Periodic() else 500.0  # a periodic box is isolated
    filled, ratio, accuracy = dense_vapour(Mist, walls, {"nuclei": nuclei, "area": area}, 13)
    assert carnahan_starling(filled) > 1.7
    assert accuracy < 0.02
    assert abs(ratio - 1.0) <= 4.0 * accuracy


# ------------------------------------------------------------------ on dsmc, where they collide


OPEN, DIAMETER = 24.0, 0.35  # a mean free path is a quarter of the box: no block is shorter than vapour takes to spread


def many(kind, *, number=4000, seed=7, walls=BATHS, **facts):
    """Return air that collides, a quarter of it saturated vapour, over its liquid."""
    rng = np.random.default_rng(seed)
    vapour = number // 4
    substance = Substance(MASS, DIAMETER, PHI, C_L, vapour / OPEN**3 * math.exp(PHI))
    wide = {"area": 4.0 * OPEN**2} if kind is Mist else {}
    is_vapour = np.arange(number) < vapour
    mass, rotation = np.where(is_vapour, MASS, 1.0), np.where(is_vapour, 3.0, 2.0)
    return MoistDsmcParcel(
        0.5 * DIAMETER + OPEN * rng.random((number, 3)),
        rng.standard_normal((number, 3)) / np.sqrt(mass)[:, None],
        length=(OPEN + DIAMETER,) * 3,
        diameter=DIAMETER,
        mass=mass,
        rotation=rotation,
        rotational_energy=rng.standard_gamma(0.5 * rotation),
        liquid=kind(substance, number=2000, nuclei=100.0, **wide, **facts),
        walls=walls,
        seed=seed,
    ), vapour


@pytest.mark.parametrize("kind", [Mist, Pool])
def test_many_that_collide_have_one_temperature_and_the_saturation_pressure(kind):
    box, saturated = many(kind, walls=BATHS if kind is Mist else OVER_POOL)
    area = (4.0 if kind is Mist else 1.0) * OPEN**2
    box.advance(200.0)
    rows, time, last = [], box.time, (box.condensed, box.evaporated)
    for k in range(600):
        box.advance(200.0 + 2.0 * (k + 1))
        now, is_vapour = box.snapshot(), box.mass < 0.9
        flight = box.mass * np.sum(now.velocity**2, axis=1) / 3.0
        met = (box.condensed, box.evaporated)
        rates = [(a - b) / (box.time - time) for a, b in zip(met, last, strict=True)]
        low = now.position[:, 2] < 5.0
        rows.append([flight.mean(), flight[low].mean(), flight[is_vapour].mean(), box.liquid_kT, box.vapour, *rates])
        time, last = box.time, met
    mean, error = block_average(rows, BLOCKS)
    rate = area * saturated / OPEN**3 / math.sqrt(2.0 * math.pi * MASS)
    expected = np.array([1.0, 1.0, 1.0, 1.0, saturated, rate, rate])
    # seven numbers, and twice: a false alarm in 1 000 for a fresh seed
    assert (error / expected < 0.01).all()
    assert (np.abs(mean - expected) <= 4.0 * error).all()


def test_a_pool_in_an_isolated_box_stays_as_warm_as_its_air():
    # if molecules left the pool only at the end of a step, the air would be too hot by some parts in a thousand
    box, _ = many(Pool, walls=(*(Periodic(),) * 4, Specular(), Specular()))
    box.advance(300.0)
    rows = []
    for k in range(1500):
        box.advance(300.0 + 3.0 * k)
        kinetic, rotational, _ = box.energy()
        rows.append([2.0 * (kinetic + rotational) / (box.degrees_of_freedom * box.number), box.liquid_kT])
    rows = np.array(rows)
    mean, error = block_average(rows[:, 0] - rows[:, 1], BLOCKS)
    assert error < 0.002
    assert abs(mean) <= 4.0 * error


def test_a_mist_is_carried_along_by_air_that_expands():
    # a slow piston leaves the entropy of air and liquid, in which nothing can leave or come, as it is
    walls = (*(Periodic(),) * 4, Specular(), Piston(0.01))
    rng = np.random.default_rng(8)
    number, side, nuclei = 4000, 25.0, 2000.0
    box = MoistDsmcParcel(
        0.5 + (side - 1.0) * rng.random((number, 3)),
        rng.standard_normal((number, 3)),
        length=(side,) * 3,
        rotation=2.0,
        rotational_energy=rng.standard_gamma(1.0, number),
        liquid=Mist(Substance(MASS, 1.0, 300.0, C_L, 1.0), kT=1.0, nuclei=nuclei, area=30.0 * side**2),
        walls=walls,
        seed=8,
    )
    start = box.internal_energy() / (2.5 * number)
    box.advance(1500.0)
    ratio = (box.length[2] - 1.0) / (side - 1.0)
    capacity = 2.5 * number + nuclei
    expected = ratio ** (-number / capacity)
    before = (start * 2.5 * number + nuclei) / capacity
    now = (box.internal_energy() + box.liquid_energy) / capacity
    # pressure fluctuates by a hundredth, as long as some two collisions: over the way that is a ten thousandth
    assert ratio > 1.6
    assert now / before == pytest.approx(expected, rel=2e-3)
