r"""The International Standard Atmosphere: layers of constant lapse rate from the ground to 80 km.

References
----------
ISO 2533:1975, Standard Atmosphere; ICAO Doc 7488/3 (1993), Manual of the ICAO Standard Atmosphere.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory.constants import STANDARD_GRAVITY
from atmosbox.theory.environment import environment_pressure, environment_temperature

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
    r"""Return the temperature of the International Standard Atmosphere.

    Parameters
    ----------
    height
        Geopotential height, -2 to 80 km [m].

    Returns
    -------
    ndarray
        Temperature [K].

    Raises
    ------
    ValueError
        If a height lies outside the standard.

    References
    ----------
    .. [1] ISO 2533:1975, Standard Atmosphere.

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
    r"""Return the pressure of the International Standard Atmosphere.

    Parameters
    ----------
    height
        Geopotential height, -2 to 80 km [m].

    Returns
    -------
    ndarray
        Pressure [Pa].

    Raises
    ------
    ValueError
        If a height lies outside the standard.

    Notes
    -----
    The standard's own gas constant, 287.05287 J/(kg K), is used, so that its tables are reproduced digit by digit.

    References
    ----------
    .. [1] ISO 2533:1975, Standard Atmosphere.

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
