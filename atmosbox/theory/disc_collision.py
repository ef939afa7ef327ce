"""Collisions of discs: how often they meet in the plane, and how far they fly between."""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory.disc import DiscForm, contact_value_discs, packing_fraction_discs


def collision_rate_discs(
    number_density: ArrayLike,
    diameter: ArrayLike,
    kT: ArrayLike,
    mass: ArrayLike,
    form: DiscForm = "henderson",
) -> FloatArray:
    r"""Return how often one disc is hit, :math:`\nu = 2 n \sigma g(\sigma) \sqrt{\pi k T / m}`.

    Parameters
    ----------
    number_density
        Molecules per area [length^-2].
    diameter
        Diameter of a disc [length].
    kT
        Temperature as an energy [energy].
    mass
        Mass of a disc [mass].
    form
        Equation of state that gives the contact value, as in :func:`compressibility_factor_discs`.

    Returns
    -------
    ndarray
        Collisions per disc and time [time^-1]; N discs have half of N times this many.

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state, or the form is unknown.

    References
    ----------
    .. [1] Henderson, D. (1975), doi:10.1080/00268977500102511.

    Examples
    --------
    A thin gas of discs: the rate is that of points times the width of the strip a disc sweeps.

    >>> round(float(collision_rate_discs(1e-6, 1.0, 1.0, 1.0) * 1e6), 4)
    3.5449
    """
    contact = contact_value_discs(packing_fraction_discs(number_density, diameter), form)
    sweep = 2.0 * as_floats(number_density) * as_floats(diameter)
    rate: FloatArray = sweep * contact * np.sqrt(np.pi * as_floats(kT) / as_floats(mass))
    return rate


def mean_free_path_discs(number_density: ArrayLike, diameter: ArrayLike, form: DiscForm = "henderson") -> FloatArray:
    r"""Return the mean distance between two collisions of one disc, :math:`\lambda = 1 / (2\sqrt{2}\, n \sigma g)`.

    It is the mean speed in the plane, :math:`\sqrt{\pi k T / 2 m}`, over :func:`collision_rate_discs` [1]_.

    Parameters
    ----------
    number_density
        Molecules per area [length^-2], above zero.
    diameter
        Diameter of a disc [length], above zero.
    form
        Equation of state that gives the contact value, as in :func:`compressibility_factor_discs`.

    Returns
    -------
    ndarray
        Mean free path [length].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state, or the form is unknown.

    References
    ----------
    .. [1] Gass, D. M. (1971), J. Chem. Phys. 54, 1898.

    Examples
    --------
    In a thin gas a disc flies until the strip that it sweeps, made wider by a factor :math:`\sqrt{2}` because
    the others move too, holds one other:

    >>> round(float(mean_free_path_discs(1e-4, 1.0)))
    3535
    """
    contact = contact_value_discs(packing_fraction_discs(number_density, diameter), form)
    path: FloatArray = 1.0 / (2.0 * np.sqrt(2.0) * as_floats(number_density) * as_floats(diameter) * contact)
    return path
