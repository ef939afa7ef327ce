r"""A column of ideal gas in gravity: its density decreases with height, and in equilibrium it is isothermal.

A finite column of depth H is governed by one number, :math:`a = m g H / kT`, its depth in scale heights. The
centres of spheres can come no nearer to a wall than their radius: for them the column begins one radius above the floor
and ends one radius below the ceiling.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats

__all__ = [
    "barometric_density",
    "barometric_pressure",
    "column_floor_ratio",
    "column_mean_height",
    "column_scale_height",
]


def _depth_in_scale_heights(depth: ArrayLike, kT: ArrayLike, mass: ArrayLike, gravity: ArrayLike) -> FloatArray:
    return as_floats(mass) * as_floats(gravity) * as_floats(depth) / as_floats(kT)


def barometric_pressure(
    height: ArrayLike, surface_pressure: ArrayLike, kT: ArrayLike, mass: ArrayLike, gravity: ArrayLike
) -> FloatArray:
    r"""Return the pressure of an isothermal atmosphere, :math:`p_0\, e^{-mgz/kT}`, in the unit of the surface pressure.

    Parameters
    ----------
    height, surface_pressure
        Height above the surface [length], and pressure at the surface [pressure].
    kT, mass, gravity
        Temperature as an energy [energy], mass of a molecule [mass], acceleration of gravity [length time^-2].

    Examples
    --------
    Half of an isothermal atmosphere lies above ln 2 scale heights:

    >>> round(float(barometric_pressure(np.log(2.0), 1000.0, 1.0, 1.0, 1.0)), 6)
    500.0
    """
    pressure: FloatArray = as_floats(surface_pressure) * np.exp(-_depth_in_scale_heights(height, kT, mass, gravity))
    return pressure


def column_floor_ratio(depth: ArrayLike, kT: ArrayLike, mass: ArrayLike, gravity: ArrayLike) -> FloatArray:
    """Return the density at the floor of a closed column over its mean density, :math:`a / (1 - e^{-a})`.

    Parameters
    ----------
    depth, kT, mass, gravity
        As for :func:`column_mean_height`.

    Examples
    --------
    >>> round(float(column_floor_ratio(2.0, 1.0, 1.0, 1.0)), 4)
    2.313
    """
    a = _depth_in_scale_heights(depth, kT, mass, gravity)
    return np.divide(a, -np.expm1(-a), out=np.ones_like(a), where=a != 0.0)


def column_mean_height(depth: ArrayLike, kT: ArrayLike, mass: ArrayLike, gravity: ArrayLike) -> FloatArray:
    r"""Return the mean height of the molecules of a closed column, :math:`H\, [1/a - 1/(e^a - 1)]` [length].

    The depth of the column in scale heights is :math:`a = m g H / kT`.

    Parameters
    ----------
    depth, kT
        Depth H of the column [length], and temperature as an energy [energy].
    mass, gravity
        Mass of a molecule [mass], and acceleration of gravity [length time^-2]; zero is allowed.

    Examples
    --------
    Half way up without gravity, one scale height in a very deep column:

    >>> float(column_mean_height(2.0, 1.0, 1.0, 0.0)), float(column_mean_height(1000.0, 1.0, 1.0, 1.0))
    (1.0, 1.0)
    """
    a = _depth_in_scale_heights(depth, kT, mass, gravity)
    flat = np.abs(a) < 0.05
    steep = np.where(flat, 1.0, a)
    series = 0.5 - a / 12.0 + a**3 / 720.0 - a**5 / 30240.0
    closed = 1.0 / steep - np.exp(-steep) / -np.expm1(-steep)
    mean: FloatArray = as_floats(depth) * np.where(flat, series, closed)
    return mean


def column_scale_height(mean_height: float, depth: float) -> float:
    """Return the scale height kT / m g of a closed column from the mean height of its molecules above the floor.

    It is infinite if the mean height is half the depth or more. All three have the same unit of length.

    Examples
    --------
    >>> mean = float(column_mean_height(25.0, 8.4, 1.0, 1.0))
    >>> round(mean, 3), round(column_scale_height(mean, 25.0), 9)
    (7.057, 8.4)
    """
    from scipy.optimize import brentq  # loads slowly

    def off(scale_height: float) -> float:
        return float(column_mean_height(depth, scale_height, 1.0, 1.0)) - mean_height

    low, high = 1e-3 * mean_height, 1e4 * depth
    return float(brentq(off, low, high, rtol=1e-14)) if off(low) < 0.0 < off(high) else math.inf


def barometric_density(
    height: ArrayLike, molecules_per_area: float, bottom: float, top: float, kT: float, mass: float, gravity: float
) -> FloatArray:
    """Return the number density at each height of a closed isothermal column of ideal gas [length^-3].

    The barometric law, with the constant that gives the column its number of molecules.

    Parameters
    ----------
    height
        Heights [length]; outside the column the density is zero.
    molecules_per_area
        Molecules above each unit of area [length^-2].
    bottom, top
        Lowest and highest position of a molecule's centre [length].
    kT, mass, gravity
        As for :func:`column_mean_height`.

    Examples
    --------
    >>> barometric_density([0.0, 1.0, 2.0, 3.0], 10.0, 0.0, 2.0, 1.0, 1.0, 1.0).round(3)
    array([11.565,  4.255,  1.565,  0.   ])
    """
    z, depth = as_floats(height), top - bottom
    inside = (z >= bottom) & (z <= top)
    floor = molecules_per_area / depth * column_floor_ratio(depth, kT, mass, gravity)
    above = np.where(inside, z - bottom, 0.0)
    density: FloatArray = np.where(inside, barometric_pressure(above, floor, kT, mass, gravity), 0.0)
    return density
