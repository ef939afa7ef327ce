r"""A parcel of gas that is lifted, or compressed without heat: its heat capacities, adiabat and lapse rate.

A molecule with f degrees of freedom has the heat capacity :math:`(f/2) k` at constant volume and
:math:`(f/2 + 1) k` at constant pressure. Air has f = 5, three of translation and two of rotation; spheres
that do not rotate have 3, and cool faster.
"""

from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory.constants import STANDARD_GRAVITY
from atmosbox.theory.environment import DRY_AIR_GAS_CONSTANT


def adiabatic_index(dof: ArrayLike = 5) -> FloatArray:
    r"""Return the ratio of the heat capacities at constant pressure and constant volume, :math:`\gamma = 1 + 2/f`.

    Parameters
    ----------
    dof
        Degrees of freedom f of one molecule [1].

    Returns
    -------
    ndarray
        Adiabatic index [1].

    Examples
    --------
    Discs in a plane, spheres, air:

    >>> [round(float(gamma), 4) for gamma in adiabatic_index([2, 3, 5])]
    [2.0, 1.6667, 1.4]
    """
    return 1.0 + 2.0 / as_floats(dof)


def dry_adiabat_temperature(
    pressure: ArrayLike, temperature0: ArrayLike, pressure0: ArrayLike, dof: float = 5
) -> FloatArray:
    r"""Return the temperature of dry air lifted to a pressure, :math:`T_0 (p/p_0)^{2/(f+2)}`.

    Parameters
    ----------
    pressure, pressure0
        Pressure now and at the start [pressure].
    temperature0
        Temperature at the start, in K or as an energy.
    dof
        Degrees of freedom f of one molecule [1]: 5 for air, with the exponent 2/7; 3 for spheres, with 2/5.

    Returns
    -------
    ndarray
        Temperature, in the unit of the one at the start.

    Examples
    --------
    From 1000 to 500 hPa air cools from 15 degC to -37 degC; spheres that do not rotate would cool to -55 degC:

    >>> [round(float(dry_adiabat_temperature(500.0, 288.15, 1000.0, dof)) - 273.15) for dof in (5, 3)]
    [-37, -55]
    """
    ratio = as_floats(pressure) / as_floats(pressure0)
    temperature: FloatArray = as_floats(temperature0) * ratio ** (2.0 / (dof + 2.0))
    return temperature


def dry_lapse_rate(
    gravity: ArrayLike = STANDARD_GRAVITY,
    specific_gas_constant: ArrayLike = DRY_AIR_GAS_CONSTANT,
    dof: float = 5,
) -> FloatArray:
    r"""Return the cooling of dry air per metre of lift, :math:`g / c_p`.

    Parameters
    ----------
    gravity
        Acceleration of gravity [m s^-2].
    specific_gas_constant
        Gas constant per mass, k over the mass of a molecule [J kg^-1 K^-1]; :math:`c_p` is :math:`f/2 + 1`
        times it.
    dof
        Degrees of freedom f of one molecule [1].

    Returns
    -------
    ndarray
        Dry-adiabatic lapse rate, positive if air cools upward [K m^-1].

    Examples
    --------
    In kelvin per kilometre:

    >>> round(float(dry_lapse_rate()) * 1000.0, 2)
    9.76
    """
    return as_floats(gravity) / ((dof / 2.0 + 1.0) * as_floats(specific_gas_constant))
