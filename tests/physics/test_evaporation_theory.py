"""The final state of evaporation, the rate at which molecules leave a small liquid, and the scatter of their number."""

from itertools import pairwise

import numpy as np
import pytest
from scipy import integrate, special

from atmosbox import theory
from atmosbox.theory.constants import BOLTZMANN, WATER

C_L, PHI = theory.LIQUID_HEAT_CAPACITY, theory.BINDING_TEMPERATURE
ZERO_CELSIUS = 273.15


def enthalpy(temperature, air, vapor, liquid):
    """Return the enthalpy over k of air, vapour and liquid of one temperature."""
    return (3.5 * air + 4.0 * vapor + C_L * liquid) * temperature - PHI * liquid


def test_evaporation_keeps_enthalpy_and_water_and_ends_at_saturation():
    for pressure in [3e4, 1e5]:
        for humidity in [0.0, 0.5, 1.0, 1.3]:
            for pool in [0.0, 10.0, 1000.0, 1e5]:
                for pool_temperature in [275.0, 290.0, 330.0]:
                    e = humidity * float(theory.saturation_vapor_pressure(290.0))
                    air, vapor = 1e5, 1e5 * e / (pressure - e)
                    end = theory.evaporation_equilibrium(pressure, 290.0, air, vapor, pool, pool_temperature)
                    before = enthalpy(290.0, air, vapor, 0.0) + enthalpy(pool_temperature, 0.0, 0.0, pool)
                    after = enthalpy(end.temperature, air, end.vapor, end.liquid)
                    assert after == pytest.approx(before, abs=1e-12 * (abs(before) + PHI * pool + 1e7))
                    assert end.vapor + end.liquid == pytest.approx(vapor + pool, rel=1e-14)
                    assert end.vapor_pressure == pytest.approx(pressure * end.vapor / (air + end.vapor), rel=1e-13)
                    saturated = float(theory.saturation_vapor_pressure(end.temperature))
                    if end.liquid > 0.0:
                        assert end.vapor_pressure == pytest.approx(saturated, rel=1e-10)
                    else:
                        assert end.vapor_pressure <= saturated * (1.0 + 1e-12)
                        assert end.liquid == 0.0


AIRS = [(993, 32, 15), (1000, 20, 10), (1000, 30, 25), (1000, 20, 0), (700, 0, -20)]


def test_the_wet_bulb_is_that_of_adiabatic_saturation():
    for p, t, td in AIRS:
        pressure, warm, dew = 100.0 * p, t + ZERO_CELSIUS, td + ZERO_CELSIUS
        wet = float(theory.wet_bulb_temperature(pressure, warm, dew))
        before, after = (float(theory.saturation_vapor_pressure(x)) for x in (dew, wet))
        before, after = before / (pressure - before), after / (pressure - after)
        supplied = enthalpy(wet, 0.0, 0.0, after - before)
        assert enthalpy(warm, 1.0, before, 0.0) + supplied == pytest.approx(enthalpy(wet, 1.0, after, 0.0), rel=1e-13)
        assert dew < wet < warm


def test_the_wet_bulb_is_a_little_above_metpys_which_is_normands():
    for air, apart in list(zip(AIRS, [0.252, 0.105, 0.071, 0.217, 0.055], strict=True)):
        from metpy.calc import wet_bulb_temperature
        from metpy.units import units

        p, t, td = air
        theirs = wet_bulb_temperature(p * units.hPa, t * units.degC, td * units.degC).m_as("K")
        ours = float(theory.wet_bulb_temperature(100.0 * p, t + ZERO_CELSIUS, td + ZERO_CELSIUS))
        assert ours - theirs == pytest.approx(apart, abs=0.002)


def mean_over_canonical_energies(function, heat, start):
    """Return the mean of a function of U / kT over the energies of a liquid in a heat bath; zero below the start."""

    def integrand(x):
        return np.exp((heat - 1.0) * np.log(x) - x - special.gammaln(heat)) * function(x)

    middle = max(heat, start + 4.0)
    edges = [start, start + 4.0, middle, middle + 4.0, middle + 12.0 * np.sqrt(heat) + 80.0]
    return sum(integrate.quad(integrand, a, b, epsabs=0.0, epsrel=1e-11, limit=400)[0] for a, b in pairwise(edges))


@pytest.mark.parametrize(("molecules", "nuclei"), [(1, 0.0), (1, 60.0), (10, 50.0), (50, 0.0), (200, 0.0)])
def test_a_small_liquid_in_a_heat_bath_evaporates_as_hertz_and_knudsen_say(molecules, nuclei):
    t = 293.15

    def flux(x):
        return float(theory.microcanonical_flux(x * BOLTZMANN * t, molecules, nuclei, 0.7))

    mean = mean_over_canonical_energies(flux, C_L * molecules + nuclei, PHI / t)
    assert mean == pytest.approx(float(theory.hertz_knudsen_flux(t, 0.7)), rel=1e-9)


def test_a_large_liquid_follows_hertz_and_knudsen_and_a_cold_small_one_keeps_its_molecules():
    t, n = 280.0, 10**7
    energy = n * C_L * BOLTZMANN * t
    ratio = theory.microcanonical_flux(energy, n) / theory.hertz_knudsen_flux(t)
    assert ratio == pytest.approx(1.0, abs=1e-5)
    assert theory.microcanonical_flux(0.99 * PHI * BOLTZMANN, 2) == 0.0
    assert theory.microcanonical_flux(1e3 * PHI * BOLTZMANN, 0, 100.0) == 0.0
    assert theory.microcanonical_flux(1.01 * PHI * BOLTZMANN, 1) > 0.0


def test_at_fixed_temperature_the_number_of_vapour_molecules_is_a_poisson_cut_off():
    volume, t = (100e-9) ** 3, 273.15
    expected = float(theory.saturation_vapor_pressure(t)) * volume / (BOLTZMANN * t)
    for water in (0, 1, 5, 170, 5000):
        number = theory.isothermal_vapor_number(water, t, volume)
        known = np.flatnonzero(number.probability[:-1] > 1e-250)
        ratio = number.probability[known + 1] / number.probability[known]
        assert np.allclose(ratio * (known + 1), expected, rtol=1e-9)
        assert np.sum(number.probability) == pytest.approx(1.0, rel=1e-13)
        share = special.pdtr(water - 1, expected) / special.pdtr(water, expected) if water else 0.0
        assert number.mean == pytest.approx(expected * share, rel=1e-9)
    assert number.variance == pytest.approx(expected, rel=1e-11)  # with liquid to spare


WATERS, AIR, VOLUME = 40, 30, 2e-23
ENERGY = BOLTZMANN * (285.0 * (2.5 * AIR + 3.0 * 6 + C_L * 34 + 20.0) + 6 * PHI)


def test_in_a_box_without_heat_every_number_of_molecules_is_left_as_often_as_it_is_reached():
    # Detailed balance of the exact law of evaporation with molecules that come back, energies microcanonical.
    probability = theory.isolated_vapor_number(WATERS, AIR, ENERGY, VOLUME, 20.0).probability
    checked = 0
    for k in range(1, WATERS):
        before, after = ENERGY / BOLTZMANN - PHI * (k - 1), ENERGY / BOLTZMANN - PHI * k
        if after <= 0.0 or min(probability[k], probability[k - 1]) < 1e-12:
            continue
        n = WATERS - (k - 1)
        liquid, gas = C_L * n + 20.0, 2.5 * AIR + 3.0 * (k - 1)
        lost, log_beta = PHI / before, special.betaln(liquid, gas)

        def leaving(x, liquid=liquid, gas=gas, log_beta=log_beta, before=before, n=n):
            share = np.exp((liquid - 1.0) * np.log(x) + (gas - 1.0) * np.log1p(-x) - log_beta)
            return share * float(theory.microcanonical_flux(x * before * BOLTZMANN, n, 20.0))

        off = integrate.quad(leaving, lost, 1.0, epsabs=0.0, epsrel=1e-10, limit=400)[0]
        liquid, gas = liquid - C_L, gas + 3.0
        # A molecule of vapour meets the wall at <v>/4V: the mean of sqrt(E_gas) over its share of the energy.
        root = np.exp(
            special.betaln(liquid, gas + 0.5)
            - special.betaln(liquid, gas)
            + special.gammaln(gas)
            - special.gammaln(gas + 0.5)
        )
        back = k / VOLUME * np.sqrt(after * BOLTZMANN / (2.0 * np.pi * WATER.molecule_mass)) * root
        assert probability[k - 1] * off == pytest.approx(probability[k] * back, rel=1e-8)
        checked += 1
    assert checked > 8


def test_a_box_with_a_great_reserve_of_heat_is_one_of_fixed_temperature():
    reserve, t = 1e9, 285.0
    energy = BOLTZMANN * (t * (2.5 * AIR + 3.0 * 6 + C_L * 34 + reserve) + 6 * PHI)
    isolated = theory.isolated_vapor_number(WATERS, AIR, energy, VOLUME, reserve)
    isothermal = theory.isothermal_vapor_number(WATERS, t, VOLUME)
    assert np.allclose(isolated.probability, isothermal.probability, rtol=1e-3, atol=1e-12)


def test_what_cannot_be_is_refused_with_a_sentence():
    cases = [
        (lambda: theory.evaporation_equilibrium(1e5, 290.0, 0.0, 1.0, 1.0), "air"),
        (lambda: theory.evaporation_equilibrium(1e5, 290.0, 1.0, 1.0, 1.0, 700.0), "liquid_temperature"),
        (lambda: theory.wet_bulb_temperature(1e5, 290.0, 291.0), "supersaturated"),
        (lambda: theory.wet_bulb_temperature(1e3, 295.0, 293.0), "boils"),
        (lambda: theory.microcanonical_flux(-1.0, 5), "thermal_energy"),
        (lambda: theory.isothermal_vapor_number(10, 290.0, 0.0), "volume"),
        (lambda: theory.isolated_vapor_number(0, 0, 1.0, 1.0), "nothing"),
        (lambda: theory.evaporation_equilibrium(1e8, 640.0, 1.0, 1e3, 1.0), "critical"),
    ]
    for call, match in cases:
        with pytest.raises(ValueError, match=match):
            call()
