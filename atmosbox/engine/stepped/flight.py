r"""The first half of a step: every molecule flies as if it were alone, and meets the walls.

Two rules for the fall in gravity can be chosen, because simple programs have different ones:

``PARABOLA``
    the exact parabola, :math:`z + v \Delta t - g \Delta t^2 / 2`.
``EULER``
    with the velocity before the step, :math:`z + v \Delta t`, which heats by :math:`m g^2 \Delta t / 2` per molecule
    and unit time.

So can the rule for a smooth wall at rest, with :math:`d = \Delta t \sqrt{kT/m} / L` in a box of length L:

``MIRROR``
    reverses the velocity at the moment of the hit, as a wall does.
``FOLD``
    lets the molecule fly on, and then mirrors its position and its velocity. The pressure is exact; but in gravity the
    floor lifts the molecules that it mirrors, and heats by :math:`m g^2 \Delta t / 2` per molecule and unit time.
``FLIP``
    reverses the velocity and leaves the molecule beyond the wall, from where it comes back a step later: the pressure
    is low by the factor :math:`1 - 2 \sqrt{2/\pi}\, d`. With the parabola energy does not drift.
``CLAMP``
    reverses the velocity and puts the molecule onto the wall: the pressure is low by :math:`1 - \sqrt{2/\pi}\, d`.
``UNDO``
    reverses the velocity and puts the molecule back to its position before the step. In gravity it keeps the velocity
    that it gained in the fall, which heats by :math:`m g^2 \Delta t / 2` again.

A heat bath emits a molecule at the moment of the hit, and it flies for the rest of the step; if it waited for the next
step, the gas would be too hot. A hit on the piston, too, happens where the piston is at that moment.
"""

import math

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.motion import time_to_ceiling, time_to_leave, time_to_leave_in_gravity
from atmosbox.engine.core.walls import SPECULAR, resolve_wall_hit

MOTIONS = ("parabola", "euler")
PARABOLA, EULER = range(2)
SMOOTH_WALLS = ("mirror", "fold", "flip", "clamp", "undo")
MIRROR, FOLD, FLIP, CLAMP, UNDO = range(5)
_MOST_HITS = 200


@kernel
def _wrap(x, length, inverse):
    """Return a coordinate brought back into a periodic box [length]; ``inverse`` is 0 between walls."""
    x -= length * np.floor(x * inverse)
    return 0.0 if inverse > 0.0 and x >= length else x


@kernel
def _energy(i, gas, modes):
    """Return the kinetic, rotational and potential energy of a molecule."""
    v = gas.velocity[i]
    mass = gas.kinds.table[i if modes.mixed else 0].mass
    energy = mass * (0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + gas.box.gravity * gas.position[i, 2])
    return energy + gas.kinds.rotational_energy[i] if modes.rotation else energy


@kernel
def _next_wall(i, left, gravity, radius, step, gas, modes):
    """Return when a molecule hits the next wall that acts at the moment of the hit, and which; -1 for none."""
    x, v, box, law = gas.position[i], gas.velocity[i], gas.box, gas.walls.law
    ceiling = step.ceiling + step.ceiling_velocity * (step.length - left) - radius
    high = (box.length_x - radius, box.length_y - radius, math.inf if modes.piston else ceiling)
    inverse = (box.inverse_x, box.inverse_y, box.inverse_z)
    soonest, wall = left, -1
    for axis in range(3):
        if inverse[axis] > 0.0 or (axis == 1 and box.planar):
            continue
        t, up = time_to_leave(x[axis], v[axis], radius, high[axis])
        if axis == 2 and gravity > 0.0:
            t, up = time_to_leave_in_gravity(x[2], v[2], radius, high[2], gravity)
        if t < soonest and (step.smooth_walls == MIRROR or law[2 * axis + up] != SPECULAR):
            soonest, wall = t, 2 * axis + up
    if modes.piston:
        t = time_to_ceiling(ceiling - x[2], v[2] - step.ceiling_velocity, gravity)
        if t < soonest:
            soonest, wall = t, 5
    return soonest, wall


@kernel
def _tally(wall, impulse, gained, gas, modes):
    """Tally a hit: the change of momentum along the wall's axis, and the energy gained by the molecule."""
    tallies = gas.tallies
    tallies.hits[wall] += 1
    tallies.count[4] += 1
    tallies.impulse[wall] += impulse if wall & 1 == 0 else -impulse
    given = tallies.work if modes.piston and wall == 5 else tallies.heat
    given[wall] += gained


@kernel
def _hit(i, wall, time, gas, modes):
    """Give a molecule its velocity by the law of the wall that it hits; return the energy that it gains."""
    v, kind = gas.velocity[i], gas.kinds.table[i if modes.mixed else 0]
    spin = gas.kinds.rotational_energy[i] if modes.rotation else 0.0
    before = _energy(i, gas, modes)
    (v[0], v[1], v[2]), spin, change = resolve_wall_hit(
        wall, time, (v[0], v[1], v[2]), spin, (kind.mass, kind.rotation if modes.rotation else 0.0), gas.walls,
        gas.box.planar, gas.tallies.random,
    )  # fmt: skip
    if modes.rotation:
        gas.kinds.rotational_energy[i] = spin
    gained = _energy(i, gas, modes) - before
    _tally(wall, kind.mass * change, gained, gas, modes)
    return gained


@kernel
def _turn_back(i, old, radius, step, gas, modes):
    """Bring a molecule that ends its step beyond a smooth wall back by the rule for these walls."""
    x, v, box = gas.position[i], gas.velocity[i], gas.box
    top = step.ceiling + step.ceiling_velocity * step.length
    length = (box.length_x, box.length_y, top)
    inverse = (box.inverse_x, box.inverse_y, box.inverse_z)
    for axis in range(3):
        x[axis] = _wrap(x[axis], length[axis], inverse[axis])
        low, high = radius, length[axis] - radius
        if inverse[axis] > 0.0 or low <= x[axis] <= high:
            continue
        up = x[axis] > high
        edge, wall = (high, 2 * axis + 1) if up else (low, 2 * axis)
        rule = step.smooth_walls if gas.walls.law[wall] == SPECULAR else MIRROR
        if rule == FOLD:
            x[axis] = min(max(2.0 * edge - x[axis], low), high)
        elif rule == UNDO:
            x[axis] = old[axis]
        elif rule != FLIP:  # at MIRROR it is beyond by rounding
            x[axis] = edge
        if rule != MIRROR and (v[axis] > 0.0) == up:
            v[axis] = -v[axis]
            _tally(wall, 2.0 * gas.kinds.table[i if modes.mixed else 0].mass * v[axis], 0.0, gas, modes)


@kernel
def _fly_to_walls(i, step, gas, modes):
    """Move a molecule from wall to wall through a step; return the energy that walls did not give it."""
    x, v = gas.position[i], gas.velocity[i]
    radius = gas.kinds.table[i if modes.mixed else 0].radius
    gravity = gas.box.gravity if modes.gravity and step.motion == PARABOLA else 0.0
    old = (x[0], x[1], x[2])
    made = -_energy(i, gas, modes)
    left = step.length
    for _ in range(_MOST_HITS):
        t, wall = _next_wall(i, left, gravity, radius, step, gas, modes)
        x[0] += t * v[0]
        x[1] += t * v[1]
        x[2] += t * (v[2] - 0.5 * gravity * t)
        v[2] -= gravity * t
        left -= t
        if wall < 0:
            break
        made -= _hit(i, wall, step.time + step.length - left, gas, modes)
        # rounding must not leave it beyond the wall
        edge = (gas.box.length_x, gas.box.length_y, step.ceiling + step.ceiling_velocity * (step.length - left))
        x[wall >> 1] = edge[wall >> 1] - radius if wall & 1 == 1 else radius
    if modes.gravity and step.motion == EULER:
        v[2] -= gas.box.gravity * step.length
    _turn_back(i, old, radius, step, gas, modes)
    return made + _energy(i, gas, modes)


@kernel
def fly(step, gas, modes):
    """Move all molecules by one step; nearly all of them meet no wall."""
    x, v, box = gas.position, gas.velocity, gas.box
    dt = step.length
    gain = box.gravity * dt if modes.gravity else 0.0
    fall = 0.5 * gain * dt if step.motion == PARABOLA else 0.0
    heating = 0.5 * gain * gain if step.motion == EULER else 0.0
    # a parabola may reach the ceiling although neither of its ends does
    top = min(step.ceiling, step.ceiling + step.ceiling_velocity * dt) - 0.5 * gain * dt
    exact = not modes.gravity or (step.motion == PARABOLA and step.smooth_walls == MIRROR)
    made = 0.0
    for i in range(len(x)):
        radius = gas.kinds.table[i if modes.mixed else 0].radius
        to_x, to_y, to_z = x[i, 0] + v[i, 0] * dt, x[i, 1] + v[i, 1] * dt, x[i, 2] + v[i, 2] * dt - fall
        if modes.periodic:
            to_x, to_y = _wrap(to_x, box.length_x, box.inverse_x), _wrap(to_y, box.length_y, box.inverse_y)
            to_z = _wrap(to_z, box.length_z, box.inverse_z)
        if (
            (box.inverse_x > 0.0 or radius <= to_x <= box.length_x - radius)
            and (box.inverse_y > 0.0 or radius <= to_y <= box.length_y - radius)
            and (box.inverse_z > 0.0 or radius <= to_z <= top - radius)
        ):
            x[i, 0], x[i, 1], x[i, 2] = to_x, to_y, to_z
            v[i, 2] -= gain
            made += gas.kinds.table[i if modes.mixed else 0].mass * heating
        else:
            extra = _fly_to_walls(i, step, gas, modes)
            made += 0.0 if exact else extra
    gas.made[0] += made
