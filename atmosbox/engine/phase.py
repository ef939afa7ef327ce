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

__all__ = ["FREE", "NO_ROOM", "TAKEN", "enter", "look_for_room", "room_at", "take_out", "withdraw"]

FREE, TAKEN, NO_ROOM = 0, 1, 2


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
