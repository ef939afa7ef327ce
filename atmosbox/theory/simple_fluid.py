r"""Three simple fluids, argon, nitrogen and methane: their critical points and measured vapour pressures.

Molecules with a square well represent such a fluid if their critical temperature and density are those of the fluid:
:math:`\varepsilon = k T_c / T_c^*` and :math:`\sigma^3 = \rho_c^* / n_c`.

References
----------
.. [1] Tegeler, C., Span, R., Wagner, W. (1999), doi:10.1063/1.556037 (argon).
.. [2] Span, R. et al. (2000), doi:10.1063/1.1349047 (nitrogen).
.. [3] Setzmann, U., Wagner, W. (1991), doi:10.1063/1.555898 (methane).
.. [4] Singh, J. K., Kofke, D. A., Errington, J. R. (2003), doi:10.1063/1.1590313 (the square well of range 1.5).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.theory.constants import AVOGADRO, BOLTZMANN

__all__ = [
    "SIMPLE_FLUIDS",
    "WELL_CRITICAL_DENSITY",
    "WELL_CRITICAL_TEMPERATURE",
    "SimpleFluid",
    "well_vapor_pressure",
]

WELL_CRITICAL_TEMPERATURE = 1.2172
"""Critical temperature T* of the square well of range 1.5, by simulation [4]_."""
WELL_CRITICAL_DENSITY = 0.3079
"""Critical density of the square well of range 1.5, by simulation [4]_ [diameter^-3]."""


@dataclass(frozen=True)
class SimpleFluid:
    """A fluid of nearly round molecules.

    Parameters
    ----------
    name
        Its name.
    molar_mass
        Mass of a mole [kg mol-1].
    critical_temperature, critical_pressure, critical_density
        Values at the critical point [K, Pa, mol m-3].
    coefficients, exponents
        Those of its vapour pressure, ln(p / p_c) = T_c / T times the sum of a (1 - T / T_c)^e.

    Examples
    --------
    Argon boils at -185.8 degC under a pressure of one atmosphere:

    >>> round(float(SIMPLE_FLUIDS["argon"].vapor_pressure(87.302)) / 101325.0, 3)
    1.0
    """

    name: str
    molar_mass: float
    critical_temperature: float
    critical_pressure: float
    critical_density: float
    coefficients: tuple[float, ...]
    exponents: tuple[float, ...]

    @property
    def molecule_mass(self) -> float:
        """Mass of one molecule [kg]."""
        return self.molar_mass / AVOGADRO

    @property
    def well_depth(self) -> float:
        """Depth of the square well that has the critical temperature of this fluid [J]."""
        return BOLTZMANN * self.critical_temperature / WELL_CRITICAL_TEMPERATURE

    @property
    def well_diameter(self) -> float:
        """Diameter of the spheres that have the critical density of this fluid [m]."""
        cube: float = WELL_CRITICAL_DENSITY / (AVOGADRO * self.critical_density)
        return float(np.cbrt(cube))

    def vapor_pressure(self, temperature: ArrayLike) -> NDArray[np.float64]:
        """Return the measured vapour pressure [Pa] at a temperature [K], NaN above the critical one."""
        warmth = np.asarray(temperature, np.float64)
        below = 1.0 - np.minimum(warmth, self.critical_temperature) / self.critical_temperature
        terms = sum(a * below**e for a, e in zip(self.coefficients, self.exponents, strict=True))
        pressure = self.critical_pressure * np.exp(self.critical_temperature / warmth * terms)
        return np.where(warmth <= self.critical_temperature, pressure, np.nan)


SIMPLE_FLUIDS = {
    fluid.name: fluid
    for fluid in (
        SimpleFluid(
            "argon", 39.948e-3, 150.687, 4.863e6, 13407.43,
            (-5.9409785, 1.3553888, -0.46497607, -1.5399043), (1.0, 1.5, 2.0, 4.5),
        ),
        SimpleFluid(
            "nitrogen", 28.01348e-3, 126.192, 3.3958e6, 11183.9,
            (-6.12445284, 1.26327220, -0.765910082, -1.77570564), (1.0, 1.5, 2.5, 5.0),
        ),
        SimpleFluid(
            "methane", 16.0428e-3, 190.564, 4.5922e6, 10139.128,
            (-6.036219, 1.409353, -0.4945199, -1.443048), (1.0, 1.5, 2.0, 4.5),
        ),
    )
}  # fmt: skip
"""The fluids by name."""


def well_vapor_pressure(temperature: ArrayLike) -> NDArray[np.float64]:
    r"""Return the vapour pressure of the square well of range 1.5 by published simulations [depth/diameter^3].

    :math:`\ln p = 3.5211 - 7.1939 / T^*`, the line through the pressures of Singh, Kofke and Errington (2003) that the
    program etomica, of the same group, uses. NaN above the critical temperature.

    Parameters
    ----------
    temperature
        Temperature T*.

    Examples
    --------
    >>> round(float(well_vapor_pressure(1.0)), 4)
    0.0254
    """
    warmth = np.asarray(temperature, np.float64)
    return np.where(warmth <= WELL_CRITICAL_TEMPERATURE, np.exp(3.5211 - 7.1939 / warmth), np.nan)
