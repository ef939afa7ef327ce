"""Velocities and rotational energies of the molecules at the start; positions are in `scatter` and `lattice`."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.elementary import log_of_normal
from atmosbox.engine.core.random import Source, normal
from atmosbox.engine.core.refusal import RefusedError

Array = NDArray[np.float64]


def maxwell_velocities(
    kT: ArrayLike, mass: ArrayLike, rng: Source, *, planar: bool = False, exact: bool = False
) -> Array:
    """Return random velocities of a gas at rest in equilibrium.

    Parameters
    ----------
    kT : (molecule,) or one number
        Temperature [energy].
    mass : (molecule,)
        Masses [mass].
    rng
        Random numbers.
    planar
        Whether the y velocity is zero.
    exact
        Whether to remove the drift and to scale the speeds so that the kinetic energy is exactly that of kT.

    Returns
    -------
    (molecule, axis) ndarray
        Velocities [length/time].

    Raises
    ------
    RefusedError
        If kT is negative or not finite.

    Examples
    --------
    >>> from atmosbox.engine.core.random import RandomNumbers
    >>> v = maxwell_velocities(2.0, np.ones(100), RandomNumbers(1), exact=True)
    >>> round(float((v**2).sum()) / 300, 12)
    2.0
    """
    m = np.atleast_1d(np.asarray(mass, np.float64))
    energy = np.broadcast_to(np.asarray(kT, np.float64), m.shape)
    if not (np.isfinite(energy).all() and (energy >= 0.0).all()):
        raise RefusedError("kT of a start must be 0 or above and finite")
    v = normal(rng, (m.size, 3)) * np.sqrt(energy / m)[:, None]
    if planar:
        v[:, 1] = 0.0
    if exact and m.size > 1 and energy.mean() > 0.0:
        v -= np.sum(m[:, None] * v, axis=0) / m.sum()
        dimensions = 2.0 if planar else 3.0
        v *= math.sqrt(dimensions * float(energy.sum()) / float(np.sum(m[:, None] * v * v)))
    return v


def equal_speeds(speed: float, number: int, rng: Source, *, planar: bool = False) -> Array:
    """Return velocities of the same speed [length/time] in random directions.

    Examples
    --------
    >>> from atmosbox.engine.core.random import RandomNumbers
    >>> v = equal_speeds(3.0, 5, RandomNumbers(1))
    >>> np.allclose((v**2).sum(axis=1), 9.0)
    True
    """
    v = normal(rng, (number, 3))
    if planar:
        v[:, 1] = 0.0
    return np.asarray(speed * v / np.sqrt(np.sum(v * v, axis=1))[:, None])


def rotational_energies(kT: ArrayLike, rotation: ArrayLike, rng: Source) -> Array:
    """Return random rotational energies in equilibrium [energy], for 0 to 3 rotational degrees of freedom.

    They are gamma variates of shape half the degrees of freedom, times kT.

    Examples
    --------
    >>> from atmosbox.engine.core.random import RandomNumbers
    >>> rotational_energies(1.0, np.array([0.0]), RandomNumbers(1))
    array([0.])
    """
    degrees = np.atleast_1d(np.asarray(rotation, np.float64))
    energy = np.where(degrees >= 2.0, -log_of_normal(rng.random(degrees.size)), 0.0)
    odd = degrees % 2.0 == 1.0
    deviate = normal(rng, int(odd.sum()))
    energy[odd] += 0.5 * deviate * deviate
    return np.asarray(energy * np.asarray(kT, np.float64))
