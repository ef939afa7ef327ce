r"""Who leaves a liquid, and who stays: the energies of the molecules, above that of one at rest in the liquid.

Those that stay have thermal energies with the density of states of :mod:`atmosbox.theory.liquid_rate`, those that leave
the binding energy and what a molecule of vapour carries across a surface. Units are SI.
"""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory._water import BINDING, LIQUID_HEAT, VAPOR_HEAT, checked_positive
from atmosbox.theory.constants import BOLTZMANN

__all__ = ["LEAVING_FREEDOM", "leaving_energy_density", "staying_energy_density"]

LEAVING_FREEDOM: float = VAPOR_HEAT - 0.5
"""Energy that a molecule carries across the surface, in kT: 2 by flight, for the fast come oftener, 3/2 by rotation."""


def _mean_density(edges: ArrayLike, temperature: float, shape: float, least: float) -> FloatArray:
    from scipy import special  # loads slowly

    bounds = np.maximum(as_floats(edges) / BOLTZMANN - least, 0.0)
    warm = checked_positive(as_floats(temperature), "temperature")
    density: FloatArray = np.diff(special.gammainc(shape, bounds / warm)) / np.diff(as_floats(edges))
    return density


def leaving_energy_density(edges: ArrayLike, temperature: float) -> FloatArray:
    r"""Return which share of the molecules that leave a liquid has how much energy, per unit of energy.

    The binding energy :math:`\varphi` and a gamma variate, :math:`\varphi + kT\, \Gamma(2 + 3/2)`.

    Parameters
    ----------
    edges : (bin + 1,)
        Bounds of the bins over which the density is averaged [J].
    temperature
        Temperature of the liquid [K].

    Returns
    -------
    (bin,) ndarray
        Density [J^-1].

    Raises
    ------
    ValueError
        If the temperature is not positive.

    References
    ----------
    .. [1] Weisskopf, V. (1937), doi:10.1103/PhysRev.52.295.

    Examples
    --------
    At 20 degC none leaves with less than 94 zJ:

    >>> edges = np.array([0.0, 94e-21, 200e-21])
    >>> (leaving_energy_density(edges, 293.15) * np.diff(edges)).round(3)
    array([0., 1.])
    """
    return _mean_density(edges, temperature, LEAVING_FREEDOM, BINDING)


def staying_energy_density(edges: ArrayLike, temperature: float) -> FloatArray:
    r"""Return which share of the molecules in a liquid has how much thermal energy, per unit of energy.

    A gamma variate of the heat capacity, :math:`kT\, \Gamma(c_l / k)`.

    Parameters
    ----------
    edges : (bin + 1,)
        Bounds of the bins over which the density is averaged [J].
    temperature
        Temperature of the liquid [K].

    Returns
    -------
    (bin,) ndarray
        Density [J^-1].

    Raises
    ------
    ValueError
        If the temperature is not positive.

    Examples
    --------
    At 20 degC one in three thousand has as much as it takes to leave:

    >>> edges = np.array([0.0, 94e-21, 1000e-21])
    >>> round(1.0 / float(staying_energy_density(edges, 293.15)[1] * np.diff(edges)[1]), -3)
    3000.0
    """
    return _mean_density(edges, temperature, LIQUID_HEAT, 0.0)
