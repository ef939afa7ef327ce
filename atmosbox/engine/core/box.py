"""The box in the form that the kernels take."""

import math

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.state import Box

__all__ = ["new_box"]


def new_box(
    sides: NDArray[np.float64],
    periodic: tuple[bool, bool, bool],
    *,
    moving: bool,
    gravity: float,
    planar: bool,
    exchange: float,
    stall: float,
) -> Box:
    """Return the box as a `Box`; with a moving ceiling its height is ``inf``, as the position is kept in `Walls`.

    Examples
    --------
    >>> box = new_box(np.ones(3), (True, False, False), moving=True, gravity=0.0, planar=False, exchange=1.0, stall=1.0)
    >>> box.length_z, box.inverse_x, box.inverse_y
    (inf, 1.0, 0.0)
    """
    length = [float(side) for side in sides]
    if moving:
        length[2] = math.inf
    inverse = [1.0 / float(side) if turn else 0.0 for side, turn in zip(sides, periodic, strict=True)]
    return Box(
        length_x=length[0],
        length_y=length[1],
        length_z=length[2],
        inverse_x=inverse[0],
        inverse_y=inverse[1],
        inverse_z=inverse[2],
        gravity=gravity,
        planar=planar,
        exchange=exchange,
        stall=stall,
    )
