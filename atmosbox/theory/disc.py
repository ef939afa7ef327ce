r"""Discs: the gas of a two-dimensional scene, with all centres and velocities in one plane.

The packing fraction is the share of the area covered, :math:`\eta = \pi n \sigma^2 / 4` with n molecules per
area.
"""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats

FREEZING_PACKING_FRACTION_DISCS = 0.700
"""Packing fraction above which discs begin to order (Bernard & Krauth 2011, doi:10.1103/PhysRevLett.107.155704)."""


def checked_packing_fraction_discs(packing_fraction: ArrayLike) -> FloatArray:
    """Return the packing fractions as floats, or raise ``ValueError`` where the equation of state does not hold."""
    eta = as_floats(packing_fraction)
    if not np.all((eta >= 0.0) & (eta < 1.0)):
        raise ValueError("packing_fraction must lie in [0, 1) for the henderson equation of state.")
    return eta


def packing_fraction_discs(number_density: ArrayLike, diameter: ArrayLike) -> FloatArray:
    r"""Return the share of the area that discs cover, :math:`\eta = \pi n \sigma^2 / 4`.

    Parameters
    ----------
    number_density
        Molecules per area [length^-2].
    diameter
        Diameter of a disc [length].

    Returns
    -------
    ndarray
        Packing fraction [1].

    Examples
    --------
    Discs in the closest packing cover nine tenths of the plane:

    >>> round(float(packing_fraction_discs(2.0 / 3.0**0.5, 1.0)), 4)
    0.9069
    """
    return np.pi / 4.0 * as_floats(number_density) * as_floats(diameter) ** 2


def contact_value_discs(packing_fraction: ArrayLike) -> FloatArray:
    r"""Return the pair distribution of discs at contact, :math:`g(\sigma) = (Z - 1) / (2 \eta)`.

    Parameters
    ----------
    packing_fraction
        Share of the area covered [1].

    Returns
    -------
    ndarray
        Pair distribution at contact [1].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    References
    ----------
    .. [1] Henderson, D. (1975), doi:10.1080/00268977500102511.

    Examples
    --------
    >>> round(float(contact_value_discs(0.3)), 4)
    1.773
    """
    eta = checked_packing_fraction_discs(packing_fraction)
    return (1.0 - 7.0 * eta / 16.0) / (1.0 - eta) ** 2


def compressibility_factor_discs(packing_fraction: ArrayLike) -> FloatArray:
    r"""Return the compressibility factor of discs, their pressure over that of points: :math:`Z = P / (n k T)`.

    By Henderson [1]_, :math:`Z = (1 + \eta^2/8) / (1 - \eta)^2`.

    Parameters
    ----------
    packing_fraction
        Share of the area covered [1].

    Returns
    -------
    ndarray
        Compressibility factor [1].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    References
    ----------
    .. [1] Henderson, D. (1975), doi:10.1080/00268977500102511.

    Examples
    --------
    >>> round(float(compressibility_factor_discs(0.5)), 6)
    4.125
    """
    return 1.0 + 2.0 * as_floats(packing_fraction) * contact_value_discs(packing_fraction)


def inverse_compressibility_discs(packing_fraction: ArrayLike) -> FloatArray:
    r"""Return the stiffness of a plane gas against compression at constant temperature, :math:`d(\eta Z) / d\eta`.

    It is :math:`(\partial P / \partial n)_T / kT = (1 + \eta + 3\eta^2/8 - \eta^3/8) / (1 - \eta)^3` [1]_, and 1 for
    an ideal gas.

    Parameters
    ----------
    packing_fraction
        Share of the area covered [1].

    Returns
    -------
    ndarray
        Reduced inverse compressibility [1].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    References
    ----------
    .. [1] Henderson, D. (1975), doi:10.1080/00268977500102511.

    Examples
    --------
    Discs that cover half of the plane are thirteen times as stiff as points:

    >>> round(float(inverse_compressibility_discs(0.5)), 3)
    12.625
    """
    eta = checked_packing_fraction_discs(packing_fraction)
    return (1.0 + eta + 0.375 * eta**2 - 0.125 * eta**3) / (1.0 - eta) ** 3


def gas_pressure_discs(number_density: ArrayLike, kT: ArrayLike, diameter: ArrayLike = 0.0) -> FloatArray:
    r"""Return the pressure of a gas of discs, a force per length, :math:`P = n k T Z`.

    Parameters
    ----------
    number_density
        Molecules per area [length^-2].
    kT
        Temperature as an energy [energy].
    diameter
        Diameter of a disc [length]; zero for an ideal gas.

    Returns
    -------
    ndarray
        Pressure [energy length^-2].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    References
    ----------
    .. [1] Henderson, D. (1975), doi:10.1080/00268977500102511.

    Examples
    --------
    Where they cover a tenth of the plane, the pressure of discs is 24 % higher than that of points:

    >>> n = 0.1 * 4.0 / np.pi
    >>> round(float(gas_pressure_discs(n, 1.0, 1.0) / gas_pressure_discs(n, 1.0)), 3)
    1.236
    """
    density = as_floats(number_density)
    packing = packing_fraction_discs(density, diameter)
    return density * as_floats(kT) * compressibility_factor_discs(packing)


def collision_rate_discs(
    number_density: ArrayLike,
    diameter: ArrayLike,
    kT: ArrayLike,
    mass: ArrayLike,
) -> FloatArray:
    r"""Return the collision rate of one disc, :math:`\nu = 2 n \sigma g(\sigma) \sqrt{\pi k T / m}`.

    Parameters
    ----------
    number_density
        Molecules per area [length^-2].
    diameter
        Diameter of a disc [length].
    kT
        Temperature as an energy [energy].
    mass
        Mass of a disc [mass].

    Returns
    -------
    ndarray
        Collisions per disc and time [time^-1]; a gas of N discs has N/2 times as many.

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    References
    ----------
    .. [1] Henderson, D. (1975), doi:10.1080/00268977500102511.

    Examples
    --------
    In a thin gas of discs the rate is that of points, times the width of the strip that a disc sweeps:

    >>> round(float(collision_rate_discs(1e-6, 1.0, 1.0, 1.0) * 1e6), 4)
    3.5449
    """
    contact = contact_value_discs(packing_fraction_discs(number_density, diameter))
    sweep = 2.0 * as_floats(number_density) * as_floats(diameter)
    rate: FloatArray = sweep * contact * np.sqrt(np.pi * as_floats(kT) / as_floats(mass))
    return rate
