r"""The second classic scheme: discs of unequal mass in a plane; a look ahead in time tells whether a pair approaches.

Each step is Euler's: :math:`z + v \Delta t` with the old velocity, then :math:`v - g \Delta t`. A disc that
ends beyond a wall is put back onto it, and its velocity is reversed. Then all pairs are tested, in the order of
their indices. For those that overlap the distance a time :math:`\epsilon` later is computed; if it is smaller, they
approach, and both new velocities are computed from both old ones.

Cost and errors: N (N - 1) / 2 tests a step. The contact comes late, so that the collisional pressure is low by
the fraction :math:`(3/\sqrt{\pi}) \delta`, in a dilute gas, with :math:`\delta = \Delta t \sqrt{kT/m} / \sigma`; and
because relative motion is straight, the look ahead misses pairs with
:math:`-\epsilon v^2 / 2 < r \cdot v < 0`, which graze each other. Euler's fall heats each molecule by
:math:`m g^2 \Delta t / 2` per unit of time, and discs put back onto a floor gain half as much again. Discs that are put
back also lose the rest of their step: the pressure on walls a length L apart is low by
:math:`\sqrt{2/\pi} \Delta t \sqrt{kT/m} / L`. Without gravity energy is kept to rounding.
"""

from atmosbox.engine.classic.classic_tally import beyond, meet_wall, tally_contact, wrap
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.pair import nearest_along

__all__ = ["is_approaching", "march_lookahead"]


@kernel
def is_approaching(rx, rz, vx, vz, epsilon):
    """Return whether two discs will be nearer to each other a moment later than they are now.

    Parameters
    ----------
    rx, rz, vx, vz
        Position [length] and velocity [length/time] of one disc relative to the other.
    epsilon
        How far to look ahead [time].

    Examples
    --------
    A grazing pair has passed its nearest distance a moment later, and is wrongly taken for one that moves apart:

    >>> is_approaching(1.0, 0.0, -1.0, 0.0, 0.001), is_approaching(1.0, 0.0, -0.001, 2.0, 0.001)
    (True, False)
    """
    ahead_x = rx + epsilon * vx
    ahead_z = rz + epsilon * vz
    return ahead_x * ahead_x + ahead_z * ahead_z < rx * rx + rz * rz


@kernel
def _move(discs, frame, walls, tallies, score, time):
    """Move every disc by one Euler step; put a disc that ends beyond a wall back onto it."""
    x, v = discs.position, discs.velocity
    dt, gravity = frame.time_step, frame.gravity
    made = 0.0
    for i in range(discs.mass.size):
        radius = discs.radius[i]
        old, before = x[2, i], v[2, i]
        to_x = x[0, i] + v[0, i] * dt
        to_z = old + before * dt
        after = before - gravity * dt
        v[2, i] = after
        side_x = beyond(to_x, radius, frame.length[0], frame.inverse[0])
        side_z = beyond(to_z, radius, frame.length[2], frame.inverse[2])
        if side_x == 0:
            x[0, i] = wrap(to_x, frame.length[0], frame.inverse[0])
        else:
            x[0, i] = radius if side_x < 0 else frame.length[0] - radius
        if side_z == 0:
            x[2, i] = wrap(to_z, frame.length[2], frame.inverse[2])
        else:
            x[2, i] = radius if side_z < 0 else frame.length[2] - radius
        if gravity > 0.0:
            made += discs.mass[i] * (gravity * (x[2, i] - old) + 0.5 * (after * after - before * before))
        if side_x != 0:
            meet_wall(i, 0, side_x, time, discs, frame, walls, tallies)
        if side_z != 0:
            meet_wall(i, 2, side_z, time, discs, frame, walls, tallies)
    score.numerical_heat[0] += made


@kernel
def _collide(step, epsilon, discs, frame, tallies, score):
    """Give new velocities to all pairs that overlap and approach, in the order of their indices."""
    x, z = discs.position[0], discs.position[2]
    v, mass, radius = discs.velocity, discs.mass, discs.radius
    n = mass.size
    for i in range(n):
        for j in range(i + 1, n):
            rx = nearest_along(x[i] - x[j], frame.length[0], frame.inverse[0])
            rz = nearest_along(z[i] - z[j], frame.length[2], frame.inverse[2])
            touching = radius[i] + radius[j]
            square = rx * rx + rz * rz
            if square >= touching * touching:
                continue
            vx = v[0, i] - v[0, j]
            vz = v[2, i] - v[2, j]
            if is_approaching(rx, rz, vx, vz, epsilon):
                approach = rx * vx + rz * vz
                total = mass[i] + mass[j]
                change = -2.0 * mass[j] / total * approach / square
                back = -2.0 * mass[i] / total * approach / square
                v[0, i] += change * rx
                v[2, i] += change * rz
                v[0, j] -= back * rx
                v[2, j] -= back * rz
                height = z[i] - 0.5 * rz
                tally_contact((i, j), step, height, mass[i] * change * square, False, discs, tallies, score)
    score.count[0] += n * (n - 1) // 2


@kernel(entry=True)
def march_lookahead(discs, epsilon, frame, walls, tallies, score, done, steps):
    """Advance by ``steps`` steps after the first ``done``.

    Parameters
    ----------
    discs, frame, walls
        The molecules, the box and its walls.
    epsilon
        How far to look ahead [time].
    tallies, score
        The tallies.
    done, steps
        Number of steps since the start, and number of steps to make.
    """
    for step in range(done, done + steps):
        _move(discs, frame, walls, tallies, score, (step + 1) * frame.time_step)
        if frame.contacts:
            _collide(step, epsilon, discs, frame, tallies, score)
