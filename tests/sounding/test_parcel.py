import metpy.calc as mpcalc
import numpy as np
import pytest
from metpy.units import units

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding import Sounding, hydrostatic_height, indices, lifted_parcel, weisman_klemp

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


def test_cloud_base_is_at_the_height_of_a_dry_adiabat():
    air = weisman_klemp()
    lcl = indices(air).lcl
    height = np.interp(-np.log(lcl.pressure), -np.log(air.pressure), hydrostatic_height(air))
    assert (300.0 - lcl.temperature) / height == pytest.approx(9.8e-3, rel=0.02)


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


def two_caps():
    """Air in which a parcel is buoyant twice: below a warm layer, and above it."""
    air = weisman_klemp(0.016)
    height = hydrostatic_height(air)
    warm = np.where((height > 3000.0) & (height < 3400.0), 8.0, 0.0)
    return Sounding(air.pressure, air.temperature + warm, air.dewpoint)


def test_of_several_levels_of_free_convection_the_highest_is_taken():
    air = two_caps()
    lowest = mpcalc.lfc(*straight(air), which="bottom")[0].to("Pa").magnitude
    assert indices(air).lfc.pressure < 70_000.0 < lowest


def test_what_metpy_cannot_answer_is_refused_in_a_sentence(monkeypatch):
    def fail(*args):
        raise RuntimeError("no convergence")

    with monkeypatch.context() as patch:
        patch.setattr(mpcalc, "surface_based_cape_cin", fail)
        with pytest.raises(SoundingError, match=r"calm: MetPy finds no parcel's path \(no convergence\): give"):
            indices(STABLE)
    monkeypatch.setattr(lifted_parcel, "_level", lambda *args: None)
    with pytest.raises(SoundingError, match="calm: MetPy finds no cloud base"):
        indices(STABLE)
