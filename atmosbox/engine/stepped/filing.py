"""Molecules sorted by cell, for the search for neighbours.

In every step the molecules are sorted by cell (a stable counting sort): then each row of cells along x is one stretch
of memory, and three adjacent cells are one short stretch of it. Every thread counts and sorts a part of the molecules.
"""

from typing import Any, NamedTuple

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.stepped.window import LANES

__all__ = ["Grid", "Records", "count_up", "file_molecules", "new_records"]

_FAR = 1e18


class Grid(NamedTuple):
    """The cells: their number along each axis, and the cells per length along x and y [1/length].

    There are ``number_z`` layers, fewer when the ceiling comes down so low that they would be thinner than
    ``thinnest`` [length]. ``wraps_*`` tells whether the last cell's neighbour is the first; ``simple`` whether every
    periodic axis has enough cells for that. ``reach`` is the distance of two that touch [length], 0 if sizes differ;
    ``margin`` the distance from a wall within which the largest may touch it [length].
    """

    number_x: int
    number_y: int
    number_z: int
    inverse_x: float
    inverse_y: float
    thinnest: float
    wraps_x: bool
    wraps_y: bool
    wraps_z: bool
    simple: bool
    reach: float
    margin: float


class Records(NamedTuple):
    """The molecules in the order of their cells.

    ``x``, ``y``, ``z``, ``radius : (record,)`` in single precision [length] (radius is None if all are equal),
    ``slot`` the place of the molecule in memory, ``cell`` its cell. Cell c holds the records ``start[c]`` to
    ``start[c + 1] - 1``; after the last cell comes a row of empty ones, which is used for rows that do not
    exist. ``histogram : (part, cell)`` counts molecules, one row for each part of them that a thread takes.
    """

    x: Any
    y: Any
    z: Any
    radius: Any
    slot: Any
    cell: Any
    start: Any
    histogram: Any


def new_records(molecules: int, grid: Grid, parts: int, *, mixed: bool) -> Records:
    """Return memory for the records; its end is filled with neighbours that are far from everything.

    Examples
    --------
    >>> grid = Grid(3, 3, 3, 1.0, 1.0, 1.0, False, False, False, True, 1.0, 0.5)
    >>> new_records(10, grid, 1, mixed=False).start.size
    31
    """
    cells = grid.number_x * grid.number_y * grid.number_z
    return Records(
        x=np.full(molecules + LANES, _FAR, np.float32),
        y=np.full(molecules + LANES, _FAR, np.float32),
        z=np.full(molecules + LANES, _FAR, np.float32),
        radius=np.zeros(molecules + LANES, np.float32) if mixed else None,
        slot=np.zeros(molecules, np.uint32),
        cell=np.zeros(molecules, np.int32),
        start=np.zeros(cells + grid.number_x + 1, np.int32),
        histogram=np.zeros((parts, cells), np.int32),
    )


@kernel
def count_up(records, cells, number_x, molecules):
    """Turn the histograms into indices: where each cell starts, and in it the molecules of each part."""
    place = 0
    for cell in range(cells):
        records.start[cell] = place
        for part in range(records.histogram.shape[0]):
            here = records.histogram[part, cell]
            records.histogram[part, cell] = place
            place += here
    for cell in range(cells, cells + number_x + 1):
        records.start[cell] = molecules


@kernel
def file_molecules(state, records, radius, part, first, last):
    """Write the molecules of one part, slots ``first`` to ``last - 1``, into the records of their cells.

    ``state`` are the molecules (`atmosbox.engine.stepped.stepped.State`), ``radius`` the radius of the records or None.
    """
    x = state.position[0]
    y = state.position[1]
    z = state.position[2]
    cell = state.cell
    for i in range(np.uint32(first), np.uint32(last)):
        p = np.uint32(i)
        c = np.uint32(cell[p])
        q = np.uint32(records.histogram[part, c])
        records.histogram[part, c] = q + np.uint32(1)
        records.x[q] = x[p]
        records.y[q] = y[p]
        records.z[q] = z[p]
        if radius is not None:
            radius[q] = state.size[p]
        records.slot[q] = p
        records.cell[q] = c
