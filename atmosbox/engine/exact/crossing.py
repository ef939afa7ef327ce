"""A molecule reaches a boundary: it enters a cell, or leaves one, or the boundary is a wall.

Entering, it is compared with the members of the new cells alone; leaving, with nobody.
"""

import numpy as np

from atmosbox.engine.core.jit import POSITIVE, kernel
from atmosbox.engine.exact.calendar import schedule
from atmosbox.engine.exact.cells import append, overlapped, remove
from atmosbox.engine.exact.prediction import CONTACT, next_move, size_and_radius, soonest_in_cell

__all__ = ["ENTERED", "FULL", "LEFT", "WALL", "cross"]

WALL, ENTERED, LEFT, FULL = 0, 1, 2, 3


@kernel
def _is_wall(slot, axis, up, size, radius, length, inverse, last_slot, cells, modes):
    """Tell whether the boundary that a molecule has reached is a wall."""
    if inverse != 0.0:
        return False
    if modes.spanning:
        if up == 1:
            return cells.boundary[size, axis, slot + 1] >= length - radius
        return cells.boundary[size, axis, slot] <= radius
    return slot + up == 0 or slot + up == last_slot + 1


@kernel
def cross(i, what, t, x, y, z, vx, vy, vz, molecules, events, kinds, cells, calendar, box, walls, modes):
    """Let molecule i, which is at (x, y, z) at time t, cross the boundary that it has reached, and plan its next move.

    Returns
    -------
    int
        ``ENTERED`` or ``LEFT``; ``WALL`` or ``FULL``, with nothing changed, if it is a wall or a new cell has no room.
    """
    axis = what >> 1
    up = what & 1
    slot = np.int64(cells.slot[i, axis])
    size, radius = size_and_radius(i, molecules, kinds, modes)
    if axis == 0:
        length, inverse, last, number = box.length_x, box.inverse_x, cells.last_slot_x, cells.number_x
    elif axis == 1:
        length, inverse, last, number = box.length_y, box.inverse_y, cells.last_slot_y, cells.number_y
    else:
        length, inverse, last, number = box.length_z, box.inverse_z, cells.last_slot_z, cells.number_z
    if _is_wall(slot, axis, up, size, radius, length, inverse, last, cells, modes):
        return WALL
    next_slot = slot + 2 * up - 1
    shift = 0.0
    if modes.periodic and inverse != 0.0:
        if next_slot < 0:
            next_slot = last
            shift = length
        elif next_slot > last:
            next_slot = 0
            shift = -length
        if shift != 0.0:
            x += shift if axis == 0 else 0.0
            y += shift if axis == 1 else 0.0
            z += shift if axis == 2 else 0.0
    first, span = overlapped(slot, size, axis, cells, modes)
    next_first, next_span = overlapped(next_slot, size, axis, cells, modes)
    enter = next_span > span
    highest = next_first + next_span - 1 if enter else first + span - 1
    lowest = next_first if enter else first
    cell = highest if (up == 1) == enter else lowest
    if modes.periodic and cell >= number:
        cell -= number
    # the cells along the two other axes
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
    event = events[i]
    contact_time = event.contact_time
    if enter and modes.contacts:
        soonest = contact_time - t
        partner = -1
        full = False
        for q in range(first_1, first_1 + span_1):
            if modes.periodic and q >= number_1:
                q -= number_1
            for r in range(first_2, first_2 + span_2):
                if modes.periodic and r >= number_2:
                    r -= number_2
                c = base + q * step_1 + r * step_2
                full |= np.int64(cells.row[(c * stride) & POSITIVE]) + 1 >= stride
                soonest, partner = soonest_in_cell(
                    c, i, t, x, y, z, vx, vy, vz, radius, soonest, partner, molecules, kinds, cells, box, modes
                )
        if full:
            return FULL
        if partner >= 0:
            contact_time = t + soonest
            event.contact_time = contact_time
            event.partner = partner
            event.partner_count = molecules[partner].count
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
    if modes.periodic and shift != 0.0:
        if axis == 0:
            molecules[i].x += shift
        elif axis == 1:
            molecules[i].y += shift
        else:
            molecules[i].z += shift
    cells.slot[i, axis] = next_slot
    slots = np.int64(event.slot_x), np.int64(event.slot_y), np.int64(event.slot_z)
    time, what = next_move(slots[0], slots[1], slots[2], t, x, y, z, vx, vy, vz, size, radius, cells, box, walls, modes)
    time += t
    if contact_time < time:
        what = CONTACT
    event.what = what
    schedule(calendar, i, min(time, contact_time))
    return ENTERED if enter else LEFT
