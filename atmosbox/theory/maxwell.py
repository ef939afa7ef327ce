r"""How fast molecules are: Maxwell's distribution, and what a small closed box does to it.

References
----------
Maxwell, J. C. (1860), doi:10.1080/14786446008642818.
"""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats, require_dimensions


def most_probable_speed(kT: ArrayLike, mass: ArrayLike, dimensions: int = 3) -> FloatArray:
    r"""Return the speed at the peak of Maxwell's distribution.

    :math:`\sqrt{2kT/m}`, or :math:`\sqrt{kT/m}` in a plane.

    Parameters
    ----------
    kT
        Temperature as an energy [energy].
    mass
        Mass of a molecule [mass].
    dimensions
        3, or 2 for molecules in a plane.

    Returns
    -------
    ndarray
        Most probable speed [length time^-1].

    Raises
    ------
    ValueError
        If dimensions is neither 2 nor 3.

    Examples
    --------
    Air at 288.15 K, in metres per second:

    >>> from atmosbox.theory.constants import BOLTZMANN, DRY_AIR
    >>> round(float(most_probable_speed(BOLTZMANN * 288.15, DRY_AIR.molecule_mass)))
    407
    """
    require_dimensions(dimensions)
    speed: FloatArray = np.sqrt((dimensions - 1) * as_floats(kT) / as_floats(mass))
    return speed


def mean_speed(kT: ArrayLike, mass: ArrayLike, dimensions: int = 3) -> FloatArray:
    r"""Return the mean speed of the molecules.

    :math:`\sqrt{8kT/\pi m}`, or :math:`\sqrt{\pi kT/2m}` in a plane.

    Parameters
    ----------
    kT
        Temperature as an energy [energy].
    mass
        Mass of a molecule [mass].
    dimensions
        3, or 2 for molecules in a plane.

    Returns
    -------
    ndarray
        Mean speed [length time^-1].

    Raises
    ------
    ValueError
        If dimensions is neither 2 nor 3.

    Examples
    --------
    Air at 288.15 K, in metres per second:

    >>> from atmosbox.theory.constants import BOLTZMANN, DRY_AIR
    >>> round(float(mean_speed(BOLTZMANN * 288.15, DRY_AIR.molecule_mass)))
    459
    """
    require_dimensions(dimensions)
    factor = 8.0 / np.pi if dimensions == 3 else np.pi / 2.0
    speed: FloatArray = np.sqrt(factor * as_floats(kT) / as_floats(mass))
    return speed


def root_mean_square_speed(kT: ArrayLike, mass: ArrayLike, dimensions: int = 3) -> FloatArray:
    r"""Return the speed that carries the mean energy, :math:`\sqrt{d\, kT/m}` in d dimensions.

    Parameters
    ----------
    kT
        Temperature as an energy [energy].
    mass
        Mass of a molecule [mass].
    dimensions
        3, or 2 for molecules in a plane.

    Returns
    -------
    ndarray
        Root-mean-square speed [length time^-1].

    Raises
    ------
    ValueError
        If dimensions is neither 2 nor 3.

    Examples
    --------
    Air at 288.15 K, in metres per second:

    >>> from atmosbox.theory.constants import BOLTZMANN, DRY_AIR
    >>> round(float(root_mean_square_speed(BOLTZMANN * 288.15, DRY_AIR.molecule_mass)))
    498
    """
    require_dimensions(dimensions)
    speed: FloatArray = np.sqrt(dimensions * as_floats(kT) / as_floats(mass))
    return speed


def maxwell_speed_density(speed: ArrayLike, kT: ArrayLike, mass: ArrayLike, dimensions: int = 3) -> FloatArray:
    r"""Return Maxwell's distribution of speeds: the share of molecules per interval of speed.

    :math:`4\pi (m/2\pi kT)^{3/2} v^2 e^{-mv^2/2kT}` in space, :math:`(m v/kT)\, e^{-mv^2/2kT}` in a plane.

    Parameters
    ----------
    speed
        Speed [length time^-1], at least zero.
    kT
        Temperature as an energy [energy].
    mass
        Mass of a molecule [mass].
    dimensions
        3, or 2 for molecules in a plane.

    Returns
    -------
    ndarray
        Probability density of the speed [time length^-1].

    Raises
    ------
    ValueError
        If dimensions is neither 2 nor 3.

    References
    ----------
    .. [1] Maxwell, J. C. (1860), doi:10.1080/14786446008642818.

    Examples
    --------
    No molecule stands still:

    >>> [round(float(p), 4) for p in maxwell_speed_density([0.0, 1.0, 2.0], 1.0, 1.0)]
    [0.0, 0.4839, 0.432]
    """
    require_dimensions(dimensions)
    v, spread = as_floats(speed), as_floats(kT) / as_floats(mass)
    bell = np.exp(-(v**2) / (2.0 * spread))
    if dimensions == 2:
        plane: FloatArray = v / spread * bell
        return plane
    space: FloatArray = np.sqrt(2.0 / np.pi) * v**2 / spread**1.5 * bell
    return space


def maxwell_speed_cumulative(speed: ArrayLike, kT: ArrayLike, mass: ArrayLike, dimensions: int = 3) -> FloatArray:
    r"""Return the share of molecules slower than a speed.

    The regularised incomplete gamma function :math:`P(d/2,\, mv^2/2kT)` in d dimensions. The mean of the
    density over a bin of a histogram is the difference of two of these, divided by the width of the bin.

    Parameters
    ----------
    speed
        Speed [length time^-1], at least zero.
    kT
        Temperature as an energy [energy].
    mass
        Mass of a molecule [mass].
    dimensions
        3, or 2 for molecules in a plane.

    Returns
    -------
    ndarray
        Share of the molecules, 0 to 1 [1].

    Raises
    ------
    ValueError
        If dimensions is neither 2 nor 3.

    References
    ----------
    .. [1] Maxwell, J. C. (1860), doi:10.1080/14786446008642818.

    Examples
    --------
    One molecule in 24 000 is faster than three times the mean speed:

    >>> faster = 1.0 - maxwell_speed_cumulative(3.0 * mean_speed(1.0, 1.0), 1.0, 1.0)
    >>> round(1.0 / float(faster), -3)
    24000.0
    """
    from scipy import special  # loads slowly

    require_dimensions(dimensions)
    share: FloatArray = special.gammainc(
        dimensions / 2.0, as_floats(mass) * as_floats(speed) ** 2 / (2.0 * as_floats(kT))
    )
    return share


def constant_energy_kurtosis(dof: ArrayLike) -> FloatArray:
    r"""Return the kurtosis of one velocity component in a box of exactly constant energy, :math:`3f/(f+2)`.

    In a closed box the velocities lie on a sphere in f dimensions, and one component follows a beta
    distribution, not quite Gauss's: a molecule cannot have more than all the energy.

    Parameters
    ----------
    dof
        Degrees of freedom f that share the energy, 3N without rotation [1].

    Returns
    -------
    ndarray
        Kurtosis, 3 for a normal distribution [1].

    References
    ----------
    .. [1] Scalas, E., Gabriel, A. T., Martin, E., Germano, G. (2015), doi:10.1103/PhysRevE.92.022140.

    Examples
    --------
    >>> round(float(constant_energy_kurtosis(3 * 100)), 3)
    2.98
    """
    f = as_floats(dof)
    return 3.0 * f / (f + 2.0)


def constant_energy_speed_factor(dof: ArrayLike) -> FloatArray:
    r"""Return by what factor the mean speed in a box of exactly constant energy exceeds Maxwell's.

    :math:`\sqrt{f/2}\; \Gamma(f/2) / \Gamma((f+1)/2) \approx 1 + 1/4f`. The collision rate carries the same
    factor.

    Parameters
    ----------
    dof
        Degrees of freedom f that share the energy, 3N without rotation [1].

    Returns
    -------
    ndarray
        Mean speed over that of Maxwell's distribution at :math:`kT = 2E/f` [1].

    References
    ----------
    .. [1] Scalas, E., Gabriel, A. T., Martin, E., Germano, G. (2015), doi:10.1103/PhysRevE.92.022140.

    Examples
    --------
    It matters below about a hundred molecules:

    >>> round(float(constant_energy_speed_factor(3 * 10)), 4)
    1.0084
    """
    from scipy import special  # loads slowly

    f = as_floats(dof)
    factor: FloatArray = np.sqrt(f / 2.0) * np.exp(special.gammaln(f / 2.0) - special.gammaln((f + 1.0) / 2.0))
    return factor
