r"""Spheres and discs with excluded volume: their pressure beside that of an ideal gas, and their free energy.

The packing fraction is the share of the space that spheres fill, :math:`\phi = \pi n \sigma^3 / 6`, or of the area that
discs cover, :math:`\eta = \pi n \sigma^2 / 4` with n molecules per area. All quantities here depend on it alone, never
on the temperature, because hard spheres have no energy except that of their motion.
"""

from collections.abc import Callable
from typing import Literal, NamedTuple

import numpy as np
from numpy.polynomial import Polynomial
from numpy.polynomial.legendre import leggauss
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats, require_dimensions

__all__ = [
    "FREEZING_PACKING_FRACTION", "FREEZING_PACKING_FRACTION_DISCS", "collision_rate_discs", "compressibility_factor",
    "compressibility_factor_discs", "contact_value", "contact_value_discs", "excess_chemical_potential",
    "excess_chemical_potential_discs", "excess_free_energy", "excess_free_energy_discs", "gas_pressure",
    "gas_pressure_discs", "hard_sphere_isentrope", "inverse_compressibility", "inverse_compressibility_discs",
    "packing_fraction", "packing_fraction_discs",
]  # fmt: skip

Form = Literal["kolafa", "carnahan-starling"]

FREEZING_PACKING_FRACTION = 0.494
"""Packing fraction above which spheres begin to crystallise (Hoover & Ree 1968, J. Chem. Phys. 49, 3609)."""

_HIGHEST_PACKING: dict[str, float] = {"kolafa": 1.03 * np.pi / 6.0, "carnahan-starling": 1.0}

# Z = sum of c_k x^k, x = phi / (1 - phi), k = 0 to 22 (Kolafa, Labík, Malijevský 2004).
_COEFFICIENTS = np.zeros(23)
_COEFFICIENTS[:9] = (1.0, 4.0, 6.0, 2.3647684, -0.8698551, 1.1062803, -1.1014221, 0.66605866, -0.03633431)
_COEFFICIENTS[[10, 14, 22]] = -0.20965164, 0.10555569, -0.00872380
_SERIES = Polynomial(_COEFFICIENTS)
_SERIES_SLOPE = _SERIES.deriv()
CONTACT_SERIES = Polynomial(_COEFFICIENTS[1:] / 4.0)


def checked_packing_fraction(packing_fraction: ArrayLike, form: Form = "kolafa") -> FloatArray:
    """Return the packing fractions as floats, or raise ``ValueError`` where the equation of state does not hold."""
    if form not in _HIGHEST_PACKING:
        raise ValueError(f"form = {form!r} must be one of {', '.join(_HIGHEST_PACKING)}.")
    phi = as_floats(packing_fraction)
    highest = _HIGHEST_PACKING[form]
    if not np.all((phi >= 0.0) & (phi < highest)):
        raise ValueError(f"packing_fraction must lie in [0, {highest:.4g}) for the {form} equation of state.")
    return phi


def packing_fraction(number_density: ArrayLike, diameter: ArrayLike) -> FloatArray:
    r"""Return the share of the space that the molecules fill, :math:`\phi = \pi n \sigma^3 / 6`.

    Parameters
    ----------
    number_density, diameter
        Molecules per volume [length^-3], and their diameter [length].

    Examples
    --------
    Air at the ground is nearly empty: its molecules fill 0.07 % of the space.

    >>> from atmosbox.theory.constants import BOLTZMANN, DRY_AIR
    >>> round(float(packing_fraction(100000.0 / (BOLTZMANN * 288.15), DRY_AIR.diameter)), 5)
    0.00067
    """
    return np.pi / 6.0 * as_floats(number_density) * as_floats(diameter) ** 3


def contact_value(packing_fraction: ArrayLike, form: Form = "kolafa") -> FloatArray:
    r"""Return the pair distribution at contact, :math:`g(\sigma)`: how much denser the gas is next to a molecule.

    It is 1 in a thin gas. Neighbours shield each other from collisions on other sides, so pairs in contact are more
    frequent than by chance, and by the virial theorem :math:`Z = 1 + 4 \phi g(\sigma)`.

    Parameters
    ----------
    packing_fraction, form
        As for :func:`compressibility_factor`.

    Examples
    --------
    >>> round(float(contact_value(0.2)), 5)
    1.76175
    """
    phi = checked_packing_fraction(packing_fraction, form)
    if form == "carnahan-starling":
        return (1.0 - phi / 2.0) / (1.0 - phi) ** 3
    contact: FloatArray = CONTACT_SERIES(phi / (1.0 - phi)) / (1.0 - phi)
    return contact


def compressibility_factor(packing_fraction: ArrayLike, form: Form = "kolafa") -> FloatArray:
    r"""Return the compressibility factor of spheres, their pressure over that of an ideal gas: :math:`Z = P / (n k T)`.

    The series of Kolafa, Labík and Malijevský (2004), doi:10.1039/B402792B, was fitted to molecular dynamics of 0.004 %
    accuracy at reduced densities up to 1.03, with the virial coefficients B2 to B6 built in. The classic formula of
    Carnahan and Starling (1969), doi:10.1063/1.1672048, good to 0.3 %, is
    :math:`Z = (1 + \phi + \phi^2 - \phi^3) / (1 - \phi)^3`.

    Parameters
    ----------
    packing_fraction
        Share of the space filled, below 0.539, or below 1 for Carnahan and Starling.
    form
        Equation of state: ``"kolafa"`` or ``"carnahan-starling"``.

    Examples
    --------
    In a thin gas Z exceeds 1 by four times the packing fraction; with a fifth filled the pressure is 2.4 times ideal:

    >>> [round(float(z), 4) for z in compressibility_factor([0.001, 0.2])]
    [1.004, 2.4094]
    """
    return 1.0 + 4.0 * checked_packing_fraction(packing_fraction, form) * contact_value(packing_fraction, form)


def inverse_compressibility(packing_fraction: ArrayLike) -> FloatArray:
    r"""Return the isothermal stiffness of the gas against compression, :math:`(\partial P / \partial n)_T / kT`.

    In terms of the compressibility factor it is :math:`d(\phi Z) / d\phi`; 1 for an ideal gas. Its inverse is the mean
    square fluctuation of the number of molecules in a large cell, divided by that number.

    Parameters
    ----------
    packing_fraction
        Share of the space filled, below 0.539.

    Examples
    --------
    >>> round(float(inverse_compressibility(0.2)), 4)
    4.7236
    """
    phi = checked_packing_fraction(packing_fraction)
    x = phi / (1.0 - phi)
    stiffness: FloatArray = _SERIES(x) + phi * _SERIES_SLOPE(x) / (1.0 - phi) ** 2
    return stiffness


def gas_pressure(number_density: ArrayLike, kT: ArrayLike, diameter: ArrayLike = 0.0) -> FloatArray:
    """Return the pressure of a gas of hard spheres, :math:`P = n k T Z` [energy length^-3].

    Parameters
    ----------
    number_density, kT, diameter
        Molecules per volume [length^-3], temperature as an energy [energy], diameter [length], 0 for points.

    Examples
    --------
    The excluded volume adds a quarter of a per cent to the pressure of air at the ground:

    >>> from atmosbox.theory.constants import BOLTZMANN, DRY_AIR
    >>> kT = BOLTZMANN * 288.15
    >>> round(float(gas_pressure(100000.0 / kT, kT, DRY_AIR.diameter)))
    100267
    """
    density = as_floats(number_density)
    return density * as_floats(kT) * compressibility_factor(packing_fraction(density, diameter))


FREEZING_PACKING_FRACTION_DISCS = 0.700
"""Packing fraction above which discs begin to order (Bernard & Krauth 2011, doi:10.1103/PhysRevLett.107.155704)."""


def checked_packing_fraction_discs(packing_fraction: ArrayLike) -> FloatArray:
    """Return the packing fractions as floats, or raise ``ValueError`` where the equation of state does not hold."""
    eta = as_floats(packing_fraction)
    if not np.all((eta >= 0.0) & (eta < 1.0)):
        raise ValueError("packing_fraction must lie in [0, 1) for the henderson equation of state.")
    return eta


def packing_fraction_discs(number_density: ArrayLike, diameter: ArrayLike) -> FloatArray:
    r"""Return the share of the area that discs cover, :math:`\eta = \pi n \sigma^2 / 4`.

    Parameters
    ----------
    number_density, diameter
        Molecules per area [length^-2], and their diameter [length].

    Examples
    --------
    Discs in the closest packing cover nine tenths of the plane:

    >>> round(float(packing_fraction_discs(2.0 / 3.0**0.5, 1.0)), 4)
    0.9069
    """
    return np.pi / 4.0 * as_floats(number_density) * as_floats(diameter) ** 2


def contact_value_discs(packing_fraction: ArrayLike) -> FloatArray:
    r"""Return the pair distribution of discs at contact, :math:`g(\sigma) = (Z - 1) / (2 \eta)`.

    Parameters
    ----------
    packing_fraction
        Share of the area covered, below 1.

    Examples
    --------
    >>> round(float(contact_value_discs(0.3)), 4)
    1.773
    """
    eta = checked_packing_fraction_discs(packing_fraction)
    return (1.0 - 7.0 * eta / 16.0) / (1.0 - eta) ** 2


def compressibility_factor_discs(packing_fraction: ArrayLike) -> FloatArray:
    r"""Return the compressibility factor of discs, their pressure over that of points: :math:`Z = P / (n k T)`.

    By Henderson (1975), doi:10.1080/00268977500102511, :math:`Z = (1 + \eta^2/8) / (1 - \eta)^2`.

    Parameters
    ----------
    packing_fraction
        Share of the area covered, below 1.

    Examples
    --------
    >>> round(float(compressibility_factor_discs(0.5)), 6)
    4.125
    """
    return 1.0 + 2.0 * as_floats(packing_fraction) * contact_value_discs(packing_fraction)


def inverse_compressibility_discs(packing_fraction: ArrayLike) -> FloatArray:
    r"""Return the stiffness of a plane gas against compression at constant temperature, :math:`d(\eta Z) / d\eta`.

    It is :math:`(\partial P / \partial n)_T / kT = (1 + \eta + 3\eta^2/8 - \eta^3/8) / (1 - \eta)^3`, and 1 for an
    ideal gas.

    Parameters
    ----------
    packing_fraction
        Share of the area covered, below 1.

    Examples
    --------
    Discs that cover half of the plane are thirteen times as stiff as points:

    >>> round(float(inverse_compressibility_discs(0.5)), 3)
    12.625
    """
    eta = checked_packing_fraction_discs(packing_fraction)
    return (1.0 + eta + 0.375 * eta**2 - 0.125 * eta**3) / (1.0 - eta) ** 3


def gas_pressure_discs(number_density: ArrayLike, kT: ArrayLike, diameter: ArrayLike = 0.0) -> FloatArray:
    """Return the pressure of a gas of discs, a force per length, :math:`P = n k T Z` [energy length^-2].

    Parameters
    ----------
    number_density, kT, diameter
        Discs per area [length^-2], temperature as an energy [energy], diameter [length], 0 for points.

    Examples
    --------
    Where they cover a tenth of the plane, the pressure of discs is 24 % higher than that of points:

    >>> n = 0.1 * 4.0 / np.pi
    >>> round(float(gas_pressure_discs(n, 1.0, 1.0) / gas_pressure_discs(n, 1.0)), 3)
    1.236
    """
    density = as_floats(number_density)
    packing = packing_fraction_discs(density, diameter)
    return density * as_floats(kT) * compressibility_factor_discs(packing)


def collision_rate_discs(number_density: ArrayLike, diameter: ArrayLike, kT: ArrayLike, mass: ArrayLike) -> FloatArray:
    r"""Return the collision rate of one disc, :math:`\nu = 2 n \sigma g(\sigma) \sqrt{\pi k T / m}` [time^-1].

    A gas of N discs has N/2 times as many collisions.

    Parameters
    ----------
    number_density, diameter, kT, mass
        Discs per area [length^-2], diameter [length], temperature as an energy [energy], mass of a disc [mass].

    Examples
    --------
    In a thin gas of discs the rate is that of points, times the width of the strip that a disc sweeps:

    >>> round(float(collision_rate_discs(1e-6, 1.0, 1.0, 1.0) * 1e6), 4)
    3.5449
    """
    contact = contact_value_discs(packing_fraction_discs(number_density, diameter))
    sweep = 2.0 * as_floats(number_density) * as_floats(diameter)
    rate: FloatArray = sweep * contact * np.sqrt(np.pi * as_floats(kT) / as_floats(mass))
    return rate


_NODES, _WEIGHTS = leggauss(32)
_NODES, _WEIGHTS = (_NODES + 1.0) / 2.0, _WEIGHTS / 2.0


def excess_free_energy(packing_fraction: ArrayLike) -> FloatArray:
    r"""Return the free energy per molecule, in units of kT, that excluded volume adds to an ideal gas.

    :math:`a(\phi) = \int_0^\phi (Z - 1)\, d\phi' / \phi'`, exact to rounding. Hard spheres have no potential energy, so
    this is also minus the excess entropy per molecule in units of k; the reason is the volume from which each molecule
    excludes the others.

    Parameters
    ----------
    packing_fraction
        Share of the space filled, below 0.539.

    Examples
    --------
    >>> round(float(excess_free_energy(0.2)), 4)
    1.0635
    """
    phi = checked_packing_fraction(packing_fraction)
    integral: FloatArray = contact_value(phi[..., np.newaxis] * _NODES) @ _WEIGHTS
    return 4.0 * phi * integral


def excess_chemical_potential(packing_fraction: ArrayLike) -> FloatArray:
    r"""Return the work, in units of kT, of inserting one more molecule, :math:`\mu_{ex} / kT = a(\phi) + Z(\phi) - 1`.

    Here :math:`a` is that of :func:`excess_free_energy`. The probability that a random place is free for a sphere is
    :math:`e^{-\mu_{ex}/kT}`.

    Parameters
    ----------
    packing_fraction
        Share of the space filled, below 0.539.

    Examples
    --------
    In a gas that fills a fifth of its space one place in twelve is free:

    >>> round(float(1.0 / np.exp(-excess_chemical_potential(0.2))))
    12
    """
    return excess_free_energy(packing_fraction) + compressibility_factor(packing_fraction) - 1.0


def excess_free_energy_discs(packing_fraction: ArrayLike) -> FloatArray:
    r"""Return the free energy per disc, in units of kT, that excluded volume adds to an ideal plane gas.

    :math:`a(\eta) = \int_0^\eta (Z - 1)\, d\eta' / \eta' = \frac{9 \eta}{8 (1 - \eta)} - \frac{7}{8} \ln (1 - \eta)`

    Parameters
    ----------
    packing_fraction
        Share of the area covered, below 1.

    Examples
    --------
    >>> round(float(excess_free_energy_discs(0.2)), 4)
    0.4765
    """
    eta = checked_packing_fraction_discs(packing_fraction)
    energy: FloatArray = 1.125 * eta / (1.0 - eta) - 0.875 * np.log1p(-eta)
    return energy


def excess_chemical_potential_discs(packing_fraction: ArrayLike) -> FloatArray:
    r"""Return the work, in units of kT, of inserting one more disc, :math:`a(\eta) + Z(\eta) - 1`.

    Parameters
    ----------
    packing_fraction
        Share of the area covered, below 1.

    Examples
    --------
    Where discs cover a fifth of the plane, one place in three is free for another disc:

    >>> round(float(np.exp(excess_chemical_potential_discs(0.2))))
    3
    """
    return excess_free_energy_discs(packing_fraction) + compressibility_factor_discs(packing_fraction) - 1.0


def hard_sphere_isentrope(packing_fraction: ArrayLike, packing_fraction0: ArrayLike, dof: float = 3) -> FloatArray:
    r"""Return the factor by which a gas of spheres warms when it is compressed slowly and without heat.

    The entropy per molecule, :math:`(f/2) \ln T - \ln \phi - a(\phi)`, is constant, so

    .. math:: T / T_0 = \left[ (\phi / \phi_0)\, e^{a(\phi) - a(\phi_0)} \right]^{2/f},
              \qquad dT / T = -(2/f)\, Z\, dV / V .

    As a function of pressure the correction to :func:`atmosbox.theory.dry_adiabat_temperature` begins only at second
    order in the packing fraction: the additional work and the higher pressure cancel at first order.

    Parameters
    ----------
    packing_fraction, packing_fraction0
        Share of the space filled, now and at the start, below 0.539.
    dof
        Degrees of freedom f that share the energy: 3, or 5 with two of rotation, 6 with three.

    Examples
    --------
    Compressed from a twentieth to a tenth filled, spheres warm by a factor 1.87; points would by 1.59:

    >>> round(float(hard_sphere_isentrope(0.10, 0.05)), 4)
    1.8673
    """
    phi, phi0 = as_floats(packing_fraction), as_floats(packing_fraction0)
    room = excess_free_energy(phi) - excess_free_energy(phi0)
    warming: FloatArray = (phi / phi0 * np.exp(room)) ** (2.0 / dof)
    return warming


class Crowding(NamedTuple):
    """Properties of a gas as functions of its packing fraction, and the packing fraction at which it freezes."""

    chemical_potential: Callable[[ArrayLike], FloatArray]
    compressibility_factor: Callable[[ArrayLike], FloatArray]
    stiffness: Callable[[ArrayLike], FloatArray]
    packing_fraction: Callable[[ArrayLike, ArrayLike], FloatArray]
    freezing: float


_SPHERES = Crowding(
    excess_chemical_potential,
    compressibility_factor,
    inverse_compressibility,
    packing_fraction,
    FREEZING_PACKING_FRACTION,
)
_DISCS = Crowding(
    excess_chemical_potential_discs,
    compressibility_factor_discs,
    inverse_compressibility_discs,
    packing_fraction_discs,
    FREEZING_PACKING_FRACTION_DISCS,
)


def crowding(dimensions: int) -> Crowding:
    """Return the equation of state of spheres or of discs."""
    require_dimensions(dimensions)
    return _DISCS if dimensions == 2 else _SPHERES
