r"""How much an honest measurement scatters.

A box of a few hundred molecules has a temperature that flickers, and a wall that is hit a few thousand times
feels a pressure that does. These are properties of gases, not faults of the engine; they set the error bars
that a run cannot beat.

References
----------
Hadjiconstantinou, N. G., Garcia, A. L., Bazant, M. Z., He, G. (2003), doi:10.1016/S0021-9991(03)00099-8.
"""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats


def temperature_noise(molecules: ArrayLike, dof: float = 3, temperature: ArrayLike = 1.0) -> FloatArray:
    r"""Return the scatter of the temperature of N molecules about their heat bath's, :math:`T \sqrt{2/fN}`.

    Parameters
    ----------
    molecules
        Number of molecules N [1].
    dof
        Degrees of freedom f of one molecule [1].
    temperature
        Mean temperature, in K or as an energy; without it the scatter is relative.

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


def count_noise(molecules: ArrayLike, share: ArrayLike = 0.0) -> FloatArray:
    r"""Return the scatter of the number of molecules in a part of a box, :math:`\sqrt{n (1 - s)}`.

    Each molecule of an ideal gas is in the part or not, by the toss of a coin.

    Parameters
    ----------
    molecules
        Mean number n in the part [1].
    share
        Share s of the box that the part is; 0 for a part of a very large box [1].

    Returns
    -------
    ndarray
        Standard deviation of the number [1].

    References
    ----------
    .. [1] Hadjiconstantinou, N. G., et al. (2003), doi:10.1016/S0021-9991(03)00099-8.

    Examples
    --------
    Of 800 molecules 400 +- 14 are in the left half:

    >>> round(float(count_noise(400, 0.5)))
    14
    """
    scatter: FloatArray = np.sqrt(as_floats(molecules) * (1.0 - as_floats(share)))
    return scatter


def wall_pressure_noise(hits: ArrayLike, accommodation: ArrayLike = 0.0) -> FloatArray:
    r"""Return the relative standard error of a pressure measured from hits on a wall.

    The hits are independent, and each gives a Rayleigh-distributed impulse on arrival and another when it
    leaves; the two are equal at a specular wall and independent at a heat bath:

    .. math:: \sqrt{\frac{8 - (4 - \pi)\, \alpha}{2 \pi N}},

    from 1.128 (:math:`\alpha = 0`) to 1.066 (:math:`\alpha = 1`) over :math:`\sqrt{N}`.

    Parameters
    ----------
    hits
        Number of hits N [1].
    accommodation
        Share :math:`\alpha` of the hits after which a molecule leaves with the temperature of the wall: 0
        specular, 1 diffuse [1].

    Returns
    -------
    ndarray
        Standard error of the pressure over the pressure [1].

    References
    ----------
    .. [1] Hadjiconstantinou, N. G., et al. (2003), doi:10.1016/S0021-9991(03)00099-8.

    Examples
    --------
    Ten thousand hits measure a pressure to one per cent:

    >>> [round(float(wall_pressure_noise(10_000, a)), 5) for a in (0.0, 1.0)]
    [0.01128, 0.01066]
    """
    impulse = (8.0 - (4.0 - np.pi) * as_floats(accommodation)) / (2.0 * np.pi)
    error: FloatArray = np.sqrt(impulse / as_floats(hits))
    return error


def heat_noise(hits: ArrayLike, kT: ArrayLike, rotational_dof: float = 0) -> FloatArray:
    r"""Return the scatter of the heat through a heat bath that is in equilibrium with its gas.

    :math:`kT \sqrt{(4 + \zeta) N}`. Each hit brings an energy and takes another, both of the variance
    :func:`atmosbox.theory.emission_energy_variance`.

    Parameters
    ----------
    hits
        Number of hits N [1].
    kT
        Temperature as an energy [energy].
    rotational_dof
        Rotational degrees of freedom :math:`\zeta` [1].

    Returns
    -------
    ndarray
        Standard deviation of the heat [energy].

    References
    ----------
    .. [1] Garcia, A. L., Wagner, W. (2006), J. Comput. Phys. 217, 693 (WIAS preprint 1013).

    Examples
    --------
    >>> float(heat_noise(10_000, 1.0))
    200.0
    """
    scatter: FloatArray = as_floats(kT) * np.sqrt((4.0 + rotational_dof) * as_floats(hits))
    return scatter


def collision_rate_noise(collisions: ArrayLike) -> FloatArray:
    r"""Return the relative standard error of a counted collision rate, at most :math:`1/\sqrt{N_c}`.

    Parameters
    ----------
    collisions
        Number of collisions counted [1].

    Returns
    -------
    ndarray
        Standard error of the rate over the rate [1].

    Notes
    -----
    Independent events would give this exactly. In a gas at constant energy the collisions are a little more
    regular, so that it is an upper bound.

    Examples
    --------
    >>> float(collision_rate_noise(10_000))
    0.01
    """
    error: FloatArray = 1.0 / np.sqrt(as_floats(collisions))
    return error


def compressibility_noise(compressibility_factor: ArrayLike, collisions: ArrayLike) -> FloatArray:
    r"""Return the standard error of a compressibility factor measured from collisions.

    At most :math:`(Z-1) \sqrt{4/\pi N_c}`. The virial is the sum of the impulses along the lines of centres,
    which are Rayleigh-distributed as on a wall.

    Parameters
    ----------
    compressibility_factor
        Expected Z [1].
    collisions
        Number of collisions counted [1].

    Returns
    -------
    ndarray
        Standard error of Z [1].

    Notes
    -----
    An upper bound, for the reason given in :func:`collision_rate_noise`.

    Examples
    --------
    >>> round(float(compressibility_noise(2.0, 10_000)), 4)
    0.0113
    """
    error: FloatArray = (as_floats(compressibility_factor) - 1.0) * np.sqrt(4.0 / np.pi)
    return error * collision_rate_noise(collisions)
