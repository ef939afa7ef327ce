r"""A step of a molecule that comes near walls: it flies from hit to hit.

A heat bath emits a molecule at the moment of the hit, and it flies for the rest of the step; if it waited
for the next step, the gas would be too hot. A hit on the piston also happens where the piston is at that moment. The
rule for a smooth wall at rest can be chosen, because simple programs have different rules:

``MIRROR``
    reverses the velocity at the moment of the hit, as a wall does.
``FOLD``
    lets the molecule fly on and then mirrors its position and velocity. Without gravity that is the same; with it, the
    floor lifts the molecules that it mirrors and so makes energy, :math:`m g^2 \Delta t / 2` per molecule and time.
``FLIP``
    reverses the velocity and leaves the molecule beyond the wall, from where it comes back a step later.
``CLAMP``
    reverses the velocity and puts the molecule on the wall.
``REWIND``
    reverses the velocity and puts the molecule back to its position at the start of the step.
"""

import math

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.motion import time_to_ceiling, time_to_leave, time_to_leave_in_gravity
from atmosbox.engine.core.walls import SPECULAR, resolve_wall_hit
from atmosbox.engine.stepped.flight import EULER, PARABOLA, SEMI_IMPLICIT

__all__ = ["CLAMP", "FLIP", "FOLD", "MIRROR", "REWIND", "bounce"]

MIRROR, FOLD, FLIP, CLAMP, REWIND = 0, 1, 2, 3, 4
_BOUNCES = 200


@kernel
def _next_wall(at, left, gravity, radius, step, gas, modes):
    """Return when a molecule hits the next wall that acts at the moment of the hit, and which; -1 for none."""
    x, y, z, vx, vy, vz = at
    box, walls = gas.box, gas.walls
    crude = step.rule != MIRROR
    soonest = left
    wall = -1
    if box.inverse_x == 0.0:
        t, high = time_to_leave(x, vx, radius, box.length_x - radius)
        if t < soonest and not (crude and walls.law[high] == SPECULAR):
            soonest = t
            wall = 0 + high
    if box.inverse_y == 0.0 and not box.planar:
        t, high = time_to_leave(y, vy, radius, box.length_y - radius)
        if t < soonest and not (crude and walls.law[2 + high] == SPECULAR):
            soonest = t
            wall = 2 + high
    if box.inverse_z == 0.0:
        top = step.ceiling + step.ceiling_velocity * (step.length - left) - radius
        if gravity > 0.0:
            t, high = time_to_leave_in_gravity(z, vz, radius, math.inf if modes.piston else top, gravity)
        else:
            t, high = time_to_leave(z, vz, radius, math.inf if modes.piston else top)
        if t < soonest and not (crude and walls.law[4 + high] == SPECULAR):
            soonest = t
            wall = 4 + high
        if modes.piston:
            t = time_to_ceiling(top - z, vz - step.ceiling_velocity, gravity)
            if t < soonest:
                soonest = t
                wall = 5
    return soonest, wall


@kernel
def _book(wall, impulse, gained, tallies, modes):
    """Tally a hit: the change of momentum along the wall's axis, and the energy gained by the molecule."""
    tallies.hits[wall] += 1
    tallies.count[4] += 1
    tallies.impulse[wall] += impulse if wall & 1 == 0 else -impulse
    if modes.piston and wall == 5:
        tallies.work[wall] += gained
    else:
        tallies.heat[wall] += gained


@kernel
def _end_along(now, before, axis, low, high, turn, step, walls):
    """Return position and velocity along one axis at the end of the step, and the smooth wall that was hit, or -1.

    ``now``, ``before`` are pairs of position and velocity, ``turn`` is the side of the box and its inverse, 0 unless
    the axis is periodic.
    """
    x, v = now
    old_x, old_v = before
    side, inverse = turn
    if inverse > 0.0:
        x -= side * np.floor(x * inverse)
        return (0.0 if x >= side else x), v, -1
    if low <= x <= high:
        return x, v, -1
    up = x > high
    edge = high if up else low
    wall = 2 * axis + (1 if up else 0)
    if step.rule == MIRROR or walls.law[wall] != SPECULAR:  # beyond by rounding
        return edge, v, -1
    if step.rule == FLIP and (v < 0.0 if up else v > 0.0):  # on its way back
        return x, v, -1
    if step.rule == FOLD:
        x = min(max(2.0 * edge - x, low), high)
    elif step.rule == CLAMP:
        x = edge
    elif step.rule == REWIND:
        x = old_x
        v = old_v
    return x, (-abs(v) if up else abs(v)), wall


@kernel
def bounce(p, step, gas, modes):
    """Move a molecule through a step in which it comes near walls, and tally its hits.

    Parameters
    ----------
    p
        Slot of the molecule.
    step, gas, modes
        The step, the data of the engine, and the flags of the scene: see `atmosbox.engine.stepped.stepped`.

    Returns
    -------
    float
        Energy made by the scheme itself [energy]: the energy gained by the molecule minus that given by walls.
    """
    state, kinds, box, walls, tallies = gas.state, gas.kinds, gas.box, gas.walls, gas.tallies
    i = np.int64(state.name[p])
    kind = kinds.table[i if modes.mixed else 0]
    mass = kind.mass
    radius = kind.radius
    rotation = kind.rotation if modes.rotation else 0.0
    spin = kinds.rotational_energy[i] if modes.rotation else 0.0
    gravity = box.gravity if modes.gravity and step.motion == PARABOLA else 0.0
    old_x, old_y, old_z = state.position[0, p], state.position[1, p], state.position[2, p]
    old_vx, old_vy, old_vz = state.velocity[0, p], state.velocity[1, p], state.velocity[2, p]
    x, y, z, vx, vy, vz = old_x, old_y, old_z, old_vx, old_vy, old_vz
    weight = mass * box.gravity if modes.gravity else 0.0
    made = -0.5 * mass * (vx * vx + vy * vy + vz * vz) - spin - weight * z
    if modes.gravity and step.motion == SEMI_IMPLICIT:
        vz -= box.gravity * step.length
    left = step.length
    for _ in range(_BOUNCES):
        t, wall = _next_wall((x, y, z, vx, vy, vz), left, gravity, radius, step, gas, modes)
        x += t * vx
        y += t * vy
        z += t * (vz - 0.5 * gravity * t)
        vz -= gravity * t
        left -= t
        if wall < 0:
            break
        before = 0.5 * mass * (vx * vx + vy * vy + vz * vz) + spin
        now = step.time + step.length - left
        high = wall & 1 == 1
        velocity, spin, change = resolve_wall_hit(
            wall, now, (vx, vy, vz), spin, (mass, rotation), walls, box.planar, tallies.random
        )
        vx, vy, vz = velocity
        if wall < 2:
            x = box.length_x - radius if high else radius
        elif wall < 4:
            y = box.length_y - radius if high else radius
        else:
            z = step.ceiling + step.ceiling_velocity * (step.length - left) - radius if high else radius
        gained = 0.5 * mass * (vx * vx + vy * vy + vz * vz) + spin - before
        made -= gained
        _book(wall, mass * change, gained, tallies, modes)
    if modes.gravity and step.motion == EULER:
        vz -= box.gravity * step.length
    came_x, came_y, came_z = vx, vy, vz
    x, vx, wall_x = _end_along(
        (x, vx), (old_x, old_vx), 0, radius, box.length_x - radius, (box.length_x, box.inverse_x), step, walls
    )  # fmt: skip
    y, vy, wall_y = _end_along(
        (y, vy), (old_y, old_vy), 1, radius, box.length_y - radius, (box.length_y, box.inverse_y), step, walls
    )  # fmt: skip
    top = step.ceiling + step.ceiling_velocity * step.length - radius
    z, vz, wall_z = _end_along(
        (z, vz), (old_z, old_vz), 2, radius, top, (box.length_z, box.inverse_z), step, walls
    )  # fmt: skip
    if wall_x >= 0:
        _book(wall_x, mass * (vx - came_x), 0.0, tallies, modes)
    if wall_y >= 0:
        _book(wall_y, mass * (vy - came_y), 0.0, tallies, modes)
    if wall_z >= 0:
        _book(wall_z, mass * (vz - came_z), 0.0, tallies, modes)
    state.position[0, p], state.position[1, p], state.position[2, p] = x, y, z
    state.velocity[0, p], state.velocity[1, p], state.velocity[2, p] = vx, vy, vz
    if modes.rotation:
        kinds.rotational_energy[i] = spin
    return made + 0.5 * mass * (vx * vx + vy * vy + vz * vz) + spin + weight * z
