r"""Water vapour in the air: saturation, dewpoint, mixing ratio, relative humidity, virtual temperature.

A molecule of water is held in the liquid by one binding energy, :math:`\varphi`; it has the heat capacity 4 k as
vapour, at constant pressure, and 9.14 k as liquid. These three numbers give the latent heat and, by the law of Clausius
and Clapeyron, the vapour pressure. One pair of numbers is taken from measurement: 2.50084e6 J/kg and 611.2 Pa at 273.16
K. The vapour pressure of measured water (IAPWS) is here to compare with; no simulation uses it.

Names are those of MetPy. Temperatures are in K, pressures in Pa, mixing ratios in kg per kg of dry air, relative
humidities in parts of one.
"""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory import _water
from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory._water import (
    CRITICAL_TEMPERATURE,
    MASS_RATIO,
    checked_not_negative,
    checked_positive,
    checked_temperature,
)

__all__ = [
    "BINDING_TEMPERATURE", "LIQUID_HEAT_CAPACITY", "VAPOR_HEAT_CAPACITY", "WATER_MASS_RATIO", "density_temperature",
    "dewpoint", "mixing_ratio", "saturation_mixing_ratio", "saturation_vapor_pressure",
    "saturation_vapor_pressure_iapws", "vapor_pressure", "virtual_temperature",
]  # fmt: skip

VAPOR_HEAT_CAPACITY: float = _water.VAPOR_HEAT
"""Heat capacity of a molecule of vapour at constant pressure [k]."""
LIQUID_HEAT_CAPACITY: float = _water.LIQUID_HEAT
"""Heat capacity of a molecule of liquid water, 4219.4 J/(kg K) [k]."""
BINDING_TEMPERATURE: float = _water.BINDING
"""Binding energy of a molecule in liquid water over k [K]."""


def saturation_vapor_pressure(temperature: ArrayLike) -> FloatArray:
    r"""Return the pressure of the vapour over liquid water when as many molecules evaporate as condense [Pa]; 0 at 0 K.

    The law of Rankine and Kirchhoff (Ambaum 2020, doi:10.1002/qj.3899, equation 13), with :math:`T_t` = 273.16 K:

    .. math:: e_s = 611.2\,\mathrm{Pa}\, \exp\left[-\frac{\varphi}{k} \left(\frac{1}{T} - \frac{1}{T_t}\right)
              - \frac{c_l - c_{pv}}{k} \ln \frac{T}{T_t}\right] .

    Parameters
    ----------
    temperature
        Temperature [K]. Below 273.16 K the water is supercooled: there is no ice here.

    Raises
    ------
    ValueError
        If a temperature lies below 0 K or above the critical point of water, 647.096 K.

    Notes
    -----
    Compared with measured water (:func:`saturation_vapor_pressure_iapws`) it is too low: by 0.06 % at -10 degC, 0.20 %
    at 20, 0.44 % at 40 and 2.2 % at 100 degC, because real vapour is not an ideal gas, and 611.2 Pa is 0.07 % too low.
    MetPy 1.7 uses the same formula of the same paper, with 4.03 k for the vapour: their agreement to 0.03 % confirms
    neither.

    Examples
    --------
    In hPa, at -10, 0, 20 and 40 degC:

    >>> (saturation_vapor_pressure([263.15, 273.15, 293.15, 313.15]) / 100.0).round(2)
    array([ 2.86,  6.11, 23.35, 73.52])
    """
    return _water.saturation(checked_temperature(as_floats(temperature)))


def dewpoint(vapor_pressure: ArrayLike) -> FloatArray:
    """Return the temperature to which air must cool for its vapour to be saturated [K]; 0 K without any vapour.

    The inverse of :func:`saturation_vapor_pressure`, by Lambert's function (Romps 2017, doi:10.1175/JAS-D-17-0102.1).

    Parameters
    ----------
    vapor_pressure
        Vapour pressure e [Pa], at most that of the critical point.

    Examples
    --------
    >>> round(float(dewpoint(1935.0)) - 273.15, 2)
    17.00
    """
    e = checked_not_negative(as_floats(vapor_pressure), "vapor_pressure")
    most = float(_water.saturation(np.asarray(_water.CRITICAL_TEMPERATURE)))
    if np.any(e > most):
        raise ValueError(f"vapor_pressure must not exceed {most:.4g} Pa, that of the critical point of water.")
    return _water.dewpoint_of(e)


_CRITICAL_PRESSURE = 22.064e6
_COEFFICIENTS = np.array([-7.85951783, 1.84408259, -11.7866497, 22.6807411, -15.9618719, 1.80122502])
_EXPONENTS = np.array([1.0, 1.5, 3.0, 3.5, 4.0, 7.5])
_COLDEST = 233.15
"""Below about -40 degC water cannot be kept liquid, and there is no measurement to compare with [K]."""


def saturation_vapor_pressure_iapws(temperature: ArrayLike) -> FloatArray:
    r"""Return the saturation vapour pressure over liquid water by the formula of IAPWS, a fit to measurements [Pa].

    Equation 1 of the release SR1-86(1992) of the International Association for the Properties of Water and Steam,
    iapws.org/relguide/Supp-sat.html, by Wagner and Pruss (1993), doi:10.1063/1.555926. With
    :math:`\vartheta = 1 - T/T_c`, :math:`T_c` = 647.096 K and :math:`p_c` = 22.064 MPa,

    .. math:: \ln \frac{e_s}{p_c} = \frac{T_c}{T} \left(a_1 \vartheta + a_2 \vartheta^{1.5} + a_3 \vartheta^3
              + a_4 \vartheta^{3.5} + a_5 \vartheta^4 + a_6 \vartheta^{7.5}\right) .

    The release covers 273.16 K to the critical point. Below 273.16 K this is the same formula extended: at -20 degC it
    is 0.08 %, at -40 degC 0.7 % above that of Murphy and Koop (2005), doi:10.1256/qj.04.94, for supercooled water.

    Parameters
    ----------
    temperature
        Temperature [K].

    Raises
    ------
    ValueError
        If a temperature lies below 233.15 K, where water freezes at once, or above the critical point, 647.096 K.

    Examples
    --------
    Water boils at 99.97 degC, where the vapour presses with one standard atmosphere:

    >>> round(float(saturation_vapor_pressure_iapws(373.1243)))
    101325
    """
    t = as_floats(temperature)
    if not np.all((t >= _COLDEST) & (t <= CRITICAL_TEMPERATURE)):
        raise ValueError(
            f"temperature must lie from {_COLDEST} K, below which no water stays liquid, to the critical point of "
            f"water, {CRITICAL_TEMPERATURE} K."
        )
    powers = (1.0 - t / CRITICAL_TEMPERATURE)[..., np.newaxis] ** _EXPONENTS
    pressure: FloatArray = _CRITICAL_PRESSURE * np.exp(CRITICAL_TEMPERATURE / t * (powers @ _COEFFICIENTS))
    return pressure


WATER_MASS_RATIO: float = MASS_RATIO
"""Mass of a molecule of water over that of air: mixing ratio per molecule of water and molecule of air [1]."""


def vapor_pressure(pressure: ArrayLike, mixing_ratio: ArrayLike) -> FloatArray:
    r"""Return the partial pressure of water vapour in air, :math:`p r / (\epsilon + r)` [Pa].

    Parameters
    ----------
    pressure, mixing_ratio
        Pressure of the air p [Pa], and mass of vapour per mass of dry air r [kg kg^-1].

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
    r"""Return the mass of vapour per mass of dry air, :math:`\epsilon e / (p - e)` [kg kg^-1].

    Parameters
    ----------
    vapor_pressure, pressure
        Vapour pressure e, and pressure of the air with its vapour p [Pa].

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
    r"""Return the mass of vapour per mass of dry air at saturation, :math:`\epsilon e_s / (p - e_s)` [kg kg^-1].

    Parameters
    ----------
    pressure, temperature
        Pressure of the air with its vapour [Pa], and temperature [K].

    Raises
    ------
    ValueError
        If water of that temperature boils at that pressure.

    Examples
    --------
    Grams per kilogram at 20 degC:

    >>> round(1000.0 * float(saturation_mixing_ratio(1000e2, 293.15)), 1)
    14.9
    """
    return mixing_ratio(saturation_vapor_pressure(temperature), pressure)


def density_temperature(temperature: ArrayLike, vapor: ArrayLike, liquid: ArrayLike = 0.0) -> FloatArray:
    r"""Return the temperature at which dry air would be as dense as air with this vapour and this liquid [K].

    :math:`T (1 + r/\epsilon) / (1 + r + l)`: vapour makes air lighter, and a cloud carries the weight of its water
    (Emanuel 1994, Atmospheric Convection, equation 4.3.6). Without liquid it is the virtual temperature.

    Parameters
    ----------
    temperature
        Temperature [K].
    vapor, liquid
        Mass per mass of dry air [kg kg^-1].

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
    r"""Return the temperature at which dry air of the same pressure is as dense as this air, which has no liquid [K].

    :math:`T (1 + r / \epsilon) / (1 + r)`: vapour makes air lighter (Emanuel 1994, Atmospheric Convection, chapter 4).

    Parameters
    ----------
    temperature, mixing_ratio
        Temperature T [K], and mass of vapour per mass of dry air r [kg kg^-1].

    Examples
    --------
    Fifteen grams of vapour add 2.7 K:

    >>> round(float(virtual_temperature(293.15, 0.015)), 1)
    295.8
    """
    t = checked_positive(as_floats(temperature), "temperature")
    r = checked_not_negative(as_floats(mixing_ratio), "mixing_ratio")
    return density_temperature(t, r)
