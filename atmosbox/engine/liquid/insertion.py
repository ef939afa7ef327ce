"""A molecule leaves the box or enters it: it condenses, or it evaporates into a place without overlap.

The data of a molecule stay in memory. A molecule that is not in the box is in no cell, has no event, and its clock
reads infinity; predictions of contacts with it are stale.
"""

import math
from enum import IntEnum

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.pair import nearest_image, reach
from atmosbox.engine.core.random import uniform
from atmosbox.engine.exact.calendar import schedule
from atmosbox.engine.exact.cells import overlapped, side, slots_at, turns_past
from atmosbox.engine.exact.encounter import size_and_radius, slots_of, write
from atmosbox.engine.exact.membership import Change, change, listed, places, row_of
from atmosbox.engine.exact.prediction import call


class Place(IntEnum):
    """Whether a molecule can be put at a place.

    ``FREE``: it can; ``TAKEN``: it would overlap another; ``ROW_FULL``: the row of a cell must grow first.
    """

    FREE = 0
    TAKEN = 1
    ROW_FULL = 2


@kernel
def _is_free(ignored, t, at, radius, size, slots, gas, modes):
    """Return whether a sphere of this radius at x, y, z, in the cells of three slots, overlaps none but two ignored."""
    cells = gas.cells
    x, y, z = at
    first_x, span_x = overlapped(slots[0], size, 0, cells, modes)
    first_y, span_y = overlapped(slots[1], size, 1, cells, modes)
    first_z, span_z = overlapped(slots[2], size, 2, cells, modes)
    for a in range(first_x, first_x + span_x):
        for b in range(first_y, first_y + span_y):
            for c in range(first_z, first_z + span_z):
                start = row_of(a, b, c, cells)
                for place in range(places(start, cells, modes)):
                    j = listed(start, place, cells, modes)
                    if j < 0 or j in ignored:
                        continue
                    other = gas.molecules[j]
                    dt = t - other.clock
                    distance = reach(radius, size_and_radius(j, gas, modes)[1])
                    rx, ry, rz = x - other.x - dt * other.vx, y - other.y - dt * other.vy, z - other.z - dt * other.vz
                    rx, ry, rz = nearest_image(rx, ry, rz, gas.box, modes)
                    if rx * rx + ry * ry + rz * rz < distance * distance:
                        return False
    return True


@kernel
def place_at(i, t, x, y, z, gas, modes):
    """Return a `Place`: whether molecule i can be put at x, y, z; store its slots there."""
    cells = gas.cells
    size, radius = size_and_radius(i, gas, modes)
    slots = slots_at(x, y, z, size, cells, modes)
    cells.slot[i, 0], cells.slot[i, 1], cells.slot[i, 2] = slots
    if not modes.contacts:
        return Place.FREE
    if not _is_free((i, i), t, (x, y, z), radius, size, slots, gas, modes):
        return Place.TAKEN
    return Place.ROW_FULL if change(Change.TEST, i, size, slots, cells, modes) else Place.FREE


@kernel
def has_room(i, j, t, at, radius, gas, modes):
    """Return whether drop j, whose `Motion` is ``at``, would overlap no molecule but i with another radius."""
    size, _ = size_and_radius(j, gas, modes)
    return _is_free((i, j), t, (at.x, at.y, at.z), radius, size, slots_of(j, gas), gas, modes)


@kernel
def move_to(i, x, y, z, gas, modes):
    """Move molecule i to the cells of another place; return that place in the periodic box; and if rows had room."""
    cells = gas.cells
    size, _ = size_and_radius(i, gas, modes)
    x -= turns_past(x, 0, size, gas)
    y -= turns_past(y, 1, size, gas)
    z -= turns_past(z, 2, size, gas)
    new = slots_at(x, y, z, size, cells, modes)
    if change(Change.TEST, i, size, new, cells, modes):
        return x, y, z, False
    change(Change.REMOVE, i, size, slots_of(i, gas), cells, modes)
    change(Change.ADD, i, size, new, cells, modes)
    cells.slot[i, 0], cells.slot[i, 1], cells.slot[i, 2] = new
    return x, y, z, True


@kernel
def _anywhere(axis, length, size, radius, gas, modes):
    """Draw a coordinate: between two walls as far as the radius allows, or anywhere along a periodic axis."""
    low, high = radius, length - radius
    if modes.periodic and side(axis, gas.box)[1] != 0.0:
        low = gas.cells.boundary[size, axis, 0]
        high = low + length
    return low + (high - low) * uniform(gas.tallies.random)


@kernel
def find_place(i, t, ceiling, gas, modes):
    """Draw a place for molecule i, which is not in the box; return a `Place`, and its x, y and z [length].

    With a pool the place is on the floor, otherwise anywhere.
    """
    size, radius = size_and_radius(i, gas, modes)
    x = y = z = 0.0
    found = Place.TAKEN
    for _ in range(1000):
        x = _anywhere(0, gas.box.length_x, size, radius, gas, modes)
        y = _anywhere(1, gas.box.length_y, size, radius, gas, modes)
        z = radius if modes.pool else _anywhere(2, ceiling, size, radius, gas, modes)
        found = place_at(i, t, x, y, z, gas, modes)
        if found != Place.TAKEN:
            break
    return found, x, y, z


@kernel
def take_out(i, gas, modes):
    """Remove a molecule or a drop from its cells and from the calendar."""
    event = gas.events[i]
    if modes.contacts:
        size, _ = size_and_radius(i, gas, modes)
        change(Change.REMOVE, i, size, slots_of(i, gas), gas.cells, modes)
    molecule = gas.molecules[i]
    molecule.clock = math.inf
    molecule.vx, molecule.vy, molecule.vz = 0.0, 0.0, 0.0
    molecule.count += 1
    if modes.rotation:
        gas.kinds.rotational_energy[i] = 0.0
    event.contact_time = math.inf
    schedule(gas.calendar, i, math.inf)


@kernel
def withdraw(i, gas, reservoir, modes):
    """Remove molecule i from the box: it is absent until it evaporates."""
    take_out(i, gas, modes)
    reservoir.absent[reservoir.top[0]] = i
    reservoir.top[0] += 1


@kernel
def enter(i, t, at, spin, gas, reservoir, modes):
    """Put molecule i, the last absent one, into the box at time t, where `find_place` has found a place for it."""
    reservoir.top[0] -= 1
    if modes.contacts:
        size, _ = size_and_radius(i, gas, modes)
        change(Change.ADD, i, size, slots_of(i, gas), gas.cells, modes)
    write(i, t, at, gas)
    if modes.rotation:
        gas.kinds.rotational_energy[i] = spin
    call(i, t, gas)
