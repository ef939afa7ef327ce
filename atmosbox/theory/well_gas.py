r"""Molecules that attract each other by a square well: their properties in closed form.

Lengths are in diameters sigma, energies in depths epsilon: the temperature is then :math:`T^* = kT / \varepsilon`, the
density :math:`\rho^* = n \sigma^3`, the pressure :math:`p \sigma^3 / \varepsilon`. The well reaches to
:math:`\lambda \sigma`. Two molecules are in each other's well :math:`1 + x` times as often as without attraction,
:math:`x = e^{1/T^*} - 1`.

References
----------
Hirschfelder, J. O., Curtiss, C. F., Bird, R. B. (1954), Molecular Theory of Gases and Liquids, section 3.5
(virial coefficients; the third is that of Kihara, T. (1953), doi:10.1103/RevModPhys.25.831).
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "square_well_compressibility",
    "square_well_second_virial",
    "square_well_third_virial",
]

Array = NDArray[np.float64]

_HARD = 2.0 * np.pi / 3.0
"""The second virial coefficient of hard spheres, b0."""


def square_well_second_virial(temperature: ArrayLike, range: float = 1.5) -> Array:
    r"""Return the second virial coefficient, :math:`B_2 = b_0 [1 - (\lambda^3 - 1) x]` [diameter^3].

    Parameters
    ----------
    temperature
        Temperature T*, above 0.
    range
        Reach lambda of the well [diameter].

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

    :math:`B_3 = b_0^2 (5 - c_1 x - c_2 x^2 - c_3 x^3) / 8` with :math:`c_1 = \lambda^6 - 18 \lambda^4 + 32 \lambda^3 -
    15`, :math:`c_2 = 2 \lambda^6 - 36 \lambda^4 + 32 \lambda^3 + 18 \lambda^2 - 16`, :math:`c_3 = 6 \lambda^6 -
    18 \lambda^4 + 18 \lambda^2 - 6`.

    Parameters
    ----------
    temperature
        Temperature T*, above 0.
    range
        Reach lambda of the well, from 1 to 2 [diameter].

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
