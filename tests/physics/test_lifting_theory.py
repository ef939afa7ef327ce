"""Adiabats, pistons and the environment of a parcel: textbook values, and relations between them."""

import math

import numpy as np
import pytest
from scipy import integrate

from atmosbox import theory


def test_the_dry_adiabat_is_metpys():
    from metpy.calc import dry_lapse
    from metpy.units import units

    pressure = np.array([1000.0, 850.0, 500.0, 300.0, 100.0])
    expected = dry_lapse(pressure * units.hPa, 293.15 * units.kelvin).to("kelvin").magnitude
    assert np.allclose(theory.dry_adiabat_temperature(pressure, 293.15, 1000.0), expected, rtol=1e-12)


def test_a_parcel_lifted_through_air_of_its_own_temperature_follows_the_dry_lapse_rate():
    rate = theory.dry_lapse_rate()
    pressure = theory.environment_pressure(3000.0, 290.0, 1e5, rate)
    parcel = theory.dry_adiabat_temperature(pressure, 290.0, 1e5)
    assert parcel == pytest.approx(theory.environment_temperature(3000.0, 290.0, rate), rel=1e-13)


@pytest.mark.parametrize(
    ("height", "hectopascal"), [(0, 1013.25), (1000, 898.746), (5000, 540.199), (11000, 226.320), (20000, 54.749)]
)
def test_the_standard_atmosphere_has_its_tabulated_pressure(height, hectopascal):
    # A table that says 226.321 is the US standard of 1976, whose air weighs 28.9644 g/mol, not 28.96442.
    assert theory.isa_pressure(height) / 100.0 == pytest.approx(hectopascal, abs=5e-4)


@pytest.mark.parametrize("lapse_rate", [9.8e-3, 6.5e-3, 1e-9, 0.0, -5e-3])
def test_height_and_pressure_of_an_environment_are_inverse(lapse_rate):
    heights = np.array([-100.0, 0.0, 10.0, 3000.0, 9000.0])
    pressures = theory.environment_pressure(heights, 290.0, 1e5, lapse_rate)
    back = theory.height_of_pressure(pressures, 290.0, 1e5, lapse_rate)
    assert np.allclose(back, heights, rtol=1e-12, atol=1e-9)


def expanding(rate, *, rotates=True):
    """Return the entropy production of a gas per molecule and time at a small rate of expansion along one axis.

    The model has temperatures along and across the axis and of rotation, which relax towards each other: the first two
    with the viscosity of Chapman and Enskog, the last at every contact, by Larsen and Borgnakke.
    """
    shear, turn, freedom = 1.016 * 1.25, 2.0, 5.0 if rotates else 3.0

    def change(_, state):
        along, across, spin = state
        motion = (along + 2.0 * across) / 3.0
        given = (motion - spin) / turn if rotates else 0.0
        return [
            -2.0 * rate * along - (along - motion) / shear - 2.0 / 3.0 * given + 2.0 * rate * along / freedom * motion,
            -(across - motion) / shear - 2.0 / 3.0 * given + 2.0 * rate * along / freedom * motion,
            given + 2.0 * rate * along / freedom * spin,
        ]

    # heated evenly so that it stays as warm; the missing pressure is -D rate, and work lost is D rate^2
    along, across, spin = integrate.solve_ivp(change, (0.0, 60.0), [1.0, 1.0, 1.0], rtol=1e-10, atol=1e-13).y[:, -1]
    mean = (along + 2.0 * across + (freedom - 3.0) * spin) / freedom
    return (mean - along) / mean * rate


def test_the_dissipation_of_an_expanding_gas_is_that_of_kinetic_theory():
    rate = 1e-5
    derived = expanding(rate) / rate**2
    assert derived == pytest.approx(5.0 / 3.0 * 1.016 + 8.0 / 25.0, rel=1e-3)
    assert expanding(rate, rotates=False) / rate**2 == pytest.approx(5.0 / 3.0 * 1.016, rel=1e-3)
    # the constant in use is rounded, and lies within its measured uncertainty of 0.06
    assert pytest.approx(derived, rel=0.015) == theory.DISSIPATION


def uniform(length, freedom=5, closing=20.0, top=3e4):
    """Return the finite-rate error of the temperature of a uniform gas lifted from 1000 hPa under a piston, over T.

    Temperatures along and across the axis and of the rotation, as in `expanding`, and the logarithm of the volume.
    """
    shear, turn = 1.016 * 1.25, 2.0
    fall = math.log(1e5 / top) / length

    def change(time, state):
        along, across, spin, volume = state
        mean = (along + 2.0 * across + (freedom - 3) * spin) / freedom
        motion = (along + 2.0 * across) / 3.0
        tau = math.exp(volume) / math.sqrt(motion)
        rate = (fall + (math.log(mean) - volume + fall * time) / closing) / (1.0 + 2.0 / freedom)
        given = (motion - spin) / turn / tau if freedom > 3 else 0.0
        return [
            -2.0 * rate * along - (along - motion) / shear / tau - 2.0 / 3.0 * given,
            -(across - motion) / shear / tau - 2.0 / 3.0 * given,
            given,
            rate,
        ]

    end = integrate.solve_ivp(change, (0.0, length), [1.0, 1.0, 1.0, 0.0], rtol=1e-9, atol=1e-11).y[:, -1]
    mean = (end[0] + 2.0 * end[1] + (freedom - 3) * end[2]) / freedom
    return mean / (mean * math.exp(-end[3])) ** (2.0 / (freedom + 2.0)) - 1.0


EVEN = tuple(np.geomspace(1e5, 3e4, 400))


@pytest.mark.parametrize(("length", "within"), [(50.0, 0.02), (100.0, 0.015), (400.0, 0.01), (1600.0, 0.01)])
def test_a_finite_rate_warms_a_uniform_gas_as_kinetic_theory_demands_to_second_order(length, within):
    # the first order alone is 7 % too large at 50 mean free times, 3 % at 100
    found = theory.Ascent(EVEN, length, 0.0).finite_speed(3e4)
    assert found == pytest.approx(uniform(length), rel=within)


def test_the_flow_in_a_box_that_is_stretched_counts_as_the_warmth_of_its_energy():
    length, height, freedom = 50.0, 10.0, 5
    more = theory.Ascent(EVEN, length, height).finite_speed(3e4) - theory.Ascent(EVEN, length, 0.0).finite_speed(3e4)
    rate = math.log(1e5 / 3e4) / length / 1.4
    high, cold = height * (1e5 / 3e4) ** (1.0 / 1.4), (3e4 / 1e5) ** (2.0 / 7.0)
    z = (np.arange(1000) + 0.5) / 1000.0 * high
    energy = np.mean(0.5 * (rate * z) ** 2)  # of a molecule of mass 1, in kT at the start
    # the gas is warmer by 2/f of this at its volume, and by f/(f + 2) of that at the pressure that it then has
    assert more == pytest.approx(energy / cold * 2.0 / freedom * freedom / (freedom + 2.0), rel=1e-3)
