r"""What becomes of a parcel of gas that is lifted, squeezed, or held at its temperature while it expands.

A molecule with f degrees of freedom has the heat capacity :math:`(f/2) k` at constant volume and
:math:`(f/2 + 1) k` at constant pressure. Air has f = 5, three of translation and two of rotation; spheres
that do not rotate have 3, and cool faster.
"""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory.constants import STANDARD_GRAVITY
from atmosbox.theory.environment import DRY_AIR_GAS_CONSTANT


def adiabatic_index(dof: ArrayLike = 5) -> FloatArray:
    r"""Return the ratio of the heat capacities, :math:`\gamma = 1 + 2/f`.

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


def adiabatic_temperature(volume: ArrayLike, temperature0: ArrayLike, volume0: ArrayLike, dof: float = 5) -> FloatArray:
    r"""Return the temperature of an ideal gas whose volume is changed slowly and without heat.

    :math:`T V^{\gamma - 1}` stays.

    Parameters
    ----------
    volume, volume0
        Volume now and at the start [length^3].
    temperature0
        Temperature at the start, in K or as an energy.
    dof
        Degrees of freedom f of one molecule [1].

    Returns
    -------
    ndarray
        Temperature, in the unit of the one at the start.

    References
    ----------
    .. [1] Bellan, P. M. (2004), A microscopic, mechanical derivation for the adiabatic gas relation,
       arXiv:physics/0310015: the same from molecules that bounce off a moving wall.

    Examples
    --------
    Spheres in an eighth of the room are four times as hot:

    >>> round(float(adiabatic_temperature(1.0, 300.0, 8.0, dof=3)), 6)
    1200.0
    """
    ratio = as_floats(volume0) / as_floats(volume)
    temperature: FloatArray = as_floats(temperature0) * ratio ** (2.0 / dof)
    return temperature


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
        Degrees of freedom f of one molecule: 5 for air, whose exponent is 2/7; 3 for spheres, 2/5 [1].

    Returns
    -------
    ndarray
        Temperature, in the unit of the one at the start.

    Examples
    --------
    From 1000 to 500 hPa air cools from 15 degC to -37 degC; spheres that do not rotate would to -55 degC:

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
    r"""Return by how much dry air cools with each metre that it is lifted, :math:`g / c_p`.

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
        Dry-adiabatic lapse rate, positive where it cools upward [K m^-1].

    Examples
    --------
    In kelvin per kilometre:

    >>> round(float(dry_lapse_rate()) * 1000.0, 2)
    9.76
    """
    return as_floats(gravity) / ((dof / 2.0 + 1.0) * as_floats(specific_gas_constant))


def isothermal_work(molecules: ArrayLike, kT: ArrayLike, volume0: ArrayLike, volume: ArrayLike) -> FloatArray:
    r"""Return the work that an ideal gas does while it expands slowly at constant temperature.

    :math:`N k T \ln(V/V_0)`. All of it comes as heat through the walls.

    Parameters
    ----------
    molecules
        Number of molecules N [1].
    kT
        Temperature as an energy [energy].
    volume0, volume
        Volume at the start and at the end [length^3].

    Returns
    -------
    ndarray
        Work done by the gas, negative if it is compressed [energy].

    Examples
    --------
    >>> round(float(isothermal_work(1000, 1.0, 1.0, 2.0)), 2)
    693.15
    """
    work: FloatArray = as_floats(molecules) * as_floats(kT) * np.log(as_floats(volume) / as_floats(volume0))
    return work


def piston_pressure_ratio(piston_speed: ArrayLike, kT: ArrayLike, mass: ArrayLike) -> FloatArray:
    r"""Return how much less a gas presses on a piston that recedes than on one at rest.

    Fewer molecules reach it, and they hit it less hard. With :math:`s = u / \sqrt{2kT/m}` and the molecules
    that arrive still distributed as Maxwell says,

    .. math:: P/P_0 = (1 + 2 s^2)\, \mathrm{erfc}\, s - (2/\sqrt{\pi})\, s\, e^{-s^2}
              = 1 - (4/\sqrt{\pi})\, s + O(s^2) .

    So a gas that expands at a finite speed does less work than one that expands slowly, and one that is
    compressed takes more.

    Parameters
    ----------
    piston_speed
        Speed u of the piston away from the gas, negative if it comes nearer [length time^-1].
    kT
        Temperature as an energy [energy].
    mass
        Mass of a molecule [mass].

    Returns
    -------
    ndarray
        Pressure on the moving piston over that on a piston at rest [1].

    Notes
    -----
    The integral of :math:`2 m n (v - u)^2` over the velocities v > u of molecules that catch up with the
    piston.

    Examples
    --------
    One per cent is lost at 0.44 % of the most probable speed, for air at 288.15 K about 1.8 m/s:

    >>> from atmosbox.theory.constants import BOLTZMANN, DRY_AIR
    >>> round(float(piston_pressure_ratio(1.8, BOLTZMANN * 288.15, DRY_AIR.molecule_mass)), 3)
    0.99
    """
    from scipy import special  # loads slowly

    s = as_floats(piston_speed) / np.sqrt(2.0 * as_floats(kT) / as_floats(mass))
    ratio: FloatArray = (1.0 + 2.0 * s**2) * special.erfc(s) - 2.0 / np.sqrt(np.pi) * s * np.exp(-(s**2))
    return ratio
