r"""The effect of the excluded volume of molecules on entropy, free energy and the adiabat.

References
----------
Kolafa, J., Labík, S., Malijevský, A. (2004), doi:10.1039/B402792B. Henderson, D. (1975),
doi:10.1080/00268977500102511.
"""

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory.disc import checked_packing_fraction_discs, compressibility_factor_discs
from atmosbox.theory.equation_of_state import checked_packing_fraction, compressibility_factor, contact_value

_NODES, _WEIGHTS = leggauss(32)
_NODES, _WEIGHTS = (_NODES + 1.0) / 2.0, _WEIGHTS / 2.0


def excess_free_energy(packing_fraction: ArrayLike) -> FloatArray:
    r"""Return the free energy per molecule, in units of kT, that excluded volume adds to an ideal gas.

    :math:`a(\phi) = \int_0^\phi (Z - 1)\, d\phi' / \phi'`. Hard spheres have no potential energy, so this is also minus
    the excess entropy per molecule in units of k; the reason is the volume from which each molecule excludes the
    others.

    Parameters
    ----------
    packing_fraction
        Share of the space filled [1].

    Returns
    -------
    ndarray
        Excess free energy per molecule over kT [1].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    Notes
    -----
    The integral is a Gauss-Legendre quadrature with 32 points, exact to rounding.

    References
    ----------
    .. [1] Kolafa, J., Labík, S., Malijevský, A. (2004), doi:10.1039/B402792B.

    Examples
    --------
    >>> round(float(excess_free_energy(0.2)), 4)
    1.0635
    """
    phi = checked_packing_fraction(packing_fraction)
    integral: FloatArray = contact_value(phi[..., np.newaxis] * _NODES) @ _WEIGHTS
    return 4.0 * phi * integral


def excess_chemical_potential(packing_fraction: ArrayLike) -> FloatArray:
    r"""Return the work, in units of kT, of inserting one more molecule.

    :math:`\mu_{ex} / kT = a(\phi) + Z(\phi) - 1` with :math:`a` from :func:`excess_free_energy`; the probability that a
    random place is free for a sphere is :math:`e^{-\mu_{ex}/kT}`.

    Parameters
    ----------
    packing_fraction
        Share of the space filled [1].

    Returns
    -------
    ndarray
        Excess chemical potential over kT [1].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    References
    ----------
    .. [1] Kolafa, J., Labík, S., Malijevský, A. (2004), doi:10.1039/B402792B.

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
    [1]_, as :func:`excess_free_energy` of spheres.

    Parameters
    ----------
    packing_fraction
        Share of the area covered [1].

    Returns
    -------
    ndarray
        Excess free energy per disc over kT [1].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    References
    ----------
    .. [1] Henderson, D. (1975), doi:10.1080/00268977500102511.

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
        Share of the area covered [1].

    Returns
    -------
    ndarray
        Excess chemical potential over kT [1].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    References
    ----------
    .. [1] Henderson, D. (1975), doi:10.1080/00268977500102511.

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

    Parameters
    ----------
    packing_fraction, packing_fraction0
        Share of the space filled, now and at the start [1].
    dof
        Degrees of freedom f that share the energy: 3, or 5 with two of rotation, 6 with three [1].

    Returns
    -------
    ndarray
        Temperature over the temperature at the start [1].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    Notes
    -----
    As a function of pressure the correction to :func:`atmosbox.theory.dry_adiabat_temperature` begins only at second
    order in the packing fraction: the additional work and the higher pressure cancel at first order.

    References
    ----------
    .. [1] Kolafa, J., Labík, S., Malijevský, A. (2004), doi:10.1039/B402792B.

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
