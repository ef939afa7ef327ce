r"""Drops that can be seen: they fly, grow, shrink and merge, from event to event.

A drop is a sphere in the box like a molecule, but no contact with it is elastic. A molecule of vapour that hits one
stays; any other leaves it again with another energy, shared as in `liquid`. All of that happens in the frame in
which the two have no momentum: what the pair's common motion carries is kept, and so is momentum. Two drops that
touch become one, and the energy of their approach warms the liquid.

A molecule leaves some drop in proportion to the surface that it will leave behind, which makes a drop of n molecules
lose one as often as one of n - 1 catches one: the balance is detailed again.
"""

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.random import uniform
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.calendar import next_event
from atmosbox.engine.exact.encounter import position_at, write
from atmosbox.engine.exact.exact import BUSY, DONE, LOOK, MET, ROW_FULL, STALLED, piled_up, proceed
from atmosbox.engine.exact.prediction import plan
from atmosbox.engine.liquid.drop_shape import (
    DropRecords,
    about,
    nearest,
    placed,
    radius_of,
    resize,
    surface_left,
    within,
)
from atmosbox.engine.liquid.insertion import NO_ROOM, TAKEN, has_room, move_to, room_at
from atmosbox.engine.liquid.moist import ceiling_at, renew
from atmosbox.engine.liquid.phase import enter, take_out, withdraw
from atmosbox.engine.liquid.reservoir import AIR_MET, THERMAL, condense, evaporate, exchange, leave

__all__ = ["DropRecords", "specialise"]

_LEAVES = 1


@kernel
def _renew(t, drops, tallies, ledger):
    """Sum the surface anew, and draw when the next molecule leaves."""
    surface = 0.0
    for k in range(drops.record.size):
        surface += surface_left(drops, k)
    ledger.surface[0] = surface
    renew(t, tallies, ledger)


@kernel
def _may_grow(i, j, k, t, x, y, z, molecules, events, kinds, cells, box, walls, drops, modes):
    """Tell whether drop k has room for one molecule more: neither a wall nor anybody but molecule i stands there."""
    radius = radius_of(drops, k, drops.held[k] + 1)
    if box.inverse_x == 0.0 and not radius <= x <= box.length_x - radius:
        return False
    if box.inverse_y == 0.0 and not radius <= y <= box.length_y - radius:
        return False
    if box.inverse_z == 0.0 and not radius <= z <= ceiling_at(t, box, walls, modes)[0] - radius:
        return False
    return has_room(i, j, t, x, y, z, radius, molecules, events, kinds, cells, box, modes)


@kernel
def _merge(i, j, t, molecules, events, kinds, cells, calendar, box, walls, drops, tallies, ledger, modes):
    """Let the smaller of two drops be swallowed by the larger one; return a status and the number of that one."""
    a = np.int64(molecules[i].kind) - modes.drops
    b = np.int64(molecules[j].kind) - modes.drops
    if kinds.table[modes.drops + b].mass > kinds.table[modes.drops + a].mass:
        i, j = j, i
        a, b = b, a
    x, y, z, vx, vy, vz = position_at(molecules[i], t, box, modes)
    px, py, pz, wx, wy, wz = position_at(molecules[j], t, box, modes)
    mass = kinds.table[modes.drops + a].mass
    other = kinds.table[modes.drops + b].mass
    share = other / (mass + other)
    ux, uy, uz = wx - vx, wy - vy, wz - vz
    x += share * nearest(px - x, box.length_x, box.inverse_x)
    y += share * nearest(py - y, box.length_y, box.inverse_y)
    z += share * nearest(pz - z, box.length_z, box.inverse_z)
    radius = (drops.cube[a] + drops.cube[b] + (drops.held[a] + drops.held[b]) * drops.molecule_cube) ** (1.0 / 3.0)
    x = within(x, radius, box.length_x, box.inverse_x)
    y = within(y, radius, box.length_y, box.inverse_y)
    z = within(z, radius, ceiling_at(t, box, walls, modes)[0], box.inverse_z)
    x, y, z, moved = move_to(i, x, y, z, molecules, events, kinds, cells, box, modes)
    if not moved:
        return ROW_FULL, i
    ledger.energy[THERMAL] += 0.5 * mass * share * (ux * ux + uy * uy + uz * uz)
    drops.held[a] += drops.held[b]
    drops.cube[a] += drops.cube[b]
    drops.core[a] += drops.core[b]
    drops.held[b] = 0
    drops.alive[b] = 0
    drops.merged[0] += 1
    take_out(j, molecules, events, kinds, cells, calendar, modes)
    resize(drops, a, kinds, modes)
    write(molecules[i], t, x, y, z, vx + share * ux, vy + share * uy, vz + share * uz)
    return DONE, i


@kernel
def _hit(i, j, t, molecules, events, kinds, cells, calendar, box, walls, drops, tallies, ledger, modes):
    """Let molecule i hit drop j."""
    k = np.int64(molecules[j].kind) - modes.drops
    number = np.int64(molecules[i].kind)
    mass = kinds.table[number].mass
    rotation = kinds.table[number].rotation if modes.rotation else 0.0
    heavy = kinds.table[modes.drops + k].mass
    x, y, z, vx, vy, vz = position_at(molecules[i], t, box, modes)
    px, py, pz, wx, wy, wz = position_at(molecules[j], t, box, modes)
    ux, uy, uz = vx - wx, vy - wy, vz - wz
    light = mass / (mass + heavy)
    cx, cy, cz = wx + light * ux, wy + light * uy, wz + light * uz
    reduced = heavy * light
    spin = kinds.rotational_energy[i] if modes.rotation else 0.0
    energy = 0.5 * reduced * (ux * ux + uy * uy + uz * uz) + spin
    sticks = number == ledger.kind and (ledger.sticking >= 1.0 or uniform(tallies.random) < ledger.sticking)
    if sticks and _may_grow(i, j, k, t, px, py, pz, molecules, events, kinds, cells, box, walls, drops, modes):
        condense(ledger, energy)
        withdraw(i, molecules, events, kinds, cells, calendar, ledger, modes)
        drops.held[k] += 1
        resize(drops, k, kinds, modes)
        wx, wy, wz = cx, cy, cz
    else:
        flight, spin = exchange(ledger, energy, rotation, tallies.random)
        ledger.energy[THERMAL] += energy - flight - spin
        ledger.count[AIR_MET] += 1
        nx = nearest(x - px, box.length_x, box.inverse_x)
        ny = nearest(y - py, box.length_y, box.inverse_y)
        nz = nearest(z - pz, box.length_z, box.inverse_z)
        long = math.sqrt(nx * nx + ny * ny + nz * nz)
        ex, ey, ez = about(nx / long, ny / long, nz / long, tallies.random)
        speed = math.sqrt(2.0 * flight / reduced)
        vx, vy, vz = cx + (1.0 - light) * speed * ex, cy + (1.0 - light) * speed * ey, cz + (1.0 - light) * speed * ez
        wx, wy, wz = cx - light * speed * ex, cy - light * speed * ey, cz - light * speed * ez
        if modes.rotation:
            kinds.rotational_energy[i] = spin
        write(molecules[i], t, x, y, z, vx, vy, vz)
        plan(i, t, x, y, z, vx, vy, vz, molecules, events, kinds, cells, calendar, box, walls, modes)
    write(molecules[j], t, px, py, pz, wx, wy, wz)
    _renew(t, drops, tallies, ledger)


@kernel
def _emit(t, molecules, events, kinds, cells, calendar, box, walls, drops, tallies, ledger, modes):
    """Let a molecule leave one of the drops, unless something stands there; return a status and the drop's number."""
    k = 0
    left = uniform(tallies.random) * ledger.surface[0]
    for each in range(drops.record.size):
        surface = surface_left(drops, each)
        if surface > 0.0:
            k = each
            if left < surface:
                break
            left -= surface
    i = ledger.absent[ledger.top[0] - 1]
    j = drops.record[k]
    px, py, pz, wx, wy, wz = position_at(molecules[j], t, box, modes)
    drops.held[k] -= 1
    resize(drops, k, kinds, modes)
    radius = drops.molecule_radius
    reach = (kinds.table[modes.drops + k].radius + radius) * (1.0 + 1e-12)
    nz = 2.0 * uniform(tallies.random) - 1.0
    across = math.sqrt(1.0 - nz * nz)
    angle = 2.0 * math.pi * uniform(tallies.random)
    nx, ny = across * math.cos(angle), across * math.sin(angle)
    size = kinds.table[ledger.kind].size_class
    x, inside_x = placed(px + reach * nx, radius, box.length_x, box.inverse_x, cells.boundary[size, 0, 0])
    y, inside_y = placed(py + reach * ny, radius, box.length_y, box.inverse_y, cells.boundary[size, 1, 0])
    top = ceiling_at(t, box, walls, modes)[0]
    z, inside_z = placed(pz + reach * nz, radius, top, box.inverse_z, cells.boundary[size, 2, 0])
    found = TAKEN
    if inside_x and inside_y and inside_z:
        found = room_at(i, t, x, y, z, molecules, events, kinds, cells, box, modes)
    if found in (TAKEN, NO_ROOM):
        drops.held[k] += 1
        resize(drops, k, kinds, modes)
        if found == NO_ROOM:
            return ROW_FULL, j
        _renew(t, drops, tallies, ledger)
        return DONE, j
    mass, heavy = drops.molecule_mass, kinds.table[modes.drops + k].mass
    light = mass / (mass + heavy)
    flight, spin = evaporate(ledger, tallies.random)
    leave(ledger, flight + spin)
    speed = math.sqrt(2.0 * flight / (heavy * light))
    ex, ey, ez = about(nx, ny, nz, tallies.random)
    a, b = (1.0 - light) * speed, light * speed
    enter(
        i, t, x, y, z, wx + a * ex, wy + a * ey, wz + a * ez, spin,
        molecules, events, kinds, cells, calendar, box, walls, ledger, modes,
    )  # fmt: skip
    write(molecules[j], t, px, py, pz, wx - b * ex, wy - b * ey, wz - b * ez)
    _renew(t, drops, tallies, ledger)
    return DONE, j


@functools.cache
def specialise(modes: Modes) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Return the kernels of one set of modes: ``begin``, which draws the first time, and ``advance``."""

    @kernel(entry=True)
    def begin(kinds, drops, tallies, ledger, now):
        """Make each drop as large as it is, and draw at time ``now`` when the next molecule leaves."""
        for k in range(drops.record.size):
            resize(drops, k, kinds, modes)
        _renew(now, drops, tallies, ledger)

    @kernel(entry=True)
    def advance(molecules, events, kinds, cells, calendar, box, walls, drops, tallies, ledger, until, most):
        """Resolve events of molecules and drops up to time ``until``; return a status and how many."""
        done = 0
        looked = 0
        while done < most:
            due = ledger.clock[_LEAVES]
            status, some = proceed(
                molecules, events, kinds, cells, calendar, box, walls, tallies, min(until, due), most - done, modes
            )
            done += some + 1
            if done - looked >= LOOK:
                _, t = next_event(calendar)
                if piled_up(min(t, due), done - looked, molecules.size, box, tallies):
                    return STALLED, done
                looked = done
            j = -1
            t = due
            if status == MET:
                i, t = next_event(calendar)
                j = np.int64(events[i].partner)
                if min(np.int64(molecules[i].kind), np.int64(molecules[j].kind)) >= modes.drops:
                    status, j = _merge(
                        i, j, t, molecules, events, kinds, cells, calendar, box, walls, drops, tallies, ledger, modes
                    )
                    if status != DONE:
                        return status, done
                    _renew(t, drops, tallies, ledger)
                else:
                    if np.int64(molecules[i].kind) >= modes.drops:
                        i, j = j, i
                    _hit(i, j, t, molecules, events, kinds, cells, calendar, box, walls, drops, tallies, ledger, modes)
            elif status == BUSY:
                continue
            elif status != DONE or due > until:
                return status, done
            else:
                status, j = _emit(
                    due, molecules, events, kinds, cells, calendar, box, walls, drops, tallies, ledger, modes
                )
                if status != DONE:
                    return status, done
            x, y, z, vx, vy, vz = position_at(molecules[j], t, box, modes)
            plan(j, t, x, y, z, vx, vy, vz, molecules, events, kinds, cells, calendar, box, walls, modes)
        return BUSY, done

    return begin, advance
