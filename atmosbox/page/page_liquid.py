"""Liquid that has no place in the model, given one to be seen: a mist as clumps, a pool and rain as layers.

The mist of a scene is an area that vapour meets and a number of molecules in it, and a pool is a floor and a number:
the engine follows no molecule of them. The page draws as much of them as there is, and says that it chose the places.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["POOL", "RAIN", "SWELLING", "clumps", "layer", "places"]

_A_CLUMP = 12.0  # molecules, once all water has condensed
_MOST = 40
_MARGIN = 0.08  # of the box, which clumps leave free
SWELLING = 0.55
"""Radius of a clump of one molecule, over the diameter with which that is drawn."""
POOL, RAIN = -1.0, -2.0
"""What a layer is: it stands in place of a radius."""

Floats = NDArray[np.float64]


def clumps(number: int, water: int, length: Floats, diameter: float) -> Floats:
    """Return the clumps that a mist is drawn as, all alike and at places that never change.

    Parameters
    ----------
    number : int
        How many molecules are in the mist now.
    water : int
        How many molecules of water there are in all.
    length : (axis,)
        Sides of the box now.
    diameter : float
        With which a molecule of water is drawn, in the same unit.

    Returns
    -------
    ndarray of float, (clump, 4)
        Places and radii; the volume of all grows in proportion to the number.

    Examples
    --------
    >>> few, many = (clumps(number, 120, np.ones(3), 0.01) for number in (20, 120))
    >>> len(few), len(many), round(float((many[0, 3] / few[0, 3]) ** 3), 9)
    (10, 10, 6.0)
    """
    if number <= 0:
        return np.zeros((0, 4))
    place = places(water)[:number] * length
    count = len(place)
    radius = SWELLING * diameter * (number / count) ** (1.0 / 3.0)
    return np.column_stack((place, np.full(count, radius)))


def places(water: int) -> Floats:
    """Return where clumps of so many molecules of water are drawn, as shares of the box.

    If fewer molecules have condensed than there are places, they take the first ones.

    Examples
    --------
    >>> places(24).round(2).tolist()
    [[0.5, 0.36, 0.25], [0.29, 0.64, 0.42]]
    """
    count = int(np.clip(round(water / _A_CLUMP), 1, _MOST))
    return _MARGIN + (1.0 - 2.0 * _MARGIN) * np.stack([_spread(count, base) for base in (2, 3, 5)], axis=1)


def layer(number: int, water: int, *, rain: bool = False) -> Floats:
    """Return the layer of liquid on the floor, as a drop whose radius is negative and says what it is.

    Parameters
    ----------
    number : int
        How many molecules are in the layer.
    water : int
        How many molecules of water there are in all.
    rain : bool
        Whether it is rain that has fallen, and not a pool.

    Returns
    -------
    ndarray of float, (1, 4) or (0, 4)
        Its level, from 0 to 1, in the third column.

    Examples
    --------
    >>> layer(50, 200).tolist(), layer(0, 200).size
    ([[0.0, 0.0, 0.25, -1.0]], 0)
    """
    if number <= 0 or water <= 0:
        return np.zeros((0, 4))
    return np.array([[0.0, 0.0, min(number / water, 1.0), RAIN if rain else POOL]])


def _spread(count: int, base: int) -> Floats:
    """Return numbers from 0 to 1 that lie apart: the sequence of van der Corput."""
    found = np.zeros(count)
    index, part = np.arange(1, count + 1), 1.0
    while index.any():
        part /= base
        found += part * (index % base)
        index = index // base
    return found
