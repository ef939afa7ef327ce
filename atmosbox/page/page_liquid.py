"""The picture of liquid that has no position in the model: a mist is drawn as clumps, a pool and rain as layers.

In the model, a mist is an area that vapour molecules hit and a number of molecules in the mist; a pool is the floor and
a number of molecules. The engine does not follow these molecules. The page draws the right amount of liquid, at places
of its own choice, and tells the reader so.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["POOL", "RAIN", "SWELLING", "clumps", "layer", "places"]

_A_CLUMP = 2.0  # molecules in a clump when all water has condensed
_MOST = 40  # clumps
_MARGIN = 0.08  # share of the box at each side without clumps
SWELLING = 1.6
"""Radius of a clump of one molecule, divided by the diameter with which a molecule of water is drawn."""
POOL, RAIN = -1.0, -2.0
"""The kind of a layer, in place of a radius."""

Floats = NDArray[np.float64]


def clumps(number: int, water: int, length: Floats, diameter: float) -> Floats:
    """Return the clumps of a mist, all of one size, at places that are fixed shares of the box.

    Parameters
    ----------
    number : int
        Number of molecules in the mist in this frame.
    water : int
        Number of molecules of water in the run.
    length : (axis,)
        Sides of the box in this frame.
    diameter : float
        Diameter with which a molecule of water is drawn, in the unit of `length`.

    Returns
    -------
    ndarray of float, (clump, 4)
        Positions and radii; the volume of all clumps together is proportional to the number of molecules.

    Examples
    --------
    >>> few, many = (clumps(number, 120, np.ones(3), 0.01) for number in (20, 120))
    >>> len(few), len(many), round(float((many[0, 3] / few[0, 3]) ** 3), 9)
    (20, 40, 3.0)
    """
    if number <= 0:
        return np.zeros((0, 4))
    place = places(water)[:number] * length
    count = len(place)
    radius = SWELLING * diameter * (number / count) ** (1.0 / 3.0)
    return np.column_stack((place, np.full(count, radius)))


def places(water: int) -> Floats:
    """Return the places of the clumps for a number of molecules of water, as shares of the box.

    If fewer molecules have condensed than there are places, only the first places are used.

    Examples
    --------
    >>> places(4).round(2).tolist()
    [[0.5, 0.36, 0.25], [0.29, 0.64, 0.42]]
    """
    count = int(np.clip(round(water / _A_CLUMP), 1, _MOST))
    return _MARGIN + (1.0 - 2.0 * _MARGIN) * np.stack([_spread(count, base) for base in (2, 3, 5)], axis=1)


def layer(number: int, water: int, *, rain: bool = False) -> Floats:
    """Return the layer of liquid on the floor, as a drop whose negative radius tells its kind, `POOL` or `RAIN`.

    Parameters
    ----------
    number : int
        Number of molecules in the layer.
    water : int
        Number of molecules of water in the run.
    rain : bool
        Whether the layer is fallen rain and not a pool.

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
    """Return evenly spread numbers from 0 to 1: the van der Corput sequence in a base."""
    found = np.zeros(count)
    index, part = np.arange(1, count + 1), 1.0
    while index.any():
        part /= base
        found += part * (index % base)
        index = index // base
    return found
