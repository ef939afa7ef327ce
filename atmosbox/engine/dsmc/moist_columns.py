r"""The events of liquid in a step among many molecules: of a mist, and of a pool.

All molecules have flown, and those that came to a pool wait on it. Then the events of the liquid are computed *one by
one* in the order of their times within the step: a molecule meets it, one leaves it, one rains out. If all molecules
that meet it were treated first, in the order of the list, many would condense before one could leave, and the liquid
would be too warm. Each clock is a Poisson process, so it has no memory and its time may be drawn again whenever the
liquid has changed.

In an ideal gas a molecule of speed w relative to the air meets the **mist** at the rate :math:`A w / 4 V`. The time is
drawn for the largest speed of all, and a meeting is accepted with a probability proportional to the speed. A molecule
that leaves the gas leaves a hole in the columns, which the last molecule fills.

Molecules whose flight takes them to the **pool** wait there for their turn. A molecule that leaves it flies for *the
rest of the step*, from wall to wall, and may be back within it. If it were put on the floor at the end of the step
instead, there would be too few slow molecules above the pool, and the gas would be too hot.
"""

import math
from collections import namedtuple

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.random import scramble, uniform
from atmosbox.engine.dsmc.columns import Step, axes_of, find_cell, number_present
from atmosbox.engine.dsmc.streaming import bounce
from atmosbox.engine.exact.calendar import new_calendar, next_event, schedule
from atmosbox.engine.liquid.reservoir import (
    AIR_MET,
    LEAVES,
    RAINS,
    THERMAL,
    Reservoir,
    condense,
    direction,
    emitted,
    exchange,
    rain_out,
    renew,
    stays,
    wait,
)

_GONE = -1.0


class Water(namedtuple("Water", "reservoir calendar hole holes random")):
    """The liquid in a box of many molecules.

    ``reservoir``: its molecules and energy; ``calendar``: the times at which molecules waiting on a pool came to it;
    ``hole : (slot,)``: the slots of molecules that left the gas in this step, ``holes[0]`` of them; ``random : (1,)``:
    a state of random numbers.
    """


def new_water(reservoir: Reservoir, waiting: int) -> Water:
    """Return the data of a liquid in a box where at most ``waiting`` molecules can wait on a pool."""
    return Water(
        reservoir, new_calendar(waiting), np.zeros(waiting, np.int64), np.zeros(1, np.int64), np.zeros(1, np.uint64)
    )


@kernel
def copy_slot(source, p, columns, rotates):
    """Copy the molecule of one slot to another."""
    columns.x[p], columns.y[p], columns.z[p] = columns.x[source], columns.y[source], columns.z[source]
    columns.vx[p], columns.vy[p], columns.vz[p] = columns.vx[source], columns.vy[source], columns.vz[source]
    if rotates:
        columns.spin[p] = columns.spin[source]
    columns.identity[p] = columns.identity[source]
    columns.kind[p] = columns.kind[source]
    columns.cell[p] = columns.cell[source]


@kernel
def strike(p, columns, reservoir):
    """Mark the molecule of a slot as absent from the box."""
    reservoir.absent[reservoir.top[0]] = columns.identity[p]
    reservoir.top[0] += 1


@kernel
def touch(p, flow, air, features):
    """Resolve a meeting of a molecule with the liquid, which flows upwards with the air; return whether it stays there.

    If not, it leaves the liquid with another energy.
    """
    columns, gas, reservoir, state = air.columns, air.gas, air.water.reservoir, air.water.random
    kind = np.int64(columns.kind[p])
    mass = gas.masses[kind]
    vx, vy, vz = columns.vx[p], columns.vy[p], columns.vz[p]
    spin = columns.spin[p] if features.rotates else 0.0
    energy = 0.5 * mass * (vx * vx + vy * vy + vz * vz) + spin
    if kind == reservoir.kind and stays(reservoir, state):
        condense(reservoir, energy)
        return True
    relative = energy - 0.5 * mass * (vz * vz - (vz - flow) * (vz - flow))
    flight, new_spin = exchange(reservoir, relative, gas.rotations[kind], state)
    ex, ey, ez = direction(features.pool, state)
    speed = math.sqrt(2.0 * flight / mass)
    wx, wy, wz = speed * ex, speed * ey, speed * ez + flow
    given = 0.5 * mass * (wx * wx + wy * wy + wz * wz) + new_spin - energy
    if reservoir.energy[THERMAL] - given >= 0.0:
        reservoir.energy[THERMAL] -= given
        reservoir.count[AIR_MET] += 1
        columns.vx[p], columns.vy[p], columns.vz[p] = wx, wy, wz
        if features.rotates:
            columns.spin[p] = new_spin
    elif features.pool:
        columns.vz[p] = -vz
    return False


@kernel
def emit(p, where, flow, air, features):
    """Move a molecule from the liquid to a place (x, y, z) [length] in the gas, into a free slot."""
    columns, gas, reservoir, state = air.columns, air.gas, air.water.reservoir, air.water.random
    velocity, spin, _ = emitted(gas.masses[reservoir.kind], flow, features.pool, reservoir, state)
    columns.x[p], columns.y[p], columns.z[p] = where
    columns.vx[p], columns.vy[p], columns.vz[p] = velocity
    if features.rotates:
        columns.spin[p] = spin
    columns.kind[p] = reservoir.kind
    reservoir.top[0] -= 1
    columns.identity[p] = reservoir.absent[reservoir.top[0]]


@kernel
def place(radius, length, inverse, state):
    """Draw a coordinate that a centre can have along an axis."""
    margin = radius if inverse == 0.0 else 0.0
    return margin + (length - 2.0 * margin) * uniform(state)


@kernel
def _fastest(number, columns):
    """Return the highest speed of all molecules [length/time]; four maxima side by side are faster than one."""
    a = b = c = d = 0.0
    vx, vy, vz = columns.vx, columns.vy, columns.vz
    whole = number - number % 4
    for p in range(0, whole, 4):
        a = max(a, vx[p] * vx[p] + vy[p] * vy[p] + vz[p] * vz[p])
        b = max(b, vx[p + 1] * vx[p + 1] + vy[p + 1] * vy[p + 1] + vz[p + 1] * vz[p + 1])
        c = max(c, vx[p + 2] * vx[p + 2] + vy[p + 2] * vy[p + 2] + vz[p + 2] * vz[p + 2])
        d = max(d, vx[p + 3] * vx[p + 3] + vy[p + 3] * vy[p + 3] + vz[p + 3] * vz[p + 3])
    for p in range(whole, number):
        a = max(a, vx[p] * vx[p] + vy[p] * vy[p] + vz[p] * vz[p])
    return math.sqrt(max(a, b, c, d))


@kernel(entry=True)
def mist_step(step, air, features):
    """Resolve the events of a mist, which moves with the air, in a step."""
    columns, gas, box, water = air.columns, air.gas, air.box, air.water
    reservoir, state, clock = water.reservoir, water.random, water.reservoir.clock
    dt, ceiling, top = step.length, step.ceiling, step.top
    state[0] = scramble(~step.key)
    number = number_present(columns, water)
    r = gas.radius
    axes = axes_of(top, air.grid, gas, box)
    volume = box.length_x - (2.0 * r if box.inverse_x == 0.0 else 0.0)
    volume *= box.length_y - (2.0 * r if box.inverse_y == 0.0 else 0.0)
    volume *= 0.5 * (ceiling + top) - (2.0 * r if box.inverse_z == 0.0 else 0.0)
    often = reservoir.area / (4.0 * volume)
    rise = (top - ceiling) / dt
    bound = _fastest(number, columns) + abs(rise)
    meets = wait(number * often * bound, state)
    renew(0.0, state, reservoir)
    while True:
        t = min(meets, clock[LEAVES], clock[RAINS])
        if t > dt:
            break
        if t == meets:
            p = min(np.int64(uniform(state) * number), number - 1)
            flow = rise * columns.z[p] / top
            vx, vy, vz = columns.vx[p], columns.vy[p], columns.vz[p] - flow
            enough = uniform(state) * bound
            if enough * enough >= vx * vx + vy * vy + vz * vz:
                meets = t + wait(number * often * bound, state)
                continue
            if touch(p, flow, air, features):
                number -= 1
                strike(p, columns, reservoir)
                copy_slot(number, p, columns, features.rotates)
            else:
                vx, vy, vz = columns.vx[p], columns.vy[p], columns.vz[p] - flow
                bound = max(bound, math.sqrt(vx * vx + vy * vy + vz * vz))
        elif t == clock[LEAVES]:
            p = number
            x = place(r, box.length_x, box.inverse_x, state)
            y = place(r, box.length_y, box.inverse_y, state)
            z = place(r, top, box.inverse_z, state)
            flow = rise * z / top
            emit(p, (x, y, z), flow, air, features)
            find_cell(p, axes, columns)
            number += 1
            vx, vy, vz = columns.vx[p], columns.vy[p], columns.vz[p] - flow
            bound = max(bound, math.sqrt(vx * vx + vy * vy + vz * vz))
        else:
            rain_out(reservoir)
        meets = t + wait(number * often * bound, state)
        renew(t, state, reservoir)


@kernel
def fill_holes(last, columns, left, water, rotates):
    """Move the last molecules into the holes before them; ``last`` is the slot after the last one in use.

    The first and the third of four have left: the fourth takes the place of the first.

    >>> import numpy as np
    >>> from atmosbox.engine.dsmc.columns import Columns
    >>> columns = Columns(*(np.arange(4.0) for _ in range(7)), *(np.arange(4) for _ in range(4)))
    >>> left, gone = np.array([-1.0, 0.0, -1.0, 0.0]), (np.array([0, 2]), np.array([2]))
    >>> fill_holes(4, columns, left, Water(None, None, *gone, None), True)
    >>> columns.x[:2], left
    (array([3., 1.]), array([0., 0., 0., 0.]))
    """
    for k in range(water.holes[0]):
        while last > 0 and left[last - 1] == _GONE:
            last -= 1
            left[last] = 0.0
        p = water.hole[k]
        if p < last:
            last -= 1
            copy_slot(last, p, columns, rotates)
            left[p] = 0.0
    water.holes[0] = 0


@kernel(entry=True)
def pool_step(step, air, features):
    """Resolve the events of a pool on the floor in a step, with the molecules that wait on it."""
    columns, gas, box, water = air.columns, air.gas, air.box, air.water
    reservoir, state, calendar, left = water.reservoir, water.random, water.calendar, air.workspace.left
    dt, ceiling, top, clock = step.length, step.ceiling, step.top, reservoir.clock
    state[0] = scramble(~step.key)
    number = number_present(columns, water)
    counters = air.workspace.counters[air.workspace.counters.shape[0] - 1]
    rise = (top - ceiling) / dt
    axes = axes_of(top, air.grid, gas, box)
    for p in range(number):
        if left[p] > 0.0:
            schedule(calendar, p, dt - left[p])
    renew(0.0, state, reservoir)
    while True:
        p, comes = next_event(calendar)
        t = min(comes, clock[LEAVES], clock[RAINS])
        if t > dt:
            break
        flies = False
        if t == comes:
            schedule(calendar, p, math.inf)
            left[p] = 0.0
            mass = gas.masses[columns.kind[p]]
            counters[0, 4] -= mass * columns.vz[p]
            counters[2, 4] += 1.0
            flies = not touch(p, 0.0, air, features)
            if not flies:
                strike(p, columns, reservoir)
                left[p] = _GONE
                water.hole[water.holes[0]] = p
                water.holes[0] += 1
        elif t == clock[LEAVES]:
            flies = True
            p = number
            if water.holes[0] > 0:
                water.holes[0] -= 1
                p = water.hole[water.holes[0]]
            else:
                number += 1
            left[p] = 0.0
            x = place(gas.radius, box.length_x, box.inverse_x, state)
            y = place(gas.radius, box.length_y, box.inverse_y, state)
            emit(p, (x, y, gas.radius), 0.0, air, features)
        else:
            rain_out(reservoir)
        if flies:
            counters[0, 4] += gas.masses[columns.kind[p]] * columns.vz[p]
            rest = Step(step.start + t, dt - t, ceiling + rise * t, top, step.key)
            bounce(p, rest, air, state, counters, features)
            find_cell(p, axes, columns)
            if left[p] > 0.0:
                schedule(calendar, p, dt - left[p])
        renew(t, state, reservoir)
    fill_holes(number, columns, left, water, features.rotates)
