r"""The vapour in a small parcel of air over water, in equilibrium at constant pressure and without heat exchange.

This is the exact distribution at equilibrium, for any number of molecules, even for one: every law of evaporation and
condensation under a piston must lead to it. The liquid is that of :mod:`atmosbox.theory.liquid_rate`. Units are SI.
"""

import math
from typing import NamedTuple

import numpy as np

from atmosbox.theory._array import FloatArray, require_not_negative, require_positive
from atmosbox.theory._water import (
    AIR_HEAT,
    BINDING,
    EXCESS,
    LIQUID_HEAT,
    TRIPLE_PRESSURE,
    TRIPLE_TEMPERATURE,
    VAPOR_HEAT,
)
from atmosbox.theory.vapor_number import vapor_number

__all__ = ["IsobaricWater", "isobaric_water"]


class IsobaricWater(NamedTuple):
    """Mean state and distribution of the vapour in air with a little water, in equilibrium."""

    probability: FloatArray
    """Probability of 0, 1, 2, ... molecules of vapour, up to all the water [1]."""
    vapor: float
    """Mean number of molecules of vapour [1]."""
    variance: float
    """Variance of that number [1]."""
    temperature: float
    """Mean temperature [K]."""
    vapor_pressure: float
    """Mean vapour pressure [Pa]."""


def isobaric_water(pressure: float, temperature: float, air: int, vapor: int, liquid: int) -> IsobaricWater:
    r"""Return the equilibrium of air, vapour and liquid at constant pressure, without heat exchange.

    Each division of the enthalpy, and each volume, has a probability proportional to its number of states. With
    :math:`\varphi` for every molecule outside the liquid and :math:`M = c_{pd} N_a + c_{pv} N_v + c_l n`,

    .. math:: P(N_v) \propto \frac{(N_a + N_v)!}{N_v!} \left( \frac{\zeta}{p} \right)^{N_v}
              \frac{(H - N_v \varphi)^M}{\Gamma(M + 1)} , \qquad
              \zeta = e_s\, (kT)^{c_l - c_{pv}} e^{\varphi / kT} ,

    where :math:`\zeta` does not depend on T. At each number the mean temperature is :math:`(H - N_v \varphi) / M`.

    Parameters
    ----------
    pressure
        Pressure of the gas p [Pa].
    temperature
        Temperature of air, vapour and liquid at the start [K].
    air, vapor, liquid
        Molecules of air :math:`N_a`, of vapour and of liquid at the start [1].

    Returns
    -------
    IsobaricWater
        Probabilities of the number of molecules of vapour, and means.

    Raises
    ------
    ValueError
        If the pressure or the temperature is not positive, a number is negative, or there are no molecules.

    Notes
    -----
    For a large parcel :func:`atmosbox.theory.evaporation_equilibrium` gives the same. In a small one a molecule that
    evaporates cools all the others, and sometimes the whole pool evaporates.

    References
    ----------
    .. [1] Andersen, H. C. (1980), doi:10.1063/1.439486: the ensemble of constant enthalpy and pressure.
    .. [2] Weisskopf, V. (1937), doi:10.1103/PhysRev.52.295.

    Examples
    --------
    Two molecules of vapour in 200 of air of 30 degC, over a pool of 20: the vapour scatters much, and everything is
    0.8 K warmer than it would be in a large parcel.

    >>> end = isobaric_water(1000e2, 303.15, 198, 2, 20)
    >>> round(end.vapor, 1), round(end.variance, 1), round(end.temperature, 1)
    (3.9, 1.6, 291.5)
    """
    require_positive(pressure=pressure, temperature=temperature)
    require_not_negative(air=air, vapor=vapor, liquid=liquid)
    water = int(vapor) + int(liquid)
    if not air + water > 0:
        raise ValueError("air, vapor and liquid are all 0: nothing could hold the enthalpy.")
    number = np.arange(water + 1)
    enthalpy = (AIR_HEAT * air + VAPOR_HEAT * vapor + LIQUID_HEAT * liquid) * temperature + vapor * BINDING
    left = enthalpy - BINDING * number
    states = AIR_HEAT * air + VAPOR_HEAT * number + LIQUID_HEAT * (water - number)
    possible = left > 0.0
    t = TRIPLE_TEMPERATURE
    zeta = np.log(TRIPLE_PRESSURE / pressure) + EXCESS * np.log(t) + BINDING / t
    weight = zeta * number - _log_gamma(number + 1.0) + _log_gamma(air + number + 1.0)
    weight += states * np.log(np.where(possible, left, 1.0)) - _log_gamma(states + 1.0)
    found = vapor_number(np.where(possible, weight, -np.inf))
    return IsobaricWater(
        *found,
        float(found.probability @ (left / states)),
        float(pressure * (found.probability @ (number / np.maximum(air + number, 1.0)))),
    )


_log_gamma = np.vectorize(math.lgamma, otypes=[np.float64])  # scipy's takes a fifth of a second to load
