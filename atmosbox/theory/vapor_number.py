r"""Fluctuations of the number of molecules of vapour in a small closed box that also holds liquid.

These are the exact distributions at equilibrium, for any number of molecules; every law of evaporation and condensation
must lead to them. The liquid is that of :mod:`atmosbox.theory.liquid_rate`. Units are SI.
"""

from typing import NamedTuple

import numpy as np

from atmosbox.theory import _water
from atmosbox.theory._array import FloatArray, as_floats, require_not_negative, require_positive
from atmosbox.theory._water import (
    AIR_HEAT,
    BINDING,
    LIQUID_HEAT,
    TRIPLE_PRESSURE,
    TRIPLE_TEMPERATURE,
    VAPOR_HEAT,
    checked_temperature,
)
from atmosbox.theory.constants import BOLTZMANN


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
    rate. So the number has the Poisson distribution with :math:`\lambda = e_s V / kT`, cut off at all the water.

    Parameters
    ----------
    water
        Molecules of water, vapour and liquid [1].
    temperature
        Temperature of the liquid and of the gas [K].
    volume
        Volume of the gas [m^3].

    Returns
    -------
    VaporNumber
        Probabilities, mean and variance.

    Raises
    ------
    ValueError
        If the temperature lies outside 0 to 647.096 K, the volume is not positive or the number negative.

    References
    ----------
    .. [1] van Kampen, N. G. (2007), Stochastic Processes in Physics and Chemistry, chapter VI.

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

    where :math:`\zeta` does not depend on T.

    Parameters
    ----------
    water
        Molecules of water, vapour and liquid [1].
    air
        Molecules of air :math:`N_a` [1].
    energy
        Energy E: kinetic and rotational of the gas, thermal of the liquid, and the binding energy
        :data:`atmosbox.theory.BINDING_TEMPERATURE` times k for each molecule of vapour [J].
    volume
        Volume of the gas [m^3].
    nuclei_heat
        Heat capacity of condensation nuclei at the temperature of the liquid, :math:`C_n` [k].

    Returns
    -------
    VaporNumber
        Probabilities, mean and variance.

    Raises
    ------
    ValueError
        If the energy or the volume is not positive, or a number or a heat capacity negative.

    Notes
    -----
    A molecule that evaporates cools the others, so the number scatters less than at fixed temperature.

    References
    ----------
    .. [1] Weisskopf, V. (1937), doi:10.1103/PhysRev.52.295.

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
