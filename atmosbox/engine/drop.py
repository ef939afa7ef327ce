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
from typing import Any, NamedTuple

import numpy as np

from atmosbox.engine._jit import kernel
from atmosbox.engine.calendar import next_event
from atmosbox.engine.encounter import position_at
from atmosbox.engine.exact import BUSY, CROWDED, DONE, MET, ROW_FULL, STALLED, proceed
from atmosbox.engine.liquid import AIR_MET, THERMAL, condense, evaporate, exchange, leave
from atmosbox.engine.moist import renew
from atmosbox.engine.phase import NO_ROOM, TAKEN, enter, room_at, take_out, withdraw
from atmosbox.engine.plan import plan
from atmosbox.engine.random import uniform
from atmosbox.engine.state import Modes

__all__ = ["DropRecords", "specialise"]

_LEAVES = 1


class DropRecords(NamedTuple):
    """What is known of the drops beside their flight.

    ``record``, ``held : (drop,)`` their numbers among the molecules, and how many molecules each holds; ``cube``,
    ``core : (drop,)`` cube of the radius and mass of the nucleus [length^3, mass]; ``alive : (drop,)`` whether it has
    not been swallowed; ``merged : (1,)`` how often that happened; then cube of the radius, mass and radius in flight of
    one molecule.
    """

    record: Any
    held: Any
    cube: Any
    core: Any
    alive: Any
    merged: Any
    molecule_cube: float
    molecule_mass: float
    molecule_radius: float


@kernel
def _radius(drops, k, held):
    """Return the radius of drop k if it held so many molecules [length]."""
    return (drops.cube[k] + held * drops.molecule_cube) ** (1.0 / 3.0)


@kernel
def _resize(drops, k, kinds, modes):
    """Let drop k be as large and as heavy as what it holds."""
    kind = kinds.table[modes.drops + k]
    kind.radius = _radius(drops, k, drops.held[k])
    kind.mass = drops.core[k] + drops.held[k] * drops.molecule_mass


@kernel
def _surface_left(drops, k):
    """Return the surface from which a molecule leaves drop k, at the distance of its centre [length^2]."""
    if drops.alive[k] == 0 or drops.held[k] < 1:
        return 0.0
    reach = _radius(drops, k, drops.held[k] - 1) + drops.molecule_radius
    return 4.0 * math.pi * reach * reach


@kernel
def _renew(t, drops, tallies, ledger):
    """Sum the surface anew, and draw when the next molecule leaves."""
    surface = 0.0
    for k in range(drops.record.size):
        surface += _surface_left(drops, k)
    ledger.surface[0] = surface
    renew(t, tallies, ledger)


@kernel
def _write(molecule, t, x, y, z, vx, vy, vz):
    molecule.x = x
    molecule.y = y
    molecule.z = z
    molecule.vx = vx
    molecule.vy = vy
    molecule.vz = vz
    molecule.clock = t
    molecule.count += 1


@kernel
def _nearest(r, length, inverse):
    """Return a distance along an axis, to the nearest image if the axis is periodic."""
    return r - length * np.rint(r * inverse) if inverse != 0.0 else r


@kernel
def _about(nx, ny, nz, state):
    """Return a direction by the cosine law about a normal."""
    rise = math.sqrt(uniform(state))
    across = math.sqrt(max(1.0 - rise * rise, 0.0))
    angle = 2.0 * math.pi * uniform(state)
    # two axes at right angles to the normal: Duff and others 2017, jcgt.org/published/0006/01/01
    sign = 1.0 if nz >= 0.0 else -1.0
    a = -1.0 / (sign + nz)
    b = nx * ny * a
    c, s = across * math.cos(angle), across * math.sin(angle)
    return (
        c * (1.0 + sign * nx * nx * a) + s * b + rise * nx,
        c * sign * b + s * (sign + ny * ny * a) + rise * ny,
        -c * sign * nx - s * ny + rise * nz,
    )


@kernel
def _within(u, radius, length, inverse):
    """Return a coordinate of a drop, moved inwards if it has grown into a wall."""
    return u if inverse != 0.0 else min(max(u, radius), max(length - radius, radius))


@kernel
def _merge(i, j, t, molecules, events, kinds, cells, calendar, box, walls, drops, tallies, ledger, modes):
    """Let the smaller of two drops be swallowed by the larger one; return the number of that one."""
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
    ledger.energy[THERMAL] += 0.5 * mass * share * (ux * ux + uy * uy + uz * uz)
    x += share * _nearest(px - x, box.length_x, box.inverse_x)
    y += share * _nearest(py - y, box.length_y, box.inverse_y)
    z += share * _nearest(pz - z, box.length_z, box.inverse_z)
    drops.held[a] += drops.held[b]
    drops.cube[a] += drops.cube[b]
    drops.core[a] += drops.core[b]
    drops.held[b] = 0
    drops.alive[b] = 0
    drops.merged[0] += 1
    take_out(j, molecules, events, kinds, cells, calendar, modes)
    _resize(drops, a, kinds, modes)
    radius = kinds.table[modes.drops + a].radius
    x = _within(x, radius, box.length_x, box.inverse_x)
    y = _within(y, radius, box.length_y, box.inverse_y)
    top = walls.piston[0] + walls.piston[1] * (t - walls.piston[2]) if modes.piston else box.length_z
    z = _within(z, radius, top, box.inverse_z)
    _write(molecules[i], t, x, y, z, vx + share * ux, vy + share * uy, vz + share * uz)
    return i


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
    if number == ledger.kind and (ledger.sticking >= 1.0 or uniform(tallies.random) < ledger.sticking):
        condense(ledger, energy)
        withdraw(i, molecules, events, kinds, cells, calendar, ledger, modes)
        drops.held[k] += 1
        _resize(drops, k, kinds, modes)
        wx, wy, wz = cx, cy, cz
    else:
        flight, spin = exchange(ledger, energy, rotation, tallies.random)
        ledger.energy[THERMAL] += energy - flight - spin
        ledger.count[AIR_MET] += 1
        nx = _nearest(x - px, box.length_x, box.inverse_x)
        ny = _nearest(y - py, box.length_y, box.inverse_y)
        nz = _nearest(z - pz, box.length_z, box.inverse_z)
        long = math.sqrt(nx * nx + ny * ny + nz * nz)
        ex, ey, ez = _about(nx / long, ny / long, nz / long, tallies.random)
        speed = math.sqrt(2.0 * flight / reduced)
        vx, vy, vz = cx + (1.0 - light) * speed * ex, cy + (1.0 - light) * speed * ey, cz + (1.0 - light) * speed * ez
        wx, wy, wz = cx - light * speed * ex, cy - light * speed * ey, cz - light * speed * ez
        if modes.rotation:
            kinds.rotational_energy[i] = spin
        _write(molecules[i], t, x, y, z, vx, vy, vz)
        plan(i, t, x, y, z, vx, vy, vz, molecules, events, kinds, cells, calendar, box, walls, modes)
    _write(molecules[j], t, px, py, pz, wx, wy, wz)
    _renew(t, drops, tallies, ledger)


@kernel
def _emit(t, molecules, events, kinds, cells, calendar, box, walls, drops, tallies, ledger, modes):
    """Let a molecule leave one of the drops; return a status and the number of the drop."""
    k = 0
    left = uniform(tallies.random) * ledger.surface[0]
    for each in range(drops.record.size):
        surface = _surface_left(drops, each)
        if surface > 0.0:
            k = each
            if left < surface:
                break
            left -= surface
    i = ledger.absent[ledger.top[0] - 1]
    j = drops.record[k]
    px, py, pz, wx, wy, wz = position_at(molecules[j], t, box, modes)
    top = walls.piston[0] + walls.piston[1] * (t - walls.piston[2]) if modes.piston else box.length_z
    drops.held[k] -= 1
    _resize(drops, k, kinds, modes)
    radius = drops.molecule_radius
    reach = (kinds.table[modes.drops + k].radius + radius) * (1.0 + 1e-12)
    found = TAKEN
    x, y, z, nx, ny, nz = px, py, pz, 0.0, 0.0, 1.0
    for _ in range(1000):
        nz = 2.0 * uniform(tallies.random) - 1.0
        across = math.sqrt(1.0 - nz * nz)
        angle = 2.0 * math.pi * uniform(tallies.random)
        nx, ny = across * math.cos(angle), across * math.sin(angle)
        x, y, z = px + reach * nx, py + reach * ny, pz + reach * nz
        if box.inverse_x != 0.0:
            low = cells.boundary[kinds.table[ledger.kind].size_class, 0, 0]
            x -= math.floor((x - low) / box.length_x) * box.length_x
        elif not radius <= x <= box.length_x - radius:
            continue
        if box.inverse_y != 0.0:
            low = cells.boundary[kinds.table[ledger.kind].size_class, 1, 0]
            y -= math.floor((y - low) / box.length_y) * box.length_y
        elif not radius <= y <= box.length_y - radius:
            continue
        if box.inverse_z != 0.0:
            low = cells.boundary[kinds.table[ledger.kind].size_class, 2, 0]
            z -= math.floor((z - low) / box.length_z) * box.length_z
        elif not radius <= z <= top - radius:
            continue
        found = room_at(i, t, x, y, z, molecules, events, kinds, cells, box, modes)
        if found != TAKEN:
            break
    if found in (TAKEN, NO_ROOM):
        drops.held[k] += 1
        _resize(drops, k, kinds, modes)
        return (CROWDED if found == TAKEN else ROW_FULL), j
    mass, heavy = drops.molecule_mass, kinds.table[modes.drops + k].mass
    light = mass / (mass + heavy)
    flight, spin = evaporate(ledger, tallies.random)
    leave(ledger, flight + spin)
    speed = math.sqrt(2.0 * flight / (heavy * light))
    ex, ey, ez = _about(nx, ny, nz, tallies.random)
    a, b = (1.0 - light) * speed, light * speed
    enter(
        i, t, x, y, z, wx + a * ex, wy + a * ey, wz + a * ez, spin,
        molecules, events, kinds, cells, calendar, box, walls, ledger, modes,
    )  # fmt: skip
    _write(molecules[j], t, px, py, pz, wx - b * ex, wy - b * ey, wz - b * ez)
    _renew(t, drops, tallies, ledger)
    return DONE, j


@functools.cache
def specialise(modes: Modes) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Return the kernels of one set of modes: ``begin``, which draws the first time, and ``advance``."""

    @kernel(entry=True)
    def begin(kinds, drops, tallies, ledger, now):
        """Make each drop as large as it is, and draw at time ``now`` when the next molecule leaves."""
        for k in range(drops.record.size):
            _resize(drops, k, kinds, modes)
        _renew(now, drops, tallies, ledger)

    @kernel(entry=True)
    def advance(molecules, events, kinds, cells, calendar, box, walls, drops, tallies, ledger, until, most):
        """Resolve events of molecules and drops up to time ``until``; return a status and how many."""
        done = 0
        looked = 0
        progress = tallies.progress
        while done < most:
            due = ledger.clock[_LEAVES]
            status, some = proceed(
                molecules, events, kinds, cells, calendar, box, walls, tallies, min(until, due), most - done, modes
            )
            done += some + 1
            if done - looked >= 1024:
                i, t = next_event(calendar)
                t = min(t, due)
                if t - progress[0] > box.stall:
                    progress[0] = t
                    progress[1] = 0.0
                progress[1] += done - looked
                looked = done
                if progress[1] > 100_000 + 64 * molecules.size:
                    return STALLED, done
            j = -1
            t = due
            if status == MET:
                i, t = next_event(calendar)
                j = np.int64(events[i].partner)
                if min(np.int64(molecules[i].kind), np.int64(molecules[j].kind)) >= modes.drops:
                    j = _merge(
                        i, j, t, molecules, events, kinds, cells, calendar, box, walls, drops, tallies, ledger, modes
                    )
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
