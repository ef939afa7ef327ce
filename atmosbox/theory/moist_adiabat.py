r"""The adiabats of saturated air: its entropy, the curves along which it cools, and how fast with height.

Two curves are called moist adiabat. On the reversible one the parcel carries all the liquid that has condensed; on
the pseudo-adiabat the liquid leaves as it forms, with its entropy. Both count the heat of the vapour and a latent
heat that falls with temperature. Units are SI; mixing ratios are kg per kg of dry air.

References
----------
Emanuel, K. A. (1994), Atmospheric Convection, chapter 4.
"""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory import _water
from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory._water import AIR_HEAT, MASS_RATIO, checked_not_negative, checked_positive, checked_temperature
from atmosbox.theory.constants import STANDARD_GRAVITY
from atmosbox.theory.environment import DRY_AIR_GAS_CONSTANT


def _checked(
    pressure: ArrayLike, temperature: ArrayLike, nuclei_heat: ArrayLike
) -> tuple[FloatArray, FloatArray, FloatArray]:
    p = checked_positive(as_floats(pressure), "pressure")
    t = checked_positive(checked_temperature(as_floats(temperature)), "temperature")
    return p, t, AIR_HEAT + checked_not_negative(as_floats(nuclei_heat), "nuclei_heat")


def _require_air(pressure: FloatArray, temperature: FloatArray) -> None:
    if not np.all(np.isfinite(_water.saturated_vapor(pressure, temperature))):
        raise ValueError("temperature is so high that water boils at this pressure: saturated air would hold no air.")


def moist_entropy(
    pressure: ArrayLike, temperature: ArrayLike, total_water: ArrayLike, nuclei_heat: ArrayLike = 0.0
) -> FloatArray:
    r"""Return the entropy of air with its vapour and its liquid, which a lift without heat or rain leaves as it is.

    In a cloud, per molecule of air, with w molecules of water of which v are vapour,

    .. math:: s / k = (c_{pd} + C + w c_l) \ln T - \ln (p - e_s) + v L / kT ;

    water that is all vapour has its own :math:`v (c_{pv} \ln T - \ln e)`, which joins it at saturation [1]_.

    Parameters
    ----------
    pressure
        Pressure p [Pa].
    temperature
        Temperature T [K].
    total_water
        Vapour and liquid, mass per mass of dry air [kg kg^-1]. What is more than saturation is liquid.
    nuclei_heat
        Heat capacity C of whatever is as warm as the air, per molecule of air [k].

    Returns
    -------
    ndarray
        Entropy per mass of dry air [J kg^-1 K^-1]: zero for dry air at 1000 hPa and for liquid, both at 273.16 K.

    Raises
    ------
    ValueError
        If pressure or temperature is not positive, the temperature above 647.096 K, or water or heat negative.

    References
    ----------
    .. [1] Emanuel, K. A. (1994), Atmospheric Convection, equation 4.5.9.

    Examples
    --------
    Saturated at 20 degC, and lifted to 500 hPa with its 7.6 g/kg of cloud water:

    >>> temperature = reversible_adiabat(500e2, 1000e2, 293.15, 0.0149)
    >>> moist_entropy([1000e2, 500e2], [293.15, temperature], 0.0149).round(3)
    array([206.608, 206.608])
    """
    p, t, heat = _checked(pressure, temperature, nuclei_heat)
    water = checked_not_negative(as_floats(total_water), "total_water") / MASS_RATIO
    entropy: FloatArray = DRY_AIR_GAS_CONSTANT * _water.entropy(p, t, water, heat)
    return entropy


def reversible_adiabat(
    pressure: ArrayLike,
    pressure0: ArrayLike,
    temperature0: ArrayLike,
    total_water: ArrayLike,
    nuclei_heat: ArrayLike = 0.0,
) -> FloatArray:
    r"""Return the temperature of air that is lifted with all its water, at each pressure.

    :func:`moist_entropy` stays. Up or down, in the cloud or below it, the way does not matter.

    Parameters
    ----------
    pressure, pressure0
        Pressure now and at the start [Pa].
    temperature0
        Temperature at the start [K].
    total_water
        Vapour and liquid, mass per mass of dry air [kg kg^-1]. Zero gives the dry adiabat.
    nuclei_heat
        Heat capacity of whatever is as warm as the air, per molecule of air [k].

    Returns
    -------
    ndarray
        Temperature [K].

    Raises
    ------
    ValueError
        If a pressure or the temperature is not positive, the temperature above 647.096 K, or water or heat negative.

    Notes
    -----
    Newton's method in ln T, to rounding. Entropy rises with temperature, so there is one root.

    References
    ----------
    .. [1] Emanuel, K. A. (1994), Atmospheric Convection, section 4.5.

    Examples
    --------
    Twenty degrees and 14.9 g/kg at 1000 hPa, saturated, at 500 and at 300 hPa in degC:

    >>> (reversible_adiabat([500e2, 300e2], 1000e2, 293.15, 0.01490) - 273.15).round(1)
    array([ -8.3, -35. ])
    """
    p0, t0, heat = _checked(pressure0, temperature0, nuclei_heat)
    p = checked_positive(as_floats(pressure), "pressure")
    water = checked_not_negative(as_floats(total_water), "total_water") / MASS_RATIO
    return _water.temperature_of_entropy(_water.entropy(p0, t0, water, heat), p, water, heat)


def pseudoadiabat(pressure: ArrayLike, pressure0: float, temperature0: float, nuclei_heat: float = 0.0) -> FloatArray:
    r"""Return the temperature of air that stays just saturated, at each pressure.

    Upward the liquid leaves as it forms; downward, as in a wet-bulb, water of the same temperature is added. Per
    molecule of air, with v molecules of vapour,

    .. math:: (c_{pd} + C + v c_l)\, d \ln T - k\, d \ln (p - e_s) + d (v L / T) = 0 .

    Parameters
    ----------
    pressure
        Pressures, in any order [Pa].
    pressure0, temperature0
        Pressure [Pa] and temperature [K] of one point of the curve.
    nuclei_heat
        Heat capacity C of whatever is as warm as the air, per molecule of air [k].

    Returns
    -------
    ndarray
        Temperature [K].

    Raises
    ------
    ValueError
        If an argument is not positive, the heat negative, such water boils at `pressure0`, or the curve passes the
        critical point of water.

    Notes
    -----
    A Runge-Kutta method of order 8 in ln T over ln p, good to a relative 1e-11. MetPy's ``moist_lapse`` drops the
    heat of the vapour and keeps L constant: from 20 degC at 1000 hPa it is up to 0.25 K warmer.

    References
    ----------
    .. [1] Emanuel, K. A. (1994), Atmospheric Convection, section 4.7.

    Examples
    --------
    Twenty degrees at 1000 hPa, at 500 and at 300 hPa in degC:

    >>> (pseudoadiabat([500e2, 300e2], 1000e2, 293.15) - 273.15).round(1)
    array([ -8.7, -36.7])
    """
    p0, t0, heat = _checked(pressure0, temperature0, nuclei_heat)
    p = checked_positive(as_floats(pressure), "pressure")
    _require_air(p0, t0)
    curve = _water.rained_temperature(p.ravel(), float(p0), float(t0), 0.0, float(heat))
    return curve.reshape(p.shape)


def moist_lapse_rate(
    pressure: ArrayLike,
    temperature: ArrayLike,
    liquid: ArrayLike = 0.0,
    nuclei_heat: ArrayLike = 0.0,
    gravity: ArrayLike = STANDARD_GRAVITY,
) -> FloatArray:
    r"""Return by how much saturated air cools with each metre that it is lifted.

    Per mass of dry air, with the mixing ratios r of vapour and l of liquid,

    .. math:: \Gamma_s = g\, \frac{(1 + r)(1 + L r / R_d T)}
              {c_{pd} + C + r c_{pv} + l c_l + L^2 r (\epsilon + r) / R_d T^2} .

    Parameters
    ----------
    pressure
        Pressure [Pa].
    temperature
        Temperature T [K].
    liquid
        Liquid that the parcel carries, mass per mass of dry air [kg kg^-1]. What condenses next may stay or leave.
    nuclei_heat
        Heat capacity C of whatever is as warm as the air, per molecule of air [k].
    gravity
        Acceleration of gravity g [m s^-2].

    Returns
    -------
    ndarray
        Saturated adiabatic lapse rate, positive where it cools upward [K m^-1].

    Raises
    ------
    ValueError
        If an argument is negative, the temperature above 647.096 K, or such water boils at the pressure.

    Notes
    -----
    Pressure falls as in air of the parcel's vapour and temperature, without its liquid. The common form
    :math:`g (1 + L r / R_d T) / (c_{pd} + L^2 r \epsilon / R_d T^2)` leaves out the heat of the vapour: it is larger,
    at 1000 hPa by 0.5 % at 10 degC and by 1.7 % at 30 degC, at 500 hPa and 30 degC by 3.4 %.

    References
    ----------
    .. [1] American Meteorological Society, Glossary of Meteorology, moist-adiabatic lapse rate.

    Examples
    --------
    K per km at 1000 hPa, at -40, 0 and 30 degC:

    >>> (1000.0 * moist_lapse_rate(1000e2, [233.15, 273.15, 303.15])).round(1)
    array([9.5, 6.5, 3.5])
    """
    p, t, heat = _checked(pressure, temperature, nuclei_heat)
    carried = checked_not_negative(as_floats(liquid), "liquid") / MASS_RATIO
    g = checked_not_negative(as_floats(gravity), "gravity")
    _require_air(p, t)
    vapor = _water.saturated_vapor(p, t)
    weight = (1.0 + MASS_RATIO * vapor) / (1.0 + vapor)
    rate: FloatArray = g / DRY_AIR_GAS_CONSTANT * weight * _water.saturated_slope(p, t, carried, heat)
    return rate
