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
from typing import Any, NamedTuple

import numpy as np

from atmosbox.engine._jit import POSITIVE, kernel, prefetch
from atmosbox.engine.calendar import next_event, schedule
from atmosbox.engine.cells import append, overlapped, remove
from atmosbox.engine.contact import resolve_contact, share_energy
from atmosbox.engine.motion import time_to_ceiling, time_to_leave, time_to_leave_in_gravity
from atmosbox.engine.random import uniform
from atmosbox.engine.walls import resolve_wall_hit

__all__ = ["BUSY", "DONE", "ROW_FULL", "STALLED", "Modes", "specialise"]

DONE, BUSY, ROW_FULL, STALLED = 0, 1, 2, 3
_CONTACT, _CEILING = 6, 7
_MANY = 4_000


class Modes(NamedTuple):
    """What a scene requires.

    Contacts at all (points never meet), gravity, rotation, several kinds of molecule, spheres larger than
    cells, periodic axes, a piston.
    """

    contacts: bool
    gravity: bool
    rotation: bool
    mixed: bool
    spanning: bool
    periodic: bool
    piston: bool


@kernel
def _soonest_in_cell(cell, i, t, x, y, z, vx, vy, vz, radius, soonest, partner, molecules, kinds, cells, box, modes):
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
def _size_and_radius(i, molecules, kinds, modes):
    if modes.mixed:
        kind = kinds.table[molecules[i].kind]
        return np.int64(kind.size), kind.radius
    return np.int64(0), kinds.table[0].radius


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
def _next_move(slot_x, slot_y, slot_z, t, x, y, z, vx, vy, vz, size, radius, cells, box, walls, modes):
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
            what = _CEILING
        time = min(time, time_c)
    return time, what


@kernel
def _plan(i, t, x, y, z, vx, vy, vz, molecules, events, kinds, cells, calendar, box, walls, modes):
    """Plan everything anew for a molecule that is at (x, y, z) at time t."""
    slot_x = np.int64(events[i].slot_x)
    slot_y = np.int64(events[i].slot_y)
    slot_z = np.int64(events[i].slot_z)
    size, radius = _size_and_radius(i, molecules, kinds, modes)
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
                    soonest, partner = _soonest_in_cell(
                        cell, i, t, x, y, z, vx, vy, vz, radius, soonest, partner,
                        molecules, kinds, cells, box, modes,
                    )  # fmt: skip
    time, what = _next_move(slot_x, slot_y, slot_z, t, x, y, z, vx, vy, vz, size, radius, cells, box, walls, modes)
    event = events[i]
    event.contact_time = t + soonest
    if partner >= 0:
        event.partner = partner
        event.partner_count = molecules[partner].count
    if soonest < time:
        what = _CONTACT
    event.what = what
    schedule(calendar, i, t + min(time, soonest))


@kernel
def _position(molecule, t, box, modes):
    """Return position and velocity of a molecule at time t."""
    dt = t - molecule.clock
    vz = molecule.vz
    x = molecule.x + dt * molecule.vx
    y = molecule.y + dt * molecule.vy
    if modes.gravity:
        z = molecule.z + dt * (vz - 0.5 * box.gravity * dt)
        vz = vz - box.gravity * dt
    else:
        z = molecule.z + dt * vz
    return x, y, z, molecule.vx, molecule.vy, vz


@kernel
def _write(molecule, x, y, z, vx, vy, vz, t):
    molecule.x = x
    molecule.y = y
    molecule.z = z
    molecule.vx = vx
    molecule.vy = vy
    molecule.vz = vz
    molecule.clock = t
    molecule.count += 1


@kernel
def _meet(i, j, t, x, y, z, vx, vy, vz, molecules, kinds, box, tallies, modes):
    """Resolve a contact; return the new states of both."""
    px, py, pz, wx, wy, wz = _position(molecules[j], t, box, modes)
    rx = x - px
    ry = y - py
    rz = z - pz
    if modes.periodic:
        rx -= box.length_x * np.rint(rx * box.inverse_x)
        ry -= box.length_y * np.rint(ry * box.inverse_y)
        if not (modes.gravity or modes.piston):
            rz -= box.length_z * np.rint(rz * box.inverse_z)
    ux = vx - wx
    uy = vy - wy
    uz = vz - wz
    mass = kinds.table[0].mass
    other_mass = mass
    rotation = kinds.table[0].rotation
    other_rotation = rotation
    if modes.mixed:
        kind = kinds.table[molecules[i].kind]
        other_kind = kinds.table[molecules[j].kind]
        mass = kind.mass
        other_mass = other_kind.mass
        rotation = kind.rotation
        other_rotation = other_kind.rotation
    dx, dy, dz = resolve_contact(rx, ry, rz, ux, uy, uz, mass, other_mass)
    if modes.rotation and (box.exchange >= 1.0 or uniform(tallies.random) < box.exchange):
        reduced_mass = mass * other_mass / (mass + other_mass)
        spin = kinds.rotational_energy
        relative = 0.5 * reduced_mass * (ux * ux + uy * uy + uz * uz)
        dimensions = 2.0 if box.planar else 3.0
        shared, spin[i], spin[j] = share_energy(
            relative + spin[i] + spin[j], dimensions, rotation, other_rotation, tallies.random
        )
        # the elastic contact turns the relative velocity u into u + d (1 + m_i / m_j); now its length is scaled
        share = 1.0 + mass / other_mass
        scale = math.sqrt(shared / relative)
        dx = (scale * (ux + share * dx) - ux) / share
        dy = (scale * (uy + share * dy) - uy) / share
        dz = (scale * (uz + share * dz) - uz) / share
    back = mass / other_mass if modes.mixed else 1.0
    layer = min(max(int((z - 0.5 * rz) * tallies.layer_scale), 0), tallies.virial.size - 1)
    tallies.virial[layer] += mass * (rx * dx + ry * dy + rz * dz)
    _write(molecules[i], x, y, z, vx + dx, vy + dy, vz + dz, t)
    _write(molecules[j], px, py, pz, wx - back * dx, wy - back * dy, wz - back * dz, t)
    return vx + dx, vy + dy, vz + dz, px, py, pz, wx - back * dx, wy - back * dy, wz - back * dz


@kernel
def _hit(i, wall, t, x, y, z, vx, vy, vz, molecules, kinds, box, walls, tallies, modes):
    """Resolve a hit on a wall or the piston; return the new state."""
    mass = kinds.table[0].mass
    radius = kinds.table[0].radius
    rotation = kinds.table[0].rotation
    if modes.mixed:
        kind = kinds.table[molecules[i].kind]
        mass = kind.mass
        radius = kind.radius
        rotation = kind.rotation
    spin = kinds.rotational_energy[i] if modes.rotation else 0.0
    if not modes.rotation:
        rotation = 0.0
    before = 0.5 * mass * (vx * vx + vy * vy + vz * vz) + spin
    since_start = walls.epoch[0] + t
    axis = wall >> 1
    high = wall & 1 == 1
    if axis == 0:
        came = vx
        vx, vy, vz, spin = resolve_wall_hit(
            walls, wall, since_start, vx, vy, vz, spin, mass, rotation, box.planar, tallies.random
        )
        went = vx
        x = box.length_x - radius if high else radius
    elif axis == 1:
        came = vy
        vy, vx, vz, spin = resolve_wall_hit(
            walls, wall, since_start, vy, vx, vz, spin, mass, rotation, box.planar, tallies.random
        )
        went = vy
        y = box.length_y - radius if high else radius
    else:
        came = vz
        vz, vx, vy, spin = resolve_wall_hit(
            walls, wall, since_start, vz, vx, vy, spin, mass, rotation, box.planar, tallies.random
        )
        went = vz
        if modes.piston and high:
            z = walls.piston[0] + walls.piston[1] * (t - walls.piston[2]) - radius
        else:
            z = box.length_z - radius if high else radius
    if modes.rotation:
        kinds.rotational_energy[i] = spin
    gained = 0.5 * mass * (vx * vx + vy * vy + vz * vz) + spin - before
    tallies.hits[wall] += 1
    tallies.impulse[wall] += mass * (came - went) if high else mass * (went - came)
    if modes.piston and wall == 5:
        tallies.work[wall] += gained
    else:
        tallies.heat[wall] += gained
    _write(molecules[i], x, y, z, vx, vy, vz, t)
    return x, y, z, vx, vy, vz


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
            if what == _CONTACT:
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
            x, y, z, vx, vy, vz = _position(molecules[i], now, box, modes)
            size, _ = _size_and_radius(i, molecules, kinds, modes)
            for axis in range(3):
                if axis == 0:
                    u, length, last = x, box.length_x, cells.last_slot_x
                elif axis == 1:
                    u, length, last = y, box.length_y, cells.last_slot_y
                else:
                    u, length, last = z, box.length_z, cells.last_slot_z
                if modes.mixed:
                    last = cells.boundary.shape[2] - 2
                    while last > 0 and cells.boundary[size, axis, last] == math.inf:
                        last -= 1
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
                lower = 0
                upper = last + 1
                while upper - lower > 1:
                    middle = (lower + upper) >> 1
                    if u >= cells.boundary[size, axis, middle]:
                        lower = middle
                    else:
                        upper = middle
                cells.slot[i, axis] = lower
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
            x, y, z, vx, vy, vz = _position(molecules[i], now, box, modes)
            _plan(i, now, x, y, z, vx, vy, vz, molecules, events, kinds, cells, calendar, box, walls, modes)
        return DONE

    @kernel(entry=True)
    def replan_ceiling(molecules, events, kinds, cells, calendar, box, walls, now, lowest):
        """Plan anew, at time ``now``, the moves of all that may meet the ceiling, or that were to meet it.

        Below ``lowest``, the lowest place of the ceiling before it is asked again, a molecule leaves its slot first.
        """
        for i in range(molecules.size):
            event = events[i]
            slot_z = np.int64(event.slot_z)
            size, radius = _size_and_radius(i, molecules, kinds, modes)
            if cells.boundary[size, 2, slot_z + 1] < lowest - radius and np.int64(event.what) != _CEILING:
                continue
            x, y, z, vx, vy, vz = _position(molecules[i], now, box, modes)
            time, what = _next_move(
                np.int64(event.slot_x),
                np.int64(event.slot_y),
                slot_z,
                now, x, y, z, vx, vy, vz, size, radius, cells, box, walls, modes,
            )  # fmt: skip
            time += now
            if event.contact_time < time:
                what = _CONTACT
            event.what = what
            schedule(calendar, i, min(time, event.contact_time))

    @kernel(entry=True)
    def advance(molecules, events, kinds, cells, calendar, box, walls, tallies, until, most):
        """Resolve events up to time ``until``, at most ``most`` of them; return a status and how many."""
        row = cells.row
        stride = cells.stride
        done = 0
        status = BUSY
        progress = tallies.progress
        many = molecules.size >= _MANY
        contacts = entered = left = stale = wall_hits = 0
        while done < most:
            i, t = next_event(calendar)
            if not t <= until:
                status = DONE
                break
            if done & 1023 == 1023:
                if t - progress[0] > box.stall:
                    progress[0] = t
                    progress[1] = 0.0
                progress[1] += 1024.0
                if progress[1] > 100_000 + 64 * molecules.size:
                    status = STALLED
                    break
            if many:
                _warm_up(calendar, cells, molecules, events, modes)
            event = events[i]
            what = np.int64(event.what)
            x, y, z, vx, vy, vz = _position(molecules[i], t, box, modes)
            if what < _CONTACT:
                axis = what >> 1
                up = what & 1
                slot = np.int64(cells.slot[i, axis])
                size, radius = _size_and_radius(i, molecules, kinds, modes)
                if axis == 0:
                    length, inverse, last, number = box.length_x, box.inverse_x, cells.last_slot_x, cells.number_x
                elif axis == 1:
                    length, inverse, last, number = box.length_y, box.inverse_y, cells.last_slot_y, cells.number_y
                else:
                    length, inverse, last, number = box.length_z, box.inverse_z, cells.last_slot_z, cells.number_z
                if not _is_wall(slot, axis, up, size, radius, length, inverse, last, cells, modes):
                    next_slot = slot + 2 * up - 1
                    shift = 0.0
                    if modes.periodic and inverse != 0.0:
                        slots = last + 1
                        if next_slot < 0:
                            next_slot = slots - 1
                            shift = length
                        elif next_slot == slots:
                            next_slot = 0
                            shift = -length
                    first, span = overlapped(slot, size, axis, cells, modes)
                    next_first, next_span = overlapped(next_slot, size, axis, cells, modes)
                    enter = next_span > span
                    if enter:
                        cell = next_first + next_span - 1 if up == 1 else next_first
                    else:
                        cell = first if up == 1 else first + span - 1
                    if modes.periodic and cell >= number:
                        cell -= number
                    a1 = 1 if axis == 0 else 0
                    a2 = 1 if axis == 2 else 2
                    slot_1 = np.int64(cells.slot[i, a1])
                    slot_2 = np.int64(cells.slot[i, a2])
                    across = cells.number_y * cells.number_z
                    step = across if axis == 0 else (cells.number_z if axis == 1 else 1)
                    step_1 = cells.number_z if axis == 0 else across
                    step_2 = cells.number_z if axis == 2 else 1
                    number_1 = cells.number_y if axis == 0 else cells.number_x
                    number_2 = cells.number_y if axis == 2 else cells.number_z
                    first_1, span_1 = overlapped(slot_1, size, a1, cells, modes)
                    first_2, span_2 = overlapped(slot_2, size, a2, cells, modes)
                    contact_time = event.contact_time
                    if enter and modes.contacts:
                        soonest = contact_time - t
                        partner = -1
                        if shift != 0.0:
                            x += shift if axis == 0 else 0.0
                            y += shift if axis == 1 else 0.0
                            z += shift if axis == 2 else 0.0
                        full = False
                        for q in range(first_1, first_1 + span_1):
                            if modes.periodic and q >= number_1:
                                q -= number_1
                            for r in range(first_2, first_2 + span_2):
                                if modes.periodic and r >= number_2:
                                    r -= number_2
                                c = cell * step + q * step_1 + r * step_2
                                full |= np.int64(row[(c * stride) & POSITIVE]) + 1 >= stride
                                soonest, partner = _soonest_in_cell(
                                    c, i, t, x, y, z, vx, vy, vz, radius, soonest, partner,
                                    molecules, kinds, cells, box, modes,
                                )  # fmt: skip
                        if full:
                            status = ROW_FULL
                            break
                        for q in range(first_1, first_1 + span_1):
                            if modes.periodic and q >= number_1:
                                q -= number_1
                            for r in range(first_2, first_2 + span_2):
                                if modes.periodic and r >= number_2:
                                    r -= number_2
                                append(row, (cell * step + q * step_1 + r * step_2) * stride, i)
                        if partner >= 0:
                            contact_time = t + soonest
                            event.contact_time = contact_time
                            event.partner = partner
                            event.partner_count = molecules[partner].count
                        entered += 1
                    else:
                        if shift != 0.0:
                            x += shift if axis == 0 else 0.0
                            y += shift if axis == 1 else 0.0
                            z += shift if axis == 2 else 0.0
                        for q in range(first_1, first_1 + (span_1 if modes.contacts else 0)):
                            if modes.periodic and q >= number_1:
                                q -= number_1
                            for r in range(first_2, first_2 + span_2):
                                if modes.periodic and r >= number_2:
                                    r -= number_2
                                remove(row, (cell * step + q * step_1 + r * step_2) * stride, i)
                        left += 1
                    if shift != 0.0:
                        if axis == 0:
                            molecules[i].x += shift
                        elif axis == 1:
                            molecules[i].y += shift
                        else:
                            molecules[i].z += shift
                    cells.slot[i, axis] = next_slot
                    time, what = _next_move(
                        np.int64(event.slot_x),
                        np.int64(event.slot_y),
                        np.int64(event.slot_z),
                        t, x, y, z, vx, vy, vz, size, radius, cells, box, walls, modes,
                    )  # fmt: skip
                    time += t
                    if contact_time < time:
                        what = _CONTACT
                    event.what = what
                    schedule(calendar, i, min(time, contact_time))
                    done += 1
                    continue
            j = -1
            px, py, pz, wx, wy, wz = x, y, z, vx, vy, vz
            if what == _CONTACT:
                j = np.int64(event.partner)
                if molecules[j].count == event.partner_count:
                    vx, vy, vz, px, py, pz, wx, wy, wz = _meet(
                        i, j, t, x, y, z, vx, vy, vz, molecules, kinds, box, tallies, modes
                    )
                    contacts += 1
                else:
                    stale += 1
                    j = -1
            else:
                wall = 5 if what == _CEILING else what
                x, y, z, vx, vy, vz = _hit(
                    i, wall, t, x, y, z, vx, vy, vz, molecules, kinds, box, walls, tallies, modes
                )
                wall_hits += 1
            done += 1
            m = i
            while True:
                _plan(m, t, x, y, z, vx, vy, vz, molecules, events, kinds, cells, calendar, box, walls, modes)
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
                _, radius = _size_and_radius(i, molecules, kinds, modes)
                for q in range(p + 1, end):
                    j = np.int64(cells.row[q])
                    _, other_radius = _size_and_radius(j, molecules, kinds, modes)
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
