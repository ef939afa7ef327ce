"""The saturation vapour pressure of measured water: the standard that the model's own formula is compared with.

Nothing in a simulation uses it.
"""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory._water import CRITICAL_TEMPERATURE

__all__ = ["saturation_vapor_pressure_iapws"]

_CRITICAL_PRESSURE = 22.064e6
_COEFFICIENTS = np.array([-7.85951783, 1.84408259, -11.7866497, 22.6807411, -15.9618719, 1.80122502])
_EXPONENTS = np.array([1.0, 1.5, 3.0, 3.5, 4.0, 7.5])
_COLDEST = 233.15
"""Below about -40 degC water cannot be kept liquid, and there is no measurement to compare with [K]."""


def saturation_vapor_pressure_iapws(temperature: ArrayLike) -> FloatArray:
    r"""Return the saturation vapour pressure over liquid water by the formula of IAPWS, a fit to measurements.

    Equation 1 of the release SR1-86(1992) of the International Association for the Properties of Water and Steam
    [1]_, by Wagner and Pruss [2]_. With :math:`\vartheta = 1 - T/T_c`, :math:`T_c` = 647.096 K and :math:`p_c` =
    22.064 MPa,

    .. math:: \ln \frac{e_s}{p_c} = \frac{T_c}{T} \left(a_1 \vartheta + a_2 \vartheta^{1.5} + a_3 \vartheta^3
              + a_4 \vartheta^{3.5} + a_5 \vartheta^4 + a_6 \vartheta^{7.5}\right) .

    Parameters
    ----------
    temperature
        Temperature [K].

    Returns
    -------
    ndarray
        Saturation vapour pressure [Pa].

    Raises
    ------
    ValueError
        If a temperature lies below 233.15 K, where water freezes at once, or above the critical point, 647.096 K.

    Notes
    -----
    The release covers 273.16 K to the critical point. Below 273.16 K this is the same formula extended: at -20 degC it
    is 0.08 %, at -40 degC 0.7 % above that of Murphy and Koop [3]_ for supercooled water.

    References
    ----------
    .. [1] IAPWS SR1-86(1992), Revised Supplementary Release on Saturation Properties of Ordinary Water Substance,
       iapws.org/relguide/Supp-sat.html.
    .. [2] Wagner, W., Pruss, A. (1993), doi:10.1063/1.555926.
    .. [3] Murphy, D. M., Koop, T. (2005), doi:10.1256/qj.04.94.

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
