"""A step of free flight for many molecules at once, with all wall hits on the way.

Hardly any molecule reaches a wall within one step, so all fly without a branch, eight at a time, and mark those that
need more work because of a wall. Between smooth walls at rest that face each other flight goes on beyond the wall and
is *folded* back; only the impulse remains to be tallied. Before any other wall a molecule *waits*: it flies last,
alone, from wall to wall. Each hit happens at its exact time and place, and a molecule emitted by a heat bath flies for
*the rest of the step*. If it were emitted at the end of the step instead, there would be too few slow molecules near
the wall, and the gas would be too hot.
"""

import math

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.motion import time_to_ceiling, time_to_leave, time_to_leave_in_gravity
from atmosbox.engine.core.walls import PISTON, resolve_wall_hit
from atmosbox.engine.dsmc.columns import place_along

WAITS = 4
"""The mark of a molecule that waits. Smaller marks, 1 and 2, tell the axes along which it is folded, x, y or both."""

_MOST_HITS = 1000


@kernel
def wait_at_walls(x, v, low, high, dt, mark):
    """Mark as waiting the molecules that would leave an interval [length] within a step of dt [time].

    >>> mark = np.zeros(2, np.int32)
    >>> wait_at_walls(np.array([1.0, 1.0]), np.array([0.5, 1.5]), 0.0, 2.0, 1.0, mark)
    >>> mark
    array([0, 4], dtype=int32)
    """
    for p in range(x.size):
        ahead = x[p] + v[p] * dt
        mark[p] = mark[p] if (ahead >= low) & (ahead <= high) else np.int32(WAITS)


@kernel
def fall(z, v, dt, mark, gravity, axis, cell):
    """Move molecules up and down on their exact parabola; those that would reach floor or ceiling wait.

    A parabola is highest above its chord, so it meets the ceiling, if at all, where the straight line without
    gravity does, too; and it is lowest at its ends. ``axis.high`` is the height of the ceiling at the end of the step.
    The index along this axis, times the stride, is added to each ``cell``; for a molecule that waits it has no meaning.
    """
    gain = gravity * dt
    drop = 0.5 * gain * dt
    low, high = axis.low, axis.high
    for p in range(z.size):
        ahead = z[p] + v[p] * dt
        there = ahead - drop
        waits = (mark[p] != 0) | (there < low) | (ahead > high)
        z[p] = z[p] if waits else there
        v[p] = v[p] if waits else v[p] - gain
        mark[p] = np.int32(WAITS) if waits else np.int32(0)
        cell[p] += place_along(there, axis)


@kernel
def fold(x, v, dt, mark, sign, axis, cell):
    """Move those that do not wait uniformly between two smooth walls; one that hits a wall gets the mark ``sign``.

    A molecule so fast that it is beyond the other wall after one folding is left there, for `mirror`.

    The second molecule flies to 0.5 beyond the upper wall, and ends as far below it, in the last of four cells:

    >>> from atmosbox.engine.dsmc.columns import Axis
    >>> x, v, mark, cell = np.array([0.5, 1.5]), np.ones(2), np.zeros(2, np.int32), np.zeros(2, np.uint32)
    >>> fold(x, v, 1.0, mark, 1, Axis(0.0, 2.0, 2.0, 3, 1), cell)
    >>> x, v, mark, cell
    (array([1.5, 1.5]), array([ 1., -1.]), array([0, 1], dtype=int32), array([3, 3], dtype=uint32))
    """
    low, high = axis.low, axis.high
    for p in range(x.size):
        there = x[p] + (v[p] * dt if mark[p] < WAITS else 0.0)
        below = there < low
        above = there > high
        there = 2.0 * low - there if below else (2.0 * high - there if above else there)
        x[p] = there
        v[p] = -v[p] if below | above else v[p]
        mark[p] |= np.int32(sign) if below | above else np.int32(0)
        cell[p] += place_along(there, axis)


@kernel
def mirror(p, x, v, wall, low, high, mass, counters):
    """Tally the hit of a molecule that has been folded, and fold it again until it is inside.

    ``wall`` is the lower of the two walls; the ``counters`` are described at `bounce`.

    A molecule that would fly four widths of its box, and was folded once, hit walls four times:

    >>> x, v, counters = np.array([-2.5]), np.array([-4.0]), np.zeros((3, 6))
    >>> mirror(0, x, v, 0, 0.0, 1.0, 1.0, counters)
    >>> float(x[0]), float(v[0]), counters[2, :2]
    (0.5, 4.0, array([2., 2.]))
    """
    there, speed = x[p], v[p]
    for _ in range(_MOST_HITS):
        hit = wall if speed > 0.0 else wall + 1
        counters[0, hit] += 2.0 * mass * abs(speed)
        counters[2, hit] += 1.0
        if low <= there <= high:
            break
        there = 2.0 * (low if there < low else high) - there
        speed = -speed
    x[p], v[p] = min(max(there, low), high), speed


@kernel
def glide(x, v, dt, mark, axis, cell):
    """Move those that do not wait uniformly between walls: see `fold`."""
    low, high = axis.low, axis.high
    for p in range(x.size):
        there = min(max(x[p] + (v[p] * dt if mark[p] < WAITS else 0.0), low), high)
        x[p] = there
        cell[p] += place_along(there, axis)


@kernel
def turn_round(x, v, dt, mark, axis, cell):
    """Move those that do not wait uniformly along a periodic axis: see `fold`."""
    length = axis.high
    inverse = 1.0 / length
    for p in range(x.size):
        there = x[p] + (v[p] * dt if mark[p] < WAITS else 0.0)
        there = min(max(there - length * math.floor(there * inverse), 0.0), length)
        x[p] = there
        cell[p] += place_along(there, axis)


@kernel
def bounce(p, step, air, state, counters, features):
    """Fly a molecule through a step, or the rest of it, from wall to wall, or as far as a pool.

    At a pool ``air.workspace.left`` gets the rest of the step [time]. Outward impulse, energy given and hits are added
    to ``counters : (3, wall)``. A molecule that hits walls a thousand times in one step, as on a floor near absolute
    zero, loses the rest of that flight, but no energy.
    """
    columns, gas, box, walls = air.columns, air.gas, air.box, air.walls
    dt, ceiling = step.length, step.ceiling
    x, y, z = columns.x[p], columns.y[p], columns.z[p]
    vx, vy, vz = columns.vx[p], columns.vy[p], columns.vz[p]
    spin = columns.spin[p] if features.rotates else 0.0
    mass = gas.masses[columns.kind[p]] if features.wet else gas.mass
    rotation = gas.rotations[columns.kind[p]] if features.wet else gas.rotation
    radius = gas.radius
    high_x, high_y = box.length_x - radius, box.length_y - radius
    piston = walls.piston[1] if walls.law[5] == PISTON else 0.0
    top = ceiling + piston * dt - radius
    left = dt
    for _ in range(_MOST_HITS):
        soonest = left
        wall = -1
        # most walls are out of reach: this is found without a division
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
        if features.pool and wall == 4:
            air.workspace.left[p] = left
            break
        before = 0.5 * mass * (vx * vx + vy * vy + vz * vz) + spin
        high = wall & 1 == 1
        velocity, spin, change = resolve_wall_hit(
            wall, step.start + (dt - left), (vx, vy, vz), spin, (mass, rotation), walls, False, state
        )
        vx, vy, vz = velocity
        if wall < 2:
            x = high_x if high else radius
        elif wall < 4:
            y = high_y if high else radius
        else:
            z = ceiling + piston * (dt - left) - radius if high else radius
        counters[0, wall] += -mass * change if high else mass * change
        counters[1, wall] += 0.5 * mass * (vx * vx + vy * vy + vz * vz) + spin - before
        counters[2, wall] += 1.0
    columns.x[p] = _back_inside(x, radius, high_x, box.length_x, box.inverse_x)
    columns.y[p] = _back_inside(y, radius, high_y, box.length_y, box.inverse_y)
    columns.z[p] = _back_inside(z, radius, top, box.length_z, box.inverse_z)
    columns.vx[p], columns.vy[p], columns.vz[p] = vx, vy, vz
    if features.rotates:
        columns.spin[p] = spin


@kernel
def _back_inside(x, low, high, length, inverse):
    """Return a coordinate moved back inside if rounding has put it into a wall, or flight beyond a periodic end."""
    if inverse == 0.0:
        return min(max(x, low), high)
    return min(max(x - length * math.floor(x * inverse), 0.0), length)
