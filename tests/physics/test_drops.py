"""Drops and vapour reach statistical equilibrium, in which all arrangements without overlaps are equally likely.

Means allow 4 standard errors from 40 blocks: a false alarm once in 4 000 for a fresh seed, never for these. The
molecules are so small that they hardly ever collide with each other; they exchange energy through drops.
"""

import math

import numpy as np
import pytest
from scipy import special

from atmosbox.engine import Drops, HeatBath, Specular, Substance
from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.liquid.drop_parcelset import DropParcelSet
from atmosbox.scene.statistics import block_average

pytestmark = pytest.mark.skipif(not COMPILED, reason="so many events take minutes without numba")

SMALL, MASS, AIR_MASS, PHI, C_L = 0.02, 0.62, 1.0, 3.0, 5.0
AIR, BLOCKS = 2, 40
MIDDLE = ((0.5, 0.5, 0.5),)
CORNERS = np.array([[0.1, 0.1, 0.1], [0.9, 0.9, 0.1], [0.1, 0.9, 0.9], [0.9, 0.1, 0.9]])


def water(saturated):
    """Return water of a saturation pressure at kT = 1."""
    return Substance(MASS, SMALL, PHI, C_L, saturated * math.exp(PHI), rotation=3.0)


def box(drops, seed, kT=1.0, **options):
    """Return a box of two molecules of air, with drops in it."""
    rng = np.random.default_rng(seed)
    return DropParcelSet(
        CORNERS[:AIR],
        rng.standard_normal((AIR, 3)) * math.sqrt(kT / AIR_MASS),
        length=(1.0, 1.0, 1.0),
        mass=AIR_MASS,
        diameter=SMALL,
        rotation=2.0,
        rotational_energy=kT * rng.standard_gamma(1.0, AIR),
        liquid=drops,
        seed=seed,
        **options,
    )


def log_room(drops, molecules, air=AIR):
    """Return the logarithm of the free volume of molecules of vapour and of air, for n = 0, 1, ... in the liquid.

    The centre of each can be anywhere in the box except in the excluded volume of the drops.
    """
    n = np.arange(molecules + 1)
    volume = np.full(molecules + 1, (1.0 - SMALL) ** 3)
    for _ in drops.position:
        reach = np.cbrt(drops.nucleus**3 + n * drops.molecule_radius**3) + 0.5 * SMALL
        volume -= 4.0 / 3.0 * math.pi * reach**3
    return (molecules - n + air) * np.log(volume)


def log_ways(drops, molecules):
    """Return the logarithm of the number of ways to distribute n molecules over drops: all are equally likely.

    The rate at which a molecule leaves is proportional to the surface that the drop then has, and so is the rate of
    return. So no way is preferred, whatever the sizes are.
    """
    n, others = np.arange(molecules + 1), len(drops.position) - 1
    return np.log(special.comb(n + others, others))


def normal(log_weight):
    weight = np.exp(log_weight - log_weight.max())
    return weight / weight.sum()


def canonical(molecules, drops, e_s, air=AIR):
    """Return the probability of n molecules in the liquid between heat baths of kT = 1."""
    v = molecules - np.arange(molecules + 1)
    log_weight = v * math.log(e_s) - special.gammaln(v + 1.0)
    return normal(log_weight + log_room(drops, molecules, air) + log_ways(drops, molecules))


def sampled(parcel, step, samples, read):
    """Return the readings at equal intervals of time."""
    parcel.advance(50.0)
    rows = []
    for k in range(samples):
        parcel.advance(50.0 + (k + 1) * step)
        rows.append(read(parcel))
    assert parcel.ledger() < 1e-10
    assert min(parcel.condensed, parcel.evaporated) > 1000
    return np.array(rows, float)


def agrees(values, exact, within):
    """Check that means agree with theory, and that their errors are small enough for the check."""
    mean, error = block_average(values, BLOCKS)
    assert (error < within).all()
    assert (np.abs(mean - exact) <= 4.0 * error).all(), (mean, exact, error)


# ------------------------------------------------------------------ an isolated box


# ------------------------------------------------------------------ between heat baths

BATHS = (HeatBath(1.0),) * 6


@pytest.mark.parametrize(
    ("mass", "ball"),
    [(0.5, 0.15), *(pytest.param(*case, marks=pytest.mark.nightly) for case in ((0.5, 0.0), (10.0, 0.15)))],
)
def test_a_light_drop_that_flies_about_is_in_the_same_balance(mass, ball):
    # it moves freely in the box, and has hardly more mass than a molecule
    molecules, nucleus = 4, 0.12
    facts = {"nucleus": nucleus, "nucleus_mass": mass, "molecule_radius": ball}
    drops = Drops(water(2.0), number=molecules, nuclei=10.0, position=MIDDLE, **facts)
    parcel = box(drops, 8, walls=BATHS)
    n = np.arange(molecules + 1)
    own = 3.0 * np.log(1.0 - 2.0 * np.cbrt(nucleus**3 + n * ball**3))
    chance = normal(np.log(canonical(molecules, drops, drops.substance.saturation_pressure(1.0))) + own)

    def read(parcel):
        drop = parcel._fields[parcel._drops.record[0]]
        flight = 0.5 * parcel._kinds.table["mass"][parcel._first_drop] * sum(drop["v" + axis] ** 2 for axis in "xyz")
        return (*(parcel.liquid == n), flight, parcel.liquid_kT)

    rows = sampled(parcel, 4.0, 20_000, read)
    agrees(rows, np.array([*chance, 1.5, 1.0]), 0.03)


def test_a_smooth_box_with_a_light_drop_has_one_temperature():
    # the energies of four molecules, the drop and its liquid are gamma variates of their degrees of freedom
    facts = {"nucleus": 0.15, "nucleus_mass": 1.0, "molecule_radius": 0.1, "nuclei": 10.0}
    substance = Substance(MASS, SMALL, 60.0, C_L, 1e-9, rotation=3.0)
    drops = Drops(substance, number=2, position=MIDDLE, **facts)
    parcel = box(drops, 5, walls=(Specular(),) * 6)
    total = sum(parcel.energy()) + parcel.condensed_energy
    parcel.advance(50.0)
    rows = []
    for k in range(12_000):
        parcel.advance(54.0 + 4.0 * k)
        kinetic, rotational, _ = parcel.energy()
        flight = parcel.condensed_energy - parcel.liquid_energy
        rows.append(np.array([kinetic, rotational, parcel.liquid_energy, flight]) / total)
    freedom = np.array([1.5 * AIR, AIR, 10.0 + 2.0 * C_L, 1.5])
    assert (parcel.liquid, parcel.evaporated) == (2, 0)
    agrees(np.array(rows), freedom / freedom.sum(), 0.003)
