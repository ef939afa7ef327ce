"""Cells that are laid out in a page, with the functions by which Python lays them out: see `row_cells`.

A piston that has moved far needs others, for molecules of one size between walls; the layers of a column depend on the
temperature that its molecules have at the start, to its last digit, and so on the seed.
"""

import math
from typing import Any, NamedTuple

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.exact.row_cells import TALLER, cell_numbers, widths_for_rows, write_layers, write_slots
from atmosbox.engine.exact.rows import FEWEST, describe_cells

__all__ = ["LAST", "NUMBER", "PLACES", "Column", "Layout", "choose_cells", "write_cells", "write_column"]

PLACES, NUMBER, LAST = 0, 1, 4
"""Where in ``Layout.shape`` the number of places of a row, those of cells and those of the last slots stand."""


class Layout(NamedTuple):
    """The cells of a box as they are now.

    ``shape : (7,)`` places of a row, numbers of cells, last slots; ``filled : (1,)`` the height of the ceiling when
    they were chosen [length]; ``edge : (axis, ...)`` memory for their edges, ``radius`` of all molecules [length].
    """

    shape: Any
    filled: Any
    edge: Any
    radius: float


class Column(NamedTuple):
    """What decides on the layers of a column, beside its temperature.

    ``weight`` of a molecule [force], ``bath`` the temperature of the warmest wall [energy], ``wanted`` how many layers
    are asked for, ``thinnest`` of them [length]; ``radius`` of all molecules [length]; ``x, y, z`` the edges of cells
    [length], of which the last are written.
    """

    weight: float
    bath: float
    wanted: int
    thinnest: float
    radius: float
    x: Any
    y: Any
    z: Any


@kernel
def choose_cells(filled, molecules, box, layout):
    """Choose the numbers of cells for a ceiling at the height ``filled``; tell whether there are any that will do."""
    x, y = box.length_x, box.length_y
    width = widths_for_rows(x, y, filled, layout.radius, molecules, False)
    walled = (False, False, False)
    found = cell_numbers((x, y, TALLER * filled), filled, width, layout.radius, molecules, walled, False)
    for axis in range(3):
        layout.shape[NUMBER + axis] = found[axis]
    layout.shape[PLACES] = FEWEST
    layout.filled[0] = filled
    return found[0] > 0


@kernel
def write_cells(gas, layout, modes):
    """Write the tables of the cells that were chosen."""
    cells, shape, edge = gas.cells, layout.shape, layout.edge
    length = (gas.box.length_x, gas.box.length_y, TALLER * layout.filled[0])
    edges = (edge[0, : shape[NUMBER] + 1], edge[1, : shape[NUMBER + 1] + 1], edge[2, : shape[NUMBER + 2] + 1])
    cells.boundary[:] = math.inf
    for axis in range(3):
        n = shape[NUMBER + axis]
        for k in range(n):
            edges[axis][k] = k * (length[axis] / n)
        edges[axis][n] = length[axis]
        boundary = cells.boundary[0, axis]
        shape[LAST + axis] = write_slots(edges[axis], layout.radius, False, modes.mixed, axis == 2, boundary)
    describe_cells(edges, (False, False, False), False, cells.copies)
    cells.copies.place[:] = 0


@kernel
def write_column(kT, gas, column):
    """Write the layers for molecules of a temperature [energy]; tell whether there are as many as before."""
    box, z = gas.box, column.z
    if write_layers(box.length_z, column.wanted, max(kT, column.bath) / column.weight, column.thinnest, z) < z.size - 1:
        return False
    write_slots(z, column.radius, False, False, False, gas.cells.boundary[0, 2])
    periodic = (box.inverse_x != 0.0, box.inverse_y != 0.0, False)
    describe_cells((column.x, column.y, z), periodic, box.planar, gas.cells.copies)
    return True
