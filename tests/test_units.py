"""The constants, and the units of a scene."""

import pytest

from atmosbox.scene.units import Scale
from atmosbox.theory.constants import AVOGADRO, BOLTZMANN, DRY_AIR, GAS_CONSTANT, STANDARD_GRAVITY


def test_the_constants_are_those_of_the_si():
    assert (BOLTZMANN, AVOGADRO, STANDARD_GRAVITY) == (1.380649e-23, 6.02214076e23, 9.80665)
    assert pytest.approx(8.31446261815324, rel=1e-15) == GAS_CONSTANT


def test_the_units_of_a_scale_fit_together():
    scale = Scale(DRY_AIR.diameter, DRY_AIR.molecule_mass, BOLTZMANN * 288.15, 1e20)
    assert scale.velocity * scale.time == pytest.approx(scale.length, rel=1e-14)
    assert scale.acceleration * scale.time == pytest.approx(scale.velocity, rel=1e-14)
    assert scale.mass * scale.velocity**2 == pytest.approx(scale.energy, rel=1e-14)
    assert scale.temperature == pytest.approx(288.15, rel=1e-14)
    assert scale.pressure * scale.length**3 == pytest.approx(scale.total_energy, rel=1e-14)
    assert scale.mass_density * scale.velocity**2 == pytest.approx(scale.pressure, rel=1e-14)
    # The pressure on a wall is the impulse that it receives per area and time.
    impulse_per_area_and_time = scale.weight * scale.mass * scale.velocity / (scale.length**2 * scale.time)
    assert impulse_per_area_and_time == pytest.approx(scale.pressure, rel=1e-14)
