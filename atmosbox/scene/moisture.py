"""Water for a scene: the substance in the scene's units, and moist air at its start."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.engine import Maxwell, Rotating, Substance
from atmosbox.scene.units import Scale, rounded
from atmosbox.theory.constants import DRY_AIR, WATER

Array = NDArray[np.float64]
WARM = Maxwell(1.0, exact=True), Rotating(1.0, exact=True)
"""A start at kT = 1 to rounding, without total momentum."""
NUCLEI = 100.0
"""Heat capacity of the nuclei on which droplets form, in k, where there is enough air."""


def water(scale: Scale) -> Substance:
    """Return water in the units of a scene whose units of mass and length are a molecule of air and its diameter.

    Its binding energy and its heat capacity are those of `atmosbox.theory.saturation_vapor_pressure`; so its saturation
    vapour pressure follows that formula at every temperature.

    >>> from atmosbox.theory.constants import BOLTZMANN
    >>> scale = Scale(DRY_AIR.diameter, DRY_AIR.molecule_mass, BOLTZMANN * 293.15)
    >>> round(water(scale).saturation_pressure(273.15 / 293.15) * scale.pressure / 100.0, 3)
    6.108
    """
    binding = law.BINDING_TEMPERATURE / scale.temperature
    at_unit = float(law.saturation_vapor_pressure(scale.temperature)) / scale.pressure
    return Substance(
        mass=law.WATER_MASS_RATIO,
        diameter=1.0,
        binding_energy=binding,
        heat_capacity=law.LIQUID_HEAT_CAPACITY,
        volatility=rounded(at_unit * math.exp(binding)),
        rotation=float(WATER.rotational_dof),
    )


def vapour_molecules(molecules: int, vapour_pressure: float, pressure: float) -> int:
    """Return how many of ``molecules`` are vapour at a partial pressure.

    >>> vapour_molecules(1000, 23.0, 1000.0)
    23
    """
    return round(molecules * vapour_pressure / pressure)


def nuclei_heat_capacity(air: int) -> float:
    """Return the heat capacity of the nuclei on which droplets form, in k.

    It keeps the temperature steady when the first molecules condense. It is at most half a percent of the heat capacity
    of the air at constant pressure, 7/2 k per molecule, and so changes an adiabat little.

    >>> nuclei_heat_capacity(1000), nuclei_heat_capacity(10_000)
    (17.5, 100.0)
    """
    return min(NUCLEI, 0.005 * 3.5 * air)


class MoistAir(NamedTuple):
    """The molecules of moist air, the vapour first: ``mass`` and ``rotation : (molecule,)``."""

    mass: Array
    rotation: Array


def moist_air(molecules: int, vapour: int) -> MoistAir:
    """Return molecules of moist air.

    >>> from atmosbox.engine import RandomNumbers, Start
    >>> air = moist_air(100, 2)
    >>> drawn = Start(100, WARM).draw(RandomNumbers(1), **air._asdict())
    >>> kinetic = 0.5 * float(np.sum(air.mass * np.sum(drawn.velocity**2, axis=1)))
    >>> round(kinetic, 9), round(float(drawn.rotational_energy.sum()), 9)
    (150.0, 101.0)
    """
    mass = np.ones(molecules)
    mass[:vapour] = law.WATER_MASS_RATIO
    rotation = np.full(molecules, float(DRY_AIR.rotational_dof))
    rotation[:vapour] = float(WATER.rotational_dof)
    return MoistAir(mass, rotation)
