"""The next events of a molecule: its next contact, its next boundary of a cell, its next hit on a wall.

All three are predicted after each encounter of the molecule, and the soonest becomes its event in the calendar
(`plan`). Partners for a contact are searched only in its own cells: by `search` where rows hold copies of trajectories,
by `soonest_in_cell` where they are lists of molecules.
"""

import math
from collections import namedtuple

import numpy as np

from atmosbox.engine.core.jit import POSITIVE, kernel
from atmosbox.engine.core.motion import time_to_ceiling, time_to_leave, time_to_leave_in_gravity
from atmosbox.engine.core.pair import approach, nearest_image, predict, reach, soonest_image
from atmosbox.engine.exact.calendar import schedule
from atmosbox.engine.exact.cells import overlapped, side
from atmosbox.engine.exact.encounter import size_and_radius, slots_of
from atmosbox.engine.exact.search import CONTACT, search

CEILING = 7
"""An event with a moving ceiling. 0 to 5 is a boundary or a wall (2 * axis, plus 1 for the upper side), 6 a contact."""


class Meeting(namedtuple("Meeting", "after partner")):
    """The soonest contact found so far: the time until then [time], and the partner, -1 for none."""


@kernel
def soonest_in_cell(cell, i, t, at, radius, known, gas, modes):
    """Return the earlier of the `Meeting` ``known`` and the first contact of molecule i with a member of a cell.

    The positions of the members at time t are computed from their own clocks; nothing is written.
    """
    # the row of a cell: how many members it has, then their numbers, then free places
    #
    #   row[start]  row[start + 1]  row[start + 2]  row[start + 3]  ...
    #       2             17              5              free
    row = gas.cells.row
    start = (cell * gas.cells.stride) & POSITIVE
    soonest = known.after
    partner = known.partner
    for q in range(np.int64(row[start])):
        j = np.int64(row[start + 1 + q])
        # where the other molecule is at time t: it has flown freely since its own clock
        other = gas.molecules[j]
        dt = t - other.clock
        wx, wy, wz = other.vx, other.vy, other.vz
        rx = at.x - other.x - dt * wx
        ry = at.y - other.y - dt * wy
        if modes.gravity:
            rz = at.z - other.z - dt * (wz - 0.5 * gas.box.gravity * dt)
            wz = wz - gas.box.gravity * dt
        else:
            rz = at.z - other.z - dt * wz
        rx, ry, rz = nearest_image(rx, ry, rz, gas.box, modes)
        distance = reach(radius, gas.kinds.table[other.kind].radius if modes.mixed else radius)
        ux, uy, uz = at.vx - wx, at.vy - wy, at.vz - wz
        if modes.images:
            after = soonest_image(rx, ry, rz, ux, uy, uz, distance, gas.box)
            if after < soonest and i != j:
                soonest = after
                partner = j
            continue
        discriminant, b, c = approach(rx, ry, rz, ux, uy, uz, distance)
        # most pairs miss and end here; a pair that overlaps by rounding and moves apart has b >= 0
        if discriminant > 0.0:
            after = predict(discriminant, b, c)
            if after < soonest and b < 0.0 and i != j:
                soonest = after
                partner = j
    return Meeting(soonest, partner)


@kernel
def limits(slot, axis, size, radius, gas, modes):
    """Return the interval along an axis in which the centre stays until it reaches a new cell (or slot) or a wall."""
    boundary = gas.cells.boundary
    if modes.rows:
        # leaving a cell is not an event here: from slot 2c + 1 it may fly through slots 2c and 2c + 2 too
        low = boundary[size, axis, slot & ~1]
        high = boundary[size, axis, (slot | 1) + 2 * (slot & 1)]
    else:
        low = boundary[size, axis, slot]
        high = boundary[size, axis, slot + 1]
    # here the boundaries contain no walls, because molecules of one size class differ in radius
    if modes.spanning or (modes.rows and modes.mixed):
        length, inverse = side(axis, gas.box)
        if inverse == 0.0:
            low = max(low, radius)
            high = min(high, length - radius)
    return low, high


@kernel
def next_move(slots, t, at, size, radius, gas, modes):
    """Return the time until a molecule crosses a boundary or hits a wall [time from now], and the number of that one.

    ``slots`` are its slots along x, y and z, ``size`` its size class.
    """
    # the soonest of three axes: a boundary of a cell, or a wall
    low, high = limits(slots[0], 0, size, radius, gas, modes)
    time, up = time_to_leave(at.x, at.vx, low, high)
    what = up
    low, high = limits(slots[1], 1, size, radius, gas, modes)
    time_y, up = time_to_leave(at.y, at.vy, low, high)
    if time_y < time:
        what = 2 + up
    time = min(time, time_y)
    low, high = limits(slots[2], 2, size, radius, gas, modes)
    if modes.gravity:
        time_z, up = time_to_leave_in_gravity(at.z, at.vz, low, high, gas.box.gravity)
    else:
        time_z, up = time_to_leave(at.z, at.vz, low, high)
    if time_z < time:
        what = 4 + up
    time = min(time, time_z)
    if modes.piston:
        # the ceiling moves: it has its own position and time
        piston = gas.walls.piston
        speed = piston[1]
        ceiling = piston[0] + speed * (t - piston[2])
        time_c = time_to_ceiling(ceiling - radius - at.z, at.vz - speed, gas.box.gravity)
        if time_c < time:
            what = CEILING
        time = min(time, time_c)
    return time, what


@kernel
def plan_move(i, slots, t, at, size, radius, gas, modes):
    """Predict again when molecule i comes to a boundary or a wall; its next contact stays as it was predicted."""
    event = gas.events[i]
    time, what = next_move(slots, t, at, size, radius, gas, modes)
    time += t
    if event.contact_time < time:
        what = CONTACT
    event.what = what
    schedule(gas.calendar, i, min(time, event.contact_time))


@kernel
def plan(i, t, at, boundary, gas, modes):
    """Predict the next events of molecule i, whose `Motion` at time t is ``at``, and enter the first in the calendar.

    Where rows hold copies, the molecule may be at the ``boundary`` of a cell: see `search`. Returns whether a row is
    full.
    """
    event = gas.events[i]
    size, radius = size_and_radius(i, gas, modes)
    full = False
    if modes.rows:
        found = search(i, t, at, boundary, gas, modes)
        at, slots, full = found.at, found.slots, found.full
        after, partner = found.after, found.partner
        if partner < 0 and boundary >= CONTACT:
            partner = i  # no contact within the horizon: when that time comes, its events are predicted again
    else:
        slots = slots_of(i, gas)
        after, partner = _soonest_in_lists(i, t, at, slots, gas, modes)
    time, what = next_move(slots, t, at, size, radius, gas, modes)
    event.contact_time = t + after
    if partner >= 0:
        event.partner = partner
        # if the partner has another encounter before, its count differs, and the prediction is stale
        event.partner_count = gas.molecules[partner].count
    if after < time:
        what = CONTACT
    event.what = what
    schedule(gas.calendar, i, t + min(time, after))
    return full


@kernel
def call(i, t, gas):
    """Request that the events of molecule i be predicted at time t, before anything else happens.

    The request is a contact of the molecule with itself. So only the loop over events contains the search for contacts,
    which takes long to compile.
    """
    event = gas.events[i]
    event.contact_time = t
    event.partner = i
    event.what = CONTACT
    schedule(gas.calendar, i, t)


@kernel
def _soonest_in_lists(i, t, at, slots, gas, modes):
    """Return the time until the soonest contact with a member of the cells of three slots, and the partner."""
    cells = gas.cells
    size, radius = size_and_radius(i, gas, modes)
    meeting = Meeting(math.inf, -1)
    if modes.contacts:
        # the members of every cell that the sphere overlaps, one to eight of them
        first_x, span_x = overlapped(slots[0], size, 0, cells, modes)
        first_y, span_y = overlapped(slots[1], size, 1, cells, modes)
        first_z, span_z = overlapped(slots[2], size, 2, cells, modes)
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
                    meeting = soonest_in_cell(cell, i, t, at, radius, meeting, gas, modes)
    return meeting.after, meeting.partner
