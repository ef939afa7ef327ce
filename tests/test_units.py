"""The constants, the kinds of molecules and the scale of a scene."""

import math

import pytest

from atmosbox.scene.units import Scale
from atmosbox.theory.constants import AVOGADRO, BOLTZMANN, DRY_AIR, GAS_CONSTANT, STANDARD_GRAVITY


def test_the_constants_are_those_of_the_si():
    assert BOLTZMANN == 1.380649e-23
    assert AVOGADRO == 6.02214076e23
    assert pytest.approx(8.31446261815324, rel=1e-15) == GAS_CONSTANT
    assert STANDARD_GRAVITY == 9.80665


def air(weight=1.0):
    return Scale(DRY_AIR.diameter, DRY_AIR.molecule_mass, BOLTZMANN * 288.15, weight)


def test_the_units_of_a_scale_fit_together():
    scale = air(weight=1e20)
    assert scale.velocity * scale.time == pytest.approx(scale.length, rel=1e-14)
    assert scale.acceleration * scale.time == pytest.approx(scale.velocity, rel=1e-14)
    assert scale.mass * scale.velocity**2 == pytest.approx(scale.energy, rel=1e-14)
    assert scale.temperature == pytest.approx(288.15, rel=1e-14)
    assert scale.pressure * scale.length**3 == pytest.approx(scale.total_energy, rel=1e-14)
    assert scale.mass_density * scale.velocity**2 == pytest.approx(scale.pressure, rel=1e-14)
    # The pressure on a wall is the impulse that it receives per area and time.
    impulse_per_area_and_time = scale.weight * scale.mass * scale.velocity / (scale.length**2 * scale.time)
    assert impulse_per_area_and_time == pytest.approx(scale.pressure, rel=1e-14)


def test_a_weight_scales_what_counts_molecules_and_nothing_else():
    one, many = air(), air(weight=50.0)
    for name in ("number_density", "mass_density", "pressure", "total_energy"):
        assert getattr(many, name) == pytest.approx(50.0 * getattr(one, name), rel=1e-14)
    for name in ("time", "velocity", "acceleration", "temperature"):
        assert getattr(many, name) == getattr(one, name)


def test_a_scale_must_be_positive_and_finite():
    for wrong in [0.0, -1.0, math.nan, math.inf]:
        for place in range(4):
            sizes = [1.0, 1.0, 1.0, 1.0]
            sizes[place] = wrong
            with pytest.raises(ValueError, match="must be positive and finite"):
                Scale(*sizes)
