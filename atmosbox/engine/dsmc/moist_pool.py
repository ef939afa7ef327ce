"""The events of a pool in a step among many molecules.

Molecules whose flight takes them to the pool wait there for their turn. A molecule that leaves it flies for *the rest
of the step*, from wall to wall, and may be back within it. If it were put on the floor at the end of the step instead,
there would be too few slow molecules above the pool, and the gas would be too hot.
"""

import math

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.dsmc.columns import Step, cells_per_length, find_cell, number_present
from atmosbox.engine.dsmc.moist_columns import copy_slot, emit, next_rain, place, strike, touch
from atmosbox.engine.dsmc.pairing import scramble
from atmosbox.engine.dsmc.streaming import bounce
from atmosbox.engine.exact.calendar import next_event, schedule
from atmosbox.engine.liquid.reservoir import evaporation_rate, rain_out, wait

_GONE = -1.0


@kernel
def fill_holes(last, columns, left, water, rotates):
    """Move the last molecules into the holes before them; ``last`` is the slot after the last one in use.

    Examples
    --------
    The first and the third of four have left: the fourth takes the place of the first.

    >>> import numpy as np
    >>> from atmosbox.engine.dsmc.moist_columns import Water
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
    dt, ceiling, top = step.length, step.ceiling, step.top
    state[0] = scramble(~step.key)
    number = number_present(columns, water)
    counters = air.workspace.counters[air.workspace.counters.shape[0] - 1]
    rise = (top - ceiling) / dt
    per_x, per_y, per_z = cells_per_length(top, air.grid, gas, box)
    for p in range(number):
        if left[p] > 0.0:
            schedule(calendar, p, dt - left[p])
    leaves = wait(evaporation_rate(reservoir), state)
    rains = next_rain(0.0, reservoir, state)
    while True:
        p, comes = next_event(calendar)
        t = min(comes, leaves, rains)
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
        elif t == leaves:
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
            find_cell(p, per_x, per_y, per_z, columns, air.grid, gas, box)
            if left[p] > 0.0:
                schedule(calendar, p, dt - left[p])
        leaves = t + wait(evaporation_rate(reservoir), state)
        rains = next_rain(t, reservoir, state)
    fill_holes(number, columns, left, water, features.rotates)
