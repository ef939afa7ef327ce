r"""The molecules that hit a wall, and those that leave it.

Fast molecules reach a wall more often than slow ones, so those that cross a plane are not a representative sample: they
carry 2 kT of energy each, not 3/2 kT. A heat bath must send out molecules with the same distribution, or the gas beside
it is too cold.

References
----------
Garcia, A. L., Wagner, W. (2006), J. Comput. Phys. 217, 693 (WIAS preprint 1013). Tehver, R., et al. (1998),
doi:10.1103/PhysRevE.57.R17.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats, require_dimensions


class FreeMolecularSlab(NamedTuple):
    """A gas so thin that molecules fly from wall to wall without collisions."""

    kT: FloatArray
    """Temperature of the gas as an energy [energy]."""
    pressure: FloatArray
    """Pressure on either wall [energy length^-3]."""
    heat_flux: FloatArray
    """Heat from the first wall to the second, per area and time [energy length^-2 time^-1]."""


def emission_normal_speed(kT: ArrayLike, mass: ArrayLike) -> FloatArray:
    r"""Return the mean normal speed of the molecules that leave a heat bath.

    :math:`\sqrt{\pi kT / 2m}`.

    Parameters
    ----------
    kT
        Temperature of the wall as an energy [energy].
    mass
        Mass of a molecule [mass].

    Returns
    -------
    ndarray
        Mean of the normal component of the velocity [length time^-1].

    References
    ----------
    .. [1] Garcia, A. L., Wagner, W. (2006), J. Comput. Phys. 217, 693 (WIAS preprint 1013).

    Examples
    --------
    They are 1.57 times as fast as the molecules inside the gas that move in that direction:

    >>> inside = (2.0 / np.pi) ** 0.5
    >>> round(float(emission_normal_speed(1.0, 1.0)) / inside, 3)
    1.571
    """
    speed: FloatArray = np.sqrt(np.pi * as_floats(kT) / (2.0 * as_floats(mass)))
    return speed


def emission_energy(kT: ArrayLike, dimensions: int = 3, rotational_dof: float = 0) -> FloatArray:
    r"""Return the mean energy that a molecule takes from a heat bath, 2 kT for a sphere.

    The energy follows a gamma distribution of shape :math:`(d + 1 + \zeta)/2` in d dimensions with
    :math:`\zeta` rotational degrees of freedom.

    Parameters
    ----------
    kT
        Temperature of the wall as an energy [energy].
    dimensions
        3, or 2 for molecules in a plane.
    rotational_dof
        Rotational degrees of freedom: 0, or 2 for air, 3 for water vapour [1].

    Returns
    -------
    ndarray
        Mean energy [energy].

    Raises
    ------
    ValueError
        If dimensions is neither 2 nor 3.

    References
    ----------
    .. [1] Garcia, A. L., Wagner, W. (2006), J. Comput. Phys. 217, 693 (WIAS preprint 1013).

    Examples
    --------
    A sphere, a disc in a plane, a molecule of air:

    >>> [float(e) for e in (emission_energy(1.0), emission_energy(1.0, 2), emission_energy(1.0, 3, 2))]
    [2.0, 1.5, 3.0]
    """
    require_dimensions(dimensions)
    return (dimensions + 1 + rotational_dof) / 2.0 * as_floats(kT)


def free_molecular_slab(
    kT1: ArrayLike, kT2: ArrayLike, number_density: ArrayLike, mass: ArrayLike, rotational_dof: float = 0
) -> FreeMolecularSlab:
    r"""Return the state of a very thin gas between two heat baths of different temperature.

    Two streams cross without collisions, one from each wall. They carry equal numbers of molecules, so the colder
    stream is denser, and the gas has the geometric mean of the two temperatures everywhere:

    .. math:: T = \sqrt{T_1 T_2}, \qquad p = n k \sqrt{T_1 T_2}, \qquad
              q = 2 n k \sqrt{2k/\pi m}\, \sqrt{T_1 T_2}\, (\sqrt{T_1} - \sqrt{T_2})\, (1 + \zeta/4) .

    Parameters
    ----------
    kT1, kT2
        Temperature of the first and of the second wall as an energy [energy].
    number_density
        Molecules per volume [length^-3].
    mass
        Mass of a molecule [mass].
    rotational_dof
        Rotational degrees of freedom :math:`\zeta`; each carries kT/2 from wall to wall [1].

    Returns
    -------
    FreeMolecularSlab
        Temperature, pressure, and heat flux from the first wall to the second.

    References
    ----------
    .. [1] Sone, Y. (2007), Molecular Gas Dynamics, doi:10.1007/978-0-8176-4573-1.

    Examples
    --------
    Between walls of 1 and 4 the gas has 2, not the mean of 2.5:

    >>> float(free_molecular_slab(4.0, 1.0, 1.0, 1.0).kT)
    2.0
    """
    hot, cold = np.sqrt(as_floats(kT1)), np.sqrt(as_floats(kT2))
    density = as_floats(number_density)
    flux = density * np.sqrt(8.0 / (np.pi * as_floats(mass))) * hot * cold * (hot - cold)
    return FreeMolecularSlab(hot * cold, density * hot * cold, flux * (1.0 + rotational_dof / 4.0))
