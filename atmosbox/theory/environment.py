r"""The environment of a parcel: temperature, pressure and height of an atmosphere at rest.

Hydrostatic balance :math:`dp/dz = -\rho g` with the ideal gas law. Heights are geopotential, gravity does not
change with height, units are SI.

References
----------
ISO 2533:1975, Standard Atmosphere.
"""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory.constants import DRY_AIR, GAS_CONSTANT, STANDARD_GRAVITY

DRY_AIR_GAS_CONSTANT: float = GAS_CONSTANT / DRY_AIR.molar_mass
"""Gas constant of dry air per mass [J kg^-1 K^-1]."""


def environment_temperature(height: ArrayLike, surface_temperature: ArrayLike, lapse_rate: ArrayLike) -> FloatArray:
    r"""Return the temperature of air with a constant lapse rate, :math:`T_0 - \Gamma z`.

    Parameters
    ----------
    height
        Height above the surface [m].
    surface_temperature
        Temperature at the surface [K].
    lapse_rate
        Fall of the temperature with height [K m^-1]; negative in an inversion.

    Returns
    -------
    ndarray
        Temperature [K].

    Raises
    ------
    ValueError
        If the temperature at a height would not be above absolute zero.

    Examples
    --------
    >>> float(environment_temperature(2000.0, 288.0, 6.5e-3))
    275.0
    """
    temperature = as_floats(surface_temperature) - as_floats(lapse_rate) * as_floats(height)
    if not np.all(temperature > 0.0):
        raise ValueError("height lies where this lapse rate reaches absolute zero, above the atmosphere.")
    return temperature


def environment_pressure(
    height: ArrayLike,
    surface_temperature: ArrayLike,
    surface_pressure: ArrayLike,
    lapse_rate: ArrayLike,
    gravity: ArrayLike = STANDARD_GRAVITY,
    specific_gas_constant: ArrayLike = DRY_AIR_GAS_CONSTANT,
) -> FloatArray:
    r"""Return the pressure at a height in air with a constant lapse rate.

    :math:`p_0 (1 - \Gamma z / T_0)^{g / R \Gamma}`. Without a lapse rate it is the barometric law
    :math:`p_0 e^{-gz/RT_0}`.

    Parameters
    ----------
    height
        Height above the surface [m].
    surface_temperature
        Temperature at the surface [K].
    surface_pressure
        Pressure at the surface [Pa].
    lapse_rate
        Fall of the temperature with height [K m^-1]; zero and negative are allowed.
    gravity
        Acceleration of gravity [m s^-2].
    specific_gas_constant
        Gas constant of the air per mass [J kg^-1 K^-1].

    Returns
    -------
    ndarray
        Pressure [Pa].

    Raises
    ------
    ValueError
        If the temperature at a height would not be above absolute zero.

    References
    ----------
    .. [1] ISO 2533:1975, Standard Atmosphere.

    Examples
    --------
    At the height where half of the air lies below, in hPa:

    >>> round(float(environment_pressure(5500.0, 288.15, 101325.0, 6.5e-3)) / 100.0)
    505
    """
    environment_temperature(height, surface_temperature, lapse_rate)
    z, t0 = as_floats(height), as_floats(surface_temperature)
    cooling = np.asarray(as_floats(lapse_rate) * z / t0)
    stretch = np.divide(-np.log1p(-cooling), cooling, out=np.ones_like(cooling), where=cooling != 0.0)
    depth = as_floats(gravity) * z / (as_floats(specific_gas_constant) * t0)
    pressure: FloatArray = as_floats(surface_pressure) * np.exp(-depth * stretch)
    return pressure


def height_of_pressure(
    pressure: ArrayLike,
    surface_temperature: ArrayLike,
    surface_pressure: ArrayLike,
    lapse_rate: ArrayLike,
    gravity: ArrayLike = STANDARD_GRAVITY,
    specific_gas_constant: ArrayLike = DRY_AIR_GAS_CONSTANT,
) -> FloatArray:
    r"""Return the height at which air with a constant lapse rate has a pressure.

    The inverse of :func:`environment_pressure`.

    Parameters
    ----------
    pressure
        Pressure [Pa], above zero.
    surface_temperature
        Temperature at the surface [K].
    surface_pressure
        Pressure at the surface [Pa].
    lapse_rate
        Fall of the temperature with height [K m^-1]; zero and negative are allowed.
    gravity
        Acceleration of gravity [m s^-2].
    specific_gas_constant
        Gas constant of the air per mass [J kg^-1 K^-1].

    Returns
    -------
    ndarray
        Height above the surface [m].

    References
    ----------
    .. [1] ISO 2533:1975, Standard Atmosphere.

    Examples
    --------
    >>> round(float(height_of_pressure(50000.0, 288.15, 101325.0, 6.5e-3)))
    5574
    """
    fall = np.log(as_floats(pressure) / as_floats(surface_pressure))
    per_kelvin = as_floats(specific_gas_constant) / as_floats(gravity)
    cooling = np.asarray(as_floats(lapse_rate) * per_kelvin * fall)
    stretch = np.divide(np.expm1(cooling), cooling, out=np.ones_like(cooling), where=cooling != 0.0)
    height: FloatArray = -as_floats(surface_temperature) * per_kelvin * fall * stretch
    return height
