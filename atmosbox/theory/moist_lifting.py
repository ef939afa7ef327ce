"""Moist air that is lifted: its cloud base, and how cloud water and rain change its temperature.

Below the cloud base air follows the adiabat of the mixture of air and vapour; above it, that of air with vapour and
liquid at equilibrium. Liquid may be carried, which makes the lift reversible, or leave as rain, which does not. Units
are SI; mixing ratios are kg per kg of dry air. There is no ice.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory import _water
from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory._water import (
    AIR_HEAT,
    EXCESS,
    LIQUID_HEAT,
    MASS_RATIO,
    TRIPLE_TEMPERATURE,
    VAPOR_HEAT,
    checked_not_negative,
    checked_positive,
    checked_temperature,
)

__all__ = ["ParcelPath", "lcl", "moist_air_poisson_exponent", "parcel_path", "raining_path"]


def moist_air_poisson_exponent(mixing_ratio: ArrayLike, nuclei_heat: ArrayLike = 0.0) -> FloatArray:
    r"""Return the exponent :math:`\kappa` of the adiabat :math:`T \propto p^\kappa` of air without cloud, 2/7 if dry.

    :math:`k / [(1-x) (c_{pd} + C) + x c_{pv}]` for a share x of vapour among the molecules, with :math:`c_{pd} = 7k/2`
    and :math:`c_{pv} = 4k`.

    Parameters
    ----------
    mixing_ratio
        Mass of vapour per mass of dry air [kg kg^-1].
    nuclei_heat
        Heat capacity C of condensation nuclei at the temperature of the air, per molecule of air [k].

    Examples
    --------
    Twenty grams per kilogram change it little:

    >>> moist_air_poisson_exponent([0.0, 0.020]).round(4)
    array([0.2857, 0.2845])
    """
    vapor = checked_not_negative(as_floats(mixing_ratio), "mixing_ratio") / MASS_RATIO
    heat = AIR_HEAT + checked_not_negative(as_floats(nuclei_heat), "nuclei_heat")
    exponent: FloatArray = (1.0 + vapor) / (heat + VAPOR_HEAT * vapor)
    return exponent


def lcl(
    pressure: ArrayLike, temperature: ArrayLike, dewpoint: ArrayLike, nuclei_heat: ArrayLike = 0.0
) -> tuple[FloatArray, FloatArray]:
    r"""Return pressure [Pa] and temperature [K] of the lifting condensation level, where lifted air becomes saturated.

    The adiabat :math:`e \propto T^{1/\kappa}` meets :math:`e_s(T)`: a closed form with Lambert's function (Romps 2017,
    doi:10.1175/JAS-D-17-0102.1, equation 22). Both are 0 if the air is dry.

    Parameters
    ----------
    pressure, temperature
        Pressure [Pa] and temperature [K] at the start.
    dewpoint
        Dewpoint at the start [K], not above the temperature; 0 K in dry air.
    nuclei_heat
        Heat capacity of condensation nuclei at the temperature of the air, per molecule of air [k].

    Raises
    ------
    ValueError
        If the air is supersaturated, or water boils at the dewpoint at that pressure.

    Examples
    --------
    From 1000 hPa, 25 degC and a dewpoint of 17 degC:

    >>> base = lcl(1000e2, 298.15, 290.15)
    >>> round(float(base[0]) / 100.0, 1), round(float(base[1]) - 273.15, 2)
    (888.8, 15.15)
    """
    p, t = checked_positive(as_floats(pressure), "pressure"), checked_temperature(as_floats(temperature))
    td = checked_temperature(as_floats(dewpoint), "dewpoint")
    if not np.all(td <= t):
        raise ValueError("dewpoint must not exceed temperature: supersaturated air has no cloud base.")
    e = _water.saturation(td)
    if not np.all(e < p):
        raise ValueError("dewpoint is so high that water boils at this pressure: there would be no air.")
    kappa = moist_air_poisson_exponent(MASS_RATIO * e / (p - e), nuclei_heat)
    y = np.log(checked_positive(t, "temperature") / _water.TRIPLE_TEMPERATURE)
    with np.errstate(divide="ignore"):
        level = y / kappa - np.log(e / _water.TRIPLE_PRESSURE)
    base = _water.temperature_of_level(EXCESS + 1.0 / kappa, np.asarray(_water.BINDING), level)
    base = np.where(td == t, t, np.minimum(base, t))
    base_pressure: FloatArray = p * (base / t) ** (1.0 / kappa)
    return base_pressure, base


class ParcelPath(NamedTuple):
    """Temperature and water of a parcel along its path, in arrays of the shape of the pressures."""

    temperature: FloatArray
    """Temperature [K]."""
    vapor: FloatArray
    """Mass of vapour per mass of dry air [kg kg^-1]."""
    liquid: FloatArray
    """Mass of liquid in the parcel per mass of dry air [kg kg^-1]."""
    rain: FloatArray
    """Mass of water that has left so far per mass of dry air [kg kg^-1]."""


def parcel_path(
    pressure: ArrayLike,
    pressure0: float,
    temperature0: float,
    total_water: float,
    most_liquid: float = np.inf,
    nuclei_heat: float = 0.0,
) -> ParcelPath:
    """Follow a parcel up and down, for example over a mountain, with a cloud that may rain.

    While the parcel keeps its water the entropy of air, vapour and liquid is constant; they are at equilibrium. A cloud
    holds at most ``most_liquid``: what condenses beyond that falls out at once, with its entropy. Only this loss is not
    reversed when the parcel sinks. So without a bound a lift is reversible; with a bound of zero it is
    pseudo-adiabatic, and air that sinks again warms along the dry adiabat, as in a foehn (Emanuel 1994, Atmospheric
    Convection, sections 4.5 and 4.7).

    The state depends only on the pressure and on the lowest pressure so far. Where it rains ln T is integrated over ln
    p to a relative 1e-12; elsewhere T is the root of the entropy, to rounding.

    Parameters
    ----------
    pressure : (level,)
        Pressures in the order in which the parcel meets them, rising or falling [Pa].
    pressure0, temperature0
        Pressure [Pa] and temperature [K] at the start. Air given more water than saturation starts with a cloud.
    total_water, most_liquid
        Vapour and liquid at the start, and most liquid that the cloud holds, mass per mass of dry air [kg kg^-1].
    nuclei_heat
        Heat capacity of condensation nuclei at the temperature of the air, per molecule of air [k].

    Raises
    ------
    ValueError
        If the cloud holds so much that it warms the rising air enough to evaporate.

    Examples
    --------
    Air of 15 degC and 8 g/kg crosses a mountain that reaches 700 hPa. If it rains there, the valley behind is warmer:

    >>> for most_liquid in (np.inf, 0.0):
    ...     path = parcel_path([700e2, 1000e2], 1000e2, 288.15, 0.008, most_liquid)
    ...     print((path.temperature - 273.15).round(1), path.rain.round(4))
    [-3.7 15. ] [0. 0.]
    [-3.8 25.1] [0.0039 0.0039]
    """
    p = checked_positive(as_floats(pressure), "pressure")
    p0 = checked_positive(as_floats(pressure0), "pressure0")
    t0 = checked_positive(checked_temperature(as_floats(temperature0), "temperature0"), "temperature0")
    given = checked_not_negative(as_floats(total_water), "total_water") / MASS_RATIO
    heat = AIR_HEAT + checked_not_negative(as_floats(nuclei_heat), "nuclei_heat")
    if not most_liquid >= 0.0:
        raise ValueError(f"most_liquid = {most_liquid} must be at least 0.")
    bound = as_floats(most_liquid) / MASS_RATIO
    water0 = np.minimum(given, _water.saturated_vapor(p0, t0) + bound)
    entropy0 = _water.entropy(p0, t0, water0, heat)

    lowest = np.minimum.accumulate(np.concatenate([[p0], p.ravel()]))[1:]
    water, entropy = np.full(lowest.shape, water0), np.full(lowest.shape, entropy0)
    rain_pressure, rain_temperature = _first_rain(entropy0, water0, bound, heat)
    if water0 < given:
        rain_pressure, rain_temperature = p0, t0
    raining = lowest < np.minimum(rain_pressure, p0)
    highest = lowest[raining]
    if highest.size:
        start = np.minimum(rain_pressure, p0), np.minimum(rain_temperature, t0)
        curve = _water.rained_temperature(highest, float(start[0]), float(start[1]), float(bound), float(heat))
        water[raining] = _water.saturated_vapor(highest, curve) + bound
        entropy[raining] = _water.entropy(highest, curve, water[raining], heat)
    t = _water.temperature_of_entropy(entropy, p.ravel(), water, heat)
    vapor = np.minimum(_water.saturated_vapor(p.ravel(), t), water)
    rained = np.append(water0, water[raining])
    if np.any(np.diff(rained) > 1e-9 * rained[:-1]) or np.any(water - vapor > bound * (1.0 + 1e-9) + 1e-12):
        raise ValueError(
            "most_liquid is so much that lifting evaporates it instead of making rain; let it be below 0.5."
        )
    columns = t, MASS_RATIO * vapor, MASS_RATIO * (water - vapor), MASS_RATIO * (given - water)
    return ParcelPath(*(column.reshape(p.shape) for column in columns))


def _first_rain(
    entropy: FloatArray, water: FloatArray, bound: FloatArray, heat: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return pressure and temperature at which a lifted cloud holds the bound of liquid; 0 if it never does.

    There e_s(T) = p v / (1 + v) with v = water - bound, so the entropy depends on T only through ln T and 1/T.
    """
    vapor = water - bound
    if not vapor > 0.0:
        return np.zeros(()), np.zeros(())
    binding = _water.BINDING * (1.0 + vapor)
    level = (
        entropy
        + np.log(_water.TRIPLE_PRESSURE / _water.REFERENCE_PRESSURE / vapor)
        - vapor * (_water.BINDING / _water.TRIPLE_TEMPERATURE - EXCESS)
    )
    slope = heat + EXCESS + LIQUID_HEAT * water
    temperature = _water.temperature_of_level(slope, binding, level)
    pressure = _water.saturation(temperature) * (1.0 + vapor) / vapor
    return pressure, temperature


def raining_path(
    time: ArrayLike,
    pressure: ArrayLike,
    pressure0: float,
    temperature0: float,
    total_water: float,
    rate: float,
    most_liquid: float = 0.0,
    nuclei_heat: float = 0.0,
) -> ParcelPath:
    r"""Follow a parcel up and down whose cloud rains in proportion to its liquid beyond a threshold.

    Liquid l beyond a threshold falls out as :math:`-dl/dt = r \, (l - l_0)`, and takes its entropy with it (Kessler
    1969, doi:10.1007/978-1-935704-36-2_1: autoconversion). Everything else stays in the parcel, at equilibrium. A rate
    of zero gives the reversible adiabat; an infinite rate with a threshold of zero gives the pseudo-adiabat.

    The rain between two moments is computed from the surplus at the second: the error is of first order in the step.

    Parameters
    ----------
    time : (moment,)
        Time at which the parcel meets each pressure, from 0 at the start [time].
    pressure : (moment,)
        The pressures [Pa].
    pressure0, temperature0, total_water
        At the start [Pa, K, kg kg^-1].
    rate, most_liquid
        r [1/time], and the threshold [kg kg^-1].
    nuclei_heat
        Heat capacity of condensation nuclei at the temperature of the air, per molecule of air [k].

    Examples
    --------
    The faster it rains, the warmer is the valley behind a mountain that reaches 700 hPa:

    >>> way = 1e5 - 3e4 * np.sin(np.linspace(0.0, np.pi, 201)[1:])
    >>> times = np.linspace(0.0, 100.0, 201)[1:]
    >>> for rate in (0.0, 0.1, 1e3):
    ...     path = raining_path(times, way, 1e5, 288.15, 0.008, rate)
    ...     print(round(float(path.temperature[-1]) - 273.15, 1))
    15.0
    24.5
    25.1
    """
    moments, p = checked_not_negative(as_floats(time), "time"), checked_positive(as_floats(pressure), "pressure")
    p0 = checked_positive(as_floats(pressure0), "pressure0")
    t0 = checked_positive(checked_temperature(as_floats(temperature0), "temperature0"), "temperature0")
    given = checked_not_negative(as_floats(total_water), "total_water") / MASS_RATIO
    keeps = checked_not_negative(as_floats(most_liquid), "most_liquid") / MASS_RATIO
    heat = AIR_HEAT + checked_not_negative(as_floats(nuclei_heat), "nuclei_heat")
    fast = checked_not_negative(as_floats(rate), "rate")
    steps = np.diff(moments, prepend=0.0)
    if np.any(steps < 0.0):
        raise ValueError("times must not decrease.")
    water, s = given, _water.entropy(p0, t0, given, heat)
    rows = np.empty((len(p), 3))
    for k in range(len(p)):
        level = p[k : k + 1]
        t, vapor = _state(s, level, water, heat)
        lost = np.minimum(np.maximum(water - vapor - keeps, 0.0) * -np.expm1(-fast * steps[k]), water - vapor)
        water, s = water - lost, s - lost * LIQUID_HEAT * np.log(t / TRIPLE_TEMPERATURE)
        if lost > 0.0:
            t, vapor = _state(s, level, water, heat)
        rows[k] = float(t), float(vapor), float(water)
    columns = rows[:, 0], MASS_RATIO * rows[:, 1], MASS_RATIO * (rows[:, 2] - rows[:, 1])
    return ParcelPath(*columns, MASS_RATIO * (given - rows[:, 2]))


def _state(s: FloatArray, level: FloatArray, water: FloatArray, heat: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return temperature and vapour at a pressure, for an entropy and an amount of water."""
    t = _water.temperature_of_entropy(np.atleast_1d(s), level, water, heat)[0]
    return t, np.minimum(_water.saturated_vapor(level[0], t), water)
