import numpy as np
import pytest

from atmosbox.errors import SettingError
from atmosbox.scene.sounding import indices, weisman_klemp

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


def test_potential_temperature_and_humidity_have_their_values_at_ground_and_tropopause():
    air = weisman_klemp()
    theta = air.temperature * (1e5 / air.pressure) ** (2 / 7)
    humidity = saturation_pressure(air.dewpoint) / saturation_pressure(air.temperature)
    tropopause = int(12e3 / 250.0)
    assert theta[0] == pytest.approx(300.0)
    assert theta[tropopause] == pytest.approx(343.0)
    # The humidity is that of mixing ratios, which differs from that of vapor pressures by e/p.
    assert humidity[tropopause:] == pytest.approx(0.25, rel=1e-3)
    assert np.all(np.diff(theta) > 0.0)


@pytest.mark.parametrize("cap", [0.011, 0.014, 0.016])
def test_the_mixing_ratio_is_constant_near_the_ground(cap):
    air = weisman_klemp(cap)
    vapor = saturation_pressure(air.dewpoint)
    mixing_ratio = EPSILON * vapor / (air.pressure - vapor)
    assert mixing_ratio[0] == pytest.approx(cap, rel=1e-4)
    assert mixing_ratio.max() == pytest.approx(cap, rel=1e-4)
    assert np.count_nonzero(mixing_ratio > 0.999 * cap) > 3
    assert np.all(np.diff(mixing_ratio[:49]) < 1e-9)


def test_energy_grows_with_the_moisture_near_the_ground_and_inhibition_shrinks():
    found = [indices(weisman_klemp(cap)) for cap in (0.011, 0.014, 0.016)]
    # CAPE by MetPy's definition; the paper gives 2200 J/kg by its own.
    assert found[1].cape == pytest.approx(1880.0, abs=20.0)
    assert found[1].cin == pytest.approx(-48.0, abs=3.0)
    assert found[0].cape < 600.0 < 3000.0 < found[2].cape
    assert found[0].cin < found[1].cin < found[2].cin < 0.0


def test_numbers_in_the_wrong_unit_are_refused():
    cases = [
        ({"mixing_ratio": 14.0}, "mixing_ratio = 14.0 is not what the formula is for: give 0.0001 to 0.03 kg kg-1"),
        ({"mixing_ratio": float("nan")}, "mixing_ratio = nan is not what"),
    ]
    for given, sentence in cases:
        with pytest.raises(SettingError, match=sentence):
            weisman_klemp(**given)


def test_at_its_limits_it_is_an_ascent():
    for cap in [1e-4, 0.03]:
        air = weisman_klemp(cap)
        assert np.all(air.dewpoint <= air.temperature)
