"""Molecules make room for drops: those that overlap a drop get new random positions."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.random import RandomNumbers, uniform

__all__ = ["clear", "clear_of_drops"]

Array = NDArray[np.float64]


@kernel
def _distance(place, i, x, y, z):
    """Return the distance of a point from the centre of molecule i, or of drop i [length]."""
    dx, dy, dz = place[i, 0] - x, place[i, 1] - y, place[i, 2] - z
    return math.sqrt(dx * dx + dy * dy + dz * dz)


@kernel
def _is_reached(x, y, z, centre, reach):
    """Return whether a point lies within the reach of a drop."""
    found = False
    for k in range(reach.size):
        found |= _distance(centre, k, x, y, z) < reach[k]
    return found


@kernel
def _is_taken(i, x, y, z, place):
    """Return whether molecule i would overlap another one at a point."""
    found = False
    for j in range(place.shape[0]):
        found |= j != i and _distance(place, j, x, y, z) <= 1.0
    return found


@kernel(entry=True)
def clear(place, centre, reach, side, state):
    """Give new positions to molecules within reach of a drop: see `clear_of_drops`; ``state : (1,)`` is advanced."""
    for i in range(place.shape[0]):
        x, y, z = place[i, 0], place[i, 1], place[i, 2]
        if not _is_reached(x, y, z, centre, reach):
            continue
        while True:
            x = 0.5 + (side - 1.0) * uniform(state)
            y = 0.5 + (side - 1.0) * uniform(state)
            z = 0.5 + (side - 1.0) * uniform(state)
            if not (_is_reached(x, y, z, centre, reach) or _is_taken(i, x, y, z, place)):
                break
        place[i, 0], place[i, 1], place[i, 2] = x, y, z


def clear_of_drops(position: Array, centre: ArrayLike, reach: ArrayLike, side: float, rng: RandomNumbers) -> Array:
    """Return positions of molecules of diameter 1 between walls; those within reach of a drop are drawn again.

    Parameters
    ----------
    position : (molecule, axis)
        Centres of molecules that do not overlap [length].
    centre : (drop, axis)
        Centres of the drops [length].
    reach : (drop,)
        Distance from the centre of each drop within which no centre of a molecule may be [length].
    side
        Side of the box, a cube [length].
    rng
        Random numbers.

    Examples
    --------
    >>> pair = np.array([[2.0, 2.0, 2.0], [5.0, 5.0, 5.0]])
    >>> pair = clear_of_drops(pair, [[3.0, 3.0, 3.0]], [2.0], 8.0, RandomNumbers(1))
    >>> bool(np.linalg.norm(pair[0] - 3.0) > 2.0), pair[1].tolist()
    (True, [5.0, 5.0, 5.0])
    """
    place = np.array(position, np.float64)
    clear(place, np.array(centre, np.float64), np.array(reach, np.float64), float(side), rng.state)
    return place
