r"""Visible drops: they fly, grow, shrink and merge; the loop over events.

A drop is a sphere in the box like a molecule, but its contacts are not elastic. A vapour molecule that hits it sticks,
always or with a probability; any other leaves it again with another energy, shared as in `reservoir`. All this is
computed in the frame in which the pair has no momentum, so momentum is conserved, and the energy of the pair's common
motion stays with it. Two drops that touch become one, and the energy of their approach warms the liquid.

The drop that a molecule leaves is drawn with a weight that is the surface after it has left. So a drop of n molecules
loses one as often as a drop of n - 1 catches one, and detailed balance holds again. Drops with a surface energy, or
with salt in them, each lose molecules at a rate of their own: see `drop_shape`.
"""

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from atmosbox.engine.core.elementary import circle
from atmosbox.engine.core.jit import by_reference, kernel
from atmosbox.engine.core.pair import nearest_image
from atmosbox.engine.core.random import uniform
from atmosbox.engine.core.state import Modes, Motion
from atmosbox.engine.exact.calendar import next_event
from atmosbox.engine.exact.encounter import kind_of, motion_at, write
from atmosbox.engine.exact.exact import Status, piled_up, proceed
from atmosbox.engine.exact.prediction import call
from atmosbox.engine.liquid.drop_shape import given_by_surface, radius_of, redraw, resize, surface_energy, surface_left
from atmosbox.engine.liquid.insertion import Place, enter, has_room, move_to, place_at, take_out, withdraw
from atmosbox.engine.liquid.moist import ceiling_at
from atmosbox.engine.liquid.reservoir import AIR_MET, LEAVES, THERMAL, condense, evaporate, exchange, leave, stays


@kernel
def _about(nx, ny, nz, state):
    """Draw a direction by the cosine law about a normal."""
    rise = math.sqrt(uniform(state))
    across = math.sqrt(max(1.0 - rise * rise, 0.0))
    cosine, sine = circle(uniform(state))
    # two axes at right angles to the normal: Duff and others 2017, jcgt.org/published/0006/01/01
    sign = 1.0 if nz >= 0.0 else -1.0
    a = -1.0 / (sign + nz)
    b = nx * ny * a
    c, s = across * cosine, across * sine
    return (
        c * (1.0 + sign * nx * nx * a) + s * b + rise * nx,
        c * sign * b + s * (sign + ny * ny * a) + rise * ny,
        -c * sign * nx - s * ny + rise * nz,
    )


@kernel
def _within(u, radius, length, inverse):
    """Return a coordinate of a drop, moved inwards if the drop has grown into a wall."""
    return u if inverse != 0.0 else min(max(u, radius), max(length - radius, radius))


@kernel
def _placed(u, radius, length, inverse, lowest):
    """Return a coordinate of a molecule, brought back into a periodic box, and whether it is between the walls."""
    if inverse != 0.0:
        return u - math.floor((u - lowest) / length) * length, True
    return u, radius <= u <= length - radius


@kernel
def _may_grow(i, j, k, t, at, gas, drops, modes):
    """Return whether drop k, index j, has room for one molecule more: no wall and no molecule but i is in the way."""
    box = gas.box
    radius = radius_of(drops, drops.cube[k], drops.held[k] + 1)
    if box.inverse_x == 0.0 and not radius <= at.x <= box.length_x - radius:
        return False
    if box.inverse_y == 0.0 and not radius <= at.y <= box.length_y - radius:
        return False
    if box.inverse_z == 0.0 and not radius <= at.z <= ceiling_at(t, gas, modes)[0] - radius:
        return False
    return has_room(i, j, t, at, radius, gas, modes)


@kernel
def _merge(i, j, t, gas, drops, reservoir, modes):
    """Merge the smaller of two drops into the larger one; return a `Status` and the index of the larger one."""
    box, table = gas.box, gas.kinds.table
    a = np.int64(gas.molecules[i].kind) - modes.drops
    b = np.int64(gas.molecules[j].kind) - modes.drops
    if table[modes.drops + b].mass > table[modes.drops + a].mass:
        i, j = j, i
        a, b = b, a
    one = motion_at(i, t, gas, modes)
    two = motion_at(j, t, gas, modes)
    mass = table[modes.drops + a].mass
    other = table[modes.drops + b].mass
    share = other / (mass + other)
    ux, uy, uz = two.vx - one.vx, two.vy - one.vy, two.vz - one.vz
    # the new drop is at the centre of mass of both, as far as the walls allow
    rx, ry, rz = nearest_image(two.x - one.x, two.y - one.y, two.z - one.z, box, modes)
    x, y, z = one.x + share * rx, one.y + share * ry, one.z + share * rz
    cube, held = drops.cube[a] + drops.cube[b], drops.held[a] + drops.held[b]
    radius = radius_of(drops, cube, held)
    x = _within(x, radius, box.length_x, box.inverse_x)
    y = _within(y, radius, box.length_y, box.inverse_y)
    z = _within(z, radius, ceiling_at(t, gas, modes)[0], box.inverse_z)
    x, y, z, moved = move_to(i, x, y, z, gas, modes)
    if not moved:
        return Status.FULL, i
    reservoir.energy[THERMAL] += 0.5 * mass * share * (ux * ux + uy * uy + uz * uz)
    if not drops.plain:
        # one drop has less surface than two
        lost = surface_energy(drops, drops.cube[a], drops.held[a]) + surface_energy(drops, drops.cube[b], drops.held[b])
        reservoir.energy[THERMAL] += lost - surface_energy(drops, cube, held)
        drops.solute[a] += drops.solute[b]
    drops.held[a] = held
    drops.cube[a] = cube
    drops.core[a] += drops.core[b]
    drops.held[b] = 0
    drops.alive[b] = 0
    drops.merged[0] += 1
    take_out(j, gas, modes)
    resize(drops, a, gas.kinds, modes)
    write(i, t, Motion(x, y, z, one.vx + share * ux, one.vy + share * uy, one.vz + share * uz), gas)
    return Status.DONE, i


@kernel
def _hit(i, j, t, gas, drops, reservoir, modes):
    """Resolve a hit of molecule i on drop j: it sticks, or leaves again with another energy."""
    box, kinds, state = gas.box, gas.kinds, gas.tallies.random
    k = np.int64(gas.molecules[j].kind) - modes.drops
    mass, _, rotation = kind_of(i, gas, modes)
    heavy = kinds.table[modes.drops + k].mass
    at = motion_at(i, t, gas, modes)
    drop = motion_at(j, t, gas, modes)
    # the pair's relative energy, in the frame in which the two have no momentum; c is the velocity of that frame
    ux, uy, uz = at.vx - drop.vx, at.vy - drop.vy, at.vz - drop.vz
    light = mass / (mass + heavy)
    cx, cy, cz = drop.vx + light * ux, drop.vy + light * uy, drop.vz + light * uz
    reduced = heavy * light
    spin = kinds.rotational_energy[i] if modes.rotation else 0.0
    energy = 0.5 * reduced * (ux * ux + uy * uy + uz * uz) + spin
    is_vapour = np.int64(gas.molecules[i].kind) == reservoir.kind
    sticks = is_vapour and stays(reservoir, state)
    wx, wy, wz = cx, cy, cz
    if sticks and _may_grow(i, j, k, t, drop, gas, drops, modes):
        condense(reservoir, energy)
        withdraw(i, gas, reservoir, modes)
        drops.held[k] += 1
        if not drops.plain:
            reservoir.energy[THERMAL] -= given_by_surface(drops, k, drops.held[k])
        resize(drops, k, kinds, modes)
    else:
        flight, spin = exchange(reservoir, energy, rotation, state)
        reservoir.energy[THERMAL] += energy - flight - spin
        reservoir.count[AIR_MET] += 1
        nx, ny, nz = nearest_image(at.x - drop.x, at.y - drop.y, at.z - drop.z, box, modes)
        long = math.sqrt(nx * nx + ny * ny + nz * nz)
        ex, ey, ez = _about(nx / long, ny / long, nz / long, state)
        speed = math.sqrt(2.0 * flight / reduced)
        vx, vy, vz = cx + (1.0 - light) * speed * ex, cy + (1.0 - light) * speed * ey, cz + (1.0 - light) * speed * ez
        wx, wy, wz = cx - light * speed * ex, cy - light * speed * ey, cz - light * speed * ez
        if modes.rotation:
            kinds.rotational_energy[i] = spin
        after = Motion(at.x, at.y, at.z, vx, vy, vz)
        write(i, t, after, gas)
        call(i, t, gas)
    write(j, t, Motion(drop.x, drop.y, drop.z, wx, wy, wz), gas)


@kernel
def _emit(t, gas, drops, reservoir, modes):
    """Take a molecule out of one of the drops, unless there is no place for it; return a `Status` and that drop."""
    box, table, state = gas.box, gas.kinds.table, gas.tallies.random
    # the drop: drawn in proportion to the surface that the molecule leaves behind, or to the rate of each
    k = 0
    left = uniform(state) * (reservoir.surface[0] if drops.plain else np.sum(drops.rate))
    for each in range(drops.record.size):
        weight = surface_left(drops, each) if drops.plain else drops.rate[each]
        if weight > 0.0:
            k = each
            if left < weight:
                break
            left -= weight
    i = reservoir.absent[reservoir.top[0] - 1]
    j = drops.record[k]
    drop = motion_at(j, t, gas, modes)
    drops.held[k] -= 1
    resize(drops, k, gas.kinds, modes)
    # the place: anywhere on the drop, just outside
    radius = drops.molecule_radius
    distance = (table[modes.drops + k].radius + radius) * (1.0 + 1e-12)
    nz = 2.0 * uniform(state) - 1.0
    across = math.sqrt(1.0 - nz * nz)
    cosine, sine = circle(uniform(state))
    nx, ny = across * cosine, across * sine
    size, lowest = table[reservoir.kind].size_class, gas.cells.boundary
    x, inside_x = _placed(drop.x + distance * nx, radius, box.length_x, box.inverse_x, lowest[size, 0, 0])
    y, inside_y = _placed(drop.y + distance * ny, radius, box.length_y, box.inverse_y, lowest[size, 1, 0])
    top = ceiling_at(t, gas, modes)[0]
    z, inside_z = _placed(drop.z + distance * nz, radius, top, box.inverse_z, lowest[size, 2, 0])
    found = Place.TAKEN
    if inside_x and inside_y and inside_z:
        found = place_at(i, t, x, y, z, gas, modes)
    if found != Place.FREE:
        drops.held[k] += 1
        resize(drops, k, gas.kinds, modes)
        return Status.FULL if found == Place.ROW_FULL else Status.DONE, j
    mass, heavy = drops.molecule_mass, table[modes.drops + k].mass
    light = mass / (mass + heavy)
    if not drops.plain:
        reservoir.energy[THERMAL] += given_by_surface(drops, k, drops.held[k] + 1)
    flight, spin = evaporate(reservoir, state)
    leave(reservoir, flight + spin)
    speed = math.sqrt(2.0 * flight / (heavy * light))
    ex, ey, ez = _about(nx, ny, nz, state)
    a, b = (1.0 - light) * speed, light * speed
    free = Motion(x, y, z, drop.vx + a * ex, drop.vy + a * ey, drop.vz + a * ez)
    enter(i, t, free, spin, gas, reservoir, modes)
    write(j, t, Motion(drop.x, drop.y, drop.z, drop.vx - b * ex, drop.vy - b * ey, drop.vz - b * ez), gas)
    return Status.DONE, j


@functools.cache
def specialise(modes: Modes) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Return the kernels of one set of modes: ``begin``, which draws the first time, and ``advance``."""

    @kernel(entry=True)
    def begin(gas, drops, reservoir, now):
        """Set radius and mass of all drops, and draw at time ``now`` when the next molecule leaves."""
        gas, drops, reservoir = by_reference(gas), by_reference(drops), by_reference(reservoir)
        for k in range(drops.record.size):
            resize(drops, k, gas.kinds, modes)
        redraw(now, gas, drops, reservoir)

    @kernel(entry=True)
    def advance(gas, drops, reservoir, until, most):
        """Resolve events of molecules and drops up to ``until``; return a `Status` as a number and how many."""
        gas, drops, reservoir = by_reference(gas), by_reference(drops), by_reference(reservoir)
        done = 0
        while done < most:
            # events of molecules and drops, until a molecule leaves a drop or something meets one
            due = reservoir.clock[LEAVES]
            status, some = proceed(gas, min(until, due), most - done, modes)
            done += some + 1
            if piled_up(min(next_event(gas.calendar)[1], due), some + 1, gas):
                return Status.STALLED.value, done
            j = -1
            t = due
            if status == Status.MEETS_LIQUID:
                i, t = next_event(gas.calendar)
                j = np.int64(gas.events[i].partner)
                status = Status.DONE
                if min(np.int64(gas.molecules[i].kind), np.int64(gas.molecules[j].kind)) >= modes.drops:
                    status, j = _merge(i, j, t, gas, drops, reservoir, modes)
                else:
                    if np.int64(gas.molecules[i].kind) >= modes.drops:
                        i, j = j, i
                    _hit(i, j, t, gas, drops, reservoir, modes)
            elif status == Status.BUSY:
                continue
            elif status == Status.DONE and due <= until:
                status, j = _emit(due, gas, drops, reservoir, modes)
            else:
                return status.value, done
            if status != Status.DONE:
                return status.value, done
            # the surface, or the rates, have changed; in one place, so that it is compiled once
            redraw(t, gas, drops, reservoir)
            call(j, t, gas)
        return Status.BUSY.value, done

    return begin, advance
