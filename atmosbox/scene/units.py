r"""The scale of a scene: what the engine's reduced numbers are in SI units; and numbers rounded for the engine.

The engine has no kilogram and no kelvin: it moves molecules whose length, mass and energy are measured in units of a
:class:`Scale` that the scene chooses. :mod:`atmosbox.scene.conversion` converts between the units that people use and
SI units.

**Rounding.** The numbers that a scene sets up come from powers, exponentials and logarithms, which every C library, and
numpy on every processor, rounds differently in the last of their 53 digits. From the same numbers the engine repeats a
run to the last bit. So it is given numbers of 32 binary digits, which do not depend on the machine: a difference in
digit 53 changes digit 32 once in two million numbers, and a change of 1 in 4e9 is too small to matter to a scene.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import overload

import numpy as np
from numpy.typing import NDArray

from atmosbox.theory.constants import BOLTZMANN

__all__ = ["Scale", "rounded"]


@dataclass(frozen=True)
class Scale:
    """The value in SI units of each unit of the engine.

    Three units are free, the others follow: time = length sqrt(mass / energy), temperature = energy / k_B. A simulated
    molecule moves as a single real molecule does, but stands for `weight` of them in all quantities that count
    molecules: density, pressure, and the energy and momentum of the body of air.

    Parameters
    ----------
    length, mass
        Usually the diameter [m] and the mass of a molecule [kg].
    energy
        Usually k_B times a temperature of the scene, for one molecule [J].
    weight
        Number of real molecules for which a simulated one stands.

    Raises
    ------
    ValueError
        If one of the four is not a positive, finite number.

    Examples
    --------
    Molecules of dry air at 288.15 K, measured in their own diameter, mass and k_B T, have a unit of speed of
    sqrt(k_B T / m), 288 m/s:

    >>> from atmosbox.theory.constants import DRY_AIR
    >>> scale = Scale(DRY_AIR.diameter, DRY_AIR.molecule_mass, BOLTZMANN * 288.15)
    >>> round(scale.velocity, 1), round(scale.reduced_temperature(288.15), 12)
    (287.6, 1.0)
    """

    length: float
    mass: float
    energy: float
    weight: float = 1.0

    def __post_init__(self) -> None:
        for name in ("length", "mass", "energy", "weight"):
            if not 0.0 < getattr(self, name) < math.inf:
                raise ValueError(f"The {name} of a scale must be positive and finite, not {getattr(self, name)}.")

    @property
    def time(self) -> float:
        """Unit of time, in which a molecule of unit speed crosses the unit of length [s]."""
        return self.length * math.sqrt(self.mass / self.energy)

    @property
    def velocity(self) -> float:
        """Unit of velocity [m s-1]."""
        return math.sqrt(self.energy / self.mass)

    @property
    def acceleration(self) -> float:
        """Unit of acceleration, in which gravity is given to the engine [m s-2]."""
        return self.energy / (self.mass * self.length)

    @property
    def temperature(self) -> float:
        """Temperature at which k_B T is the unit of energy [K]."""
        return self.energy / BOLTZMANN

    @property
    def number_density(self) -> float:
        """Real molecules per volume when one simulated molecule fills the unit of volume [m-3]."""
        return self.weight / self.length**3

    @property
    def mass_density(self) -> float:
        """Unit of density of the air [kg m-3]."""
        return self.mass * self.number_density

    @property
    def pressure(self) -> float:
        """Unit of pressure of the air [Pa]."""
        return self.energy * self.number_density

    @property
    def total_energy(self) -> float:
        """Unit of energy of the body of air: of its ledger, of heat and of work [J]."""
        return self.weight * self.energy

    def reduced_temperature(self, temperature: float) -> float:
        """Return k_B T in the unit of energy: the ``kT`` that the engine is given for a heat bath."""
        return BOLTZMANN * temperature / self.energy


_DIGITS = 32


@overload
def rounded(x: float) -> float: ...
@overload
def rounded(x: NDArray[np.float64]) -> NDArray[np.float64]: ...


def rounded(x: float | NDArray[np.float64]) -> float | NDArray[np.float64]:
    """Return a number, or each of an array, rounded to 32 binary digits.

    Examples
    --------
    >>> rounded(0.1) - 0.1 < 2.0**-35, rounded(0.1) == rounded(0.1 + 1e-16), rounded(3.0)
    (True, True, 3.0)
    """
    part, power = np.frexp(x)  # exact, as are all later steps
    found = np.ldexp(np.rint(np.ldexp(part, _DIGITS)), power - _DIGITS)
    return found if isinstance(x, np.ndarray) else float(found)
