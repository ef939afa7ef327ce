"""The laws of the liquid: how fast molecules leave, with which energies, and what is counted.

Each moment is held to 4 standard errors, computed from the distribution itself: a false alarm in 16 000 seeds per
check. Each Kolmogorov-Smirnov test gives a false alarm in 10 000.
"""

import math

import numpy as np
import pytest
from scipy import integrate, special, stats

from atmosbox.engine import Mist, Substance
from atmosbox.engine.liquid.reservoir import (
    LIQUID,
    RAINED,
    RAINED_ENERGY,
    THERMAL,
    evaporate,
    evaporation_rate,
    exchange,
    heat_capacity,
    new_reservoir,
    rain_out,
)
from tests.engine.boxes import held, random_state

NUMBER = 20_000
PHI, C_L, K, MASS, AREA = 3.0, 9.0, 1e-2, 0.62, 7.0
FACTS = {"mass": MASS, "diameter": 1.0, "binding_energy": PHI, "heat_capacity": C_L, "volatility": K, "rotation": 3.0}
WATER = Substance(**FACTS)
SHAPE = 3.5


def ledger_of(number, kT=1.0, nuclei=0.0, substance=WATER, **options):
    liquid = Mist(substance, number=number, kT=kT, nuclei=nuclei, area=AREA, **options)
    return new_reservoir(liquid, liquid.area, number, 0, 0)


def rate_at(ledger, energy):
    ledger.energy[THERMAL] = energy
    return evaporation_rate(ledger)


def microcanonical(energy, number, nuclei, phi=PHI, sticking=1.0):
    """Return the rate of evaporation, from a second, independent formula."""
    capacity = C_L * number + nuclei
    rest = capacity - C_L
    flux = sticking * AREA * K / math.sqrt(2.0 * math.pi * MASS)
    return flux * math.exp(
        (rest + SHAPE - 1.0) * math.log(energy - phi)
        - special.gammaln(rest + SHAPE)
        + special.gammaln(capacity)
        - (capacity - 1.0) * math.log(energy)
    )


# ------------------------------------------------------------------ how fast


@pytest.mark.parametrize("number", [1, 2, 5])
@pytest.mark.parametrize("nuclei", [0.0, 50.0])
def test_the_rate_of_leaving_is_the_microcanonical_one(number, nuclei):
    ledger = ledger_of(number, nuclei=nuclei)
    for energy in (PHI + 1e-9, 3.5, 9.0, 60.0, 1e4):
        assert rate_at(ledger, energy) == pytest.approx(microcanonical(energy, number, nuclei), rel=1e-11)


@pytest.mark.parametrize("number", [1, 2, 5])
@pytest.mark.parametrize("nuclei", [0.0, 50.0])
@pytest.mark.parametrize("kT", [0.4, 1.0])
def test_a_drop_of_any_size_in_a_heat_bath_emits_what_hertz_and_knudsen_say(number, nuclei, kT):
    # the energy of a drop in a bath is a gamma variate; its mean rate has no correction at all, even for one molecule
    ledger = ledger_of(number, nuclei=nuclei)
    capacity = C_L * number + nuclei
    spread = math.sqrt(capacity) * kT
    low = max(PHI, capacity * kT - 15.0 * spread)
    mean, _ = integrate.quad(
        lambda energy: rate_at(ledger, energy) * stats.gamma.pdf(energy, capacity, scale=kT),
        low,
        max(capacity * kT, PHI) + 25.0 * spread,
        limit=200,
    )
    flux = WATER.saturation_pressure(kT) / math.sqrt(2.0 * math.pi * MASS * kT)
    assert mean == pytest.approx(AREA * flux, rel=1e-6)


def test_the_substance_knows_the_vapour_pressure_that_the_rate_implies():
    for kT in (0.3, 1.0, 2.0):
        assert WATER.saturation_pressure(kT) == pytest.approx(K * kT ** (4.0 - C_L) * math.exp(-PHI / kT), rel=1e-12)
    assert WATER.vapour_heat_capacity == 4.0
    assert Substance(**FACTS | {"rotation": 0.0}).vapour_heat_capacity == 2.5
    # Clausius and Clapeyron: d ln e / d ln T = L / T with L = phi + (c_p - c_l) T
    kT, step = 0.9, 1e-5
    above, below = (WATER.saturation_pressure(kT * math.exp(s)) for s in (step, -step))
    assert math.log(above / below) / (2.0 * step) == pytest.approx((PHI + (4.0 - C_L) * kT) / kT, rel=1e-8)


# ------------------------------------------------------------------ with which energies


@pytest.mark.parametrize(("number", "nuclei"), [(1, 0.0), (1, 10.0), (2, 0.0), (5, 50.0)])
def test_a_molecule_that_leaves_takes_energy_by_its_degrees_of_freedom(number, nuclei):
    ledger = ledger_of(number, nuclei=nuclei)
    ledger.energy[THERMAL] = energy = PHI + 4.0
    state = random_state(18)
    flight, spin = np.array([evaporate(ledger, state) for _ in range(NUMBER)]).T
    assert ledger.energy[THERMAL] == energy
    assert ledger.count[LIQUID] == number
    assert ledger.spectrum.sum() == NUMBER
    rest = C_L * (number - 1) + nuclei
    taken = (flight + spin) / 4.0
    if rest == 0.0:
        assert taken == pytest.approx(np.ones(NUMBER), rel=1e-14)
    else:
        assert stats.kstest(taken, "beta", args=(SHAPE, rest)).pvalue > 1e-4
    # the two share it as Gamma(2) to Gamma(3/2), whatever energy stays in the liquid
    share = flight / (flight + spin)
    assert stats.kstest(share, "beta", args=(2.0, 1.5)).pvalue > 1e-4
    assert held((share - 2.0 / 3.5) * (taken - taken.mean()), 0.0, np.var(share) * np.var(taken) + 1e-30)


@pytest.mark.parametrize("rotation", [0.0, 2.0, 3.0])
@pytest.mark.parametrize(("number", "nuclei"), [(0, 50.0), (2, 0.0)])
def test_a_molecule_that_does_not_stick_shares_all_energy_with_the_liquid(rotation, number, nuclei):
    ledger = ledger_of(number, kT=0.5, nuclei=nuclei)
    state = random_state(19)
    capacity = C_L * number + nuclei
    together = 0.5 * capacity + 2.0
    flight, spin = np.array([exchange(ledger, 2.0, rotation, state) for _ in range(NUMBER)]).T
    shape = 2.0 + 0.5 * rotation
    assert stats.kstest((flight + spin) / together, "beta", args=(shape, capacity)).pvalue > 1e-4
    if rotation:
        assert stats.kstest(flight / (flight + spin), "beta", args=(2.0, 0.5 * rotation)).pvalue > 1e-4
    else:
        assert (spin == 0.0).all()
    assert ledger.energy[THERMAL] == 0.5 * capacity


# ------------------------------------------------------------------ counters


def test_rain_takes_its_share_of_the_heat_and_leaves_the_temperature_alone():
    ledger = ledger_of(4, kT=0.7, nuclei=5.0)
    start = float(ledger.energy[THERMAL])
    for _ in range(4):
        rain_out(ledger)
        assert ledger.energy[THERMAL] == pytest.approx(0.7 * heat_capacity(ledger), rel=1e-14)
    assert ledger.energy.sum() == pytest.approx(start, rel=1e-15)
    assert ledger.energy[RAINED_ENERGY] == pytest.approx(0.7 * 4 * C_L, rel=1e-14)
    assert (ledger.count[LIQUID], ledger.count[RAINED]) == (0, 4)
