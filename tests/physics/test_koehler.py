"""The vapour over drops with curvature: the laws of Kelvin and of Koehler, by counting states, and in the box.

A drop in a closed box is stable if its growth lowers the vapour pressure faster than the equilibrium value falls: with
v molecules of vapour over n of a pure drop, while v < 3 n / ln S. The boxes below fulfil this, except those of drops
that shall grow or vanish. Means allow 4 standard errors from 40 blocks: a false alarm once in 4 000 for a fresh seed,
never for these.
"""

import math

import numpy as np
import pytest
from scipy import special

from atmosbox import theory as law
from atmosbox.engine import Drops, HeatBath, Specular, Substance
from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.liquid.drop_parcelset import DropParcelSet
from atmosbox.scene.statistics import block_average
from atmosbox.theory.constants import BOLTZMANN
from tests.oracle import drop_in_box as oracle
from tests.oracle.drop_in_box import chances, vapour_over_drop

many_events = pytest.mark.skipif(not COMPILED, reason="so many events take minutes without numba")
SMALL, MASS, PHI, C_L, PINNED = 0.02, 0.62, 8.0, 5.0, 1e12
BALL, REACH = 0.027, 0.08
"""Radius of the ball of a molecule, and the radius below which curvature raises the vapour pressure e-fold."""
TENSION = REACH / (8.0 / 3.0 * math.pi * BALL**3)
BATHS = (HeatBath(1.0),) * 6
MIDDLE, PAIR = ((0.5, 0.5, 0.5),), ((0.25, 0.5, 0.5), (0.75, 0.5, 0.5))


def drops(number, position=MIDDLE, *, saturated=20.0, salt=(), tension=TENSION, ball=BALL, diameter=SMALL, **changes):
    """Return drops around nuclei of one molecule, of water of a saturation pressure at kT = 1."""
    water = Substance(MASS, diameter, PHI, C_L, saturated * math.exp(PHI), rotation=3.0)
    facts = {"nuclei": 20.0, "nucleus": ball, "nucleus_mass": PINNED, "molecule_radius": ball} | changes
    return Drops(water, number=number, position=position, surface_tension=tension, dissolved=salt, **facts)


def box(liquid, vapour, *, walls=BATHS, seed=3, air=2):
    """Return a box with vapour in it, and two molecules of air."""
    rng = np.random.default_rng(seed)
    lattice = np.stack(np.meshgrid(*[np.arange(0.02, 0.99, 0.05)] * 3), axis=-1).reshape(-1, 3)
    wide = max(liquid.nuclei_radii) + liquid.molecule_radius * np.cbrt(liquid.number) + SMALL
    away = np.linalg.norm(lattice[:, None] - np.array(liquid.position)[None], axis=2)
    position = rng.permutation(lattice[(away > wide).all(axis=1)])[: vapour + air]
    mass = np.r_[np.full(vapour, MASS), np.ones(air)]
    rotation = np.r_[np.full(vapour, 3.0), np.full(air, 2.0)]
    facts = {"mass": mass, "diameter": liquid.substance.diameter, "rotation": rotation}
    facts |= {"length": (1.0, 1.0, 1.0), "walls": walls}
    spin = rng.standard_gamma(0.5 * rotation)
    velocity = rng.standard_normal((len(mass), 3)) / np.sqrt(mass)[:, None]
    return DropParcelSet(position, velocity, rotational_energy=spin, liquid=liquid, seed=seed, **facts)


def sampled(parcel, samples, read, step=4.0):
    """Return the readings at equal intervals of time."""
    parcel.advance(50.0)
    rows = []
    for k in range(samples):
        parcel.advance(50.0 + (k + 1) * step)
        rows.append(read(parcel))
    assert parcel.ledger() < 1e-11
    assert min(parcel.condensed, parcel.evaporated) > 1000
    return np.array(rows, float)


def over_drop(number, vapour, salt, samples):
    """Return the saturation ratio over a drop, its error, and the number of molecules in the drop."""
    parcel = box(drops(number, salt=(float(salt),)), vapour)
    mean, error = block_average(sampled(parcel, samples, lambda box: (box.vapour, box.liquid)), 40)
    room = float(oracle.room(mean[1], BALL, BALL, 1.0, SMALL)) * 20.0
    chance = chances(number + vapour, 20.0, TENSION, salt, BALL, BALL, air=2, diameter=SMALL)
    exact = float(chance @ (number + vapour - np.arange(number + vapour + 1.0)))
    assert abs(mean[0] - exact) <= 4.0 * error[0], (mean, error, exact)
    return float(mean[0]) / room, float(error[0]) / room, float(mean[1])


def kelvin(number, salt=0.0):
    """Return the laws of Kelvin and of Koehler, from `atmosbox.theory`."""
    ball = 4.0 / 3.0 * math.pi * BALL**3
    return float(law.humidity_over_drop(number, TENSION, ball, 1.0, particles=salt, core=ball))


# ------------------------------------------------------------------ the vapour over one drop

RADII = [(60, 44), (110, 38), (200, 33)]


@many_events
@pytest.mark.parametrize(
    ("number", "vapour", "samples", "within"),
    [
        (*RADII[0], 6000, 0.02),
        (*RADII[2], 6000, 0.02),
        *(pytest.param(*each, 100_000, 0.005, marks=pytest.mark.nightly) for each in RADII),
    ],
)
def test_the_vapour_over_a_drop_follows_kelvin(number, vapour, samples, within):
    measured, error, held = over_drop(number, vapour, 0.0, samples)
    assert vapour < 3.0 * number / math.log(kelvin(number))
    assert error < within * measured
    assert abs(measured - kelvin(held)) <= 4.0 * error
    assert measured - 1.0 > 12.0 * error


@many_events
@pytest.mark.parametrize(("number", "vapour"), [(40, 30), (150, 30)])
def test_the_vapour_over_a_drop_with_salt_follows_koehler(number, vapour):
    measured, error, held = over_drop(number, vapour, 20, 6000)
    assert abs(measured - kelvin(held, 20.0)) <= 4.0 * error
    assert kelvin(held) - measured > 6.0 * error


# ------------------------------------------------------------------ which drops grow

FINE = 0.0075
"""Radius of the ball of a molecule of drops that are small in their box."""
TINY = 0.004
"""Their diameter in the vapour: 2500 of them must have nearly no excluded volume."""
STEEP = 0.041 / (8.0 / 3.0 * math.pi * FINE**3)


def grain(salt):
    """Return the radius of a nucleus of a number of particles, each as large as a molecule."""
    return FINE * max(salt, 1.0) ** (1.0 / 3.0)


def grown(number, humidity, salt=0.0, until=40.0, seed=3, vapour=2500):
    """Return the number of molecules of a drop after a time in air of a given humidity, from that at the start."""
    saturated = vapour / humidity
    facts = {"tension": STEEP, "ball": FINE, "diameter": TINY, "nuclei": 1e7, "nucleus": grain(salt)}
    liquid = drops(number, saturated=saturated, salt=(salt,), **facts)
    parcel = box(liquid, vapour, seed=seed)
    parcel.advance(until)
    assert parcel.ledger() < 1e-12
    return parcel.liquid


@many_events
@pytest.mark.nightly  # its drops are larger than cells, which needs other kernels
@pytest.mark.parametrize("seed", [3, 4])
def test_a_pure_drop_a_tenth_below_the_critical_radius_vanishes_and_one_a_tenth_above_grows(seed):
    n, over = np.arange(1.0, 2000.0), vapour_over_drop(np.arange(1.0, 2000.0), STEEP, 0.0, FINE, FINE)
    critical = n[over > 2.5][-1]
    radius = law.kelvin_radius(STEEP, 4.0 / 3.0 * math.pi * FINE**3, 1.0) / math.log(2.5)
    assert oracle.radii(critical, FINE, FINE) == pytest.approx(radius, rel=0.01)
    below, above = round(0.9**3 * critical), round(1.1**3 * critical)
    assert grown(below, 2.5, seed=seed) < 0.5 * below
    assert grown(above, 2.5, seed=seed) > 1.5 * above


@many_events
@pytest.mark.nightly
def test_a_drop_with_salt_stays_small_below_the_critical_supersaturation_and_grows_above_it():
    salt, n = 50.0, np.arange(1.0, 2000.0)
    number, highest = oracle.critical(STEEP, salt, grain(salt), FINE)
    over = vapour_over_drop(n, STEEP, salt, grain(salt), FINE)
    below, above = (1.0 + share * (highest - 1.0) for share in (0.9, 1.1))
    haze = int(n[: int(number)][over[: int(number)] < below][-1])
    assert haze < 0.6 * number
    assert grown(haze, below, salt, 40.0, vapour=5000) < 0.9 * number
    assert grown(haze, above, salt, 100.0, vapour=5000) > 1.5 * number


# ------------------------------------------------------------------ counting states


def normal(logs):
    weight = np.exp(logs - np.max(logs))
    return weight / weight.sum()


def agrees(values, exact, within):
    """Check that means agree with theory, and that their errors are small enough for the check."""
    mean, error = block_average(values, 40)
    assert (error < within).all(), error
    assert (np.abs(mean - exact) <= 4.0 * error).all(), (mean, exact, error)


@many_events
def test_an_isolated_box_visits_all_states_alike():
    # the surface holds a third of what binds a molecule, the salt triples the ways of each
    molecules, core, ball, tension, salt = 4, 0.1, 0.1, 30.0, 2.5
    facts = {"saturated": 0.2, "salt": (salt,), "tension": tension, "ball": ball, "nucleus": core, "kT": 1.6}
    liquid = drops(molecules, **facts)
    parcel = box(liquid, 0, walls=(Specular(),) * 6)
    total = sum(parcel.energy()) + parcel.condensed_energy
    n = np.arange(molecules + 1.0)
    v = molecules - n
    left = total - PHI * v - 4.0 * math.pi * tension * oracle.radii(n, core, ball) ** 2
    shape = C_L * n + 20.0 + 3.0 * v + 2.5 * 2
    logs = v * math.log(liquid.substance.volatility) - special.gammaln(v + 1.0)
    logs += (
        (shape - 1.0) * np.log(left)
        - special.gammaln(shape)
        + (v + 2.0) * np.log(oracle.room(n, core, ball, 1.0, SMALL))
    )
    logs += special.gammaln(n + salt + 1.0) - special.gammaln(n + 1.0)
    chance = normal(logs)
    assert chance.max() < 0.8
    rows = sampled(parcel, 12_000, lambda box: (box.liquid, box.liquid_energy))
    here = rows[:, :1] == n
    agrees(here, chance, 0.012)
    agrees(here * (rows[:, 1:] - left * (C_L * n + 20.0) / shape), 0.0, 0.08)


@many_events
def test_two_unlike_drops_share_their_molecules_as_their_surfaces_and_salts_have_it():
    molecules, core, ball, tension, salts = 4, 0.1, 0.1, 30.0, (0.0, 3.0)
    liquid = drops(molecules, PAIR, saturated=0.4, salt=salts, tension=tension, ball=ball, nucleus=core)
    parcel = box(liquid, 0)
    held = sampled(parcel, 12_000, lambda box: box.drops()[2])
    ways = [(a, b) for a in range(molecules + 1) for b in range(molecules + 1 - a)]
    logs = []
    for way in ways:
        v = molecules - sum(way)
        radius = oracle.radii(np.array(way), core, ball)
        room = (1.0 - SMALL) ** 3 - 4.0 / 3.0 * math.pi * np.sum((radius + 0.5 * SMALL) ** 3)
        log = v * math.log(0.4) - special.gammaln(v + 1.0) + (v + 2) * math.log(room)
        log -= 4.0 * math.pi * tension * np.sum(radius**2)
        logs.append(log + sum(math.log(special.binom(n + s, n)) for n, s in zip(way, salts, strict=True)))
    agrees(np.array([(held == way).all(axis=1) for way in ways]).T, normal(np.array(logs)), 0.015)


@many_events
def test_a_light_drop_that_flies_about_is_in_the_same_balance():
    # it moves freely in the box, and has hardly more mass than a molecule
    molecules, core, ball = 4, 0.12, 0.15
    facts = {"saturated": 2.0, "tension": 0.0, "ball": ball, "nucleus": core, "nucleus_mass": 0.5, "nuclei": 10.0}
    parcel = box(drops(molecules, **facts), 0, seed=8)
    n = np.arange(molecules + 1.0)
    own = 3.0 * np.log(1.0 - 2.0 * oracle.radii(n, core, ball))
    chance = normal(np.log(chances(molecules, 2.0, 0.0, 0.0, core, ball, air=2, diameter=SMALL)) + own)

    def read(box):
        drop = box._fields[box._drops.record[0]]
        flight = 0.5 * box._kinds.table["mass"][box._first_drop] * sum(drop["v" + axis] ** 2 for axis in "xyz")
        return (*(box.liquid == n), flight, box.liquid_kT)

    agrees(sampled(parcel, 20_000, read), np.array([*chance, 1.5, 1.0]), 0.03)


# ------------------------------------------------------------------ readings and refusals of a box with such drops


def test_the_oracle_and_the_theory_are_one_law():
    n, water = (
        np.array([50.0, 500.0, 50_000.0]),
        {"tension": 0.0727, "volume": law.WATER_VOLUME, "kT": BOLTZMANN * 293.15},
    )
    ball = float(law.drop_radius(1, law.WATER_VOLUME))
    for salt in (0.0, 40.0):
        exact = vapour_over_drop(n, water["tension"] / water["kT"], salt, ball, ball)
        close = law.humidity_over_drop(n - 0.5, **water, particles=salt, core=law.WATER_VOLUME)
        activity = n / (n + salt) / ((n - 0.5) / (n - 0.5 + salt))
        np.testing.assert_allclose(exact, close * activity, rtol=1e-4)
    drop = law.critical_drop(**water, particles=40.0, core=40.0 * law.WATER_VOLUME)
    number, highest = oracle.critical(water["tension"] / water["kT"], 40.0, 40.0 ** (1.0 / 3.0) * ball, ball)
    assert abs(drop.number - number) < 2.0
    assert drop.humidity == pytest.approx(highest, rel=2e-3)
    # thin solutions: r_c^2 = 3 B / A and ln S_c = 2 A / 3 r_c
    thin = law.critical_drop(**water, particles=1e9)
    reach, salty = law.kelvin_radius(**water), 1e9 * 3.0 * law.WATER_VOLUME / (4.0 * math.pi)
    assert thin.radius == pytest.approx(math.sqrt(3.0 * salty / reach), rel=1e-3)
    assert math.log(thin.humidity) == pytest.approx(2.0 * reach / (3.0 * thin.radius), rel=1e-3)
