r"""The first classic scheme: equal discs in a plane, sorted into strips one diameter wide.

In each step every disc falls with the mean of its velocities before and after, :math:`z + (v + v') \Delta t / 2`,
which is the exact parabola. A move that ends beyond a wall is undone along that axis, and the velocity is reversed.
Then the discs are sorted into upright strips, and each is tested against those of its own strip and of the next: a
pair that overlaps, :math:`d^2 < \sigma^2`, and approaches, :math:`r \cdot v > 0`, exchanges the components of its
velocities along the line of centres.

Errors: the contact comes late, so that the collisional pressure is low by the fraction :math:`(3/\sqrt{\pi}) \delta`,
in a dilute gas, with :math:`\delta = \Delta t \sqrt{kT/m} / \sigma`; a fraction :math:`\delta^2` of the pairs, which
graze each other between two steps, is missed. An undone move restores the height but not the velocity before the
fall: on a floor this heats each molecule by :math:`m g^2 \Delta t / 2` per unit of time. Without gravity energy
is kept to rounding.
"""

import math
from typing import Any, NamedTuple

from atmosbox.engine.classic.classic_tally import beyond, meet_wall, tally_contact, wrap
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.pair import nearest_along

__all__ = ["Strips", "march_strips", "strips_across"]


class Strips(NamedTuple):
    """The discs sorted into strips along x.

    ``order : (molecule,)``: indices strip by strip, in increasing order within each; ``first : (strip + 1,)``: where
    each strip starts in it; ``strip : (molecule,)``: the strip of each disc; ``number``: number of strips, 0 for discs
    without size, which never meet; ``per_length``: strips per length [1/length].
    """

    order: Any
    first: Any
    strip: Any
    number: int
    per_length: float


def strips_across(width: float, diameter: float, molecules: int, periodic: bool) -> int:
    """Return the number of strips, none narrower than a diameter, into which a box is cut.

    Parameters
    ----------
    width, diameter
        Width of the box along x, and diameter of a disc [length].
    molecules
        Number of discs: more than four strips for each would only cost time.
    periodic
        Whether the last strip is a neighbour of the first; that takes at least three.

    Examples
    --------
    >>> strips_across(148.5, 1.0, 3000, periodic=False)
    148
    """
    if not diameter > 0.0:
        return 0
    most = 4 * molecules + 1
    ratio = width / diameter * (1.0 - 1e-12)  # so that rounding makes no strip narrower than a diameter
    number = most if ratio > most else max(1, math.floor(ratio))
    return 1 if periodic and number < 3 else number


@kernel
def _fall(discs, frame, walls, tallies, score, time):
    """Move every disc by one step, with the mean of its velocities; undo a move that ends beyond a wall."""
    x, v = discs.position, discs.velocity
    dt, gravity = frame.time_step, frame.gravity
    made = 0.0
    for i in range(discs.mass.size):
        before = v[2, i]
        after = before - gravity * dt
        to_x = x[0, i] + v[0, i] * dt
        to_z = x[2, i] + 0.5 * (before + after) * dt
        v[2, i] = after
        side_x = beyond(to_x, discs.radius[i], frame.length[0], frame.inverse[0])
        side_z = beyond(to_z, discs.radius[i], frame.length[2], frame.inverse[2])
        if side_x == 0:
            x[0, i] = wrap(to_x, frame.length[0], frame.inverse[0])
        if side_z == 0:
            x[2, i] = wrap(to_z, frame.length[2], frame.inverse[2])
        elif gravity > 0.0:  # the height is restored, the velocity gained in the fall is kept
            made += 0.5 * discs.mass[i] * (after * after - before * before)
        if side_x != 0:
            meet_wall(i, 0, side_x, time, discs, frame, walls, tallies)
        if side_z != 0:
            meet_wall(i, 2, side_z, time, discs, frame, walls, tallies)
    score.numerical_heat[0] += made


@kernel
def _sort(discs, strips):
    """Sort the discs into strips, by index within a strip."""
    x, first = discs.position, strips.first
    first[:] = 0
    for i in range(discs.mass.size):
        strip = min(max(int(x[0, i] * strips.per_length), 0), strips.number - 1)
        strips.strip[i] = strip
        first[strip + 1] += 1
    for strip in range(strips.number):
        first[strip + 1] += first[strip]
    for i in range(discs.mass.size):
        strip = strips.strip[i]
        strips.order[first[strip]] = i
        first[strip] += 1
    for strip in range(strips.number, 0, -1):
        first[strip] = first[strip - 1]
    first[0] = 0


@kernel
def _test(i, places, step, discs, strips, frame, tallies, score):
    """Test a disc against those at some places of the order, first and end; exchange if they overlap and approach."""
    begin, end = places
    x, z, v = discs.position[0], discs.position[2], discs.velocity
    diameter = 2.0 * discs.radius[i]
    for q in range(begin, end):
        j = strips.order[q]
        rx = nearest_along(x[j] - x[i], frame.length[0], frame.inverse[0])
        rz = nearest_along(z[j] - z[i], frame.length[2], frame.inverse[2])
        square = rx * rx + rz * rz
        if square < diameter * diameter and rx * (v[0, i] - v[0, j]) + rz * (v[2, i] - v[2, j]) > 0.0:
            distance = math.sqrt(square)
            nx, nz = rx / distance, rz / distance
            change = (v[0, j] - v[0, i]) * nx + (v[2, j] - v[2, i]) * nz
            v[0, i] += change * nx
            v[2, i] += change * nz
            v[0, j] -= change * nx
            v[2, j] -= change * nz
            virial = -discs.mass[i] * change * distance
            tally_contact((i, j), step, z[i] + 0.5 * rz, virial, False, discs, tallies, score)
    score.count[0] += end - begin


@kernel
def _exchange(step, discs, strips, frame, tallies, score):
    """Exchange velocities in all pairs that overlap and approach: within each strip, and with the next one."""
    for strip in range(strips.number):
        begin, end = strips.first[strip], strips.first[strip + 1]
        following = strip + 1
        if following == strips.number and frame.inverse[0] > 0.0 and strips.number > 1:
            following = 0
        for p in range(begin, end):
            i = strips.order[p]
            _test(i, (p + 1, end), step, discs, strips, frame, tallies, score)
            if following < strips.number:
                beside = strips.first[following], strips.first[following + 1]
                _test(i, beside, step, discs, strips, frame, tallies, score)


@kernel(entry=True)
def march_strips(discs, strips, frame, walls, tallies, score, done, steps):
    """Advance by ``steps`` steps after the first ``done``.

    Parameters
    ----------
    discs, strips, frame, walls
        The molecules, the strips they are sorted into, the box and its walls.
    tallies, score
        The tallies.
    done, steps
        Number of steps since the start, and number of steps to make.
    """
    for step in range(done, done + steps):
        _fall(discs, frame, walls, tallies, score, (step + 1) * frame.time_step)
        if frame.contacts:
            _sort(discs, strips)
            _exchange(step, discs, strips, frame, tallies, score)
