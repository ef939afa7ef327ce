r"""Molecules that attract each other by a square well, and three simple fluids that they represent.

Lengths are in diameters sigma, energies in depths epsilon: the temperature is then :math:`T^* = kT / \varepsilon`, the
density :math:`\rho^* = n \sigma^3`, the pressure :math:`p \sigma^3 / \varepsilon`. The well reaches to
:math:`\lambda \sigma`. Two molecules are in each other's well :math:`1 + x` times as often as without attraction,
:math:`x = e^{1/T^*} - 1`.

The fluids are argon, nitrogen and methane, with their critical points and measured vapour pressures. Molecules with a
square well represent such a fluid if their critical temperature and density are those of the fluid:
:math:`\varepsilon = k T_c / T_c^*` and :math:`\sigma^3 = \rho_c^* / n_c`.

References
----------
Hirschfelder, J. O., Curtiss, C. F., Bird, R. B. (1954), Molecular Theory of Gases and Liquids, section 3.5
(virial coefficients; the third is that of Kihara, T. (1953), doi:10.1103/RevModPhys.25.831).
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
    "square_well_compressibility",
    "square_well_second_virial",
    "square_well_third_virial",
    "well_vapor_pressure",
]

Array = NDArray[np.float64]

_HARD = 2.0 * np.pi / 3.0
"""The second virial coefficient of hard spheres, b0."""


def square_well_second_virial(temperature: ArrayLike, range: float = 1.5) -> Array:
    r"""Return the second virial coefficient, :math:`B_2 = b_0 [1 - (\lambda^3 - 1) x]` [diameter^3].

    Parameters
    ----------
    temperature, range
        Temperature T*, above 0, and reach lambda of the well [diameter].

    Examples
    --------
    It is zero at the Boyle temperature, where attraction and excluded volume compensate each other:

    >>> round(float(square_well_second_virial(1.0 / np.log(1.0 + 1.0 / 2.375))), 12) + 0.0
    0.0
    """
    x = np.expm1(1.0 / np.asarray(temperature, np.float64))
    return np.asarray(_HARD * (1.0 - (range**3 - 1.0) * x))


def square_well_third_virial(temperature: ArrayLike, range: float = 1.5) -> Array:
    r"""Return the third virial coefficient [diameter^6], for ranges up to 2.

    :math:`B_3 = b_0^2 (5 - c_1 x - c_2 x^2 - c_3 x^3) / 8` with
    :math:`c_1 = \lambda^6 - 18 \lambda^4 + 32 \lambda^3 - 15`,
    :math:`c_2 = 2 \lambda^6 - 36 \lambda^4 + 32 \lambda^3 + 18 \lambda^2 - 16`,
    :math:`c_3 = 6 \lambda^6 - 18 \lambda^4 + 18 \lambda^2 - 6` (Kihara 1953, doi:10.1103/RevModPhys.25.831).

    Parameters
    ----------
    temperature, range
        Temperature T*, above 0, and reach lambda of the well, from 1 to 2 [diameter].

    Raises
    ------
    ValueError
        If the range is above 2, where three molecules attract each other in more ways.

    Examples
    --------
    Without attraction it is the coefficient of hard spheres, 5/8 of b0 squared:

    >>> round(float(square_well_third_virial(1e9) / (2.0 * np.pi / 3.0) ** 2), 6)
    0.625
    """
    if not 1.0 <= range <= 2.0:
        raise ValueError(f"range = {range:g} is not from 1 to 2, where this formula holds.")
    x = np.expm1(1.0 / np.asarray(temperature, np.float64))
    one, two, three = _third(range)
    return np.asarray(_HARD**2 / 8.0 * (5.0 - x * (one + x * (two + x * three))))


def _third(range: float) -> tuple[float, float, float]:
    """Return c1, c2 and c3."""
    square, cube, fourth, sixth = range**2, range**3, range**4, range**6
    return (
        sixth - 18.0 * fourth + 32.0 * cube - 15.0,
        2.0 * sixth - 36.0 * fourth + 32.0 * cube + 18.0 * square - 16.0,
        6.0 * sixth - 18.0 * fourth + 18.0 * square - 6.0,
    )


def square_well_compressibility(density: ArrayLike, temperature: ArrayLike, range: float = 1.5) -> Array:
    r"""Return :math:`Z = p / n k T = 1 + B_2 \rho + B_3 \rho^2` of a gas of low density.

    Parameters
    ----------
    density, temperature
        Number density [diameter^-3], and temperature T*.
    range
        Reach lambda of the well, from 1 to 2 [diameter].

    Examples
    --------
    Cold molecules that attract each other have less pressure than an ideal gas:

    >>> round(float(square_well_compressibility(0.0190986, 1.0)), 5)
    0.87724
    """
    rho = np.asarray(density, np.float64)
    second, third = square_well_second_virial(temperature, range), square_well_third_virial(temperature, range)
    return np.asarray(1.0 + rho * (second + rho * third))


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

    :math:`\ln p = 3.5211 - 7.1939 / T^*`, the line through the pressures of Singh, Kofke and Errington (2003),
    doi:10.1063/1.1590313, that the program etomica, of the same group, uses. NaN above the critical temperature.

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
