"""Positions of the molecules at the start, at random.

Molecules too dense for random positions are refused within a second, with the reason.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.elementary import expm1, log1p
from atmosbox.engine.core.packing import packing_fraction, refuse_impossible
from atmosbox.engine.core.random import Source
from atmosbox.engine.core.refusal import PackingError, RefusedError
from atmosbox.engine.start.overlap import push_apart

__all__ = ["random_positions"]

Array = NDArray[np.float64]
_GAP = 1e-6
_ROUNDS = 8
_PATIENCE = 100
_DENSEST_RANDOM = 0.56
_DENSEST_RANDOM_PLANE = 0.74


def random_positions(
    length: Sequence[float],
    diameter: ArrayLike,
    rng: Source,
    *,
    periodic: tuple[bool, bool, bool] = (False, False, False),
    planar: bool = False,
    top: float | None = None,
    scale_height: float | None = None,
    apart: bool = True,
) -> Array:
    """Return random positions of molecules; those that overlap are pushed apart.

    Parameters
    ----------
    length
        The three sides of the box [length].
    diameter : (molecule,)
        Diameters [length], one for each molecule.
    rng
        Random numbers.
    periodic
        Whether each axis is periodic.
    planar
        Whether all centres lie in the plane y = half the box.
    top
        Only heights below this one are used [length]; the whole box by default.
    scale_height
        If given, the density decreases with height as in an isothermal atmosphere of this scale height [length].
    apart
        Whether overlapping molecules are pushed apart; without it nothing is compiled, but no engine takes the result.

    Returns
    -------
    (molecule, axis) ndarray
        Centres [length].

    Raises
    ------
    PackingError
        If they do not fit at random; a regular lattice reaches higher packing fractions.

    Notes
    -----
    Overlapping pairs are moved apart along their line of centres by the depth of the overlap, again and again.
    That works up to packing fractions of 0.56; random places tried one by one end at 0.38
    (in a plane 0.74 and 0.55).

    Examples
    --------
    >>> from atmosbox.engine.core.random import RandomNumbers
    >>> where = random_positions((5, 5, 5), np.ones(20), RandomNumbers(1))
    >>> float(where.min()) >= 0.5, where.shape
    (True, (20, 3))
    """
    sigma = np.atleast_1d(np.asarray(diameter, np.float64))
    n = sigma.size
    sides = np.array(length, np.float64)
    if top is not None:
        if not 0.0 < top <= sides[2]:
            raise RefusedError(f"top = {top:.6g} is outside the box: give a height between 0 and {sides[2]:.6g}")
        sides[2] = top
    refuse_impossible(sides, sigma, periodic, planar)
    low = np.where(periodic, 0.0, 1.0)[None, :] * 0.5 * sigma[:, None]
    high = sides[None, :] - low
    x = low + rng.random((n, 3)) * (high - low)
    if scale_height is not None and math.isfinite(scale_height):
        reach = high[:, 2] - low[:, 2]
        x[:, 2] = low[:, 2] - scale_height * log1p(rng.random(n) * expm1(-reach / scale_height))
    if planar:
        x[:, 1] = low[:, 1] = high[:, 1] = 0.5 * sides[1]
    turn = sides * np.array(periodic)
    if n < 2 or sigma.max() == 0.0:
        return x
    phi = packing_fraction(list(sides), sigma, planar=planar)
    if np.ptp(sigma) == 0.0 and phi > (_DENSEST_RANDOM_PLANE if planar else _DENSEST_RANDOM):
        raise _too_dense(n, sides, sigma, planar)
    if not apart:
        return x
    for _ in range(_PATIENCE):
        if push_apart(x, 0.5 * sigma, low, high, turn, _ROUNDS, _GAP) == 0:
            return x
    raise _too_dense(n, sides, sigma, planar)


def _too_dense(n: int, sides: Array, sigma: Array, planar: bool) -> PackingError:
    """Return the refusal of a packing fraction that only a lattice could reach."""
    phi = packing_fraction(list(sides), sigma, planar=planar)
    return PackingError(
        f"{n} molecules fill {phi:.3g} of the space, too much for a random start: "
        "take fewer or smaller molecules, a larger box, or a lattice start"
    )
