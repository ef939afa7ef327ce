"""Where there is room for a molecule, and the rows of cells in which it then stands."""

import math

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.random import uniform
from atmosbox.engine.exact.cells import append, overlapped, remove, slot_at
from atmosbox.engine.exact.prediction import size_and_radius

__all__ = ["FREE", "NO_ROOM", "STRIKE", "TAKEN", "WRITE", "enlist", "has_room", "look_for_room", "move_to", "room_at"]

FREE, TAKEN, NO_ROOM = 0, 1, 2
"""Whether there is room at a place: yes; somebody is there; a row of molecules must grow first."""
LOOK, STRIKE, WRITE = range(3)
"""What `enlist` does."""


@kernel
def _is_near(j, t, x, y, z, reach, molecules, box, modes):
    """Tell whether the centre of molecule j is nearer to a place than ``reach`` [length]; there is no gravity."""
    other = molecules[j]
    dt = t - other.clock
    rx = x - other.x - dt * other.vx
    ry = y - other.y - dt * other.vy
    rz = z - other.z - dt * other.vz
    if modes.periodic:
        rx -= box.length_x * np.rint(rx * box.inverse_x)
        ry -= box.length_y * np.rint(ry * box.inverse_y)
        if not modes.piston:
            rz -= box.length_z * np.rint(rz * box.inverse_z)
    return rx * rx + ry * ry + rz * rz < reach * reach


@kernel
def room_at(i, t, x, y, z, molecules, events, kinds, cells, box, modes):
    """Tell whether molecule i may stand at a place, and note there its slots: ``FREE``, ``TAKEN`` or ``NO_ROOM``.

    ``NO_ROOM`` is a row of molecules that must grow first.
    """
    size, radius = size_and_radius(i, molecules, kinds, modes)
    cells.slot[i, 0] = slot_at(x, size, 0, cells.last_slot_x, cells, modes)
    cells.slot[i, 1] = slot_at(y, size, 1, cells.last_slot_y, cells, modes)
    cells.slot[i, 2] = slot_at(z, size, 2, cells.last_slot_z, cells, modes)
    if not modes.contacts:
        return FREE
    full = False
    row = cells.row
    first_x, span_x = overlapped(np.int64(cells.slot[i, 0]), size, 0, cells, modes)
    first_y, span_y = overlapped(np.int64(cells.slot[i, 1]), size, 1, cells, modes)
    first_z, span_z = overlapped(np.int64(cells.slot[i, 2]), size, 2, cells, modes)
    for a in range(first_x, first_x + span_x):
        for b in range(first_y, first_y + span_y):
            for c in range(first_z, first_z + span_z):
                cell = ((a % cells.number_x) * cells.number_y + b % cells.number_y) * cells.number_z
                start = (cell + c % cells.number_z) * cells.stride
                members = np.int64(row[start])
                full |= members + 1 >= cells.stride
                for q in range(members):
                    j = np.int64(row[start + 1 + q])
                    _, other_radius = size_and_radius(j, molecules, kinds, modes)
                    if _is_near(j, t, x, y, z, radius + other_radius, molecules, box, modes):
                        return TAKEN
    return NO_ROOM if full else FREE


@kernel
def has_room(i, j, t, x, y, z, radius, molecules, events, kinds, cells, box, modes):
    """Tell whether nobody but molecule i is nearer to drop j, in its cells, than if that had another radius."""
    row = cells.row
    size = np.int64(kinds.table[molecules[j].kind].size_class)
    first_x, span_x = overlapped(np.int64(events[j].slot_x), size, 0, cells, modes)
    first_y, span_y = overlapped(np.int64(events[j].slot_y), size, 1, cells, modes)
    first_z, span_z = overlapped(np.int64(events[j].slot_z), size, 2, cells, modes)
    for a in range(first_x, first_x + span_x):
        for b in range(first_y, first_y + span_y):
            for c in range(first_z, first_z + span_z):
                cell = ((a % cells.number_x) * cells.number_y + b % cells.number_y) * cells.number_z
                start = (cell + c % cells.number_z) * cells.stride
                for q in range(np.int64(row[start])):
                    other = np.int64(row[start + 1 + q])
                    if other in (i, j):
                        continue
                    reach = radius + kinds.table[molecules[other].kind].radius
                    if _is_near(other, t, x, y, z, reach, molecules, box, modes):
                        return False
    return True


@kernel
def enlist(what, i, size, slots, cells, modes):
    """Strike molecule i from all cells of three slots, or write it there; tell whether one of them is full."""
    first_x, span_x = overlapped(np.int64(slots[0]), size, 0, cells, modes)
    first_y, span_y = overlapped(np.int64(slots[1]), size, 1, cells, modes)
    first_z, span_z = overlapped(np.int64(slots[2]), size, 2, cells, modes)
    full = False
    for a in range(first_x, first_x + span_x):
        for b in range(first_y, first_y + span_y):
            for c in range(first_z, first_z + span_z):
                cell = ((a % cells.number_x) * cells.number_y + b % cells.number_y) * cells.number_z
                start = (cell + c % cells.number_z) * cells.stride
                if what == STRIKE:
                    remove(cells.row, start, i)
                elif what == WRITE:
                    append(cells.row, start, i)
                full |= np.int64(cells.row[start]) + 1 >= cells.stride
    return full


@kernel
def move_to(i, x, y, z, molecules, events, kinds, cells, box, modes):
    """Bring molecule i to the cells of another place; return that place, in a periodic box, and whether it has room."""
    size, _ = size_and_radius(i, molecules, kinds, modes)
    if box.inverse_x != 0.0:
        x -= math.floor((x - cells.boundary[size, 0, 0]) / box.length_x) * box.length_x
    if box.inverse_y != 0.0:
        y -= math.floor((y - cells.boundary[size, 1, 0]) / box.length_y) * box.length_y
    if box.inverse_z != 0.0:
        z -= math.floor((z - cells.boundary[size, 2, 0]) / box.length_z) * box.length_z
    old = np.int64(events[i].slot_x), np.int64(events[i].slot_y), np.int64(events[i].slot_z)
    new = (
        slot_at(x, size, 0, cells.last_slot_x, cells, modes),
        slot_at(y, size, 1, cells.last_slot_y, cells, modes),
        slot_at(z, size, 2, cells.last_slot_z, cells, modes),
    )
    if enlist(LOOK, i, size, new, cells, modes):
        return x, y, z, False
    enlist(STRIKE, i, size, old, cells, modes)
    enlist(WRITE, i, size, new, cells, modes)
    cells.slot[i, 0], cells.slot[i, 1], cells.slot[i, 2] = new
    return x, y, z, True


@kernel
def _place(low, high, state):
    """Return a coordinate between two, at random."""
    return low + (high - low) * uniform(state)


@kernel
def look_for_room(i, t, ceiling, molecules, events, kinds, cells, box, tallies, modes):
    """Find a place for molecule i, which is not in the box, at random; return ``FREE`` or why not, and the place.

    With a pool it is on the floor, otherwise anywhere.
    """
    size, radius = size_and_radius(i, molecules, kinds, modes)
    low_x, high_x = radius, box.length_x - radius
    low_y, high_y = radius, box.length_y - radius
    low_z, high_z = radius, ceiling - radius
    if modes.periodic:
        if box.inverse_x != 0.0:
            low_x = cells.boundary[size, 0, 0]
            high_x = low_x + box.length_x
        if box.inverse_y != 0.0:
            low_y = cells.boundary[size, 1, 0]
            high_y = low_y + box.length_y
        if box.inverse_z != 0.0:
            low_z = cells.boundary[size, 2, 0]
            high_z = low_z + ceiling
    x = y = z = 0.0
    found = TAKEN
    for _ in range(1000):
        x = _place(low_x, high_x, tallies.random)
        y = _place(low_y, high_y, tallies.random)
        z = low_z if modes.pool else _place(low_z, high_z, tallies.random)
        found = room_at(i, t, x, y, z, molecules, events, kinds, cells, box, modes)
        if found != TAKEN:
            break
    return found, x, y, z
