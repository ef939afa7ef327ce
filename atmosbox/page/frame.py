"""One frame as bytes: positions and speeds of the molecules, and the drops; and liquid that has no position.

In the model, a mist is an area that vapour molecules hit and a number of molecules in the mist; a pool is the floor and
a number of molecules. The engine does not follow these molecules. The page draws the right amount of liquid, a mist as
clumps, a pool and rain as layers, at places of its own choice, and tells the reader so.
"""

from __future__ import annotations

import base64
import struct
import zlib
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

_HEAD = struct.Struct("<Id3fIf")
_FINEST, _FASTEST = 65535, 255

Floats = NDArray[np.floating]


def encode(
    sequence: int, time: float, length: Floats, position: Floats, speed: Floats, highest: float, drops: Floats
) -> bytes:
    r"""Return a frame as the bytes that the page reads.

    Little endian: the number of the frame (uint32), the time (float64), the three sides of the box (float32), the
    number n of molecules (uint32), the highest speed (float32), the positions divided by the sides (3 n uint16), the
    speeds divided by the highest (n uint8), the states of the molecules (n uint8: 0 in the gas, 1 not in the gas), the
    number m of drops (uint32), and the position and the radius of each drop (4 m float32). Quotients from 0 to 1 are
    scaled to the full range of their integer type.

    Parameters
    ----------
    sequence : int
        The number of the frame.
    time : float
        The time, in the unit of the stage.
    length : (axis,)
        Sides of the box in this frame.
    position : (molecule, axis)
        Positions of the molecules, in the unit of `length`; NaN for a molecule in the liquid.
    speed : (molecule,)
        Speeds of the molecules; NaN for a molecule in the liquid.
    highest : float
        The speed at the top of the scale, in the unit of `speed`; faster molecules have the same colour.
    drops : (drop, 4)
        Position and radius of each drop, in the unit of `length`.

    Returns
    -------
    bytes
        The frame.

    Examples
    --------
    >>> one = encode(7, 0.5, np.ones(3), np.full((1, 3), 0.5), np.array([300.0]), 900.0, np.zeros((0, 4)))
    >>> len(one), one[:4]
    (44, b'\x07\x00\x00\x00')
    """
    absent = ~np.isfinite(speed) | ~np.isfinite(position).all(axis=1)
    share = np.where(absent[:, None], 0.0, position / np.asarray(length, np.float64))
    place = np.rint(np.clip(share, 0.0, 1.0) * _FINEST).astype("<u2")
    colour = np.rint(np.clip(np.where(absent, 0.0, speed) / highest, 0.0, 1.0) * _FASTEST).astype(np.uint8)
    sides = [float(side) for side in length]
    return b"".join(
        (
            _HEAD.pack(sequence, time, *sides, len(place), highest),
            place.tobytes(),
            colour.tobytes(),
            absent.astype(np.uint8).tobytes(),
            struct.pack("<I", len(drops)),
            np.asarray(drops, "<f4").tobytes(),
        )
    )


def pack(frames: Iterable[bytes]) -> str:
    """Return frames as text for an HTML page: compressed (zlib), and in base64.

    Parameters
    ----------
    frames : iterable of bytes
        What `encode` returned, in order.

    Returns
    -------
    str
        The text; the same frames always give the same text.

    Examples
    --------
    >>> zlib.decompress(base64.b64decode(pack([b"one", b"two"])))
    b'onetwo'
    """
    squeeze = zlib.compressobj(9)
    parts = [squeeze.compress(frame) for frame in frames]
    return base64.b64encode(b"".join((*parts, squeeze.flush()))).decode("ascii")


_A_CLUMP = 2.0  # molecules in a clump when all water has condensed
_MOST = 40  # clumps
_MARGIN = 0.08  # share of the box at each side without clumps
SWELLING = 1.6
"""Radius of a clump of one molecule, divided by the diameter with which a molecule of water is drawn."""
POOL, RAIN = -1.0, -2.0
"""The kind of a layer, in place of a radius."""


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
