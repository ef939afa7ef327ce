r"""How often molecules collide, and how far they fly between collisions.

Enskog's theory: the rate of a thin gas, times the pair distribution at contact :math:`g(\sigma)`. For hard spheres in
equilibrium it is exact.

References
----------
Chapman, S., Cowling, T. G. (1970), Mathematical Theory of Non-uniform Gases, sections 5.2, 16.2.
"""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory.equation_of_state import contact_value, packing_fraction
from atmosbox.theory.maxwell import mean_speed


def collision_rate(number_density: ArrayLike, diameter: ArrayLike, kT: ArrayLike, mass: ArrayLike) -> FloatArray:
    r"""Return the collision rate of one molecule, :math:`\nu = 4 n \sigma^2 g(\sigma) \sqrt{\pi k T / m}`.

    Parameters
    ----------
    number_density
        Molecules per volume [length^-3].
    diameter
        Diameter of a molecule [length].
    kT
        Temperature as an energy [energy].
    mass
        Mass of a molecule [mass].

    Returns
    -------
    ndarray
        Collisions per molecule and time [time^-1]; a gas of N molecules has N/2 times as many.

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    References
    ----------
    .. [1] Chapman, S., Cowling, T. G. (1970), Mathematical Theory of Non-uniform Gases, sections 5.2, 16.2.
    .. [2] Kolafa, J., Labík, S., Malijevský, A. (2004), doi:10.1039/B402792B.

    Examples
    --------
    A molecule of air collides seven thousand million times a second:

    >>> from atmosbox.theory.constants import BOLTZMANN, DRY_AIR
    >>> kT = BOLTZMANN * 288.15
    >>> rate = collision_rate(101325.0 / kT, DRY_AIR.diameter, kT, DRY_AIR.molecule_mass)
    >>> print(f"{rate:.1e} per second")
    7.1e+09 per second
    """
    contact = contact_value(packing_fraction(number_density, diameter))
    sweep = 4.0 * as_floats(number_density) * as_floats(diameter) ** 2
    rate: FloatArray = sweep * contact * np.sqrt(np.pi * as_floats(kT) / as_floats(mass))
    return rate


def mean_free_time(number_density: ArrayLike, diameter: ArrayLike, kT: ArrayLike, mass: ArrayLike) -> FloatArray:
    r"""Return the mean time between two collisions of one molecule, :math:`\tau = 1 / \nu`.

    Parameters
    ----------
    number_density
        Molecules per volume [length^-3], above zero.
    diameter
        Diameter of a molecule [length], above zero.
    kT
        Temperature as an energy [energy].
    mass
        Mass of a molecule [mass].

    Returns
    -------
    ndarray
        Mean free time [time].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    References
    ----------
    .. [1] Chapman, S., Cowling, T. G. (1970), Mathematical Theory of Non-uniform Gases, sections 5.2, 16.2.

    Examples
    --------
    In a gas of 0.5 spheres per cubic diameter the mean free time is 0.130 of the time for one diameter at thermal
    speed:

    >>> round(float(mean_free_time(0.5, 1.0, 1.0, 1.0)), 5)
    0.13017
    """
    return 1.0 / collision_rate(number_density, diameter, kT, mass)


def mean_free_path(number_density: ArrayLike, diameter: ArrayLike) -> FloatArray:
    r"""Return the mean distance between two collisions of one molecule.

    :math:`\lambda = 1 / (\sqrt{2} \pi n \sigma^2 g)`. It is the mean speed times the mean free time, and does
    not depend on the temperature.

    Parameters
    ----------
    number_density
        Molecules per volume [length^-3], above zero.
    diameter
        Diameter of a molecule [length], above zero.

    Returns
    -------
    ndarray
        Mean free path [length].

    Raises
    ------
    ValueError
        If a packing fraction lies outside the range of the equation of state.

    References
    ----------
    .. [1] Chapman, S., Cowling, T. G. (1970), Mathematical Theory of Non-uniform Gases, sections 5.2, 16.2.

    Examples
    --------
    In air at the ground, 64 nm:

    >>> from atmosbox.theory.constants import BOLTZMANN, DRY_AIR
    >>> round(float(mean_free_path(101325.0 / (BOLTZMANN * 288.15), DRY_AIR.diameter)) * 1e9)
    64
    """
    return mean_speed(1.0, 1.0) * mean_free_time(number_density, diameter, 1.0, 1.0)


def contact_value_between(number_density: ArrayLike, diameter: ArrayLike) -> FloatArray:
    r"""Return the pair distribution at contact between the species of a mixture, :math:`g_{ij}`.

    The form of Boublík [1]_ and of Mansoori, Carnahan, Starling and Leland [2]_,

    .. math:: g_{ij} = \frac{1}{1-\phi} + \frac{3}{2} \frac{\xi d_{ij}}{(1-\phi)^2}
              + \frac{1}{2} \frac{(\xi d_{ij})^2}{(1-\phi)^3},
              \quad \xi = \frac{\pi}{6} \sum_k n_k \sigma_k^2,
              \quad d_{ij} = \frac{2 \sigma_i \sigma_j}{\sigma_i + \sigma_j} .

    Parameters
    ----------
    number_density : (species,)
        Molecules of each species per volume [length^-3].
    diameter : (species,)
        Diameter of each species [length].

    Returns
    -------
    ndarray : (species, species)
        Pair distribution at contact [1]. With one species, that of Carnahan and Starling.

    Raises
    ------
    ValueError
        If the two arguments differ in length, or the molecules fill the space.

    References
    ----------
    .. [1] Boublík, T. (1970), doi:10.1063/1.1673824.
    .. [2] Mansoori, G. A., et al. (1971), doi:10.1063/1.1675048.

    Examples
    --------
    Spheres are denser next to each other; points are denser only because the spheres leave them less volume:

    >>> print(contact_value_between([0.2, 0.1], [1.0, 0.0]).round(4))
    [[1.3206 1.117 ]
     [1.117  1.117 ]]
    """
    density, sigma = as_floats(number_density), as_floats(diameter)
    if density.ndim != 1 or density.shape != sigma.shape:
        raise ValueError("number_density and diameter must each hold one number per species.")
    filled = float(np.sum(packing_fraction(density, sigma)))
    if not 0.0 <= filled < 1.0:
        raise ValueError(f"packing_fraction = {filled:.4g} of the mixture must lie in [0, 1).")
    total = sigma[:, np.newaxis] + sigma
    product = 2.0 * sigma[:, np.newaxis] * sigma
    curvature = np.divide(product, total, out=np.zeros_like(total), where=total > 0.0)
    crowd = np.pi / 6.0 * float(density @ sigma**2) * curvature
    free = 1.0 - filled
    contact: FloatArray = 1.0 / free + 1.5 * crowd / free**2 + 0.5 * crowd**2 / free**3
    return contact


def collision_rate_between(number_density: ArrayLike, diameter: ArrayLike, mass: ArrayLike, kT: float) -> FloatArray:
    r"""Return how often a molecule of each species of a mixture collides with molecules of each species.

    :math:`\nu_{ij} = 2 n_j \sigma_{ij}^2 g_{ij} \sqrt{2 \pi k T / \mu_{ij}}` with :math:`\sigma_{ij}` the
    mean of the two diameters and :math:`\mu_{ij} = m_i m_j / (m_i + m_j)`.

    Parameters
    ----------
    number_density : (species,)
        Molecules of each species per volume [length^-3].
    diameter : (species,)
        Diameter of each species [length].
    mass : (species,)
        Mass of a molecule of each species [mass].
    kT
        Temperature as an energy [energy].

    Returns
    -------
    ndarray : (species, species)
        Collisions with species j per molecule of species i and time [time^-1]. The sum over j is the collision rate of
        a molecule of species i.

    Raises
    ------
    ValueError
        If the arguments differ in length, or the molecules fill the space.

    References
    ----------
    .. [1] Chapman, S., Cowling, T. G. (1970), Mathematical Theory of Non-uniform Gases, sections 5.2, 16.2.
    .. [2] Mansoori, G. A., et al. (1971), doi:10.1063/1.1675048.

    Examples
    --------
    Each of the few heavy molecules collides often with the many light ones, a light one seldom with the heavy ones; the
    total numbers agree:

    >>> rate = collision_rate_between([0.01, 0.09], [1.0, 1.0], [100.0, 1.0], 1.0)
    >>> bool(abs(0.01 * rate[0, 1] - 0.09 * rate[1, 0]) < 1e-15)
    True
    """
    density, sigma, masses = as_floats(number_density), as_floats(diameter), as_floats(mass)
    contact = contact_value_between(density, sigma)
    if masses.shape != density.shape:
        raise ValueError("number_density and mass must each hold one number per species.")
    reach = (sigma[:, np.newaxis] + sigma) / 2.0
    inverse_reduced_mass = 1.0 / masses[:, np.newaxis] + 1.0 / masses
    rate: FloatArray = 2.0 * density * reach**2 * contact * np.sqrt(2.0 * np.pi * kT * inverse_reduced_mass)
    return rate


def contact_share(sides: ArrayLike, diameter: float, molecules: int) -> float:
    r"""Return the ratio of collisions in a box with walls to those in open space.

    Of the positions on a sphere of one diameter around a molecule where a partner could touch it, some lie beyond a
    wall. With :math:`s_i = \sigma / L_i`, for sides L that the centres can reach, and orientations n in all directions
    equally likely, the share of the others is the mean of :math:`\prod (1 - |n_i| s_i)`; and a molecule has N - 1
    partners, not N.

    Parameters
    ----------
    sides : (axis,)
        Lengths that centres can reach, ``inf`` on a periodic axis [length].
    diameter
        Diameter of a molecule [length].
    molecules
        Number N of molecules.

    Returns
    -------
    float
        Share, between 0 and 1; exact for a thin gas, to first order in :math:`\sigma / L` for a dense one.

    Raises
    ------
    ValueError
        If there are no molecules.

    Notes
    -----
    Over all directions the means of :math:`|n_x|, |n_x n_y|, |n_x n_y n_z|` are
    :math:`1/2, 2/3\pi, 1/4\pi`.

    Examples
    --------
    Two hundred molecules of air at the ground, in a cube of 54 diameters, collide 3 % less often:

    >>> round(contact_share([54.0, 54.0, 54.0], 1.0, 200), 3)
    0.968
    """
    if molecules < 1:
        raise ValueError("a box without molecules has no contacts")
    x, y, z = diameter / np.asarray(sides, np.float64)
    lost = 0.5 * (x + y + z) - 2.0 / (3.0 * np.pi) * (x * y + y * z + z * x) + x * y * z / (4.0 * np.pi)
    return float((1.0 - lost) * (molecules - 1) / molecules)
