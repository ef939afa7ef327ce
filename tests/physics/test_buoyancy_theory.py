"""CAPE and CIN: exact integrals of piecewise linear curves, the conventions, MetPy's results, error propagation."""

import numpy as np
import pytest

from atmosbox import theory

R_DRY = theory.DRY_AIR_GAS_CONSTANT
LEVELS = np.exp(np.log(1e5) - np.arange(6.0) * 0.25)
AROUND = np.array([300.0, 290.0, 280.0, 270.0, 260.0, 250.0])


def sounding(*differences):
    """Return a sounding of equal steps in ln p with these differences of virtual temperature."""
    return LEVELS[: len(differences)], AROUND[: len(differences)], AROUND[: len(differences)] + np.array(differences)


def at(steps):
    """Return the pressure a number of steps above the ground."""
    return 1e5 * np.exp(-0.25 * steps)


def test_a_triangle_of_buoyancy_has_its_area():
    energy = theory.cape_cin(*sounding(-1.0, 1.0, 3.0, 1.0, -1.0, -3.0))
    assert energy.cape == pytest.approx(R_DRY * 0.25 * (0.25 + 2.0 + 2.0 + 0.25), rel=1e-12)
    assert energy.cin == pytest.approx(-R_DRY * 0.25 * 0.25, rel=1e-12)
    assert energy.lfc == pytest.approx(at(0.5), rel=1e-12)
    assert energy.el == pytest.approx(at(3.5), rel=1e-12)


def test_a_parcel_that_is_nowhere_buoyant_has_no_energy_and_no_level():
    for differences in ((0.0, -1.0, -2.0), (-1.0, 0.0, -1.0), (0.0, 0.0)):
        assert theory.cape_cin(*sounding(*differences)) == (0.0, 0.0, None, None)


def test_a_parcel_that_leaves_the_sounding_rising_has_no_equilibrium_level():
    energy = theory.cape_cin(*sounding(0.0, 1.0, 2.0))
    assert energy == (pytest.approx(R_DRY * 0.5, rel=1e-12), 0.0, pytest.approx(1e5), None)


def test_of_several_crossings_the_lowest_is_the_lfc_and_the_highest_the_el():
    energy = theory.cape_cin(*sounding(-1.0, 1.0, -1.0, 1.0, -1.0))
    assert energy.lfc == pytest.approx(at(0.5), rel=1e-12)
    assert energy.el == pytest.approx(at(3.5), rel=1e-12)
    assert energy.cape == pytest.approx(R_DRY * 0.25 * 0.5, rel=1e-12)  # two areas minus the stable one between them


def test_free_convection_waits_for_the_cloud_base():
    warm = sounding(0.0, 1.0, 2.0, -2.0)
    base = float(at(1.5))
    energy = theory.cape_cin(*warm, base)
    assert energy.lfc == pytest.approx(base, rel=1e-12)
    assert energy.cin == 0.0
    assert energy.cape == pytest.approx(R_DRY * 0.25 * (0.5 * 1.75 + 0.5), rel=1e-12)
    assert theory.cape_cin(*warm, float(at(2.7))).cape == 0.0
    assert theory.cape_cin(*warm, 0.0).lfc is None


def test_a_tropical_sounding_of_many_levels_as_metpy_has_it():
    import metpy.calc
    from metpy.units import units

    pressure = np.linspace(1000e2, 150e2, 171)
    t = theory.environment_temperature(theory.height_of_pressure(pressure, 300.0, 1e5, 6.8e-3), 300.0, 6.8e-3)
    td = np.minimum(t - 5.0, 294.0 - (1000e2 - pressure) * 9e-4)
    p = pressure * units.Pa
    lifted = metpy.calc.parcel_profile(p, t[0] * units.K, td[0] * units.K)
    theirs = metpy.calc.cape_cin(p, t * units.K, td * units.K, lifted)
    vapor = theory.mixing_ratio(theory.saturation_vapor_pressure(td), pressure)
    base = float(theory.lcl(pressure[0], t[0], td[0])[0])
    curve = lifted.m_as("K")
    held = np.where(pressure > base, vapor[0], theory.saturation_mixing_ratio(pressure, curve))
    around, parcel = theory.virtual_temperature(t, vapor), theory.virtual_temperature(curve, held)
    energy = theory.cape_cin(pressure, around, parcel, base)
    assert energy.cape == pytest.approx(float(theirs[0].m_as("J/kg")), rel=0.01)
    assert energy.cape > 1000.0
    assert energy.cin == pytest.approx(float(theirs[1].m_as("J/kg")), rel=0.01, abs=0.5)


def test_cloud_water_weighs_on_the_parcel():
    path = theory.parcel_path(LEVELS, 1e5, 300.0, 0.018)
    light = theory.virtual_temperature(path.temperature, path.vapor)
    heavy = theory.density_temperature(path.temperature, path.vapor, path.liquid)
    around = light - np.array([0.0, 0.5, 3.0, 4.0, 3.0, -1.0])
    loaded, free = theory.cape_cin(LEVELS, around, heavy), theory.cape_cin(LEVELS, around, light)
    assert 0.0 < loaded.cape < free.cape


def test_a_broken_sounding_is_refused_with_a_sentence():
    cases = [
        ({"pressure": [1e5, 9e4, 9e4]}, "lower"),
        ({"pressure": [1e5, np.nan, 8e4]}, "pressure"),
        ({"virtual_temperature": [290.0, 280.0]}, "same number"),
        ({"parcel_virtual_temperature": [290.0, np.nan, 270.0]}, "parcel_virtual_temperature"),
        ({"lcl_pressure": np.nan}, "lcl_pressure"),
    ]
    for change, match in cases:
        whole = {
            "pressure": [1e5, 9e4, 8e4],
            "virtual_temperature": [290.0, 280.0, 270.0],
            "parcel_virtual_temperature": [290.0, 281.0, 271.0],
        }
        assert theory.cape_cin(**whole).cape > 0.0
        with pytest.raises(ValueError, match=match):
            theory.cape_cin(**(whole | change))
