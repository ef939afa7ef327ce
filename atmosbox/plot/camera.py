"""From a position in the box to a position in the picture: the perspective of a camera in front of the box."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["EDGES", "FACES", "Camera", "corners"]

_TURN, _TILT = math.radians(24.0), math.radians(16.0)  # angles of the camera to the side and upward
_DISTANCE = 4.5  # of the camera from the middle of the box, in units of the longest side of the box

Floats = NDArray[np.float64]

FACES = (
    (0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5),
)  # fmt: skip
"""Indices of the four corners of each wall: x low, x high, y low, y high, z low, z high."""
EDGES = tuple((a, b) for a in range(8) for b in range(a + 1, 8) if bin(a ^ b).count("1") == 1)
"""Indices of the two corners at the ends of each edge."""


def corners(side: Floats) -> Floats:
    """Return the eight corners of a box, (8, 3); z varies fastest from one corner to the next.

    Examples
    --------
    >>> corners(np.array([2.0, 1.0, 1.0]))[4].tolist()
    [2.0, 0.0, 0.0]
    """
    return np.array([[a, b, c] for a in (0.0, side[0]) for b in (0.0, side[1]) for c in (0.0, side[2])])


@dataclass(frozen=True)
class Camera:
    """A camera that looks at the middle of a box, a little from the side and from above.

    Parameters
    ----------
    side : ndarray, (3,)
        Side lengths of the largest box that the camera must see, in any unit of length.

    Examples
    --------
    A nearer length is seen larger, and the wall y = 0 is in front:

    >>> camera = Camera(np.ones(3))
    >>> _, scale = camera.project(np.array([[0.5, 0.0, 0.5], [0.5, 1.0, 0.5]]))
    >>> bool(scale[0] > scale[1])
    True
    """

    side: Floats

    def project(self, position: Floats) -> tuple[Floats, Floats]:
        """Return positions in the picture (n, 2), and how large a unit of length is seen at each of them (n,)."""
        place = np.asarray(position, dtype=np.float64) - self.side / 2
        turn, tilt = (math.cos(_TURN), math.sin(_TURN)), (math.cos(_TILT), math.sin(_TILT))
        right = place[:, 0] * turn[0] + place[:, 1] * turn[1]
        away = place[:, 1] * turn[0] - place[:, 0] * turn[1]
        up = place[:, 2] * tilt[0] + away * tilt[1]
        depth = away * tilt[0] - place[:, 2] * tilt[1]
        distance = _DISTANCE * float(self.side.max())
        scale = distance / (distance + depth)
        return np.column_stack((right, up)) * scale[:, None], scale

    def behind(self, wall: int) -> bool:
        """Tell whether a wall is behind the molecules, seen from the camera."""
        return wall in (0, 3, 4)

    def limits(self, side: Floats) -> tuple[Floats, Floats]:
        """Return the lower left and the upper right corner of the picture of a box."""
        seen, _ = self.project(corners(side))
        return seen.min(axis=0), seen.max(axis=0)
