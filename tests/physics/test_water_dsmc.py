"""With time steps too, vapour and liquid reach the equilibrium of statistical mechanics, for any number of molecules.

Means allow 4 standard errors from 40 blocks: a false alarm once in 4 000 for a fresh seed, never for these. A step of
free flight, the liquid's turn and the collisions each leave that balance as it is, so no length of step changes it.
"""

import math

import numpy as np
import pytest

from atmosbox.engine import HeatBath, Mist, Periodic, Piston, Pool, Specular, Substance
from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.dsmc.moist_dsmc_parcel import MoistDsmcParcel
from atmosbox.scene.statistics import block_average

pytestmark = pytest.mark.skipif(not COMPILED, reason="so many steps take minutes without numba")

MASS, PHI, C_L = 0.62, 3.0, 5.0
BLOCKS = 40
BATHS = (HeatBath(1.0),) * 6
OVER_POOL = (*BATHS[:4], Specular(), HeatBath(1.0))

CASES = {
    "mist": (Mist, {"nuclei": 10.0, "area": 8.0}),
    "mist without nuclei": (Mist, {"nuclei": 0.0, "area": 8.0}),
    "mist of which a third sticks": (Mist, {"nuclei": 10.0, "area": 8.0, "sticking": 0.3}),
    "pool": (Pool, {"nuclei": 10.0}),
    "pool without nuclei": (Pool, {"nuclei": 0.0}),
    "pool of which a third sticks": (Pool, {"nuclei": 10.0, "sticking": 0.3}),
}


FULL = 40_000
QUICK = {("mist", 0.2): 15_000, ("pool", 0.2): 15_000, ("mist of which a third sticks", 2.0): FULL, ("pool", 2.0): FULL}
"""What is tried each time: how many samples, by case and step. All cases and steps are left to the validate tier."""


@pytest.mark.parametrize(
    ("name", "dt", "samples"),
    [
        *((*case, samples) for case, samples in QUICK.items()),
        *(
            pytest.param(name, dt, FULL, marks=pytest.mark.validate)
            for name in CASES
            for dt in (0.2, 2.0)
            if QUICK.get((name, dt)) != FULL
        ),
    ],
)
def test_an_isolated_box_visits_all_states_alike(wet, name, dt, samples):
    # 10 numbers a case: a false alarm once in 30 for twelve fresh seeds; more often over a pool, for slow
    # molecules that leave it stay away for long
    kind, options = CASES[name]
    substance = wet.water(2.0 * math.exp(PHI))
    liquid = kind(substance, number=3, kT=1.4, **options)
    box = wet.box(liquid, 2, parcel=MoistDsmcParcel, seed=13, dt=dt)
    step = 1.25 if kind is Mist else 5.0
    wet.holds_the_balance(box, 3, 2, options["nuclei"], substance, step=step, samples=samples)


@pytest.mark.parametrize(
    ("kind", "samples"),
    [(Mist, 10_000), *(pytest.param(kind, 25_000, marks=pytest.mark.validate) for kind in (Mist, Pool))],
)
def test_unlike_molecules_that_collide_visit_all_states_alike(wet, kind, samples):
    # in half the unit of time each of them collides
    diameter, options = 0.4, {"nuclei": 10.0} | ({"area": 8.0} if kind is Mist else {})
    substance = Substance(MASS, diameter, PHI, C_L, 2.0 / 0.6**3 * math.exp(PHI))
    rng = np.random.default_rng(4)
    box = MoistDsmcParcel(
        diameter / 2.0 + (1.0 - diameter) * rng.random((2, 3)),
        rng.standard_normal((2, 3)),
        length=(1.0, 1.0, 1.0),
        diameter=diameter,
        rotation=2.0,
        liquid=kind(substance, number=3, kT=1.4, **options),
        seed=4,
    )
    wet.holds_the_balance(box, 3, 2, 10.0, substance, step=2.0, samples=samples, diameter=diameter)
    assert box.contacts > 0.8 * samples


@pytest.mark.parametrize(
    ("kind", "number", "nuclei", "sticking"),
    [
        (Mist, 120, 10.0, 1.0),
        (Mist, 5, 0.0, 0.4),
        (Pool, 120, 0.0, 0.4),
        *(
            pytest.param(*case, marks=pytest.mark.validate)
            for case in ((Mist, 120, 0.0, 0.4), (Mist, 5, 10.0, 1.0), (Pool, 120, 10.0, 1.0))
        ),
    ],
)
def test_between_heat_baths_the_vapour_has_the_saturation_pressure(wet, kind, number, nuclei, sticking):
    saturated = 20.0 if number > 100 else 2.0
    substance = wet.water(saturated * math.exp(PHI))
    facts = {"number": number - round(saturated), "nuclei": nuclei, "sticking": sticking}
    liquid = Mist(substance, area=8.0, **facts) if kind is Mist else Pool(substance, **facts)
    walls = BATHS if kind is Mist else OVER_POOL
    box = wet.box(liquid, 2, parcel=MoistDsmcParcel, vapour=round(saturated), seed=6, walls=walls)
    volume = wet.open_volume(box)
    area = liquid.area if kind is Mist else (1.0 - 1e-3) ** 2
    exact = wet.vapour_number(substance.saturation_pressure(1.0) * volume, number)
    box.advance(50.0)
    rows, samples = [], 500 if kind is Mist else 1000
    for _ in range(BLOCKS):
        condensed, evaporated, impulse, time = box.condensed, box.evaporated, box.wall_impulse, box.time
        mean = 0.0
        for k in range(samples):
            box.advance(time + k + 1.0)
            mean += box.vapour / samples
        lasted = box.time - time
        felt = (box.wall_impulse - impulse)[[4, 5]] / ((1.0 - 1e-3) ** 2 * lasted)
        rows.append([mean, (box.condensed - condensed) / lasted, (box.evaporated - evaporated) / lasted, *felt])
    mean, error = block_average(rows, BLOCKS)
    # each molecule of the vapour meets the liquid at the rate A w / 4 V
    rate = exact * sticking * area / volume / math.sqrt(2.0 * math.pi * MASS)
    if number > 100:
        e = substance.saturation_pressure(1.0)
        assert rate == pytest.approx(sticking * area * e / math.sqrt(2.0 * math.pi * MASS), rel=1e-6)
    expected = np.array([exact, rate, rate, *[(exact + 2.0) / volume] * 2])
    assert (error / expected < 0.015).all()
    assert (np.abs(mean - expected) <= 4.0 * error).all()
    assert box.ledger() < 1e-11


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
    for k in range(1200):
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
