r"""A step of free flight for many molecules at once, with all that walls do to them on the way.

Hardly any molecule reaches a wall within one step. So those that will are found first, and told to wait:
their time of flight is 0. The others then fly, without a branch, eight at a time. Last, those that
waited fly one by one, from wall to wall: each hit happens at its exact time and place, and what a heat bath
emits flies for *the rest of the step*. Were it emitted at the end of the step instead, slow molecules
would be too few near the wall, and the gas too hot.
"""

import math

import numpy as np

from atmosbox.engine._jit import kernel
from atmosbox.engine.motion import time_to_ceiling, time_to_leave, time_to_leave_in_gravity
from atmosbox.engine.walls import PISTON, resolve_wall_hit

__all__ = ["bounce", "fall", "glide", "turn_round", "wait_at_ends", "wait_at_walls"]

_MOST_HITS = 1000


@kernel
def wait_at_walls(x, v, low, high, dt, flight):
    """Let those wait (flight 0) that would leave the interval [length] within a step of dt [time].

    Parameters
    ----------
    x, v : (molecule,)
        Coordinates [length] and velocities [length/time].
    low, high
        The interval [length].
    dt
        Length of the step [time].
    flight : (molecule,)
        For how long each will fly unhindered [time], changed.

    Examples
    --------
    >>> flight = np.ones(2)
    >>> wait_at_walls(np.array([1.0, 1.0]), np.array([0.5, 1.5]), 0.0, 2.0, 1.0, flight)
    >>> flight
    array([1., 0.])
    """
    for p in range(x.size):
        ahead = x[p] + v[p] * dt
        flight[p] = flight[p] if (ahead >= low) & (ahead <= high) else 0.0


@kernel
def wait_at_ends(z, v, low, high, gravity, dt, flight):
    """Let those wait that would reach floor or ceiling, under gravity: see `wait_at_walls`.

    A parabola is highest above its chord, so it meets the ceiling, if at all, where the straight line without
    gravity does, too; and it is lowest at its ends. ``high`` is where the ceiling is at the end of the step.
    """
    drop = 0.5 * gravity * dt * dt
    for p in range(z.size):
        ahead = z[p] + v[p] * dt
        flight[p] = flight[p] if (ahead - drop >= low) & (ahead <= high) else 0.0


@kernel
def glide(x, v, flight, low, high, per_length, last, stride, cell):
    """Move molecules evenly between walls, and add their cell's index along this axis, times its stride."""
    most = np.int32(last)
    step = np.int32(stride)
    for p in range(x.size):
        there = min(max(x[p] + v[p] * flight[p], low), high)
        x[p] = there
        cell[p] += min(np.int32((there - low) * per_length), most) * step


@kernel
def turn_round(x, v, flight, length, per_length, last, stride, cell):
    """Move molecules evenly along a periodic axis: see `glide`."""
    most = np.int32(last)
    step = np.int32(stride)
    inverse = 1.0 / length
    for p in range(x.size):
        there = x[p] + v[p] * flight[p]
        there = min(max(there - length * math.floor(there * inverse), 0.0), length)
        x[p] = there
        cell[p] += min(np.int32(there * per_length), most) * step


@kernel
def fall(z, v, flight, low, high, gravity, per_length, last, stride, cell):
    """Move molecules up and down their exact parabola: see `glide`."""
    most = np.int32(last)
    step = np.int32(stride)
    for p in range(z.size):
        t = flight[p]
        after = v[p] - gravity * t
        there = min(max(z[p] + 0.5 * (v[p] + after) * t, low), high)
        z[p] = there
        v[p] = after
        cell[p] += min(np.int32((there - low) * per_length), most) * step


@kernel
def bounce(p, start, dt, ceiling, swarm, gas, box, walls, state, books, rotates):
    """Fly one molecule through a step from wall to wall.

    Parameters
    ----------
    p
        Its slot.
    start, dt
        Beginning and length of the step [time].
    ceiling
        Height of the ceiling at the beginning [length].
    swarm, gas, box, walls
        The molecules, what they are, their box.
    state
        State of the random numbers, moved on.
    books : (3, wall)
        Outward impulse, energy given, hits: added to.
    rotates
        Whether molecules rotate.

    Notes
    -----
    A molecule that hits walls a thousand times in one step, as on a floor near absolute zero, loses the rest of
    that flight, and no energy.
    """
    x, y, z = swarm.x[p], swarm.y[p], swarm.z[p]
    vx, vy, vz = swarm.vx[p], swarm.vy[p], swarm.vz[p]
    spin = swarm.spin[p] if rotates else 0.0
    radius = gas.radius
    high_x, high_y = box.length_x - radius, box.length_y - radius
    piston = walls.piston[1] if walls.law[5] == PISTON else 0.0
    top = ceiling + piston * dt - radius
    left = dt
    for _ in range(_MOST_HITS):
        soonest = left
        wall = -1
        # most walls are out of reach: that is seen without a division
        ahead = x + vx * left
        if box.inverse_x == 0.0 and (ahead < radius or ahead > high_x):
            t, up = time_to_leave(x, vx, radius, high_x)
            if t < soonest:
                soonest, wall = t, up
        ahead = y + vy * left
        if box.inverse_y == 0.0 and (ahead < radius or ahead > high_y):
            t, up = time_to_leave(y, vy, radius, high_y)
            if t < soonest:
                soonest, wall = t, 2 + up
        if box.inverse_z == 0.0:
            ahead = z + vz * left
            if ahead - 0.5 * box.gravity * left * left < radius:
                if box.gravity > 0.0:
                    t, _ = time_to_leave_in_gravity(z, vz, radius, math.inf, box.gravity)
                else:
                    t, _ = time_to_leave(z, vz, radius, math.inf)
                if t < soonest:
                    soonest, wall = t, 4
            if ahead > top:
                t = time_to_ceiling(ceiling + piston * (dt - left) - radius - z, vz - piston, box.gravity)
                if t < soonest:
                    soonest, wall = t, 5
        x += vx * soonest
        y += vy * soonest
        after = vz - box.gravity * soonest
        z += 0.5 * (vz + after) * soonest
        vz = after
        left -= soonest
        if wall < 0:
            break
        before = 0.5 * gas.mass * (vx * vx + vy * vy + vz * vz) + spin
        axis = wall >> 1
        high = wall & 1 == 1
        came, first, second = (vx, vy, vz) if axis == 0 else ((vy, vx, vz) if axis == 1 else (vz, vx, vy))
        went, first, second, spin = resolve_wall_hit(
            walls, wall, start + (dt - left), came, first, second, spin, gas.mass, gas.rotation, False, state
        )
        if axis == 0:
            vx, vy, vz = went, first, second
            x = high_x if high else radius
        elif axis == 1:
            vx, vy, vz = first, went, second
            y = high_y if high else radius
        else:
            vx, vy, vz = first, second, went
            z = ceiling + piston * (dt - left) - radius if high else radius
        books[0, wall] += gas.mass * (came - went) if high else gas.mass * (went - came)
        books[1, wall] += 0.5 * gas.mass * (vx * vx + vy * vy + vz * vz) + spin - before
        books[2, wall] += 1.0
    swarm.x[p] = _back_inside(x, radius, high_x, box.length_x, box.inverse_x)
    swarm.y[p] = _back_inside(y, radius, high_y, box.length_y, box.inverse_y)
    swarm.z[p] = _back_inside(z, radius, top, box.length_z, box.inverse_z)
    swarm.vx[p], swarm.vy[p], swarm.vz[p] = vx, vy, vz
    if rotates:
        swarm.spin[p] = spin


@kernel
def _back_inside(x, low, high, length, inverse):
    """Return a coordinate that rounding has put into a wall, or flight beyond a periodic end, moved back."""
    if inverse == 0.0:
        return min(max(x, low), high)
    return min(max(x - length * math.floor(x * inverse), 0.0), length)
