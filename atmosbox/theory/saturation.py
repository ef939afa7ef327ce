r"""Saturation of water vapour: its pressure, latent heat, dewpoint.

A molecule of water is held in the liquid by one binding energy, :math:`\varphi`; it has the heat capacity 4 k as
vapour, at constant pressure, and 9.14 k as liquid. These three numbers give the latent heat and, by the law of
Clausius and Clapeyron, the vapour pressure. One pair of numbers is taken from measurement: 2.50084e6 J/kg and 611.2 Pa
at 273.16 K. Temperatures are in K, pressures in Pa.

References
----------
Ambaum, M. H. P. (2020), Accurate, simple equation for saturated vapour pressure over water and ice,
doi:10.1002/qj.3899.
"""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory import _water
from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory._water import checked_not_negative, checked_temperature

VAPOR_HEAT_CAPACITY: float = _water.VAPOR_HEAT
"""Heat capacity of a molecule of vapour at constant pressure [k]."""
LIQUID_HEAT_CAPACITY: float = _water.LIQUID_HEAT
"""Heat capacity of a molecule of liquid water, 4219.4 J/(kg K) [k]."""
BINDING_TEMPERATURE: float = _water.BINDING
"""Binding energy of a molecule in liquid water over k [K]."""


def saturation_vapor_pressure(temperature: ArrayLike) -> FloatArray:
    r"""Return the pressure of the vapour over liquid water when as many molecules evaporate as condense.

    The law of Rankine and Kirchhoff [1]_, with :math:`T_t` = 273.16 K:

    .. math:: e_s = 611.2\,\mathrm{Pa}\, \exp\left[-\frac{\varphi}{k} \left(\frac{1}{T} - \frac{1}{T_t}\right)
              - \frac{c_l - c_{pv}}{k} \ln \frac{T}{T_t}\right] .

    Parameters
    ----------
    temperature
        Temperature [K]. Below 273.16 K the water is supercooled: there is no ice here.

    Returns
    -------
    ndarray
        Saturation vapour pressure [Pa]; 0 at 0 K.

    Raises
    ------
    ValueError
        If a temperature lies below 0 K or above the critical point of water, 647.096 K.

    Notes
    -----
    Compared with measured water (:func:`saturation_vapor_pressure_iapws`) it is too low: by 0.06 % at -10 degC, 0.20 %
    at 20, 0.44 % at 40 and 2.2 % at 100 degC, because the heat capacities of real water change with temperature. MetPy
    1.7 uses the same formula of the same paper, with 4.03 k for the vapour: their agreement to 0.03 % confirms neither.

    References
    ----------
    .. [1] Ambaum, M. H. P. (2020), doi:10.1002/qj.3899, equation 13.

    Examples
    --------
    In hPa, at -10, 0, 20 and 40 degC:

    >>> (saturation_vapor_pressure([263.15, 273.15, 293.15, 313.15]) / 100.0).round(2)
    array([ 2.86,  6.11, 23.35, 73.52])
    """
    return _water.saturation(checked_temperature(as_floats(temperature)))


def dewpoint(vapor_pressure: ArrayLike) -> FloatArray:
    r"""Return the temperature to which air must cool for its vapour to be saturated.

    The inverse of :func:`saturation_vapor_pressure`, by Lambert's function [1]_.

    Parameters
    ----------
    vapor_pressure
        Vapour pressure e [Pa].

    Returns
    -------
    ndarray
        Dewpoint [K]; 0 K without any vapour.

    Raises
    ------
    ValueError
        If a vapour pressure is negative, or above that of the critical point.

    References
    ----------
    .. [1] Romps, D. M. (2017), Exact expression for the lifting condensation level, doi:10.1175/JAS-D-17-0102.1.

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
