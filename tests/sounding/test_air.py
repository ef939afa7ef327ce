"""What is computed of a sounding: the analytic one of Weisman and Klemp, heights, and MetPy's numbers of a parcel."""

import metpy.calc as mpcalc
import numpy as np
import pytest
from metpy.units import units

from atmosbox.scene.sounding import Sounding, hydrostatic_height, indices, weisman_klemp

GAS, GRAVITY, EPSILON = 287.04, 9.80665, 0.62198
HEAT = 3.5 * GAS


def saturation_pressure(temperature):
    return 611.2 * np.exp(17.67 * (temperature - 273.15) / (temperature - 29.65))


def by_iteration(height, cap):
    """Pressure and temperature by repeated integration with the trapezoidal rule, as cloud models set up this air."""
    share = np.minimum(height / 12e3, 1.0) ** 1.25
    theta = 300.0 + 43.0 * share
    theta = np.where(height > 12e3, 343.0 * np.exp(GRAVITY / (HEAT * 213.0) * (height - 12e3)), theta)
    vapor = np.zeros_like(height)
    for _ in range(20):
        virtual = theta * (1 + vapor / EPSILON) / (1 + vapor)
        layers = -GRAVITY / HEAT * np.diff(height) * 2 / (virtual[1:] + virtual[:-1])
        exner = 1.0 + np.concatenate([[0.0], np.cumsum(layers)])
        pressure = 1e5 * exner**3.5
        saturation = saturation_pressure(theta * exner)
        vapor = np.minimum(cap, (1 - 0.75 * share) * EPSILON * saturation / (pressure - saturation))
    return pressure, theta * exner


def test_it_is_the_formula_in_hydrostatic_balance():
    air = weisman_klemp(0.014)
    fine = np.linspace(0.0, 16e3, 64 * 50 + 1)
    pressure, temperature = by_iteration(fine, 0.014)
    # The gas constants differ by 4e-5, the steps of both are fine.
    np.testing.assert_allclose(air.pressure, pressure[::50], rtol=2e-4)
    np.testing.assert_allclose(air.temperature, temperature[::50], atol=0.02)
    assert len(air) == 65


@pytest.mark.parametrize("cap", [0.011, 0.014, 0.016])
def test_the_mixing_ratio_is_constant_near_the_ground(cap):
    air = weisman_klemp(cap)
    vapor = saturation_pressure(air.dewpoint)
    mixing_ratio = EPSILON * vapor / (air.pressure - vapor)
    assert mixing_ratio[0] == pytest.approx(cap, rel=1e-4)
    assert mixing_ratio.max() == pytest.approx(cap, rel=1e-4)
    assert np.count_nonzero(mixing_ratio > 0.999 * cap) > 3
    assert np.all(np.diff(mixing_ratio[:49]) < 1e-9)


def test_dry_isothermal_air_has_the_height_of_the_barometric_law():
    pressure = np.geomspace(1000e2, 100e2, 30)
    dry = Sounding(pressure, np.full(30, 250.0), np.full(30, 150.0))
    expected = 8.314462618 / 28.9647e-3 * 250.0 / 9.80665 * np.log(1000e2 / pressure)
    np.testing.assert_allclose(hydrostatic_height(dry), expected, rtol=1e-6)


PRESSURE = np.array([1000e2, 950e2, 900e2, 850e2, 700e2, 600e2, 500e2, 400e2, 300e2, 200e2])
STABLE = Sounding(PRESSURE, 288.0 - np.linspace(0, 30, 10), 270.0 - np.linspace(0, 60, 10), name="calm")


def straight(sounding):
    """Return pressure, temperature and dewpoint as a user of MetPy would write them."""
    return sounding.pressure * units.Pa, sounding.temperature * units.K, sounding.dewpoint * units.K


def test_the_numbers_are_those_of_metpy():
    air = weisman_klemp()
    found = indices(air)
    p, t, td = straight(air)
    cape, cin = mpcalc.surface_based_cape_cin(p, t, td)
    assert found.cape == pytest.approx(cape.to("J/kg").magnitude)
    assert found.cin == pytest.approx(cin.to("J/kg").magnitude)
    levels = (
        (found.lcl, mpcalc.lcl(p[0], t[0], td[0])),
        (found.lfc, mpcalc.lfc(p, t, td)),
        (found.el, mpcalc.el(p, t, td)),
    )
    for level, (pressure, temperature) in levels:
        assert level.pressure == pytest.approx(pressure.to("Pa").magnitude)
        assert level.temperature == pytest.approx(temperature.to("K").magnitude)


def test_stable_air_has_neither_lfc_nor_el_nor_energy():
    found = indices(STABLE)
    assert (found.lfc, found.el) == (None, None)
    assert (found.cape, found.cin) == (0.0, 0.0)


def test_a_sounding_that_ends_below_the_el_has_none_but_energy():
    air = weisman_klemp()
    short = Sounding(air.pressure[:30], air.temperature[:30], air.dewpoint[:30])
    found = indices(short)
    assert found.el is None
    assert found.lfc is not None
    assert 0.0 < found.cape < indices(air).cape


def test_of_several_levels_of_free_convection_the_highest_is_taken():
    # buoyant twice: below a warm layer, and above it
    base = weisman_klemp(0.016)
    height = hydrostatic_height(base)
    warm = np.where((height > 3000.0) & (height < 3400.0), 8.0, 0.0)
    air = Sounding(base.pressure, base.temperature + warm, base.dewpoint)
    lowest = mpcalc.lfc(*straight(air), which="bottom")[0].to("Pa").magnitude
    assert indices(air).lfc.pressure < 70_000.0 < lowest
