"""One frame as bytes: positions and speeds of the molecules, and the drops; and liquid that has no position.

In the model, a mist is an area that vapour molecules hit and a number of molecules in the mist; a pool is the floor and
a number of molecules. The engine does not follow these molecules. The page draws the right amount of liquid, a mist as
clumps, a pool and rain as layers, at places of its own choice, and tells the reader so.
"""

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
    """Return a frame as the bytes that the page reads.

    Little endian: the number of the frame (uint32), the time (float64), the three sides of the box (float32), the
    number n of molecules (uint32), the highest speed (float32), the positions divided by the sides (3 n uint16), the
    speeds divided by the highest (n uint8), the states of the molecules (n uint8: 0 in the gas, 1 not in the gas), the
    number m of drops (uint32), and the position and the radius of each drop (4 m float32). Quotients from 0 to 1 are
    scaled to the full range of their integer type.

    ``length`` (axis,), ``position`` (molecule, axis) and ``drops`` (drop, 4) have one unit, ``speed`` (molecule,) and
    ``highest`` another; a molecule in the liquid has NaN. Molecules faster than ``highest`` have its colour.
    """
    absent = ~np.isfinite(speed) | ~np.isfinite(position).all(axis=1)
    share = np.where(absent[:, None], 0.0, position / np.asarray(length, np.float64))
    place = np.rint(np.clip(share, 0.0, 1.0) * _FINEST).astype("<u2")
    colour = np.rint(np.clip(np.where(absent, 0.0, speed) / highest, 0.0, 1.0) * _FASTEST).astype(np.uint8)
    head = _HEAD.pack(sequence, time, *(float(side) for side in length), len(place), highest)
    parts = place, colour, absent.astype(np.uint8), np.array([len(drops)], "<u4"), np.asarray(drops, "<f4")
    return head + b"".join(part.tobytes() for part in parts)


def pack(frames: Iterable[bytes]) -> str:
    """Return frames as text for an HTML page: compressed (zlib), and in base64; the same frames give the same text."""
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
    """Return the clumps of a mist, (clump, 4): positions, at fixed shares of the sides of the box, and a common radius.

    The volume of all clumps together is proportional to the number of molecules in the mist, of ``water`` in the run.
    ``diameter`` is that of a drawn molecule, in the unit of ``length``.

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
    """Return the places of the clumps as shares of the box; a mist of fewer molecules uses the first places."""
    count = int(np.clip(round(water / _A_CLUMP), 1, _MOST))
    return _MARGIN + (1.0 - 2.0 * _MARGIN) * np.stack([_spread(count, base) for base in (2, 3, 5)], axis=1)


def layer(number: int, water: int, *, rain: bool = False) -> Floats:
    """Return the liquid on the floor as a drop, (1, 4), with its level from 0 to 1 in place of z; (0, 4) without any.

    A negative radius tells whether it is a `POOL` or fallen `RAIN`.
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
