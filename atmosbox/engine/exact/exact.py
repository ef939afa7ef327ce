"""The exact engine: from event to event, with nothing in between.

Every molecule holds one event: its next contact, its next crossing of a cell boundary, or its next wall,
whichever comes first. The calendar tells which of all is next; that one is resolved, and the molecules it
changed plan anew. A contact whose partner has meanwhile met someone else is stale: its molecule plans
anew when it comes due. Nothing is approximated; the order of events is that of the real numbers, to
rounding.

A scene pays only for what it requires: `specialise` makes the kernels for one set of `Modes`, in which
the code of everything else does not exist.
"""

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from atmosbox.engine.core.jit import kernel, prefetch
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.calendar import next_event, schedule
from atmosbox.engine.exact.cells import append, overlapped, slot_at
from atmosbox.engine.exact.crossing import ENTERED, FULL, LEFT, WALL, cross
from atmosbox.engine.exact.encounter import hit, meet, position_at
from atmosbox.engine.exact.prediction import CEILING, CONTACT, next_move, plan, size_and_radius

__all__ = ["BUSY", "CROWDED", "DONE", "LOOK", "MET", "ROW_FULL", "STALLED", "piled_up", "proceed", "specialise"]

DONE, BUSY, ROW_FULL, STALLED, MET, CROWDED = range(6)
"""Status: up to the time asked for; not yet; a row must grow; a pile-up; the next event is a molecule that meets
liquid; one that evaporates finds no place."""

_MANY = 4_000
LOOK = 1024
"""After how many events it is asked whether they pile up."""
FLOOR = 4


@kernel
def _warm_up(calendar, cells, molecules, events, modes):
    """Fetch what the runners-up of the tournament will need: at many molecules memory is what takes the time."""
    for node in range(2, 8):
        i = np.int64(calendar.winner[node])
        prefetch(molecules, i)
        prefetch(events, i)
        prefetch(calendar.time, calendar.leaf + i)
        if node < 4 and not modes.spanning:
            event = events[i]
            what = np.int64(event.what)
            sx = np.int64(event.slot_x)
            sy = np.int64(event.slot_y)
            sz = np.int64(event.slot_z)
            cell = ((sx >> 1) * cells.number_y + (sy >> 1)) * cells.number_z + (sz >> 1)
            if what == CONTACT:
                j = np.int64(event.partner)
                prefetch(molecules, j)
                prefetch(events, j)
                prefetch(calendar.time, calendar.leaf + j)
            else:
                up = what & 1
                if what < 2:
                    step = cells.number_y * cells.number_z
                    slot = sx
                elif what < 4:
                    step = cells.number_z
                    slot = sy
                else:
                    step = 1
                    slot = sz
                cell += step * ((2 * up - 1) if (slot & 1) == 0 else (1 - up))
            prefetch(cells.row, cell * cells.stride)


@kernel
def piled_up(t, events, molecules, box, tallies):
    """Note so many events up to time t; tell whether there are too many in next to no time."""
    progress = tallies.progress
    if t - progress[0] > box.stall:
        progress[0] = t
        progress[1] = 0.0
    progress[1] += events
    return progress[1] > 100_000 + 64 * molecules


@kernel
def proceed(molecules, events, kinds, cells, calendar, box, walls, tallies, until, most, modes):
    """Resolve events up to time ``until``, at most ``most`` of them; return a status and how many.

    The status ``MET`` says that the next event is a molecule that falls into a pool, or hits a drop: it is left to the
    caller.
    """
    done = 0
    status = BUSY
    many = molecules.size >= _MANY
    contacts = entered = left = stale = wall_hits = 0
    while done < most:
        i, t = next_event(calendar)
        if not t <= until:
            status = DONE
            break
        if done & (LOOK - 1) == LOOK - 1 and piled_up(t, LOOK, molecules.size, box, tallies):
            status = STALLED
            break
        if many:
            _warm_up(calendar, cells, molecules, events, modes)
        event = events[i]
        what = np.int64(event.what)
        x, y, z, vx, vy, vz = position_at(molecules[i], t, box, modes)
        if what < CONTACT:
            crossed = cross(
                i, what, t, x, y, z, vx, vy, vz, molecules, events, kinds, cells, calendar, box, walls, modes
            )
            if crossed == FULL:
                status = ROW_FULL
                break
            if crossed != WALL:
                entered += 1 if crossed == ENTERED else 0
                left += 1 if crossed == LEFT else 0
                done += 1
                continue
            if modes.pool and what == FLOOR:
                status = MET
                break
        j = -1
        px, py, pz, wx, wy, wz = x, y, z, vx, vy, vz
        if what == CONTACT:
            j = np.int64(event.partner)
            if molecules[j].count == event.partner_count:
                if modes.drops > 0 and max(np.int64(molecules[i].kind), np.int64(molecules[j].kind)) >= modes.drops:
                    status = MET
                    break
                vx, vy, vz, px, py, pz, wx, wy, wz = meet(
                    i, j, t, x, y, z, vx, vy, vz, molecules, kinds, box, tallies, modes
                )
                contacts += 1
            else:
                stale += 1
                j = -1
        else:
            wall = 5 if what == CEILING else what
            x, y, z, vx, vy, vz = hit(i, wall, t, x, y, z, vx, vy, vz, molecules, kinds, box, walls, tallies, modes)
            wall_hits += 1
        done += 1
        m = i
        while True:
            plan(m, t, x, y, z, vx, vy, vz, molecules, events, kinds, cells, calendar, box, walls, modes)
            if j < 0:
                break
            m = j
            j = -1
            x, y, z, vx, vy, vz = px, py, pz, wx, wy, wz
    tallies.count[0] += contacts
    tallies.count[1] += entered
    tallies.count[2] += left
    tallies.count[3] += stale
    tallies.count[4] += wall_hits
    return status, done


@functools.cache
def specialise(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels of one set of modes: ``place``, ``advance``, ``replan_ceiling`` and ``overlap``.

    They are closures over plain flags, compiled once per set and kept on disk.
    """

    @kernel(entry=True)
    def place(molecules, events, kinds, cells, calendar, box, walls, now):
        """Enter all molecules into their cells at time ``now`` and plan their events, unless a row is full."""
        cells.row[:] = 0
        row = cells.row
        for i in range(molecules.size):
            if modes.phases and math.isinf(molecules[i].clock):
                continue
            x, y, z, vx, vy, vz = position_at(molecules[i], now, box, modes)
            size, _ = size_and_radius(i, molecules, kinds, modes)
            for axis in range(3):
                if axis == 0:
                    u, length, last = x, box.length_x, cells.last_slot_x
                elif axis == 1:
                    u, length, last = y, box.length_y, cells.last_slot_y
                else:
                    u, length, last = z, box.length_z, cells.last_slot_z
                inverse = box.inverse_x if axis == 0 else (box.inverse_y if axis == 1 else box.inverse_z)
                if inverse != 0.0:
                    lowest = cells.boundary[size, axis, 0]
                    turns = math.floor((u - lowest) / length)
                    if turns != 0.0:
                        u -= turns * length
                        if axis == 0:
                            molecules[i].x -= turns * length
                        elif axis == 1:
                            molecules[i].y -= turns * length
                        else:
                            molecules[i].z -= turns * length
                cells.slot[i, axis] = slot_at(u, size, axis, last, cells, modes)
            first_x, span_x = overlapped(np.int64(cells.slot[i, 0]), size, 0, cells, modes)
            first_y, span_y = overlapped(np.int64(cells.slot[i, 1]), size, 1, cells, modes)
            first_z, span_z = overlapped(np.int64(cells.slot[i, 2]), size, 2, cells, modes)
            for a in range(first_x, first_x + (span_x if modes.contacts else 0)):
                for b in range(first_y, first_y + span_y):
                    for c in range(first_z, first_z + span_z):
                        cell = ((a % cells.number_x) * cells.number_y + b % cells.number_y) * cells.number_z
                        start = (cell + c % cells.number_z) * cells.stride
                        if np.int64(row[start]) + 1 >= cells.stride:
                            return ROW_FULL
                        append(row, start, i)
        for i in range(molecules.size):
            if modes.phases and math.isinf(molecules[i].clock):
                continue
            x, y, z, vx, vy, vz = position_at(molecules[i], now, box, modes)
            plan(i, now, x, y, z, vx, vy, vz, molecules, events, kinds, cells, calendar, box, walls, modes)
        return DONE

    @kernel(entry=True)
    def replan_ceiling(molecules, events, kinds, cells, calendar, box, walls, now, lowest):
        """Plan anew, at time ``now``, the moves of all that may meet the ceiling, or that were to meet it.

        Below ``lowest``, the lowest place of the ceiling before it is asked again, a molecule leaves its slot first.
        """
        for i in range(molecules.size):
            if modes.phases and math.isinf(molecules[i].clock):
                continue
            event = events[i]
            slot_z = np.int64(event.slot_z)
            size, radius = size_and_radius(i, molecules, kinds, modes)
            if cells.boundary[size, 2, slot_z + 1] < lowest - radius and np.int64(event.what) != CEILING:
                continue
            x, y, z, vx, vy, vz = position_at(molecules[i], now, box, modes)
            time, what = next_move(
                np.int64(event.slot_x),
                np.int64(event.slot_y),
                slot_z,
                now, x, y, z, vx, vy, vz, size, radius, cells, box, walls, modes,
            )  # fmt: skip
            time += now
            if event.contact_time < time:
                what = CONTACT
            event.what = what
            schedule(calendar, i, min(time, event.contact_time))

    @kernel(entry=True)
    def advance(molecules, events, kinds, cells, calendar, box, walls, tallies, until, most):
        """Resolve events up to time ``until``, at most ``most`` of them; return a status and how many."""
        return proceed(molecules, events, kinds, cells, calendar, box, walls, tallies, until, most, modes)

    @kernel(entry=True)
    def overlap(molecules, kinds, cells, box):
        """Return the deepest overlap, in diameters, and the two molecules; all clocks must read the same."""
        deepest = -1.0
        first = -1
        second = -1
        for cell in range(cells.number_x * cells.number_y * cells.number_z):
            start = cell * cells.stride
            end = start + 1 + np.int64(cells.row[start])
            for p in range(start + 1, end):
                i = np.int64(cells.row[p])
                _, radius = size_and_radius(i, molecules, kinds, modes)
                for q in range(p + 1, end):
                    j = np.int64(cells.row[q])
                    _, other_radius = size_and_radius(j, molecules, kinds, modes)
                    rx = molecules[i].x - molecules[j].x
                    ry = molecules[i].y - molecules[j].y
                    rz = molecules[i].z - molecules[j].z
                    if modes.periodic:
                        rx -= box.length_x * np.rint(rx * box.inverse_x)
                        ry -= box.length_y * np.rint(ry * box.inverse_y)
                        if not (modes.gravity or modes.piston):
                            rz -= box.length_z * np.rint(rz * box.inverse_z)
                    distance = radius + other_radius
                    depth = 1.0 - math.sqrt(rx * rx + ry * ry + rz * rz) / distance if distance > 0.0 else -1.0
                    if depth > deepest:
                        deepest = depth
                        first = min(i, j)
                        second = max(i, j)
        return deepest, first, second

    return place, advance, replan_ceiling, overlap
