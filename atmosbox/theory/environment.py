r"""The environment of a parcel: an atmosphere at rest of constant lapse rate, and the standard atmosphere.

Hydrostatic balance :math:`dp/dz = -\rho g` with the ideal gas law. Heights are geopotential, gravity does not change
with height, units are SI. The International Standard Atmosphere (ISO 2533:1975; ICAO Doc 7488/3, 1993) has layers of
constant lapse rate from the ground to 80 km.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory.constants import DRY_AIR, GAS_CONSTANT, STANDARD_GRAVITY

__all__ = [
    "DRY_AIR_GAS_CONSTANT",
    "environment_pressure",
    "environment_temperature",
    "height_of_pressure",
    "isa_pressure",
    "isa_temperature",
]

DRY_AIR_GAS_CONSTANT: float = GAS_CONSTANT / DRY_AIR.molar_mass
"""Gas constant of dry air per mass [J kg^-1 K^-1]."""


def environment_temperature(height: ArrayLike, surface_temperature: ArrayLike, lapse_rate: ArrayLike) -> FloatArray:
    r"""Return the temperature of air with a constant lapse rate, :math:`T_0 - \Gamma z` [K].

    Parameters
    ----------
    height, surface_temperature
        Height above the surface [m], and temperature at the surface [K].
    lapse_rate
        Fall of the temperature with height [K m^-1]; negative in an inversion.

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
    r"""Return the pressure at a height in air with a constant lapse rate [Pa].

    :math:`p_0 (1 - \Gamma z / T_0)^{g / R \Gamma}` (ISO 2533:1975, Standard Atmosphere). Without a lapse rate it is the
    barometric law :math:`p_0 e^{-gz/RT_0}`.

    Parameters
    ----------
    height
        Height above the surface [m].
    surface_temperature, surface_pressure
        Temperature [K] and pressure [Pa] at the surface.
    lapse_rate
        Fall of the temperature with height [K m^-1]; zero and negative are allowed.
    gravity, specific_gas_constant
        Acceleration of gravity [m s^-2], and gas constant of the air per mass [J kg^-1 K^-1].

    Raises
    ------
    ValueError
        If the temperature at a height would not be above absolute zero.

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
    """Return the height at which air with a constant lapse rate has a pressure [m].

    The inverse of :func:`environment_pressure`.

    Parameters
    ----------
    pressure
        Pressure [Pa], above zero.
    surface_temperature, surface_pressure, lapse_rate, gravity, specific_gas_constant
        As for :func:`environment_pressure`.

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


_ISA_GAS_CONSTANT = 287.05287
_ISA_LOWEST, _ISA_HIGHEST = -2000.0, 80000.0
_ISA_BASE = np.array([0.0, 11000.0, 20000.0, 32000.0, 47000.0, 51000.0, 71000.0])
_ISA_LAPSE_RATE = np.array([6.5e-3, 0.0, -1.0e-3, -2.8e-3, 0.0, 2.8e-3, 2.0e-3])


def _isa_surfaces() -> tuple[FloatArray, FloatArray]:
    """Return temperature and pressure at the bases of the standard atmosphere's layers, ground first."""
    temperature, pressure = [288.15], [101325.0]
    for base, top, lapse_rate in zip(_ISA_BASE[:-1], _ISA_BASE[1:], _ISA_LAPSE_RATE[:-1], strict=True):
        below = temperature[-1], pressure[-1], lapse_rate, STANDARD_GRAVITY, _ISA_GAS_CONSTANT
        pressure.append(float(environment_pressure(top - base, *below)))
        temperature.append(float(environment_temperature(top - base, temperature[-1], lapse_rate)))
    return as_floats(temperature), as_floats(pressure)


_ISA_TEMPERATURE, _ISA_PRESSURE = _isa_surfaces()


def _isa_layer(height: FloatArray) -> NDArray[np.intp]:
    """Return the number of the layer of the standard atmosphere in which each height lies."""
    if not np.all((height >= _ISA_LOWEST) & (height <= _ISA_HIGHEST)):
        limits = f"{_ISA_LOWEST:.0f} m and {_ISA_HIGHEST:.0f} m"
        raise ValueError(f"height must lie between {limits} in the standard atmosphere.")
    return np.maximum(np.searchsorted(_ISA_BASE, height, side="right") - 1, 0)


def isa_temperature(height: ArrayLike) -> FloatArray:
    """Return the temperature of the International Standard Atmosphere, ISO 2533:1975 [K].

    Parameters
    ----------
    height
        Geopotential height, -2 to 80 km [m].

    Examples
    --------
    The ground, the tropopause, the stratopause:

    >>> [round(float(t), 2) for t in isa_temperature([0.0, 11e3, 50e3])]
    [288.15, 216.65, 270.65]
    """
    z = as_floats(height)
    layer = _isa_layer(z)
    return environment_temperature(z - _ISA_BASE[layer], _ISA_TEMPERATURE[layer], _ISA_LAPSE_RATE[layer])


def isa_pressure(height: ArrayLike) -> FloatArray:
    """Return the pressure of the International Standard Atmosphere, ISO 2533:1975 [Pa].

    The standard's own gas constant, 287.05287 J/(kg K), is used, so that its tables are reproduced digit by digit.

    Parameters
    ----------
    height
        Geopotential height, -2 to 80 km [m].

    Examples
    --------
    The tropopause, in hPa:

    >>> round(float(isa_pressure(11000.0)) / 100.0, 3)
    226.32
    """
    z = as_floats(height)
    layer = _isa_layer(z)
    return environment_pressure(
        z - _ISA_BASE[layer],
        _ISA_TEMPERATURE[layer],
        _ISA_PRESSURE[layer],
        _ISA_LAPSE_RATE[layer],
        STANDARD_GRAVITY,
        _ISA_GAS_CONSTANT,
    )
