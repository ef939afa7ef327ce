"""The analytic sounding of Weisman and Klemp for the environment of a thunderstorm."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import SettingError
from atmosbox.scene.sounding.profile import Sounding
from atmosbox.theory.constants import DRY_AIR, GAS_CONSTANT, STANDARD_GRAVITY, WATER

_DRY_GAS = GAS_CONSTANT / DRY_AIR.molar_mass  # J kg-1 K-1
_HEAT = 3.5 * _DRY_GAS  # J kg-1 K-1, at constant pressure
_EPSILON = WATER.molar_mass / DRY_AIR.molar_mass
_GROUND, _GROUND_THETA = 1000e2, 300.0  # Pa, K
_TROPOPAUSE, _TROPOPAUSE_THETA, _TROPOPAUSE_TEMPERATURE = 12e3, 343.0, 213.0  # m, K, K
_TOP, _LEVELS, _STEPS = 16e3, 65, 25  # m; levels every 250 m; steps of the integration between two levels
_TURNS = 20  # after ten nothing changes

Floats = NDArray[np.float64]


def weisman_klemp(mixing_ratio: float = 0.014) -> Sounding:
    r"""Return the analytic sounding of Weisman and Klemp, in which many simulated storms begin [1]_.

    Below the tropopause, with s = (z / z_tr)^(5/4), the potential temperature is theta_0 + (theta_tr - theta_0) s
    and the relative humidity 1 - 3 s / 4; above it they are theta_tr exp(g (z - z_tr) / (c_p T_tr)) and 1/4.
    At the ground the pressure is 1000 hPa and theta_0 = 300 K; z_tr = 12 km, theta_tr = 343 K and T_tr = 213 K. Near
    the ground the mixing ratio is constant; of all parameters it changes CAPE most.

    Parameters
    ----------
    mixing_ratio
        The largest mixing ratio of vapour, 0.011 to 0.016 in the paper [kg kg-1].

    Raises
    ------
    SettingError
        If it is not between 0.0001 and 0.03.

    Notes
    -----
    The hydrostatic equation is that of the Exner function, d pi / dz = -g / (c_p theta_v), with the virtual potential
    temperature of the same sounding, integrated by the trapezoidal rule in steps of 10 m. Saturation is with respect to
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
    if not 1e-4 <= mixing_ratio <= 0.03:  # also true for NaN
        fix = "give 0.0001 to 0.03 kg kg-1"
        raise SettingError("mixing_ratio", mixing_ratio, "is not what the formula is for", fix)
    height = np.linspace(0.0, _TOP, (_LEVELS - 1) * _STEPS + 1)
    share = (np.minimum(height, _TROPOPAUSE) / _TROPOPAUSE) ** 1.25
    theta = _GROUND_THETA + (_TROPOPAUSE_THETA - _GROUND_THETA) * share
    above = np.maximum(height - _TROPOPAUSE, 0.0)
    theta *= np.exp(STANDARD_GRAVITY * above / (_HEAT * _TROPOPAUSE_TEMPERATURE))
    pressure, vapor = _balance(height, theta, 1.0 - 0.75 * share, mixing_ratio)
    level = slice(None, None, _STEPS)
    return Sounding(
        pressure[level],
        (theta * (pressure / _GROUND) ** (_DRY_GAS / _HEAT))[level],
        _dewpoint(pressure * vapor / (_EPSILON + vapor))[level],
        f"Weisman and Klemp, {mixing_ratio * 1e3:g} g/kg",
        "the formula of M. L. Weisman and J. B. Klemp, Mon. Wea. Rev. 110, 504 (1982)",
    )


def _balance(height: Floats, theta: Floats, humidity: Floats, cap: float) -> tuple[Floats, Floats]:
    """Return pressure and mixing ratio in hydrostatic balance; each depends on the other, and so they take turns."""
    exner = np.ones_like(height)
    for _ in range(_TURNS):
        pressure = _GROUND * exner ** (_HEAT / _DRY_GAS)
        saturation = np.minimum(_saturation_pressure(theta * exner), 0.5 * pressure)
        vapor = np.minimum(cap, humidity * _EPSILON * saturation / (pressure - saturation))
        slope = -STANDARD_GRAVITY / (_HEAT * theta * (1.0 + vapor / _EPSILON) / (1.0 + vapor))
        steps = 0.5 * (slope[1:] + slope[:-1]) * np.diff(height)
        exner = np.concatenate([[1.0], 1.0 + np.cumsum(steps)])
    return pressure, vapor


def _saturation_pressure(temperature: Floats) -> Floats:
    """Return the saturation vapor pressure over liquid water [Pa]: Bolton (1980), eq. 10."""
    celsius = temperature - 273.15
    return np.asarray(611.2 * np.exp(17.67 * celsius / (celsius + 243.5)))


def _dewpoint(vapor_pressure: Floats) -> Floats:
    """Return the dewpoint [K] of a vapor pressure [Pa]: Bolton (1980), eq. 10 solved for the temperature."""
    log = np.log(vapor_pressure / 611.2)
    return np.asarray(243.5 * log / (17.67 - log) + 273.15, dtype=np.float64)
