import metpy.calc as mpcalc
import numpy as np
import pytest
from metpy.units import units

from atmosbox.scene.sounding import Sounding, hydrostatic_height, weisman_klemp


def test_dry_isothermal_air_has_the_height_of_the_barometric_law():
    pressure = np.geomspace(1000e2, 100e2, 30)
    dry = Sounding(pressure, np.full(30, 250.0), np.full(30, 150.0))
    expected = 8.314462618 / 28.9647e-3 * 250.0 / 9.80665 * np.log(1000e2 / pressure)
    np.testing.assert_allclose(hydrostatic_height(dry), expected, rtol=1e-6)


def test_it_is_the_thickness_of_metpy():
    air = weisman_klemp()
    vapor = mpcalc.mixing_ratio_from_relative_humidity(
        air.pressure * units.Pa,
        air.temperature * units.K,
        mpcalc.relative_humidity_from_dewpoint(air.temperature * units.K, air.dewpoint * units.K),
    )
    thickness = mpcalc.thickness_hydrostatic(air.pressure * units.Pa, air.temperature * units.K, vapor)
    assert hydrostatic_height(air)[-1] == pytest.approx(thickness.to("m").magnitude, rel=1e-4)


def test_it_finds_the_heights_of_the_analytic_sounding():
    air = weisman_klemp()
    np.testing.assert_allclose(hydrostatic_height(air), 250.0 * np.arange(65), atol=1.0)
