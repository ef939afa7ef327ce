"""The division of the box into cells, for the search for overlapping pairs."""

import math

import numpy as np

from atmosbox.engine.core.elementary import expm1, root
from atmosbox.engine.core.parcel import Array
from atmosbox.engine.core.refusal import RefusedError
from atmosbox.engine.stepped.filing import Grid

__all__ = ["choose_cells"]

_OCCUPANCY = 1.6
_MOST_CELLS = 6
_CROWD = 4096.0
_MARGIN = 1.0001


def choose_cells(
    sides: Array,
    periodic: tuple[bool, bool, bool],
    diameter: Array,
    *,
    planar: bool = False,
    scale_height: float = math.inf,
    equal: bool = True,
) -> Grid:
    """Return cells at least as wide as the largest molecule, with one or two molecules each in the densest places.

    Parameters
    ----------
    sides
        The three sides of the box [length].
    periodic
        Whether each axis is periodic.
    diameter : (molecule,)
        Diameters [length].
    planar
        Whether all centres lie in one plane of x and z.
    scale_height
        Height in which the density falls to 1/e [length].
    equal
        Whether all molecules are equal.

    Returns
    -------
    Grid
        The cells; a single one if molecules have no size.

    Raises
    ------
    RefusedError
        If a periodic axis is so short that molecules would meet their own images, or if sizes differ so much
        that there would be thousands of small molecules in every cell.

    Notes
    -----
    Measured: a step is fastest with 1.3 to 2 molecules to a cell. With more, three cells often hold more than
    are tested together; with fewer, there are more cells than molecules to count.

    Examples
    --------
    >>> choose_cells(np.array([10.0, 10.0, 10.0]), (False, False, False), np.ones(500)).number_x
    6
    """
    biggest = float(diameter.max(initial=0.0))
    number = [1, 1, 1]
    if biggest > 0.0:
        depth = float(sides[2])
        if math.isfinite(scale_height):
            depth = -scale_height * float(expm1(-depth / scale_height))
        axes = [0, 2] if planar else [0, 1, 2]
        for axis in axes:
            if periodic[axis] and 0.45 * sides[axis] <= 1.001 * biggest:
                raise RefusedError(
                    f"a periodic box of length {sides[axis]:.6g} is too short for molecules of diameter "
                    f"{biggest:.6g}, which would meet their own images: make it longer than {2.25 * biggest:.6g}"
                )
        width = _width([float(sides[axis]) for axis in axes], diameter.size, depth / float(sides[2]))
        width = max(width, _MARGIN * biggest)
        for axis in axes:
            number[axis] = max(1, int(sides[axis] / width))
            if periodic[axis] and number[axis] < 3:
                number[axis] = 1
        crowd = diameter.size * float(sides[2]) / depth / math.prod(number)
        if crowd > _CROWD and not equal:
            raise RefusedError(
                f"the largest molecule, of diameter {biggest:.4g}, is so large that {crowd:.0f} molecules are in "
                f"each cell of its size, more than {_CROWD:.0f}: make it smaller, or use the exact engine"
            )
    wraps = [periodic[axis] and number[axis] >= 3 for axis in range(3)]
    return Grid(
        number_x=number[0],
        number_y=number[1],
        number_z=number[2],
        inverse_x=number[0] / float(sides[0]),
        inverse_y=number[1] / float(sides[1]),
        thinnest=_MARGIN * biggest if biggest > 0.0 else math.inf,
        wraps_x=wraps[0],
        wraps_y=wraps[1],
        wraps_z=wraps[2],
        simple=wraps == list(periodic),
        reach=biggest if equal else 0.0,
        margin=0.5 * biggest + 1e-12 * float(np.max(sides)),
    )


def _width(sides: list[float], molecules: int, share: float) -> float:
    """Return the width of cells that hold few molecules each in the densest places, and are not too many [length]."""
    free = sorted(sides)
    while True:
        space = math.prod(free) * share * _OCCUPANCY / molecules
        least = math.prod(free) / (_MOST_CELLS * molecules)
        width = float(root(max(space, least), len(free)))
        if free[0] >= width or len(free) == 1:
            return width
        free = free[1:]
