"""Which molecules can meet: cells, and the slots that tell which cells a molecule overlaps.

A molecule belongs to every cell that its *sphere* overlaps: most often one, near a face two, in a corner
eight. Two spheres that touch share the cell of the point where they touch, so a molecule is only ever
compared with those that share a cell of its own, never with neighbouring cells. Along each axis its
centre lies in a **slot**: an interval between two successive boundaries, which are the cell edges
shifted by plus and minus its radius. Crossing a boundary means entering one cell, or leaving one. Layers
of unequal thickness cost nothing, the outermost boundary is the wall, and a sphere larger than a cell
just overlaps more of them.

Three cells along one axis, and the slots of a sphere of radius r::

    cells        |      0       |      1       |      2       |
    boundaries   |r         -r +r         -r +r             -r|
    slots           0      | 1 |     2    | 3 |      4
    overlaps       {0}     {0,1}    {1}   {1,2}     {2}

An even slot 2c lies within cell c (its span is 1), an odd one 2c + 1 across the edge from c to c + 1 (span 2). The
first and the last boundary are one radius from the wall. Each cell has a row in one long array, ``stride`` numbers
long: first the number of its molecules, then their indices::

    row          | 2 | 17 | 4 | . | . || 1 | 9 | . | . | . || ...
                 cell 0                 cell 1
"""

import math
from collections import namedtuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.elementary import cbrt
from atmosbox.engine.core.jit import POSITIVE, kernel
from atmosbox.engine.core.refusal import RefusedError
from atmosbox.engine.exact.row_cells import MARGIN, MOST_CELLS, cell_widths, filled_share, write_layers

_FEW = 4
_LEAST_REACH = 1e-9
"""Smallest radius that a molecule is assumed to have, relative to the box: a point too is in two cells at an edge."""
ROW = 32
"""Number of words of a row at first, where rows hold no copies."""


class Grid(namedtuple("Grid", "number boundary first span last_slot spanning images")):
    """Cells without copies, and slots along the three axes: see `state.Cells`."""


def size_classes(radius: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Sort radii into classes of about equal size (within a tenth), so that a thousand sizes need few tables.

    Returns the class of each radius, and for each class a radius that none of its members exceeds [length].

    >>> size_classes(np.array([1.0, 1.05, 2.0]))[0]
    array([0, 0, 1])
    """
    distinct = np.unique(radius)
    starts: list[float] = []
    for value in distinct:
        if not starts or value > 1.1 * starts[-1]:
            starts.append(float(value))
    size = np.searchsorted(np.array(starts), radius, side="right") - 1
    return size, np.array([float(radius[size == k].max()) for k in range(len(starts))])


def choose_grid(
    length: NDArray[np.float64],
    periodic: tuple[bool, bool, bool],
    radii: NDArray[np.float64],
    molecules: int,
    *,
    exact_radius: bool,
    planar: bool,
    filled: float,
    open_top: bool,
    scale_height: float,
) -> Grid:
    """Choose cells without copies: some two to eight molecules to a cell, layers thinner where gravity makes gas dense.

    There are molecules up to the height ``filled``. With an ``open_top`` the ceiling moves, so that the uppermost
    cells have no end. ``exact_radius`` says that all radii are the same; ``scale_height`` is ``inf`` without gravity
    [length]. A periodic axis so short that two molecules could touch each other on both sides at once is refused.
    """
    biggest = float(radii.max()) * MARGIN
    # the most cells along an axis that are wider than a molecule
    most = [length[axis] / (2.002 * biggest) if biggest > 0.0 else math.inf for axis in range(3)]
    number: list[int] = []
    # measured (benchmarks): the pace is flat about this many molecules to a cell
    share = filled_share(length[0], length[1], filled, float(radii.min()), molecules, planar)
    occupancy = min(max(2.2 * float(cbrt(0.1 / share)), 1.5), 8.0) if share > 0.0 else 8.0
    width = cell_widths(length[0], length[1], filled, molecules / occupancy, planar)
    spanning = not exact_radius
    images = False
    for axis in range(3):
        n = max(1, min(int(length[axis] / width[axis]), MOST_CELLS))
        if planar and axis == 1:
            n = 1
        elif periodic[axis]:
            diameter = 2.0 * float(radii.max())
            if length[axis] < 2.0 * diameter:
                raise RefusedError(
                    f"length = {length[axis]:.6g} along {'xyz'[axis]} is too short for molecules of diameter "
                    f"{diameter:.6g} on a periodic axis, where two would touch each other on both sides at once: make "
                    f"it {2.0 * diameter:.6g} or more"
                )
            # Two that share a cell are within its width and a diameter of each other. Where that is less than half
            # the box, only the nearest image of the other can be met. Where this would need many cells for few
            # molecules, three cells are enough: then no sphere reaches round the box into a cell that it is already
            # in, and both the nearest image and the one on the other side are tested.
            room = 0.5 * length[axis] - 2.0 * biggest
            least = math.ceil(length[axis] / room) if room > 0.0 else math.inf
            if least > max(n, _FEW):
                images = True
                least = 3
            n = max(n, int(least))
            if exact_radius and n > most[axis]:
                n = max(int(least), int(most[axis]))
            spanning = spanning or n > most[axis]
        elif exact_radius and n > most[axis]:
            n = max(1, int(most[axis]))
        number.append(n)
    edges = [np.linspace(0.0, length[axis], number[axis] + 1) for axis in range(3)]
    if math.isfinite(scale_height) and number[2] > 1:
        thinnest = 0.25 * width[2] if spanning else max(2.002 * biggest, 0.05 * width[2])
        edge = np.zeros(number[2] + 1)
        number[2] = write_layers(float(length[2]), number[2], scale_height, thinnest, edge)
        edges[2] = edge[: number[2] + 1]
    tables = [
        [_slots(edges[axis], float(r), periodic[axis], spanning, open_top=open_top and axis == 2) for axis in range(3)]
        for r in radii
    ]
    slots = max(len(table[1]) for row in tables for table in row)
    boundary = np.full((len(radii), 3, slots + 2), np.inf)
    first = np.zeros((len(radii), 3, slots), np.int32)
    span = np.ones((len(radii), 3, slots), np.int32)
    for size, row in enumerate(tables):
        for axis, (b, f, s) in enumerate(row):
            boundary[size, axis, : len(b)] = b
            first[size, axis, : len(f)] = f
            span[size, axis, : len(s)] = s
    last = tuple(len(tables[0][axis][1]) - 1 for axis in range(3))
    return Grid((number[0], number[1], number[2]), boundary, first, span, (last[0], last[1], last[2]), spanning, images)


def _slots(
    edges: NDArray[np.float64], radius: float, periodic: bool, spanning: bool, *, open_top: bool
) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int32]]:
    """Return boundaries, first cells and numbers of cells of the slots along one axis for one radius.

    Where molecules may span cells, the table has no walls, as the molecules of a class differ in radius: the walls are
    then computed for each molecule.
    """
    n = len(edges) - 1
    length = float(edges[-1])
    # where one cell is entered exactly as another is left, the slot between would have no width: increase the reach
    reach = max(radius, _LEAST_REACH * length) * MARGIN
    inside = edges[:-1] if periodic else edges[1:-1]
    while inside.size:
        ends = np.sort(np.mod(np.concatenate([inside - reach, inside + reach]), length))
        if np.diff(ends, append=ends[0] + length).min() > 1e-12 * length:
            break
        reach *= MARGIN
    if periodic:
        shifted = np.concatenate([edges[:-1] + reach, edges[1:] - reach])
        first = np.sort(np.mod(shifted, length)) if spanning else np.sort(shifted)
        boundary = np.append(first, first[0] + length)
    else:
        between = np.sort(np.concatenate([edges[1:-1] - reach, edges[1:-1] + reach]))
        if spanning:
            between = between[(between > 0.0) & (between < length)]
            boundary = np.concatenate([[-np.inf], between, [np.inf]])
        else:
            boundary = np.concatenate([[radius], between, [np.inf if open_top else length - radius]])
    bounded = np.clip(boundary, min(0.0, boundary[1]), max(length, boundary[-2])) if not periodic else boundary
    middle = 0.5 * (bounded[1:] + bounded[:-1])
    low = _cell_of(middle - reach, edges, periodic)
    high = _cell_of(middle + reach, edges, periodic)
    return boundary, np.mod(low, n).astype(np.int32), (high - low + 1).astype(np.int32)


def _cell_of(x: NDArray[np.float64], edges: NDArray[np.float64], periodic: bool) -> NDArray[np.int64]:
    """Return the number of the cell at each coordinate; it goes on beyond a periodic end and is cut off at a wall."""
    n = len(edges) - 1
    if periodic:
        turns = np.floor(x / edges[-1]).astype(np.int64)
        inside = np.clip(np.searchsorted(edges, x - turns * edges[-1], side="right") - 1, 0, n - 1)
        around: NDArray[np.int64] = inside + turns * n
        return around
    cell: NDArray[np.int64] = np.clip(np.searchsorted(edges, x, side="right") - 1, 0, n - 1)
    return cell


@kernel
def overlapped(slot, size, axis, cells, modes):
    """Return the first cell along an axis that a sphere in a slot overlaps, and the number of cells."""
    if modes.spanning:
        return np.int64(cells.first[size, axis, slot]), np.int64(cells.span[size, axis, slot])
    return slot >> 1, 1 + (slot & 1)


@kernel
def slot_at(u, size, axis, last, cells, modes):
    """Return the slot along an axis in which a centre at the coordinate u [length] lies."""
    if modes.mixed and not modes.rows:
        last = cells.boundary.shape[2] - 3
        while last > 0 and cells.boundary[size, axis, last] == math.inf:
            last -= 1
    lower = 0
    upper = last + 1
    while upper - lower > 1:
        middle = (lower + upper) >> 1
        if u >= cells.boundary[size, axis, middle]:
            lower = middle
        else:
            upper = middle
    return lower


@kernel
def slots_at(x, y, z, size, cells, modes):
    """Return the slots of a centre along x, y and z."""
    return (
        slot_at(x, size, 0, cells.last_slot_x, cells, modes),
        slot_at(y, size, 1, cells.last_slot_y, cells, modes),
        slot_at(z, size, 2, cells.last_slot_z, cells, modes),
    )


@kernel
def side(axis, box):
    """Return the length of the box along an axis [length], and its inverse if the axis is periodic, else 0."""
    if axis == 0:
        return box.length_x, box.inverse_x
    if axis == 1:
        return box.length_y, box.inverse_y
    return box.length_z, box.inverse_z


@kernel
def turns_past(u, axis, size, gas):
    """Return by how many whole lengths of a periodic box a coordinate lies beyond it [length]; 0 along other axes."""
    length, inverse = side(axis, gas.box)
    return math.floor((u - gas.cells.boundary[size, axis, 0]) / length) * length if inverse != 0.0 else 0.0


@kernel
def shift(i, axis, by, gas):
    """Shift molecule i along an axis."""
    molecule = gas.molecules[i]
    if axis == 0:
        molecule.x += by
    elif axis == 1:
        molecule.y += by
    else:
        molecule.z += by


@kernel
def append(row, start, i):
    """Add molecule i to the cell whose row begins at ``start``."""
    start &= POSITIVE
    n = np.int64(row[start]) + 1
    row[start + n] = i
    row[start] = n


@kernel
def remove(row, start, i):
    """Remove molecule i from the cell whose row begins at ``start``."""
    start &= POSITIVE
    last = start + np.int64(row[start])
    q = start + 1
    while row[q] != i and q < last:
        q += 1
    row[q] = row[last]
    row[start] -= 1
