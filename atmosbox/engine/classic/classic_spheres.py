r"""The third classic scheme: spheres in space, all pairs in the order of their indices.

Each step is Euler's: :math:`z + v \Delta t` with the old velocity, then :math:`v - g \Delta t`. A sphere that
ends beyond a wall is reflected, like light in a mirror; at a heat bath it is put onto the wall and emitted.
Then all pairs are tested. Those that overlap exchange the components of their velocities along the line of centres,
weighted by mass. They are not moved apart: they overlap until they have flown apart. Where three are in
contact, one pair is resolved after another.

A pair that still overlaps but already moves apart must be left unchanged: only closing pairs exchange. An applet that
forgets this (``closing_only=False``) makes pairs that have passed their point of closest approach between
two steps turn back towards each other. They stay together, exchanging in every step, until they have moved apart or a
third molecule separates them: the applet counts false collisions, more and more of them the longer it runs, and the
energy does not show it, because every exchange conserves it.

Cost and errors: N (N - 1) / 2 tests a step. The contact comes late, so that the collisional pressure is low
by the fraction :math:`(4/\sqrt{\pi}) \delta`, in a dilute gas, with :math:`\delta = \Delta t \sqrt{kT/m} / \sigma`;
a fraction :math:`(8/3) \delta^2` of the pairs, which graze each other, is missed. In gravity Euler's fall, and the
mirror at the floor, each heat a molecule by :math:`m g^2 \Delta t / 2` per unit of time. Without gravity energy is
kept to rounding.
"""

import numpy as np

from atmosbox.engine.classic.classic_tally import beyond, meet_wall, tally_contact, wrap
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.pair import nearest_along
from atmosbox.engine.core.walls import HEAT_BATH

__all__ = ["march_spheres", "mirror"]

_MOST_REFLECTIONS = 1000.0


@kernel
def mirror(x, low, high):
    """Return a coordinate [length] reflected between two walls as often as needed, and the number of reflections.

    Examples
    --------
    Five lengths up in a box of height two, it has been reflected at the ceiling and at the floor:

    >>> place, times = mirror(5.0, 0.0, 2.0)
    >>> float(place), float(times)
    (1.0, 2.0)
    """
    width = high - low
    if not width > 0.0:
        return low, 1.0
    times = np.floor((x - low) / width)
    rest = x - low - times * width
    odd = times - 2.0 * np.floor(0.5 * times) == 1.0
    return min(max(high - rest if odd else low + rest, low), high), abs(times)


@kernel
def _turn_round(i, discs, frame, walls, tallies, time):
    """Put a sphere back between the walls, first its position and then its velocity, axis by axis."""
    x, radius = discs.position, discs.radius[i]
    for axis in range(3):
        side = beyond(x[axis, i], radius, frame.length[axis], frame.inverse[axis])
        if side == 0 or (axis == 1 and frame.planar):
            continue
        low, high = radius, frame.length[axis] - radius
        if walls.law[2 * axis + (1 if side > 0 else 0)] == HEAT_BATH:
            x[axis, i] = low if side < 0 else high
            reflections = 1.0
        else:
            x[axis, i], reflections = mirror(x[axis, i], low, high)
        for _ in range(int(min(reflections, _MOST_REFLECTIONS))):
            meet_wall(i, axis, side, time, discs, frame, walls, tallies)
            side = -side


@kernel
def _move(discs, frame, walls, tallies, score, time):
    """Move every sphere by one Euler step; reflect it if it ends beyond a wall, or put it onto a heat bath."""
    x, v = discs.position, discs.velocity
    dt, gravity = frame.time_step, frame.gravity
    made = 0.0
    for i in range(discs.mass.size):
        radius = discs.radius[i]
        old, before = x[2, i], v[2, i]
        x[0, i] += v[0, i] * dt
        x[1, i] += v[1, i] * dt
        x[2, i] += before * dt
        v[2, i] = before - gravity * dt
        hit = False
        for axis in range(3):
            if frame.inverse[axis] > 0.0:
                x[axis, i] = wrap(x[axis, i], frame.length[axis], frame.inverse[axis])
            elif beyond(x[axis, i], radius, frame.length[axis], 0.0) != 0:
                hit = True
        fallen = v[2, i]
        if hit:
            _turn_round(i, discs, frame, walls, tallies, time)
        if gravity > 0.0:  # energy from the walls' laws is not made by the scheme
            made += discs.mass[i] * (gravity * (x[2, i] - old) + 0.5 * (fallen * fallen - before * before))
    score.numerical_heat[0] += made


@kernel
def _collide(step, closing_only, discs, frame, tallies, score):
    """Exchange velocities in all pairs that overlap, in the order of their indices."""
    x, y, z = discs.position[0], discs.position[1], discs.position[2]
    v, mass, radius = discs.velocity, discs.mass, discs.radius
    n = mass.size
    for i in range(n):
        for j in range(i + 1, n):
            rx = nearest_along(x[i] - x[j], frame.length[0], frame.inverse[0])
            ry = nearest_along(y[i] - y[j], frame.length[1], frame.inverse[1])
            rz = nearest_along(z[i] - z[j], frame.length[2], frame.inverse[2])
            touching = radius[i] + radius[j]
            square = rx * rx + ry * ry + rz * rz
            if square >= touching * touching or square == 0.0:
                continue
            along = v[0, i] * rx + v[1, i] * ry + v[2, i] * rz
            other_along = v[0, j] * rx + v[1, j] * ry + v[2, j] * rz
            parting = along >= other_along
            if parting and closing_only:
                continue
            total = mass[i] + mass[j]
            change = 2.0 * mass[j] / total * (other_along - along) / square
            back = 2.0 * mass[i] / total * (along - other_along) / square
            v[0, i] += change * rx
            v[1, i] += change * ry
            v[2, i] += change * rz
            v[0, j] += back * rx
            v[1, j] += back * ry
            v[2, j] += back * rz
            virial = mass[i] * change * square
            tally_contact((i, j), step, z[i] - 0.5 * rz, virial, parting, discs, tallies, score)
    score.count[0] += n * (n - 1) // 2


@kernel(entry=True)
def march_spheres(discs, closing_only, frame, walls, tallies, score, done, steps):
    """Advance by ``steps`` steps after the first ``done``.

    Parameters
    ----------
    discs, frame, walls
        The molecules, the box and its walls.
    closing_only
        Whether a pair that already moves apart is left unchanged.
    tallies, score
        The tallies.
    done, steps
        Number of steps since the start, and number of steps to make.
    """
    for step in range(done, done + steps):
        _move(discs, frame, walls, tallies, score, (step + 1) * frame.time_step)
        if frame.contacts:
            _collide(step, closing_only, discs, frame, tallies, score)
