"""A molecule reaches a boundary: it enters a cell, or leaves one, or the boundary is a wall.

When it enters a cell, it is compared with the members of the new cells alone; when it leaves one, with none.
"""

from enum import IntEnum

import numpy as np

from atmosbox.engine.core.jit import POSITIVE, kernel
from atmosbox.engine.core.state import Motion
from atmosbox.engine.exact.cells import append, overlapped, remove, shift, side
from atmosbox.engine.exact.encounter import size_and_radius, slots_of
from atmosbox.engine.exact.prediction import Meeting, plan_move, soonest_in_cell


class Crossed(IntEnum):
    """The result when a molecule has reached a boundary.

    ``ENTERED``: the molecule is in one more layer of cells; ``LEFT``: it has left one; ``FULL``: the row of a new cell
    must grow first, and nothing is changed.
    """

    ENTERED = 1
    LEFT = 2
    FULL = 3


@kernel
def is_wall(i, what, gas, modes):
    """Return whether the boundary that molecule i has reached is a wall, or the end of all cells."""
    cells = gas.cells
    axis = what >> 1
    up = what & 1
    slot = np.int64(cells.slot[i, axis])
    length, inverse = side(axis, gas.box)
    if inverse != 0.0:
        return False
    if modes.spanning:
        size, radius = size_and_radius(i, gas, modes)
        if up == 1:
            return cells.boundary[size, axis, slot + 1] >= length - radius
        return cells.boundary[size, axis, slot] <= radius
    last = cells.last_slot_x if axis == 0 else (cells.last_slot_y if axis == 1 else cells.last_slot_z)
    if modes.rows:
        # slots of the first and of the last cell; the molecule may be in the next cell too
        return slot < 2 if up == 0 else slot + 1 >= last
    return slot + up == 0 or slot + up == last + 1


@kernel
def cross(i, what, t, at, gas, modes):
    """Move molecule i, whose `Motion` at time t is ``at``, across a boundary; predict the next; return a `Crossed`."""
    cells = gas.cells
    axis = what >> 1
    up = what & 1
    slot = np.int64(cells.slot[i, axis])
    size, radius = size_and_radius(i, gas, modes)
    # the next slot; beyond a periodic end it is the first or last, and the molecule is shifted by one box length
    length, inverse = side(axis, gas.box)
    next_slot = slot + 2 * up - 1
    by = 0.0
    if modes.periodic and inverse != 0.0:
        last = cells.last_slot_x if axis == 0 else (cells.last_slot_y if axis == 1 else cells.last_slot_z)
        if next_slot < 0:
            next_slot = last
            by = length
        elif next_slot > last:
            next_slot = 0
            by = -length
        if by != 0.0:
            x = at.x + (by if axis == 0 else 0.0)
            y = at.y + (by if axis == 1 else 0.0)
            z = at.z + (by if axis == 2 else 0.0)
            at = Motion(x, y, z, at.vx, at.vy, at.vz)
    # the one layer of cells, across this axis, that is entered (the span grows) or left (the span shrinks)
    first, span = overlapped(slot, size, axis, cells, modes)
    next_first, next_span = overlapped(next_slot, size, axis, cells, modes)
    enter = next_span > span
    highest = next_first + next_span - 1 if enter else first + span - 1
    lowest = next_first if enter else first
    cell = highest if (up == 1) == enter else lowest
    number = cells.number_x if axis == 0 else (cells.number_y if axis == 1 else cells.number_z)
    if modes.periodic and cell >= number:
        cell -= number
    # the cells of that layer which the sphere overlaps: their numbers along the two other axes, and their strides
    a1 = 1 if axis == 0 else 0
    a2 = 1 if axis == 2 else 2
    across = cells.number_y * cells.number_z
    step_1 = cells.number_z if axis == 0 else across
    step_2 = cells.number_z if axis == 2 else 1
    number_1 = cells.number_y if axis == 0 else cells.number_x
    number_2 = cells.number_y if axis == 2 else cells.number_z
    first_1, span_1 = overlapped(np.int64(cells.slot[i, a1]), size, a1, cells, modes)
    first_2, span_2 = overlapped(np.int64(cells.slot[i, a2]), size, a2, cells, modes)
    base = cell * (across if axis == 0 else (cells.number_z if axis == 1 else 1))
    stride = cells.stride
    event = gas.events[i]
    # on entering: is a member of the new cells met before the known contact? Nothing is changed until all have room
    if enter and modes.contacts:
        meeting = Meeting(event.contact_time - t, -1)
        full = False
        for q in range(first_1, first_1 + span_1):
            if modes.periodic and q >= number_1:
                q -= number_1
            for r in range(first_2, first_2 + span_2):
                if modes.periodic and r >= number_2:
                    r -= number_2
                c = base + q * step_1 + r * step_2
                full |= np.int64(cells.row[(c * stride) & POSITIVE]) + 1 >= stride
                meeting = soonest_in_cell(c, i, t, at, radius, meeting, gas, modes)
        if full:
            return Crossed.FULL
        if meeting.partner >= 0:
            event.contact_time = t + meeting.after
            event.partner = meeting.partner
            event.partner_count = gas.molecules[meeting.partner].count
    if modes.contacts:
        for q in range(first_1, first_1 + span_1):
            if modes.periodic and q >= number_1:
                q -= number_1
            for r in range(first_2, first_2 + span_2):
                if modes.periodic and r >= number_2:
                    r -= number_2
                start = (base + q * step_1 + r * step_2) * stride
                if enter:
                    append(cells.row, start, i)
                else:
                    remove(cells.row, start, i)
    # the molecule's own record changes only where it has crossed a periodic boundary
    if modes.periodic and by != 0.0:
        shift(i, axis, by, gas)
    cells.slot[i, axis] = next_slot
    plan_move(i, slots_of(i, gas), t, at, size, radius, gas, modes)
    return Crossed.ENTERED if enter else Crossed.LEFT
