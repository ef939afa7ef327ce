r"""How much water vapour is in the air: vapour pressure, mixing ratio, relative humidity, virtual temperature.

Names are those of MetPy. Temperatures are in K, pressures in Pa, mixing ratios in kg per kg of dry air, relative
humidities in parts of one.

References
----------
Emanuel, K. A. (1994), Atmospheric Convection, chapter 4.
"""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory import saturation
from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory._water import MASS_RATIO, checked_not_negative, checked_positive

WATER_MASS_RATIO: float = MASS_RATIO
"""Mass of a molecule of water over that of air: mixing ratio per molecule of water and molecule of air [1]."""


def vapor_pressure(pressure: ArrayLike, mixing_ratio: ArrayLike) -> FloatArray:
    r"""Return the partial pressure of water vapour in air, :math:`p r / (\epsilon + r)`.

    Parameters
    ----------
    pressure
        Pressure of the air p [Pa].
    mixing_ratio
        Mass of vapour per mass of dry air r [kg kg^-1].

    Returns
    -------
    ndarray
        Vapour pressure [Pa].

    Raises
    ------
    ValueError
        If a pressure is not positive or a mixing ratio is negative.

    Examples
    --------
    >>> round(float(vapor_pressure(1000e2, 0.010)))
    1582
    """
    p = checked_positive(as_floats(pressure), "pressure")
    r = checked_not_negative(as_floats(mixing_ratio), "mixing_ratio")
    e: FloatArray = p * r / (MASS_RATIO + r)
    return e


def mixing_ratio(vapor_pressure: ArrayLike, pressure: ArrayLike) -> FloatArray:
    r"""Return the mass of vapour per mass of dry air, :math:`\epsilon e / (p - e)`.

    Parameters
    ----------
    vapor_pressure
        Vapour pressure e [Pa].
    pressure
        Pressure of the air, with its vapour, p [Pa].

    Returns
    -------
    ndarray
        Mixing ratio [kg kg^-1].

    Raises
    ------
    ValueError
        If a vapour pressure is negative, or not below the pressure, which leaves no air.

    Examples
    --------
    >>> round(float(mixing_ratio(1582.0, 1000e2)), 4)
    0.0100
    """
    e = checked_not_negative(as_floats(vapor_pressure), "vapor_pressure")
    p = checked_positive(as_floats(pressure), "pressure")
    if not np.all(e < p):
        raise ValueError(
            "vapor_pressure must be below pressure: otherwise water of that temperature boils, and there is no air."
        )
    ratio: FloatArray = MASS_RATIO * e / (p - e)
    return ratio


def saturation_mixing_ratio(pressure: ArrayLike, temperature: ArrayLike) -> FloatArray:
    r"""Return the mass of vapour per mass of dry air at saturation, :math:`\epsilon e_s / (p - e_s)`.

    Parameters
    ----------
    pressure
        Pressure of the air, with its vapour [Pa].
    temperature
        Temperature [K].

    Returns
    -------
    ndarray
        Saturation mixing ratio [kg kg^-1].

    Raises
    ------
    ValueError
        If a temperature lies outside the range of :func:`saturation_vapor_pressure`, or water of that
        temperature boils at that pressure.

    Examples
    --------
    Grams per kilogram at 20 degC:

    >>> round(1000.0 * float(saturation_mixing_ratio(1000e2, 293.15)), 1)
    14.9
    """
    return mixing_ratio(saturation.saturation_vapor_pressure(temperature), pressure)


def density_temperature(temperature: ArrayLike, vapor: ArrayLike, liquid: ArrayLike = 0.0) -> FloatArray:
    r"""Return the temperature at which dry air would be as dense as air with this vapour and this liquid.

    :math:`T (1 + r/\epsilon) / (1 + r + l)` [1]_: vapour makes air lighter, and a cloud carries the weight of its
    water. Without liquid it is the virtual temperature.

    Parameters
    ----------
    temperature
        Temperature [K].
    vapor, liquid
        Mass per mass of dry air [kg kg^-1].

    Returns
    -------
    ndarray
        Density temperature [K].

    References
    ----------
    .. [1] Emanuel, K. A. (1994), Atmospheric Convection, equation 4.3.6.

    Examples
    --------
    Ten grams of liquid compensate three kelvin of warmth:

    >>> [round(float(density_temperature(270.0, 0.004, liquid)), 1) for liquid in (0.0, 0.010)]
    [270.7, 268.0]
    """
    r = as_floats(vapor)
    dense: FloatArray = as_floats(temperature) * (1.0 + r / MASS_RATIO) / (1.0 + r + as_floats(liquid))
    return dense


def virtual_temperature(temperature: ArrayLike, mixing_ratio: ArrayLike) -> FloatArray:
    r"""Return the temperature at which dry air of the same pressure is as dense as this air, which has no liquid.

    :math:`T (1 + r / \epsilon) / (1 + r)`: vapour makes air lighter.

    Parameters
    ----------
    temperature
        Temperature T [K].
    mixing_ratio
        Mass of vapour per mass of dry air r [kg kg^-1].

    Returns
    -------
    ndarray
        Virtual temperature [K].

    Raises
    ------
    ValueError
        If a temperature is not positive or a mixing ratio is negative.

    References
    ----------
    .. [1] Emanuel, K. A. (1994), Atmospheric Convection, equation 4.3.6.

    Examples
    --------
    Fifteen grams of vapour add 2.7 K:

    >>> round(float(virtual_temperature(293.15, 0.015)), 1)
    295.8
    """
    t = checked_positive(as_floats(temperature), "temperature")
    r = checked_not_negative(as_floats(mixing_ratio), "mixing_ratio")
    return density_temperature(t, r)
