"""Cells for a box whose ceiling has moved far: what `ParcelSet` chooses in Python, as a kernel.

Of `choose_grid` this is the part that a piston needs: molecules of one size between walls, without gravity, in rows
that hold copies of trajectories. The same cells come out, to the last bit; a test compares them over many boxes.
"""

import math
from typing import Any, NamedTuple

from atmosbox.engine.core.elementary import cbrt, log
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.exact.glance import CLOSING, DISTANCE, SLACK, SQUARE
from atmosbox.engine.exact.rows import START, STOP, TOP_SPEED

__all__ = ["LAST", "NUMBER", "STRIDE", "Layout", "choose_cells", "write_cells"]

STRIDE, NUMBER, LAST = 0, 1, 4
"""Where in ``Layout.shape`` the stride of rows stands, the three numbers of cells, and those of the last slots."""
_MARGIN = 1.0 + 1e-7
_TALLER = 1.75
_MOST = 20_000
_CROWD = 30.0


class Layout(NamedTuple):
    """The cells of a box as they are now.

    ``shape : (7,)`` words of a row, numbers of cells, last slots; ``filled : (1,)`` the height of the ceiling when they
    were chosen [length]; ``width, edge : (axis, ...)`` memory for the widths that are wanted and the edges [length];
    ``radius`` of all molecules [length]; ``shortest`` how many words a row has at first, and ``longest`` at most.
    """

    shape: Any
    filled: Any
    width: Any
    edge: Any
    radius: float
    shortest: int
    longest: int


@kernel
def _wanted_widths(cells, x, y, z, width):
    """Write down the width of a cell along each axis, if there are to be so many: see `cells._widths`."""
    width[0], width[1], width[2] = x, y, z
    free_x = free_y = free_z = True
    while free_x or free_y or free_z:
        room = (x if free_x else 1.0) * (y if free_y else 1.0) * (z if free_z else 1.0)
        free = int(free_x) + int(free_y) + int(free_z)
        size = room / cells
        if free == 3:
            size = cbrt(size)
        elif free == 2:
            size = math.sqrt(size)
        short_x, short_y, short_z = free_x and x < size, free_y and y < size, free_z and z < size
        if not (short_x or short_y or short_z):
            if free_x:
                width[0] = size
            if free_y:
                width[1] = size
            if free_z:
                width[2] = size
            break
        free_x, free_y, free_z = free_x and not short_x, free_y and not short_y, free_z and not short_z


@kernel
def _misfit(nx, ny, nz, wanted, x, y, z, width):
    """Return how far some numbers of cells are from the volume and the shape that are wanted."""
    a = log(nx * width[0] / x)
    b = log(ny * width[1] / y)
    c = log(nz * width[2] / z)
    mean = (a + b + c) / 3.0
    a, b, c = a - mean, b - mean, c - mean
    return abs(log(nx * ny * nz / max(wanted, 1.0))) + 0.5 * math.sqrt((a * a + b * b + c * c) / 3.0)


@kernel
def _nearest(length, width, most, upper):
    """Return the number of cells below, or above, that which has the width that is wanted."""
    lower = math.floor(length / width)
    return min(max(lower + (1 if upper else 0), 1), most)


@kernel
def choose_cells(filled, molecules, box, layout):
    """Choose the numbers of cells for a ceiling at the height ``filled``; tell whether there are any that will do."""
    x, y, z = box.length_x, box.length_y, _TALLER * filled
    radius, width = layout.radius, layout.width
    biggest = radius * _MARGIN
    share = molecules * (math.pi * radius * radius * (4.0 / 3.0 * radius)) / (x * y * filled)
    _wanted_widths(max(1.0, molecules / (9.0 if share < 0.05 else 8.0)), x, y, filled, width)
    top_x = min(math.floor(x / (2.002 * biggest)), _MOST)
    top_y = min(math.floor(y / (2.002 * biggest)), _MOST)
    top_z = min(math.floor(z / (2.002 * biggest)), _MOST)
    if min(top_x, top_y, top_z) < 1:
        return False
    wanted = x / width[0] * (y / width[1]) * (z / width[2])
    best = math.inf
    number = layout.shape
    for i in range(8):
        nx = _nearest(x, width[0], top_x, i & 4)
        ny = _nearest(y, width[1], top_y, i & 2)
        nz = _nearest(z, width[2], top_z, i & 1)
        misfit = _misfit(nx, ny, nz, wanted, x, y, z, width)
        if misfit < best:
            best = misfit
            number[NUMBER], number[NUMBER + 1], number[NUMBER + 2] = nx, ny, nz
    layout.filled[0] = filled
    return molecules / (number[NUMBER] * number[NUMBER + 1] * number[NUMBER + 2]) <= _CROWD


@kernel
def _farthest(edge, axis, k, n):
    """Return how far a member of a cell can be from its centre along an axis: see `rows._farthest`."""
    around = 0.0
    if k > 0:
        around = edge[axis, k] - edge[axis, k - 1]
    if k < n - 1:
        around = max(around, edge[axis, k + 2] - edge[axis, k + 1])
    return 0.5 * (edge[axis, k + 1] - edge[axis, k]) + around


@kernel
def write_cells(gas, layout, modes):
    """Write the tables of the cells that were chosen; all rows, events and the calendar are empty after it."""
    cells, copies, edge = gas.cells, gas.cells.copies, layout.edge
    shape = layout.shape
    reach = layout.radius * _MARGIN
    cells.boundary[:] = math.inf
    width = 0.0
    for axis in range(3):
        n = shape[NUMBER + axis]
        shape[LAST + axis] = 2 * (n - 1)
        length = _TALLER * layout.filled[0]
        if axis < 2:
            length = gas.box.length_x if axis == 0 else gas.box.length_y
        step = length / n
        for k in range(n):
            edge[axis, k] = k * step
        edge[axis, n] = length
        # where molecules are not all of one kind, walls are each molecule's own business
        cells.boundary[0, axis, 0] = -math.inf if modes.mixed else layout.radius
        for k in range(1, n):
            cells.boundary[0, axis, 2 * k - 1] = edge[axis, k] - reach
            cells.boundary[0, axis, 2 * k] = edge[axis, k] + reach
        # who gets above all cells leaves them; the other walls are where centres turn
        turn = math.inf if modes.mixed else length - layout.radius
        cells.boundary[0, axis, 2 * n - 1] = length if axis == 2 else turn
        for k in range(n):
            copies.centre[axis, k] = 0.5 * (edge[axis, k + 1] + edge[axis, k])
            if axis < 2:
                width = max(width, _farthest(edge, axis, k, n))
    area = gas.box.length_x * gas.box.length_y
    copies.slack[:] = math.inf
    copies.room[:] = 1.0
    for k in range(shape[NUMBER + 2]):
        layer = max(_farthest(edge, 2, k, shape[NUMBER + 2]), width)
        copies.slack[k, DISTANCE] = SLACK * layer
        copies.slack[k, SQUARE] = SLACK * layer * layer
        copies.slack[k, CLOSING] = 4.0 * SLACK * layer
        copies.room[k] = area * (edge[2, k + 1] - edge[2, k])
    copies.horizon[:] = math.inf
    copies.epoch[START] = 0.0
    copies.epoch[STOP] = math.inf
    copies.epoch[TOP_SPEED] = 0.0
    shape[STRIDE] = layout.shortest
    copies.place[:] = 0
    gas.calendar.time[:] = math.inf
    gas.calendar.winner[:] = 0
