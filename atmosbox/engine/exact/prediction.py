"""What lies ahead of a molecule: its next contact, its next boundary, its next wall."""

import math

import numpy as np

from atmosbox.engine.core.jit import POSITIVE, kernel
from atmosbox.engine.core.motion import time_to_ceiling, time_to_leave, time_to_leave_in_gravity
from atmosbox.engine.exact.calendar import schedule
from atmosbox.engine.exact.cells import overlapped

__all__ = ["CEILING", "CONTACT", "next_move", "plan", "size_and_radius", "soonest_in_cell"]

CONTACT, CEILING = 6, 7
"""What comes first: 0 to 5 is a boundary or wall (twice the axis, plus 1 for the upper side), then these."""


@kernel
def size_and_radius(i, molecules, kinds, modes):
    """Return the size class and the radius [length] of molecule i."""
    if modes.mixed:
        kind = kinds.table[molecules[i].kind]
        return np.int64(kind.size_class), kind.radius
    return np.int64(0), kinds.table[0].radius


@kernel
def soonest_in_cell(cell, i, t, x, y, z, vx, vy, vz, radius, soonest, partner, molecules, kinds, cells, box, modes):
    """Return the earlier of ``soonest`` and the first contact of molecule i with a member of a cell, and with whom.

    It is `time_to_contact` written out: most pairs miss, so the discriminant is tested alone and all else
    stands inside.
    """
    row = cells.row
    start = (cell * cells.stride) & POSITIVE
    diameter_squared = 4.0 * radius * radius
    for q in range(np.int64(row[start])):
        j = np.int64(row[start + 1 + q])
        other = molecules[j]
        dt = t - other.clock
        wx = other.vx
        wy = other.vy
        wz = other.vz
        rx = x - other.x - dt * wx
        ry = y - other.y - dt * wy
        if modes.gravity:
            rz = z - other.z - dt * (wz - 0.5 * box.gravity * dt)
            wz = wz - box.gravity * dt
        else:
            rz = z - other.z - dt * wz
        if modes.periodic:
            rx -= box.length_x * np.rint(rx * box.inverse_x)
            ry -= box.length_y * np.rint(ry * box.inverse_y)
            if not (modes.gravity or modes.piston):
                rz -= box.length_z * np.rint(rz * box.inverse_z)
        if modes.mixed:
            distance = radius + kinds.table[other.kind].radius
            diameter_squared = distance * distance
        ux = vx - wx
        uy = vy - wy
        uz = vz - wz
        b = rx * ux + ry * uy + rz * uz
        speed_squared = ux * ux + uy * uy + uz * uz
        c = rx * rx + ry * ry + rz * rz - diameter_squared
        closing = min(b, 0.0)
        discriminant = closing * closing - speed_squared * c
        if discriminant > 0.0:
            s = max(c / (math.sqrt(discriminant) - b), 0.0)
            if s < soonest and b < 0.0 and i != j:
                soonest = s
                partner = j
    return soonest, partner


@kernel
def _limits(slot, axis, size, radius, length, inverse, cells, modes):
    """Return the interval in which the centre stays before it changes slot or hits a wall."""
    low = cells.boundary[size, axis, slot]
    high = cells.boundary[size, axis, slot + 1]
    if modes.spanning and inverse == 0.0:
        low = max(low, radius)
        high = min(high, length - radius)
    return low, high


@kernel
def next_move(slot_x, slot_y, slot_z, t, x, y, z, vx, vy, vz, size, radius, cells, box, walls, modes):
    """Return when a molecule next crosses a boundary or hits a wall [time from now], and which."""
    low, high = _limits(slot_x, 0, size, radius, box.length_x, box.inverse_x, cells, modes)
    time, up = time_to_leave(x, vx, low, high)
    what = up
    low, high = _limits(slot_y, 1, size, radius, box.length_y, box.inverse_y, cells, modes)
    time_y, up = time_to_leave(y, vy, low, high)
    if time_y < time:
        what = 2 + up
    time = min(time, time_y)
    low, high = _limits(slot_z, 2, size, radius, box.length_z, box.inverse_z, cells, modes)
    if modes.gravity:
        time_z, up = time_to_leave_in_gravity(z, vz, low, high, box.gravity)
    else:
        time_z, up = time_to_leave(z, vz, low, high)
    if time_z < time:
        what = 4 + up
    time = min(time, time_z)
    if modes.piston:
        speed = walls.piston[1]
        ceiling = walls.piston[0] + speed * (t - walls.piston[2])
        time_c = time_to_ceiling(ceiling - radius - z, vz - speed, box.gravity)
        if time_c < time:
            what = CEILING
        time = min(time, time_c)
    return time, what


@kernel
def plan(i, t, x, y, z, vx, vy, vz, molecules, events, kinds, cells, calendar, box, walls, modes):
    """Plan everything anew for a molecule that is at (x, y, z) at time t."""
    slot_x = np.int64(events[i].slot_x)
    slot_y = np.int64(events[i].slot_y)
    slot_z = np.int64(events[i].slot_z)
    size, radius = size_and_radius(i, molecules, kinds, modes)
    soonest = math.inf
    partner = -1
    if modes.contacts:
        first_x, span_x = overlapped(slot_x, size, 0, cells, modes)
        first_y, span_y = overlapped(slot_y, size, 1, cells, modes)
        first_z, span_z = overlapped(slot_z, size, 2, cells, modes)
        for cx in range(first_x, first_x + span_x):
            if modes.periodic and cx >= cells.number_x:
                cx -= cells.number_x
            for cy in range(first_y, first_y + span_y):
                if modes.periodic and cy >= cells.number_y:
                    cy -= cells.number_y
                for cz in range(first_z, first_z + span_z):
                    if modes.periodic and cz >= cells.number_z:
                        cz -= cells.number_z
                    cell = (cx * cells.number_y + cy) * cells.number_z + cz
                    soonest, partner = soonest_in_cell(
                        cell, i, t, x, y, z, vx, vy, vz, radius, soonest, partner,
                        molecules, kinds, cells, box, modes,
                    )  # fmt: skip
    time, what = next_move(slot_x, slot_y, slot_z, t, x, y, z, vx, vy, vz, size, radius, cells, box, walls, modes)
    event = events[i]
    event.contact_time = t + soonest
    if partner >= 0:
        event.partner = partner
        event.partner_count = molecules[partner].count
    if soonest < time:
        what = CONTACT
    event.what = what
    schedule(calendar, i, t + min(time, soonest))
