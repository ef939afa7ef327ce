"""Shared by the tests of the engine: a box of gas in one line, dry or moist, and the equilibrium of water in it."""

import faulthandler
import math
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import special

from atmosbox.engine import (
    ParcelSet,
    Periodic,
    Specular,
    Substance,
    maxwell_velocities,
    random_positions,
    rotational_energies,
)
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from atmosbox.scene.statistics import block_average

SPECULAR = (Specular(),) * 6


def new_gas(number, length, *, walls=SPECULAR, seed, kT=1.0, spin_kT=None, planar=False, **options):
    """Return a gas at random places whose kinetic energy is exactly that of kT, for every seed."""
    rng = np.random.default_rng(seed)
    ones = np.ones(number)
    periodic = tuple(isinstance(wall, Periodic) for wall in walls[::2])
    diameter, mass = (ones * options.pop(name, 1.0) for name in ("diameter", "mass"))
    rotation = ones * options.pop("rotation", 0.0)
    x = random_positions(length, diameter, rng, periodic=periodic, planar=planar)
    v = maxwell_velocities(kT, mass, rng, planar=planar, exact=True)
    options.setdefault("rotational_energy", rotational_energies(kT if spin_kT is None else spin_kT, rotation, rng))
    return ParcelSet(
        options.pop("position", x),
        options.pop("velocity", v),
        length=length,
        walls=walls,
        diameter=diameter,
        mass=mass,
        rotation=rotation,
        planar=planar,
        seed=seed,
        **options,
    )


# ------------------------------------------------------------------ water

SMALL, MASS, AIR_MASS, PHI, C_L = 1e-3, 0.62, 1.0, 3.0, 5.0
BLOCKS = 40


def water(volatility, binding_energy=PHI):
    """Return water whose saturation pressure at kT = 1 is ``volatility`` times exp(-binding energy)."""
    return Substance(MASS, SMALL, binding_energy, C_L, volatility, rotation=3.0)


def moist_box(
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


# ------------------------------------------------------------------ for every test


@pytest.fixture(autouse=True)
def nothing_hangs(request):
    """End the whole run, with a traceback, if a test makes no progress: Ctrl-C cannot stop a kernel."""
    long = request.node.get_closest_marker("nightly") is not None
    faulthandler.dump_traceback_later(7200.0 if long else 900.0, exit=True, file=sys.__stderr__)
    yield
    faulthandler.cancel_dump_traceback_later()


@pytest.fixture(scope="session")
def gas():
    return new_gas


@pytest.fixture(scope="session")
def wet():
    """Return boxes of air and water, and their results by statistical mechanics."""
    return SimpleNamespace(
        small=SMALL,
        mass=MASS,
        air_mass=AIR_MASS,
        phi=PHI,
        c_l=C_L,
        water=water,
        box=moist_box,
        open_volume=open_volume,
        holds_the_balance=holds_the_balance,
        vapour_number=vapour_number,
    )
