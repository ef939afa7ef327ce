"""Lay out the cells in a page, with the same functions as in Python: see `row_cells`.

When a piston has moved far, molecules of one size between walls need other cells. The layers of a column depend on the
exact temperature of its molecules at the start, and so on the seed; and when so many molecules have come together that
a row is too short for them, the layers are fitted to the molecules.
"""

import math
from typing import Any, NamedTuple

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.exact.encounter import slots_of
from atmosbox.engine.exact.row_cells import (
    TALLER,
    cell_numbers,
    widths_for_rows,
    write_even_layers,
    write_layers,
    write_slots,
)
from atmosbox.engine.exact.rows import FEWEST, describe_cells

__all__ = [
    "LAST", "NUMBER", "PLACES", "Column", "Layout", "choose_cells", "follow_molecules", "write_cells", "write_column",
]  # fmt: skip

PLACES, NUMBER, LAST = 0, 1, 4
"""Indices of ``Layout.shape``: the number of places of a row, the numbers of cells, and the last slots."""


class Layout(NamedTuple):
    """The present cells of a box.

    ``shape : (7,)`` holds the places of a row, the numbers of cells and the last slots; ``filled : (1,)`` the height of
    the ceiling when the cells were chosen [length]; ``edge : (axis, ...)`` the edges of the cells, with memory for
    more; ``radius`` the radius of all molecules [length]; ``column`` the data for the choice of layers, 0 without
    gravity.
    """

    shape: Any
    filled: Any
    edge: Any
    radius: float
    column: Any


class Column(NamedTuple):
    """The data, besides its temperature, from which the layers of a column are chosen.

    ``weight`` is that of a molecule [force], ``bath`` the temperature of the warmest wall [energy], ``wanted`` the
    requested number of layers, ``thinnest`` the smallest height of a layer [length]; ``count`` and ``old`` are scratch,
    for as many layers and one more.
    """

    weight: float
    bath: float
    wanted: int
    thinnest: float
    count: Any
    old: Any


@kernel
def choose_cells(filled, molecules, box, layout):
    """Choose the numbers of cells for a ceiling at the height ``filled``; return whether suitable ones exist."""
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
def write_column(kT, gas, layout):
    """Write the layers for molecules of a temperature [energy]; return whether there is memory for them."""
    column = layout.column
    scale_height = max(kT, column.bath) / column.weight
    found = write_layers(gas.box.length_z, column.wanted, scale_height, column.thinnest, layout.edge[2])
    if found > 0:
        _describe_column(found, gas, layout)
    return found > 0


@kernel
def follow_molecules(gas, layout, modes):
    """Write layers fitted to the present positions of the molecules; return whether that was possible and worth it."""
    column, layers = layout.column, layout.shape[NUMBER + 2]
    column.count[:] = 0
    for i in range(gas.molecules.size):
        if not (modes.phases and math.isinf(gas.molecules[i].clock)):
            column.count[slots_of(i, gas)[2] >> 1] += 1
    for k in range(layers + 1):
        column.old[k] = layout.edge[2, k]
    counted, old = column.count[:layers], column.old[: layers + 1]
    found = write_even_layers(counted, old, column.wanted, column.thinnest, layout.edge[2])
    if found > 0:
        _describe_column(found, gas, layout)
    return found > 0


@kernel
def _describe_column(layers, gas, layout):
    """Write the tables of a column of this number of layers."""
    box, edge, shape = gas.box, layout.edge, layout.shape
    edges = (edge[0, : shape[NUMBER] + 1], edge[1, : shape[NUMBER + 1] + 1], edge[2, : layers + 1])
    gas.cells.boundary[0, 2] = math.inf
    shape[PLACES] = FEWEST
    shape[NUMBER + 2] = layers
    shape[LAST + 2] = write_slots(edges[2], layout.radius, False, False, False, gas.cells.boundary[0, 2])
    periodic = (box.inverse_x != 0.0, box.inverse_y != 0.0, False)
    describe_cells(edges, periodic, box.planar, gas.cells.copies)
