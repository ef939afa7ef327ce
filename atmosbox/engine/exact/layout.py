"""The present cells of a box, and how they change: longer rows, new copies, other cells.

Python runs these functions as they are written, and the lab's page compiles them. They never make memory: if there is
too little, `settling` says so. Then Python makes more and calls again; a page stops with a sentence.
"""

import functools
import math
from collections import namedtuple
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import EVENT, SLOT_OFFSET, Cells, Copies, Gas, Modes, aligned_records
from atmosbox.engine.exact.exact import Status, specialise
from atmosbox.engine.exact.row_cells import TALLER, cell_numbers, write_even_layers, write_layers, write_slots
from atmosbox.engine.exact.rows import FEWEST, MORE, MOST, describe_cells, row_stride

PLACES, NUMBER, LAST = 0, 1, 4
"""Indices of ``Layout.shape``: the number of places of a row, the numbers of cells, and the last slots."""
NOTHING, LENGTHEN, COPY, NEW_EPOCH, PLACE, CHOOSE, FOLLOW = range(7)
"""What is due in the cells: nothing; longer rows; copies of the present time; copies from the next event on; to enter
all molecules; other cells for a ceiling at another height; layers that follow the molecules."""
_FULL = Status.FULL.value


class Layout(namedtuple("Layout", "shape due filled edge radius column")):
    """The present cells of a box.

    ``shape : (7,)`` holds the places of a row, the numbers of cells and the last slots; ``due : (1,)`` what is to be
    done with the cells before the next event; ``filled : (1,)`` the height of the ceiling when the cells were chosen
    [length]; ``radius : (size,)`` the radii of molecules [length]. Where rows hold copies, ``edge : (axis, ...)`` are
    the edges of the cells, with memory for more, and ``column`` is the data for the choice of layers in gravity.
    """


class Column(namedtuple("Column", "weight bath wanted thinnest count old")):
    """The data, besides its temperature, from which the layers of a column are chosen.

    ``weight`` is that of a molecule [force], ``bath`` the temperature of the warmest wall [energy], ``wanted`` the
    requested number of layers, ``thinnest`` the smallest height of a layer [length]; ``count`` and ``old`` are scratch,
    for as many layers and one more.
    """


def new_rows(words: int) -> NDArray[np.uint32]:
    """Return the memory of rows of cells, all empty."""
    rows: NDArray[np.uint32] = aligned_records(words, np.dtype("u4")).view(np.ndarray)
    return rows


def new_cells(events: Any, sizes: int, words: int, most: int, radius: float, longest: float) -> Cells:
    """Return the memory of cells, whose tables are still empty.

    ``events`` hold the slots and the places of all molecules. All rows together have ``words`` words, an axis at most
    ``most`` cells; ``radius`` is the usual one of a molecule, ``longest`` the greatest length of an epoch of the
    copies.
    """
    row, n = new_rows(words), len(events)
    slot = np.ndarray((n, 3), np.uint16, events.data, SLOT_OFFSET, (EVENT.itemsize, 2)) if n else np.zeros((0, 3), "u2")
    copies = Copies(
        value=row.view(np.float32),
        occupied=row.view(np.int64),
        place=events.view(np.ndarray).view(np.uint8),
        centre=np.zeros((3, most + 1)),
        horizon=np.full(most, math.inf),
        slack=np.full((most, 3), math.inf),
        epoch=np.array([0.0, math.inf, 0.0, longest]),
        room=np.ones(most),
        radius=radius,
    )
    none = np.zeros((sizes, 3, 1), np.int32)
    boundary = np.full((sizes, 3, 2 * most + 2), math.inf)
    return Cells(row, 0, boundary, none, none, slot, 0, 0, 0, 0, 0, 0, copies)


@kernel(plain=True)
def stride_of(layout, modes):
    """Return the present number of words in the row of a cell: with copies of trajectories, or with numbers only."""
    places = layout.shape[PLACES]
    return row_stride(places, modes.mixed) if modes.rows else 1 + places


@kernel(plain=True)
def as_laid_out(gas, layout, modes):
    """Return the gas with its present cells."""
    c, shape = gas.cells, layout.shape
    cells = Cells(
        c.row, stride_of(layout, modes), c.boundary, c.first, c.span, c.slot,
        shape[NUMBER], shape[NUMBER + 1], shape[NUMBER + 2], shape[LAST], shape[LAST + 1], shape[LAST + 2], c.copies,
    )  # fmt: skip
    return Gas(gas.molecules, gas.events, gas.kinds, cells, gas.calendar, gas.box, gas.walls, gas.tallies)


@kernel(plain=True)
def choose_cells(filled, molecules, box, moving, layout):
    """Choose the numbers of cells whose rows hold copies; return whether suitable ones exist.

    There are molecules up to the height ``filled``; the cells reach higher if that is a ``moving`` ceiling.
    """
    length = (box.length_x, box.length_y, TALLER * filled if moving else filled)
    periodic = (box.inverse_x != 0.0, box.inverse_y != 0.0, box.inverse_z != 0.0)
    radii = layout.radius[0], layout.radius[layout.radius.size - 1]
    found = cell_numbers(length, filled, radii, molecules, periodic, box.planar)
    for axis in range(3):
        layout.shape[NUMBER + axis] = found[axis]
    layout.filled[0] = filled
    return found[0] > 0


@kernel(plain=True)
def write_cells(gas, layout, modes):
    """Write the edges and the tables of the cells that were chosen, all of the same size."""
    top = TALLER * layout.filled[0] if modes.piston else layout.filled[0]
    length = (gas.box.length_x, gas.box.length_y, top)
    for axis in range(3):
        n = layout.shape[NUMBER + axis]
        for k in range(n):
            layout.edge[axis, k] = k * (length[axis] / n)
        layout.edge[axis, n] = length[axis]
    describe(gas, layout, modes)


@kernel(plain=True)
def write_column(kT, gas, layout, modes):
    """Write layers for molecules of a temperature [energy]; return whether there is memory for them."""
    column, height = layout.column, layout.edge[2, layout.shape[NUMBER + 2]]
    scale_height = max(kT, column.bath) / column.weight
    found = write_layers(height, column.wanted, scale_height, column.thinnest, layout.edge[2])
    if found > 0:
        layout.shape[NUMBER + 2] = found
        describe(gas, layout, modes)
    return found > 0


@kernel(plain=True)
def follow_molecules(gas, layout, modes):
    """Write layers fitted to the present positions of the molecules; return whether that was possible and worth it."""
    column, layers = layout.column, layout.shape[NUMBER + 2]
    if column.wanted <= 1:
        return False
    counted, old = column.count[:layers], column.old[: layers + 1]
    counted[:] = 0
    for i in range(gas.molecules.size):
        counted[gas.cells.slot[i, 2] >> 1] += 1
    for k in range(layers + 1):
        old[k] = layout.edge[2, k]
    found = write_even_layers(counted, old, column.wanted, column.thinnest, layout.edge[2])
    if found > 0:
        layout.shape[NUMBER + 2] = found
        describe(gas, layout, modes)
    return found > 0


@kernel(plain=True)
def describe(gas, layout, modes):
    """Write the tables of cells with these edges, and make their rows short again."""
    box, edge, shape, cells = gas.box, layout.edge, layout.shape, gas.cells
    edges = (edge[0, : shape[NUMBER] + 1], edge[1, : shape[NUMBER + 1] + 1], edge[2, : shape[NUMBER + 2] + 1])
    periodic = (box.inverse_x != 0.0, box.inverse_y != 0.0, box.inverse_z != 0.0)
    shape[PLACES] = FEWEST
    cells.boundary[:] = math.inf
    for size in range(layout.radius.size):
        for axis in range(3):
            opens, radius, boundary = modes.piston and axis == 2, layout.radius[size], cells.boundary[size, axis]
            shape[LAST + axis] = write_slots(edges[axis], radius, periodic[axis], modes.mixed, opens, boundary)
    describe_cells(edges, periodic, box.planar, cells.copies)


@kernel(plain=True)
def _has_memory(gas, layout, modes):
    """Return whether there is memory for the present rows."""
    shape = layout.shape
    cells = shape[NUMBER] * shape[NUMBER + 1] * shape[NUMBER + 2]
    return cells * stride_of(layout, modes) <= gas.cells.row.size


@kernel(plain=True)
def double_rows(memory, rows, old):
    """Make rows of ``old`` words twice as long in the same memory; return whether there is enough."""
    if 2 * old * rows > memory.size:
        return False
    # from the last row to the first, so that none is overwritten before it is moved
    for row in range(rows - 1, 0, -1):
        for place in range(np.int64(memory[row * old]), -1, -1):
            memory[2 * row * old + place] = memory[row * old + place]
    return True


@kernel(plain=True)
def _chosen(gas, now, layout, modes):
    """Choose new cells, if these functions can; return whether they are chosen."""
    shape = layout.shape
    if modes.rows and modes.gravity:
        return layout.due[0] == FOLLOW and follow_molecules(gas, layout, modes)
    if modes.rows and modes.piston:
        piston = gas.walls.piston
        ceiling = piston[0] + piston[1] * (now - piston[2])
        if layout.due[0] != CHOOSE or not choose_cells(ceiling, gas.molecules.size, gas.box, True, layout):
            return False
        shape[PLACES] = FEWEST
        most = max(shape[NUMBER], shape[NUMBER + 1], shape[NUMBER + 2])
        if most >= layout.edge.shape[1] or not _has_memory(gas, layout, modes):
            return False
        write_cells(gas, layout, modes)
        return True
    return False


@functools.cache
def settling(modes: Modes) -> Any:
    """Return the kernel ``settle`` of one set of modes."""
    place_all, _, _, _, refill = specialise(modes)

    @kernel(plain=True)
    def settle(gas, now, layout):
        """Do what is due in the cells at a local time; return False if there is no memory or no way to do it."""
        due, shape = layout.due, layout.shape
        while due[0] != NOTHING:
            if due[0] >= CHOOSE:
                if not _chosen(gas, now, layout, modes):
                    return False
                due[0] = PLACE
            if due[0] == LENGTHEN:
                if modes.rows:
                    shape[PLACES] += MORE
                    due[0] = COPY
                else:
                    old, cells = stride_of(layout, modes), shape[NUMBER] * shape[NUMBER + 1] * shape[NUMBER + 2]
                    if not double_rows(gas.cells.row, cells, old):
                        return False
                    shape[PLACES] += old
                    due[0] = NOTHING
                    continue
            if modes.rows and shape[PLACES] > MOST:
                due[0] = FOLLOW
                continue
            if not _has_memory(gas, layout, modes):
                return False
            here = as_laid_out(gas, layout, modes)
            if due[0] == PLACE:
                gas.cells.copies.place[:] = 0  # these are all bytes of the events
                gas.calendar.time[:] = math.inf
                gas.calendar.winner[:] = 0
                short = place_all(here, now) == _FULL
            elif modes.rows:
                short = refill(here, gas.calendar.time[1] if due[0] == NEW_EPOCH else now)
            else:
                short = False
            if short:
                shape[PLACES] += MORE if modes.rows else stride_of(layout, modes)
            else:
                due[0] = NOTHING
        return True

    return settle
