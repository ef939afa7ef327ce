"""How molecules move at the start: velocities, and energies of rotation; places are from `scatter` and `lattice`."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.packing import packing_fraction
from atmosbox.engine.core.refusal import RefusedError
from atmosbox.engine.start.lattice import lattice_positions
from atmosbox.engine.start.scatter import random_positions

__all__ = [
    "equal_speeds",
    "lattice_positions",
    "maxwell_velocities",
    "packing_fraction",
    "random_positions",
    "rotational_energies",
    "two_halves",
]

Array = NDArray[np.float64]


def maxwell_velocities(
    kT: ArrayLike, mass: ArrayLike, rng: np.random.Generator, *, planar: bool = False, exact: bool = False
) -> Array:
    """Draw velocities of a gas at rest in equilibrium.

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
        Takes out the drift and scales the speeds so that the kinetic energy is that of kT to rounding.

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
    >>> v = maxwell_velocities(2.0, np.ones(100), np.random.default_rng(1), exact=True)
    >>> round(float((v**2).sum()) / 300, 12)
    2.0
    """
    m = np.atleast_1d(np.asarray(mass, np.float64))
    energy = np.broadcast_to(np.asarray(kT, np.float64), m.shape)
    if not (np.isfinite(energy).all() and (energy >= 0.0).all()):
        raise RefusedError("kT of a start must be 0 or above and finite")
    v = rng.standard_normal((m.size, 3)) * np.sqrt(energy / m)[:, None]
    if planar:
        v[:, 1] = 0.0
    if exact and m.size > 1 and energy.mean() > 0.0:
        v -= np.sum(m[:, None] * v, axis=0) / m.sum()
        dimensions = 2.0 if planar else 3.0
        v *= math.sqrt(dimensions * float(energy.sum()) / float(np.sum(m[:, None] * v * v)))
    return v


def equal_speeds(speed: float, number: int, rng: np.random.Generator, *, planar: bool = False) -> Array:
    """Return velocities of one speed [length/time] in random directions.

    Examples
    --------
    >>> v = equal_speeds(3.0, 5, np.random.default_rng(1))
    >>> np.allclose((v**2).sum(axis=1), 9.0)
    True
    """
    v = rng.standard_normal((number, 3))
    if planar:
        v[:, 1] = 0.0
    return np.asarray(speed * v / np.sqrt(np.sum(v * v, axis=1))[:, None])


def two_halves(position: Array, length: Sequence[float], kT: tuple[float, float]) -> Array:
    """Return the temperature [energy] of each molecule where the two halves of the box along x differ.

    Examples
    --------
    >>> two_halves(np.array([[1.0, 0, 0], [3.0, 0, 0]]), (4, 4, 4), (1.0, 2.0))
    array([1., 2.])
    """
    return np.where(position[:, 0] < 0.5 * length[0], kT[0], kT[1])


def rotational_energies(kT: ArrayLike, rotation: ArrayLike, rng: np.random.Generator) -> Array:
    """Draw rotational energies of equilibrium [energy]: gamma variates of half the degrees of freedom, times kT.

    Examples
    --------
    >>> rotational_energies(1.0, np.array([0.0]), np.random.default_rng(1))
    array([0.])
    """
    degrees = np.asarray(rotation, np.float64)
    return np.asarray(rng.standard_gamma(0.5 * degrees) * np.asarray(kT, np.float64))
