"""Which molecules are in which cells, for both kinds of rows; for everything outside the innermost loops.

The rows of cells are lists of molecules (`cells`), or hold copies of trajectories too (`rows`); the mode ``rows``
tells which.
"""

from enum import IntEnum

import numpy as np

from atmosbox.engine.core.jit import POSITIVE, kernel, lowest_bit
from atmosbox.engine.exact.cells import append, overlapped, remove
from atmosbox.engine.exact.rows import enter, has_place, leave, members_of, name_in, number_of_places, start_of


class Change(IntEnum):
    """What `change` does: ``TEST`` whether the rows have room, ``REMOVE`` a molecule from them, or ``ADD`` it."""

    TEST = 0
    REMOVE = 1
    ADD = 2


@kernel
def row_of(x, y, z, cells):
    """Return where the row of a cell begins; its numbers x, y, z may be beyond the end of a periodic axis."""
    cell = ((x % cells.number_x) * cells.number_y + y % cells.number_y) * cells.number_z + z % cells.number_z
    return (cell * cells.stride) & POSITIVE


@kernel
def places(start, cells, modes):
    """Return the number of places of a row that must be read."""
    return number_of_places(cells, modes) if modes.rows else np.int64(cells.row[start])


@kernel
def listed(start, place, cells, modes):
    """Return the molecule in a place of a row, -1 if it is free."""
    return name_in(start, place, cells, modes) if modes.rows else np.int64(cells.row[start + 1 + place])


@kernel
def change(what, i, size, slots, cells, modes):
    """Do one `Change` with molecule i in all cells of three slots; return whether one of them is full."""
    full = False
    if modes.rows:
        members = members_of(slots)
        while members != 0:
            bit = lowest_bit(members)
            members &= members - 1
            start = start_of(bit, slots, cells, modes)
            if what == Change.REMOVE:
                leave(i, bit, start, cells)
            elif what == Change.ADD:
                full |= enter(i, bit, start, cells, modes)
            else:
                full |= not has_place(start, cells, modes)
        return full
    first_x, span_x = overlapped(slots[0], size, 0, cells, modes)
    first_y, span_y = overlapped(slots[1], size, 1, cells, modes)
    first_z, span_z = overlapped(slots[2], size, 2, cells, modes)
    for x in range(first_x, first_x + span_x):
        for y in range(first_y, first_y + span_y):
            for z in range(first_z, first_z + span_z):
                start = row_of(x, y, z, cells)
                if what == Change.REMOVE:
                    remove(cells.row, start, i)
                elif what == Change.ADD:
                    append(cells.row, start, i)
                else:
                    full |= np.int64(cells.row[start]) + 1 >= cells.stride
    return full
