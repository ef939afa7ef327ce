"""How many cells a box gets along each axis, and what is written down of them, where rows hold copies of trajectories.

Python asks when a box is made, and runs these functions as they stand here; compiled code asks under a piston that has
moved far (`passing`). So the cells are the same, to the last bit, whoever has chosen them.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.elementary import cbrt, log
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Cells, Gas
from atmosbox.engine.exact.glance import CLOSING, DISTANCE, SLACK, SQUARE

__all__ = [
    "LAST", "MARGIN", "NUMBER", "STRIDE", "TALLER", "Layout", "as_laid_out", "choose_cells", "choose_numbers",
    "fits", "for_rows", "new_layout", "size_of", "wanted_widths", "write_boundaries", "write_cells", "write_layers",
]  # fmt: skip

STRIDE, NUMBER, LAST = 0, 1, 4
"""Where in ``Layout.shape`` the stride of rows stands, the three numbers of cells, and those of the last slots."""
MARGIN = 1.0 + 1e-7
"""How much larger than it is a molecule is taken to be, so that rounding leaves it out of no cell."""
TALLER = 1.75
"""The height of the cells under a piston, over that of its ceiling."""
_MOST = 20_000
_CROWD = 30.0
_SMALLEST, _LARGEST = 1e-6, 1e6


class Layout(NamedTuple):
    """The cells of a box as they are now, and what is asked when others are chosen.

    ``shape : (7,)`` words of a row, numbers of cells, last slots; ``filled : (1,)`` the height of the ceiling when they
    were chosen [length]; ``length``, ``room``, ``width : (axis,)`` what the cells cover, the part of it that molecules
    fill, the width that a cell should have [length]; ``edge : (axis, edge)`` of the cells [length]; ``radii : (size,)``
    of the classes of sizes, ``usual`` the mean radius [length]; ``shortest`` how many words a row has at first,
    ``longest`` at most, and by how many it is ``longer`` after it was full.
    """

    shape: Any
    filled: Any
    length: Any
    room: Any
    width: Any
    edge: Any
    radii: Any
    usual: float
    shortest: int
    longest: int
    longer: int


def new_layout(room: NDArray[np.float64], length: NDArray[np.float64]) -> Layout:
    """Return the layout of a box that has no cells yet: see `Layout`.

    Examples
    --------
    Eight cells of a cube:

    >>> cube = new_layout(np.ones(3), np.ones(3))
    >>> wanted_widths(8, cube.room, False, cube.width)
    >>> cube.width.tolist()
    [0.5, 0.5, 0.5]
    """
    shape, filled = np.zeros(7, np.int64), np.array([room[2]])
    return Layout(shape, filled, np.array(length), room, np.array(room), np.zeros((3, 1)), np.zeros(1), 0.0, 0, 0, 0)


@kernel
def as_laid_out(gas, layout):
    """Return the gas with its cells as they are now."""
    c, shape = gas.cells, layout.shape
    cells = Cells(
        c.row, shape[STRIDE], c.boundary, c.first, c.span, c.slot, shape[NUMBER], shape[NUMBER + 1], shape[NUMBER + 2],
        shape[LAST], shape[LAST + 1], shape[LAST + 2], c.copies,
    )  # fmt: skip
    return Gas(gas.molecules, gas.events, gas.kinds, cells, gas.calendar, gas.box, gas.walls, gas.tallies)


@kernel(plain=True)
def fits(cells, layout):
    """Tell whether there is memory for the cells as they are now."""
    shape, most = layout.shape, 0
    for axis in range(3):
        most = max(most, shape[NUMBER + axis])
    number = shape[NUMBER] * shape[NUMBER + 1] * shape[NUMBER + 2]
    tables = cells.boundary.shape[2] >= 2 * most + 2 and cells.copies.centre.shape[1] > most
    return (
        tables
        and layout.edge.shape[1] > most
        and cells.copies.slack.shape[0] >= shape[NUMBER + 2]
        and cells.row.size >= number * shape[STRIDE]
    )


@kernel(plain=True)
def wanted_widths(cells, room, planar, width):
    """Write down the width of a cell along each axis if there are to be so many; an axis shorter than one has one."""
    cells = max(1.0, cells)
    free_x, free_y, free_z = True, not planar, True
    for axis in range(3):
        width[axis] = room[axis]
    while free_x or free_y or free_z:
        size = (room[0] if free_x else 1.0) * (room[1] if free_y else 1.0) * (room[2] if free_z else 1.0) / cells
        free = int(free_x) + int(free_y) + int(free_z)
        if free == 3:
            size = cbrt(size)
        elif free == 2:
            size = math.sqrt(size)
        short_x, short_y, short_z = free_x and room[0] < size, free_y and room[1] < size, free_z and room[2] < size
        if not (short_x or short_y or short_z):
            width[0] = size if free_x else width[0]
            width[1] = size if free_y else width[1]
            width[2] = size if free_z else width[2]
            break
        free_x, free_y, free_z = free_x and not short_x, free_y and not short_y, free_z and not short_z


@kernel(plain=True)
def _misfit(nx, ny, nz, wanted, length, width):
    """Return how far some numbers of cells are from the volume and the shape that are wanted."""
    a = log(nx * width[0] / length[0])
    b = log(ny * width[1] / length[1])
    c = log(nz * width[2] / length[2])
    mean = (a + b + c) / 3.0
    a, b, c = a - mean, b - mean, c - mean
    return abs(log(nx * ny * nz / max(wanted, 1.0))) + 0.5 * math.sqrt((a * a + b * b + c * c) / 3.0)


@kernel(plain=True)
def _nearest(axis, upper, biggest, box, layout):
    """Return the number of cells below, or above, that which has the width that is wanted; 0 if there can be none."""
    if axis == 1 and box.planar:
        return 1
    inverse = box.inverse_x if axis == 0 else (box.inverse_y if axis == 1 else box.inverse_z)
    step = 2 if inverse != 0.0 else 1
    least = 4 if inverse != 0.0 else 1
    length = layout.length[axis]
    most = min(step * math.floor(length / (2.002 * biggest) / step), _MOST)
    if most < least:
        return 0
    lower = step * math.floor(length / layout.width[axis] / step)
    return min(max(lower + (step if upper else 0), least), most)


@kernel(plain=True)
def choose_numbers(molecules, biggest, box, layout):
    """Choose the numbers of cells for the widths that are wanted; tell whether rows can hold copies in such cells.

    They need cells wider than any molecule, four or more along a periodic axis, and not too many molecules in each.
    """
    length, room, width, number = layout.length, layout.room, layout.width, layout.shape
    for axis in range(3):
        if room[axis] < _SMALLEST or length[axis] > _LARGEST:
            return False  # single precision would need other units
    wanted = length[0] / width[0] * (1.0 if box.planar else length[1] / width[1]) * (length[2] / width[2])
    best = math.inf
    for i in range(8):
        nx = _nearest(0, (i & 4) != 0, biggest, box, layout)
        ny = _nearest(1, (i & 2) != 0, biggest, box, layout)
        nz = _nearest(2, (i & 1) != 0, biggest, box, layout)
        if min(nx, ny, nz) < 1:
            return False
        misfit = _misfit(nx, ny, nz, wanted, length, width)
        if misfit < best:
            best = misfit
            number[NUMBER], number[NUMBER + 1], number[NUMBER + 2] = nx, ny, nz
    return molecules / (number[NUMBER] * number[NUMBER + 1] * number[NUMBER + 2]) <= _CROWD


@kernel
def choose_cells(filled, molecules, box, layout):
    """Choose cells for a ceiling that moves, at the height ``filled`` now; tell whether there are any that will do."""
    layout.length[0], layout.length[1], layout.length[2] = box.length_x, box.length_y, TALLER * filled
    layout.room[0], layout.room[1], layout.room[2] = box.length_x, box.length_y, filled
    typical, biggest = math.inf, 0.0
    for k in range(layout.radii.size):
        typical, biggest = min(typical, layout.radii[k]), max(biggest, layout.radii[k])
    share = molecules * size_of(typical, box.planar) / (box.length_x * (1.0 if box.planar else box.length_y) * filled)
    wanted_widths(molecules / for_rows(share), layout.room, box.planar, layout.width)
    layout.filled[0] = filled
    layout.shape[STRIDE] = layout.shortest
    return choose_numbers(molecules, biggest * MARGIN, box, layout)


@kernel(plain=True)
def size_of(radius, planar):
    """Return the volume of a molecule [length^3], of a disc its area [length^2]."""
    return math.pi * radius * radius * (1.0 if planar else 4.0 / 3.0 * radius)


@kernel(plain=True)
def for_rows(share):
    """Return how many molecules a cell should have whose row holds copies, where they fill this share of the box."""
    return 9.0 if share < 0.05 else 8.0


@kernel(plain=True)
def write_boundaries(edge, n, radius, inverse, open_end, inner, boundary):
    """Write where a molecule of some radius enters and leaves the n cells along an axis; return the last slot.

    With an ``open_end`` the last cell has no wall: who gets above it leaves all cells. With ``inner`` walls are each
    molecule's own business, because not all of a class are alike.
    """
    reach = radius * MARGIN
    length = edge[n]
    if inverse != 0.0:
        for k in range(n):
            boundary[2 * k] = edge[k] + reach
            boundary[2 * k + 1] = edge[k + 1] - reach
        boundary[2 * n] = boundary[0] + length
        boundary[2 * n + 1] = boundary[1] + boundary[2 * n] - boundary[0]  # a turn further
        return 2 * n - 1
    boundary[0] = -math.inf if inner else radius
    for k in range(1, n):
        boundary[2 * k - 1] = edge[k] - reach
        boundary[2 * k] = edge[k] + reach
    boundary[2 * n - 1] = length if open_end else (math.inf if inner else length - radius)
    return 2 * n - 2


@kernel(plain=True)
def _farthest(edge, k, n, inverse):
    """Return how far a member of a cell can be from its centre along an axis: W of `glance` [length].

    It may stand in a neighbour of the cell too, anywhere.
    """
    around = 0.0
    if k > 0:
        around = edge[k] - edge[k - 1]
    elif inverse != 0.0:
        around = edge[n] - edge[n - 1]
    if k < n - 1:
        around = max(around, edge[k + 2] - edge[k + 1])
    elif inverse != 0.0:
        around = max(around, edge[1] - edge[0])
    return 0.5 * (edge[k + 1] - edge[k]) + around


@kernel(plain=True)
def write_layers(box, layout, copies):
    """Write what the copies in rows must know of their cells: see `state.Copies`."""
    width = 0.0
    for axis in range(3):
        n, edge = layout.shape[NUMBER + axis], layout.edge[axis]
        inverse = box.inverse_x if axis == 0 else (box.inverse_y if axis == 1 else box.inverse_z)
        for k in range(n):
            copies.centre[axis, k] = 0.5 * (edge[k + 1] + edge[k])
            if axis < 2 and not (axis == 1 and box.planar):
                width = max(width, _farthest(edge, k, n, inverse))
        if inverse != 0.0:  # beyond the last cell stands the first again
            copies.centre[axis, n] = copies.centre[axis, 0] + edge[n]
    layers, edge = layout.shape[NUMBER + 2], layout.edge[2]
    area = layout.length[0] * (1.0 if box.planar else layout.length[1])
    copies.slack[:] = math.inf
    copies.room[:] = 1.0
    for k in range(layers):
        layer = max(_farthest(edge, k, layers, box.inverse_z), width)
        copies.slack[k, DISTANCE] = SLACK * layer
        copies.slack[k, SQUARE] = SLACK * layer * layer
        copies.slack[k, CLOSING] = 4.0 * SLACK * layer  # times V
        copies.room[k] = area * (edge[k + 1] - edge[k])


@kernel
def write_cells(gas, layout, modes):
    """Write the tables of the cells that were chosen under a piston, all along an axis equally wide.

    Nobody stands in them yet, and nothing is planned.
    """
    cells, box, shape = gas.cells, gas.box, layout.shape
    cells.boundary[:] = math.inf
    for axis in range(3):
        n, edge = shape[NUMBER + axis], layout.edge[axis]
        step = layout.length[axis] / n
        for k in range(n):
            edge[k] = k * step
        edge[n] = layout.length[axis]
        inverse = box.inverse_x if axis == 0 else (box.inverse_y if axis == 1 else box.inverse_z)
        for size in range(layout.radii.size):
            shape[LAST + axis] = write_boundaries(
                edge, n, layout.radii[size], inverse, axis == 2, modes.mixed, cells.boundary[size, axis]
            )
    write_layers(box, layout, cells.copies)
    cells.copies.place[:] = 0
