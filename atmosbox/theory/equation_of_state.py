r"""Spheres with excluded volume: their pressure compared with that of an ideal gas, and quantities that follow from it.

The packing fraction :math:`\phi = \pi n \sigma^3 / 6` is the share of the space that the spheres fill. All quantities
here depend on it alone, never on the temperature, because hard spheres have no energy except that of their motion.

References
----------
.. [1] Carnahan, N. F., Starling, K. E. (1969), doi:10.1063/1.1672048.
.. [2] Kolafa, J., Labík, S., Malijevský, A. (2004), doi:10.1039/B402792B: fitted to molecular dynamics
   of 0.004 % accuracy at reduced densities up to 1.03, with the virial coefficients B2 to B6 built in.
"""

from typing import Literal

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats

Form = Literal["kolafa", "carnahan-starling"]

FREEZING_PACKING_FRACTION = 0.494
"""Packing fraction above which spheres begin to crystallise (Hoover & Ree 1968, J. Chem. Phys. 49, 3609)."""

_HIGHEST_PACKING: dict[str, float] = {"kolafa": 1.03 * np.pi / 6.0, "carnahan-starling": 1.0}

# Z = sum of c_k x^k, x = phi / (1 - phi), k = 0 to 22 (Kolafa, Labík, Malijevský 2004).
_COEFFICIENTS = np.zeros(23)
_COEFFICIENTS[:9] = (
    1.0,
    4.0,
    6.0,
    2.3647684,
    -0.8698551,
    1.1062803,
    -1.1014221,
    0.66605866,
    -0.03633431,
)
_COEFFICIENTS[[10, 14, 22]] = -0.20965164, 0.10555569, -0.00872380
_SERIES = Polynomial(_COEFFICIENTS)
_SERIES_SLOPE = _SERIES.deriv()
_CONTACT_SERIES = Polynomial(_COEFFICIENTS[1:] / 4.0)


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
    number_density
        Molecules per volume [length^-3].
    diameter
        Diameter of a molecule [length].

    Returns
    -------
    ndarray
        Packing fraction [1].

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
    packing_fraction
        Share of the space filled [1].
    form
        Equation of state: ``"kolafa"`` [2]_ or ``"carnahan-starling"`` [1]_.

    Returns
    -------
    ndarray
        Pair distribution at contact [1].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state, or the form is unknown.

    References
    ----------
    .. [1] Carnahan, N. F., Starling, K. E. (1969), doi:10.1063/1.1672048.
    .. [2] Kolafa, J., Labík, S., Malijevský, A. (2004), doi:10.1039/B402792B.

    Examples
    --------
    >>> round(float(contact_value(0.2)), 5)
    1.76175
    """
    phi = checked_packing_fraction(packing_fraction, form)
    if form == "carnahan-starling":
        return (1.0 - phi / 2.0) / (1.0 - phi) ** 3
    contact: FloatArray = _CONTACT_SERIES(phi / (1.0 - phi)) / (1.0 - phi)
    return contact


def compressibility_factor(packing_fraction: ArrayLike, form: Form = "kolafa") -> FloatArray:
    r"""Return the compressibility factor of spheres, their pressure over that of an ideal gas: :math:`Z = P / (n k T)`.

    Parameters
    ----------
    packing_fraction
        Share of the space filled [1].
    form
        ``"kolafa"`` [2]_, good to 0.004 %, or the classic ``"carnahan-starling"`` [1]_,
        :math:`Z = (1 + \phi + \phi^2 - \phi^3) / (1 - \phi)^3`, good to 0.3 %.

    Returns
    -------
    ndarray
        Compressibility factor [1].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state, or the form is unknown.

    References
    ----------
    .. [1] Carnahan, N. F., Starling, K. E. (1969), doi:10.1063/1.1672048.
    .. [2] Kolafa, J., Labík, S., Malijevský, A. (2004), doi:10.1039/B402792B.

    Examples
    --------
    In a thin gas Z exceeds 1 by four times the packing fraction; with a fifth filled the pressure is 2.4 times ideal:

    >>> [round(float(z), 4) for z in compressibility_factor([0.001, 0.2])]
    [1.004, 2.4094]
    """
    return 1.0 + 4.0 * checked_packing_fraction(packing_fraction, form) * contact_value(packing_fraction, form)


def inverse_compressibility(packing_fraction: ArrayLike) -> FloatArray:
    r"""Return the stiffness of the gas against compression at constant temperature.

    :math:`(\partial P / \partial n)_T / kT`, in terms of the compressibility factor
    :math:`d(\phi Z) / d\phi`; 1 for an ideal gas. Its inverse is the mean square fluctuation of the number of
    molecules in a large cell, divided by that number.

    Parameters
    ----------
    packing_fraction
        Share of the space filled [1].

    Returns
    -------
    ndarray
        Reduced inverse compressibility [1].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    References
    ----------
    .. [1] Kolafa, J., Labík, S., Malijevský, A. (2004), doi:10.1039/B402792B.

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
    r"""Return the pressure of a gas of hard spheres, :math:`P = n k T Z`.

    Without a diameter it is that of an ideal gas.

    Parameters
    ----------
    number_density
        Molecules per volume [length^-3].
    kT
        Temperature as an energy [energy].
    diameter
        Diameter of a molecule [length].

    Returns
    -------
    ndarray
        Pressure [energy length^-3].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    References
    ----------
    .. [1] Kolafa, J., Labík, S., Malijevský, A. (2004), doi:10.1039/B402792B.

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
