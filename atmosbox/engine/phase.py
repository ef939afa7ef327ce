"""A molecule leaves the box or comes into it: it condenses, or it evaporates.

Nothing is rebuilt. A molecule that is not in the box stands in no cell, its event never comes, and its clock
reads infinity; a prediction that names it is stale.
"""

import math

import numpy as np

from atmosbox.engine._jit import kernel
from atmosbox.engine.calendar import schedule
from atmosbox.engine.cells import append, overlapped, remove, slot_at
from atmosbox.engine.plan import plan, size_and_radius
from atmosbox.engine.random import uniform

__all__ = [
    "FREE",
    "NO_ROOM",
    "TAKEN",
    "enter",
    "has_room",
    "look_for_room",
    "move_to",
    "room_at",
    "take_out",
    "withdraw",
]

FREE, TAKEN, NO_ROOM = 0, 1, 2
_LOOK, _STRIKE, _WRITE = range(3)


@kernel
def take_out(i, molecules, events, kinds, cells, calendar, modes):
    """Take a molecule or a drop out of its cells, and of time."""
    if modes.contacts:
        size, _ = size_and_radius(i, molecules, kinds, modes)
        first_x, span_x = overlapped(np.int64(events[i].slot_x), size, 0, cells, modes)
        first_y, span_y = overlapped(np.int64(events[i].slot_y), size, 1, cells, modes)
        first_z, span_z = overlapped(np.int64(events[i].slot_z), size, 2, cells, modes)
        for a in range(first_x, first_x + span_x):
            for b in range(first_y, first_y + span_y):
                for c in range(first_z, first_z + span_z):
                    cell = ((a % cells.number_x) * cells.number_y + b % cells.number_y) * cells.number_z
                    remove(cells.row, (cell + c % cells.number_z) * cells.stride, i)
    molecule = molecules[i]
    molecule.clock = math.inf
    molecule.vx = 0.0
    molecule.vy = 0.0
    molecule.vz = 0.0
    molecule.count += 1
    if modes.rotation:
        kinds.rotational_energy[i] = 0.0
    events[i].contact_time = math.inf
    schedule(calendar, i, math.inf)


@kernel
def withdraw(i, molecules, events, kinds, cells, calendar, ledger, modes):
    """Take molecule i out of the box: it is absent until it evaporates."""
    take_out(i, molecules, events, kinds, cells, calendar, modes)
    ledger.absent[ledger.top[0]] = i
    ledger.top[0] += 1


@kernel
def _place(low, high, state):
    """Return a coordinate between two, at random."""
    return low + (high - low) * uniform(state)


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
                    _, other_radius = size_and_radius(j, molecules, kinds, modes)
                    if rx * rx + ry * ry + rz * rz < (radius + other_radius) ** 2:
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
                    molecule = molecules[other]
                    dt = t - molecule.clock
                    rx = x - molecule.x - dt * molecule.vx
                    ry = y - molecule.y - dt * molecule.vy
                    rz = z - molecule.z - dt * molecule.vz
                    if modes.periodic:
                        rx -= box.length_x * np.rint(rx * box.inverse_x)
                        ry -= box.length_y * np.rint(ry * box.inverse_y)
                        if not modes.piston:
                            rz -= box.length_z * np.rint(rz * box.inverse_z)
                    reach = radius + kinds.table[molecule.kind].radius
                    if rx * rx + ry * ry + rz * rz < reach * reach:
                        return False
    return True


@kernel
def _rows_of(what, i, size, slots, cells, modes):
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
                if what == _STRIKE:
                    remove(cells.row, start, i)
                elif what == _WRITE:
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
    if _rows_of(_LOOK, i, size, new, cells, modes):
        return x, y, z, False
    _rows_of(_STRIKE, i, size, old, cells, modes)
    _rows_of(_WRITE, i, size, new, cells, modes)
    cells.slot[i, 0], cells.slot[i, 1], cells.slot[i, 2] = new
    return x, y, z, True


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


@kernel
def enter(
    i, t, x, y, z, vx, vy, vz, spin, molecules, events, kinds, cells, calendar, box, walls, ledger, modes
):  # fmt: skip
    """Put molecule i, the last that is absent, where `look_for_room` has found a place for it."""
    ledger.top[0] -= 1
    if modes.contacts:
        size, _ = size_and_radius(i, molecules, kinds, modes)
        first_x, span_x = overlapped(np.int64(cells.slot[i, 0]), size, 0, cells, modes)
        first_y, span_y = overlapped(np.int64(cells.slot[i, 1]), size, 1, cells, modes)
        first_z, span_z = overlapped(np.int64(cells.slot[i, 2]), size, 2, cells, modes)
        for a in range(first_x, first_x + span_x):
            for b in range(first_y, first_y + span_y):
                for c in range(first_z, first_z + span_z):
                    cell = ((a % cells.number_x) * cells.number_y + b % cells.number_y) * cells.number_z
                    append(cells.row, (cell + c % cells.number_z) * cells.stride, i)
    molecule = molecules[i]
    molecule.x = x
    molecule.y = y
    molecule.z = z
    molecule.vx = vx
    molecule.vy = vy
    molecule.vz = vz
    molecule.clock = t
    molecule.count += 1
    if modes.rotation:
        kinds.rotational_energy[i] = spin
    plan(i, t, x, y, z, vx, vy, vz, molecules, events, kinds, cells, calendar, box, walls, modes)
