"""The analytic sounding of Weisman and Klemp for the environment of a thunderstorm."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import SettingError
from atmosbox.scene.sounding.profile import Sounding
from atmosbox.theory.constants import DRY_AIR, GAS_CONSTANT, STANDARD_GRAVITY, WATER

__all__ = ["weisman_klemp"]

_DRY_GAS = GAS_CONSTANT / DRY_AIR.molar_mass  # J kg-1 K-1
_HEAT = 3.5 * _DRY_GAS  # J kg-1 K-1, at constant pressure
_EPSILON = WATER.molar_mass / DRY_AIR.molar_mass
_REFERENCE = 1000e2  # Pa, of potential temperature
_LEVELS = 65  # every 250 m
_TOP = 16e3  # m
_STEPS = 25  # of the integration, between two levels

Floats = NDArray[np.float64]


def weisman_klemp(
    mixing_ratio: float = 0.014,
    surface_pressure: float = 1000e2,
    surface_potential_temperature: float = 300.0,
    tropopause_height: float = 12e3,
    tropopause_potential_temperature: float = 343.0,
    tropopause_temperature: float = 213.0,
) -> Sounding:
    r"""Return the analytic sounding of Weisman and Klemp, in which many simulated storms begin [1]_.

    Below the tropopause, with s = (z / z_tr)^(5/4), the potential temperature is theta_0 + (theta_tr - theta_0) s
    and the relative humidity 1 - 3 s / 4; above it they are theta_tr exp(g (z - z_tr) / (c_p T_tr)) and 1/4.
    Near the ground the mixing ratio is constant; of all parameters it changes CAPE most.

    Parameters
    ----------
    mixing_ratio
        The largest mixing ratio of vapour, 0.011 to 0.016 in the paper [kg kg-1].
    surface_pressure
        Pressure at the ground [Pa].
    surface_potential_temperature
        theta_0 at the ground; at a surface pressure of 1000 hPa it is the temperature there [K].
    tropopause_height, tropopause_potential_temperature, tropopause_temperature
        z_tr [m], theta_tr [K] and T_tr [K].

    Returns
    -------
    Sounding
        65 levels, every 250 m up to 16 km, with their heights.

    Raises
    ------
    SettingError
        If a number is not finite or outside the limits.
    SoundingError
        If the numbers, each possible by itself, do not describe an atmosphere together.

    Notes
    -----
    The hydrostatic equation is that of the Exner function, d pi / dz = -g / (c_p theta_v), with the virtual potential
    temperature of the same sounding, integrated by the midpoint rule in steps of 10 m. Saturation is with respect to
    liquid water at all temperatures and follows Bolton's formula, whose inverse gives the dewpoint [2]_. In hydrostatic
    balance, 343 K at 12 km is a temperature of 217 K, not quite the T_tr of 213 K, which only sets the slope above.

    The paper's own measure of CAPE gives about 2200 J/kg for 14 g/kg. MetPy's ``surface_based_cape_cin`` gives
    1880 J/kg, and a CIN of -48 J/kg.

    References
    ----------
    .. [1] M. L. Weisman and J. B. Klemp, The dependence of numerically simulated convective storms on vertical wind
       shear and buoyancy, Mon. Wea. Rev. 110, 504 (1982),
       https://doi.org/10.1175/1520-0493(1982)110<0504:TDONSC>2.0.CO;2.
    .. [2] D. Bolton, The computation of equivalent potential temperature, Mon. Wea. Rev. 108, 1046 (1980), eqs. 10
       and 11, https://doi.org/10.1175/1520-0493(1980)108<1046:TCOEPT>2.0.CO;2.

    Examples
    --------
    Warm and moist at the ground:

    >>> weisman_klemp()
    <Sounding Weisman and Klemp, 14 g/kg: 65 levels from 1000 hPa, 26.85 degC to 107.878 hPa, -55.08 degC>
    """
    given = {
        "mixing_ratio": mixing_ratio,
        "surface_pressure": surface_pressure,
        "surface_potential_temperature": surface_potential_temperature,
        "tropopause_height": tropopause_height,
        "tropopause_potential_temperature": tropopause_potential_temperature,
        "tropopause_temperature": tropopause_temperature,
    }
    for name, value in given.items():
        low, high, unit = _LIMITS[name]
        if not low <= value <= high:  # also true for NaN
            raise SettingError(name, value, "is not what the formula is for", f"give {low:g} to {high:g} {unit}")
    height = np.linspace(0.0, _TOP, (_LEVELS - 1) * _STEPS + 1)
    share = (np.minimum(height, tropopause_height) / tropopause_height) ** 1.25
    theta = surface_potential_temperature + (tropopause_potential_temperature - surface_potential_temperature) * share
    above = np.maximum(height - tropopause_height, 0.0)
    theta *= np.exp(STANDARD_GRAVITY * above / (_HEAT * tropopause_temperature))
    humidity = 1.0 - 0.75 * share
    pressure, vapor = _balance(height, theta, humidity, mixing_ratio, surface_pressure)
    temperature = theta * (pressure / _REFERENCE) ** (_DRY_GAS / _HEAT)
    grams = f"{mixing_ratio * 1e3:g} g/kg"
    level = slice(None, None, _STEPS)
    return Sounding(
        pressure[level],
        temperature[level],
        _dewpoint(pressure * vapor / (_EPSILON + vapor))[level],
        height[level],
        f"Weisman and Klemp, {grams}",
        "the formula of M. L. Weisman and J. B. Klemp, Mon. Wea. Rev. 110, 504 (1982)",
    )


_LIMITS = {
    "mixing_ratio": (1e-4, 0.03, "kg kg-1"),
    "surface_pressure": (500e2, 1080e2, "Pa"),
    "surface_potential_temperature": (250.0, 330.0, "K"),
    "tropopause_height": (5e3, 16e3, "m"),
    "tropopause_potential_temperature": (280.0, 420.0, "K"),
    "tropopause_temperature": (170.0, 250.0, "K"),
}


def _balance(height: Floats, theta: Floats, humidity: Floats, cap: float, ground: float) -> tuple[Floats, Floats]:
    """Return pressure and mixing ratio in hydrostatic balance; each depends on the other."""
    power = _HEAT / _DRY_GAS
    step = float(height[1] - height[0])

    def vapor_at(exner: float, potential: float, relative: float) -> float:
        pressure = float(_REFERENCE * exner**power)
        saturation = min(_saturation_pressure(potential * exner), 0.5 * pressure)
        return min(cap, relative * _EPSILON * saturation / (pressure - saturation))

    def slope(exner: float, potential: float, relative: float) -> float:
        vapor = vapor_at(exner, potential, relative)
        return -STANDARD_GRAVITY / (_HEAT * potential * (1.0 + vapor / _EPSILON) / (1.0 + vapor))

    exner = [(ground / _REFERENCE) ** (1.0 / power)]
    for i in range(height.size - 1):
        half = exner[-1] + slope(exner[-1], theta[i], humidity[i]) * step / 2
        middle = (theta[i] + theta[i + 1]) / 2, (humidity[i] + humidity[i + 1]) / 2
        exner.append(max(exner[-1] + slope(half, *middle) * step, 1e-3))
    vapor = [vapor_at(*at) for at in zip(exner, theta, humidity, strict=True)]
    return _REFERENCE * np.array(exner) ** power, np.array(vapor)


def _saturation_pressure(temperature: float) -> float:
    """Return the saturation vapor pressure over liquid water [Pa]: Bolton (1980), eq. 10."""
    celsius = temperature - 273.15
    return float(611.2 * math.exp(17.67 * celsius / (celsius + 243.5)))


def _dewpoint(vapor_pressure: Floats) -> Floats:
    """Return the dewpoint [K] of a vapor pressure [Pa]: Bolton (1980), eq. 10 solved for the temperature."""
    log = np.log(vapor_pressure / 611.2)
    return np.asarray(243.5 * log / (17.67 - log) + 273.15, dtype=np.float64)
