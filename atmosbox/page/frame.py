"""One frame as bytes: positions and speeds of the molecules, and the drops."""

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
