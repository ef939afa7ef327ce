r"""The number of molecules of vapour in a small box that also holds liquid: its exact distribution at equilibrium.

The box is closed, at a given temperature or isolated; or it is a parcel of air over water at constant pressure, without
heat exchange. The distributions are exact for any number of molecules, even for one: every law of evaporation and
condensation must lead to them. The liquid is that of :mod:`atmosbox.theory.liquid_rate`. Units are SI.
"""

import math
from typing import NamedTuple

import numpy as np

from atmosbox.theory import _water
from atmosbox.theory._array import FloatArray, as_floats, require_not_negative, require_positive
from atmosbox.theory._water import (
    AIR_HEAT,
    BINDING,
    EXCESS,
    LIQUID_HEAT,
    TRIPLE_PRESSURE,
    TRIPLE_TEMPERATURE,
    VAPOR_HEAT,
    checked_temperature,
)
from atmosbox.theory.constants import BOLTZMANN

__all__ = ["IsobaricWater", "VaporNumber", "isobaric_water", "isolated_vapor_number", "isothermal_vapor_number"]


class VaporNumber(NamedTuple):
    """Distribution of the number of molecules of vapour in a closed box."""

    probability: FloatArray
    """Probability of 0, 1, 2, ... molecules of vapour, up to all the water [1]."""
    mean: float
    """Mean number of molecules of vapour [1]."""
    variance: float
    """Variance of that number [1]."""


def vapor_number(log_weight: FloatArray) -> VaporNumber:
    """Return the distribution of a number whose values 0, 1, 2, ... have these logarithms of their weights."""
    number = np.arange(log_weight.size)
    weight = np.exp(log_weight - np.max(log_weight))
    probability: FloatArray = weight / np.sum(weight)
    mean = float(probability @ number)
    return VaporNumber(probability, mean, float(probability @ (number - mean) ** 2))


def isothermal_vapor_number(water: int, temperature: float, volume: float) -> VaporNumber:
    r"""Return the distribution of the number of molecules of vapour in a closed box with liquid at fixed temperature.

    Each molecule of vapour condenses at the same rate, and molecules leave the liquid, if there is any, at a constant
    rate. So the number has the Poisson distribution with :math:`\lambda = e_s V / kT`, cut off at all the water (van
    Kampen 2007, Stochastic Processes in Physics and Chemistry, chapter VI).

    Parameters
    ----------
    water
        Molecules of water, vapour and liquid.
    temperature, volume
        Temperature of the liquid and of the gas [K], and volume of the gas [m^3].

    Examples
    --------
    With plenty of liquid the variance equals the mean; with little liquid it is smaller:

    >>> for water in (700, 550, 400):
    ...     number = isothermal_vapor_number(water, 273.15, (150e-9) ** 3)
    ...     print(round(number.mean, 1), round(number.variance, 1))
    546.6 546.6
    530.4 214.1
    397.4 9.0
    """
    from scipy import special  # loads slowly

    require_positive(temperature=temperature, volume=volume)
    require_not_negative(water=water)
    checked_temperature(as_floats(temperature))
    expected = _water.saturation(as_floats(temperature)) * volume / (BOLTZMANN * temperature)
    number = np.arange(int(water) + 1)
    return vapor_number(special.xlogy(number, expected) - special.gammaln(number + 1.0))


def isolated_vapor_number(water: int, air: int, energy: float, volume: float, nuclei_heat: float = 0.0) -> VaporNumber:
    r"""Return the distribution of the number of molecules of vapour in a closed box that exchanges no heat.

    Each division of the energy has a probability proportional to its number of states. With :math:`\varphi` for every
    molecule outside the liquid, and half the degrees of freedom :math:`M = 5 N_a / 2 + 3 N_v + C`,

    .. math:: P(N_v) \propto \frac{\zeta^{N_v}}{N_v!} \frac{(E - N_v \varphi)^{M-1}}{\Gamma(M)} , \qquad
              \zeta = \frac{e_s V}{kT}\, (kT)^{c_l - 3} e^{\varphi / kT} ,

    where :math:`\zeta` does not depend on T (Weisskopf 1937, doi:10.1103/PhysRev.52.295). A molecule that evaporates
    cools the others, so the number scatters less than at fixed temperature.

    Parameters
    ----------
    water, air
        Molecules of water, vapour and liquid, and of air :math:`N_a`.
    energy
        Energy E: kinetic and rotational of the gas, thermal of the liquid, and the binding energy
        :data:`atmosbox.theory.BINDING_TEMPERATURE` times k for each molecule of vapour [J].
    volume
        Volume of the gas [m^3].
    nuclei_heat
        Heat capacity of condensation nuclei at the temperature of the liquid, :math:`C_n` [k].

    Examples
    --------
    Five hundred molecules of water in a thousand of air, at about 0 degC:

    >>> energy = BOLTZMANN * (273.15 * (2500 + 3 * 160 + 340 * LIQUID_HEAT) + 160 * BINDING)
    >>> number = isolated_vapor_number(500, 1000, energy, 1e-21)
    >>> round(number.mean, 1), round(number.variance, 1)
    (160.1, 15.5)
    """
    from scipy import special  # loads slowly

    require_positive(energy=energy, volume=volume)
    require_not_negative(water=water, air=air, nuclei_heat=nuclei_heat)
    if not water + air + nuclei_heat > 0.0:
        raise ValueError("water, air and nuclei_heat are all 0: nothing in the box could hold the energy.")
    number = np.arange(int(water) + 1)
    left = energy / BOLTZMANN - BINDING * number
    states = (AIR_HEAT - 1.0) * air + (VAPOR_HEAT - 1.0) * number + LIQUID_HEAT * (water - number) + nuclei_heat
    t = TRIPLE_TEMPERATURE
    zeta = np.log(TRIPLE_PRESSURE * volume / (BOLTZMANN * t)) + (LIQUID_HEAT - VAPOR_HEAT + 1.0) * np.log(t)
    possible = (left > 0.0) & (states > 0.0)
    held = (states - 1.0) * np.log(np.where(possible, left, 1.0)) - special.gammaln(np.where(possible, states, 1.0))
    weight = (zeta + BINDING / t) * number - special.gammaln(number + 1.0) + held
    return vapor_number(np.where(possible, weight, -np.inf))


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

    Each division of the enthalpy, and each volume, has a probability proportional to its number of states (Andersen
    1980, doi:10.1063/1.439486; Weisskopf 1937, doi:10.1103/PhysRev.52.295). With :math:`\varphi` for every molecule
    outside the liquid and :math:`M = c_{pd} N_a + c_{pv} N_v + c_l n`,

    .. math:: P(N_v) \propto \frac{(N_a + N_v)!}{N_v!} \left( \frac{\zeta}{p} \right)^{N_v}
              \frac{(H - N_v \varphi)^M}{\Gamma(M + 1)} , \qquad
              \zeta = e_s\, (kT)^{c_l - c_{pv}} e^{\varphi / kT} ,

    where :math:`\zeta` does not depend on T. At each number the mean temperature is :math:`(H - N_v \varphi) / M`.

    For a large parcel :func:`atmosbox.theory.evaporation_equilibrium` gives the same. In a small one a molecule that
    evaporates cools all the others, and sometimes the whole pool evaporates.

    Parameters
    ----------
    pressure, temperature
        Pressure of the gas p [Pa], and temperature of air, vapour and liquid at the start [K].
    air, vapor, liquid
        Molecules of air :math:`N_a`, of vapour and of liquid at the start.

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
