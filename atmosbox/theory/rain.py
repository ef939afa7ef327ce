"""A cloud that rains at a finite rate: the path of a parcel, which then depends on time as well as on pressure."""

import math

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory import _water
from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory._water import (
    AIR_HEAT,
    LIQUID_HEAT,
    MASS_RATIO,
    TRIPLE_TEMPERATURE,
    checked_not_negative,
    checked_positive,
    checked_temperature,
)
from atmosbox.theory.moist_lifting import ParcelPath

__all__ = ["raining_path"]


def raining_path(
    time: ArrayLike,
    pressure: ArrayLike,
    pressure0: float,
    temperature0: float,
    total_water: float,
    rate: float,
    most_liquid: float = 0.0,
    nuclei_heat: float = 0.0,
    scatter: float = 0.0,
) -> ParcelPath:
    r"""Follow a parcel up and down whose cloud rains in proportion to its liquid beyond a threshold.

    Liquid l beyond a threshold falls out as :math:`-dl/dt = r \, (l - l_0)` [1]_, and takes its entropy with it.
    Everything else stays in the parcel, at equilibrium. A rate of zero gives the reversible adiabat; an infinite rate
    with a threshold of zero gives the pseudo-adiabat.

    Parameters
    ----------
    time : (moment,)
        Time at which the parcel meets each pressure, from 0 at the start [time].
    pressure : (moment,)
        The pressures [Pa].
    pressure0, temperature0, total_water
        At the start [Pa, K, kg kg^-1].
    rate
        r [1/time].
    most_liquid
        The threshold [kg kg^-1].
    nuclei_heat
        Heat capacity of condensation nuclei at the temperature of the air, per molecule of air [k].
    scatter
        Standard deviation of the liquid of a small cloud about its equilibrium [kg kg^-1]. A surplus rains, and a
        deficit does not bring it back: so more falls than from a cloud without fluctuations.

    Returns
    -------
    ParcelPath
        Temperature, vapour, liquid and rain at each moment.

    Raises
    ------
    ValueError
        If a pressure, the temperature or a time is not allowed, or water, heat or rate is negative.

    Notes
    -----
    The rain between two moments is computed from the surplus at the second: the error is of first order in the step.

    References
    ----------
    .. [1] Kessler, E. (1969), doi:10.1007/978-1-935704-36-2_1: autoconversion above a threshold.

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
    spread = float(checked_not_negative(as_floats(scatter), "scatter")) / MASS_RATIO
    steps = np.diff(moments, prepend=0.0)
    if np.any(steps < 0.0):
        raise ValueError("times must not decrease.")
    water, s = given, _water.entropy(p0, t0, given, heat)
    rows = np.empty((len(p), 3))
    for k in range(len(p)):
        level = p[k : k + 1]
        t, vapor = _state(s, level, water, heat)
        lost = np.minimum(_surplus(float(water - vapor - keeps), spread) * -np.expm1(-fast * steps[k]), water - vapor)
        water, s = water - lost, s - lost * LIQUID_HEAT * np.log(t / TRIPLE_TEMPERATURE)
        if lost > 0.0:
            t, vapor = _state(s, level, water, heat)
        rows[k] = float(t), float(vapor), float(water)
    columns = rows[:, 0], MASS_RATIO * rows[:, 1], MASS_RATIO * (rows[:, 2] - rows[:, 1])
    return ParcelPath(*columns, MASS_RATIO * (given - rows[:, 2]))


def _surplus(mean: float, scatter: float) -> float:
    r"""Return the mean of the positive part of a normal variable, :math:`m \Phi(m/s) + s \phi(m/s)`.

    Examples
    --------
    >>> _surplus(2.0, 0.0), round(_surplus(0.0, 1.0), 3)
    (2.0, 0.399)
    """
    if not scatter > 0.0:
        return max(mean, 0.0)
    a = mean / scatter
    return 0.5 * mean * math.erfc(-a / math.sqrt(2.0)) + scatter * math.exp(-0.5 * a * a) / math.sqrt(2.0 * math.pi)


def _state(s: FloatArray, level: FloatArray, water: FloatArray, heat: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return temperature and vapour at a pressure, for an entropy and an amount of water."""
    t = _water.temperature_of_entropy(np.atleast_1d(s), level, water, heat)[0]
    return t, np.minimum(_water.saturated_vapor(level[0], t), water)
