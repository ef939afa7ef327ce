"""One moment as bytes: where the molecules are, how fast, and where the liquid is."""

from __future__ import annotations

import base64
import struct
import zlib
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

__all__ = ["encode", "pack"]

_HEAD = struct.Struct("<Id3fIf")
_FINEST, _FASTEST = 65535, 255

Floats = NDArray[np.floating]


def encode(
    sequence: int, time: float, length: Floats, position: Floats, speed: Floats, highest: float, drops: Floats
) -> bytes:
    r"""Return a frame as the page reads it.

    Little endian: the number of the frame (uint32), the time (float64), the three sides of the box (float32), the
    number n of molecules (uint32), the highest speed (float32), their positions over the sides (3 n uint16), their
    speeds over the highest (n uint8), their states (n uint8: 0 in the gas, 1 not in it), the number m of drops
    (uint32), and of each its position and its radius (4 m float32).

    Parameters
    ----------
    sequence : int
        The number of the frame.
    time : float
        In the unit of the stage.
    length : (axis,)
        Sides of the box now.
    position : (molecule, axis)
        Where the molecules are, in the unit of `length`; NaN for one that is in the liquid.
    speed : (molecule,)
        Their speeds.
    highest : float
        The speed at the top of the scale, in the same unit; faster ones are shown like it.
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
    """Return frames as text that stands in a page: deflated (zlib), and in base64.

    Parameters
    ----------
    frames : iterable of bytes
        What `encode` returned, in order.

    Returns
    -------
    str
        The text; the same frames always give the same.

    Examples
    --------
    >>> zlib.decompress(base64.b64decode(pack([b"one", b"two"])))
    b'onetwo'
    """
    squeeze = zlib.compressobj(9)
    parts = [squeeze.compress(frame) for frame in frames]
    return base64.b64encode(b"".join((*parts, squeeze.flush()))).decode("ascii")
