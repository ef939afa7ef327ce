"""Packing fraction: the part of the space that molecules fill, and the largest that is possible.

The densest packing of equal spheres is the face-centred cubic one, of equal discs the hexagonal one.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.refusal import PackingError, RefusedError, shown

Array = NDArray[np.float64]
_DENSEST = math.pi / math.sqrt(18.0)
_DENSEST_PLANE = math.pi / math.sqrt(12.0)


def packing_fraction(length: Sequence[float], diameter: ArrayLike, *, planar: bool = False) -> float:
    """Return the part of the box's volume, or of a plane box's area, that the molecules fill.

    Parameters
    ----------
    length
        The three sides of the box [length].
    diameter : (molecule,)
        Diameters [length].
    planar
        Whether the molecules are discs in the plane of x and z.

    Returns
    -------
    float
        Between 0 and 1, dimensionless.

    Examples
    --------
    >>> round(packing_fraction((10, 10, 10), np.ones(191)), 3)
    0.1
    """
    sigma = np.asarray(diameter, np.float64)
    if planar:
        return float(np.sum(math.pi / 4.0 * sigma * sigma)) / (length[0] * length[2])
    return float(np.sum(math.pi / 6.0 * sigma * sigma * sigma)) / math.prod(length)


def refuse_impossible(sides: Array, sigma: Array, periodic: tuple[bool, bool, bool], planar: bool) -> None:
    """Refuse molecules that cannot fit into the box, wherever they are placed: too wide, or beyond the densest packing.

    >>> refuse_impossible(np.array([4.0, 2.0, 4.0]), np.array([3.0]), (False, False, False), planar=False)
    Traceback (most recent call last):
    atmosbox.engine.core.refusal.PackingError: a molecule of diameter 3 does not fit into a box of side 2
    """
    if not (np.isfinite(sides).all() and (sides > 0.0).all()):
        raise RefusedError(f"length = {shown(sides)}: give three sides, each above 0")
    if not (np.isfinite(sigma).all() and (sigma >= 0.0).all()):
        raise RefusedError("diameters must be finite and 0 or above")
    if sigma.size == 0:
        return
    biggest = float(sigma.max())
    for axis in range(3):
        if not periodic[axis] and sides[axis] < biggest:
            raise PackingError(
                f"a molecule of diameter {biggest:.6g} does not fit into a box of side {sides[axis]:.6g}"
            )
    phi = packing_fraction(list(sides), sigma, planar=planar)
    densest = _DENSEST_PLANE if planar else _DENSEST
    if (phi > densest * (1.0 + 1e-9) and np.ptp(sigma) == 0.0) or phi >= 1.0:
        raise PackingError(
            f"{sigma.size} molecules would fill {phi:.3g} of the space, and no packing of spheres fills more than "
            f"{densest:.3g}: take fewer or smaller molecules, or a larger box"
        )


def refuse_solid(sides: Array, sigma: Array, planar: bool) -> None:
    """Refuse equal molecules that fill all but a ten-thousandth of the densest packing: they collide without end."""
    densest = _DENSEST_PLANE if planar else _DENSEST
    phi = packing_fraction(list(sides), sigma, planar=planar)
    if sigma.size > 1 and np.ptp(sigma) == 0.0 and phi > 0.9999 * densest:
        raise PackingError(
            f"{sigma.size} molecules fill {phi:.6f} of the space, and can hardly move: the densest packing fills "
            f"{densest:.6f}. Take fewer or smaller molecules, or a larger box"
        )
