r"""The speeds of molecules: Maxwell's distribution, and how much the temperature of a few molecules scatters.

References
----------
Maxwell, J. C. (1860), doi:10.1080/14786446008642818.
"""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats, require_dimensions


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
    No molecule has the speed zero:

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


def temperature_noise(molecules: ArrayLike, dof: float = 3, temperature: ArrayLike = 1.0) -> FloatArray:
    r"""Return the standard deviation of the temperature of N molecules in a heat bath, :math:`T \sqrt{2/fN}`.

    Parameters
    ----------
    molecules
        Number of molecules N [1].
    dof
        Degrees of freedom f of one molecule [1].
    temperature
        Mean temperature, in K or as an energy; with the default of 1 the result is relative.

    Returns
    -------
    ndarray
        Standard deviation, in the unit of the temperature.

    References
    ----------
    .. [1] Hadjiconstantinou, N. G., et al. (2003), doi:10.1016/S0021-9991(03)00099-8.

    Examples
    --------
    A thermometer of 200 molecules at 300 K scatters by 17 K, of 800 by 9 K:

    >>> [round(float(t), 1) for t in temperature_noise([200, 800], temperature=300.0)]
    [17.3, 8.7]
    """
    scatter: FloatArray = as_floats(temperature) * np.sqrt(2.0 / (dof * as_floats(molecules)))
    return scatter
