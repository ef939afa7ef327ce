r"""Direct simulation Monte Carlo: molecules fly freely for a step, then collide with random partners nearby.

In a dilute gas it matters only that molecules collide at the right rate, with partners near them. So this method does
not compute which molecules hit each other. The box is divided into cells, smaller than a mean free path, with some ten
molecules each. After every step of free flight, shorter than a mean free time, pairs are drawn at random within each
cell [1]_. During a step one molecule of a pair with relative speed c sweeps the volume :math:`\pi\sigma^2 c\,\Delta t`,
so the pair collides with the probability

.. math:: P = \frac{\pi \sigma^2 c\, \Delta t}{V_{cell}}.

Testing all pairs would cost the square of their number. Bird's *no time counter* [2]_ draws only

.. math:: \frac{n (n - 1)}{2} \frac{\pi \sigma^2 c_{max}\, \Delta t}{V_{cell}}

of them, with a speed :math:`c_{max}` that hardly any pair exceeds (it is raised when one does), and accepts each with
probability :math:`c / c_{max}`, which gives the same rates. A collision conserves the momentum and energy of its pair
and gives the relative velocity a random direction, as for spheres that meet off centre at random. Molecules have no
excluded volume: the gas is ideal.

The random numbers of a cell follow only from seed, step and cell, not from those of other cells. So a run is the same
for any number of threads.

References
----------
.. [1] Bird, G. A. (1994), Molecular Gas Dynamics and the Direct Simulation of Gas Flows, Oxford.
.. [2] Bird, G. A. (1989), Prog. Astronaut. Aeronaut. 118, 211, doi:10.2514/5.9781600865923.0211.0226.
"""

import functools
from collections.abc import Sequence
from typing import Any

import numpy as np

from atmosbox.engine.core.compiler import prange
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.random import MIX_1, scramble
from atmosbox.engine.core.refusal import RefusedError
from atmosbox.engine.core.walls import PISTON, SPECULAR
from atmosbox.engine.dsmc.columns import (
    BLOCK,
    Air,
    Features,
    Step,
    axes_of,
    count_by_cell,
    find_cell,
    index_by_cell,
    number_present,
    reserve_places,
    share_cells,
    share_of,
)
from atmosbox.engine.dsmc.moist_columns import mist_step, pool_step
from atmosbox.engine.dsmc.pairing import collide
from atmosbox.engine.dsmc.streaming import WAITS, bounce, fall, fold, glide, mirror, turn_round, wait_at_walls

_SHARED = 8  # number of steps after which cells are shared again among threads; results do not depend on it


def numbers_of_cells(number: int, sides: Sequence[float], edge: float, asked: str) -> tuple[int, int, int]:
    """Return the number of cells with about this edge [length] along each side [length] of a box.

    Cells so small that hardly any molecules would share one are refused; the message repeats what was ``asked`` for.
    """
    x, y, z = (max(1.0, float(np.rint(side / edge))) for side in sides)
    if x * y * z > max(number, 1000) * 10.0:
        raise RefusedError(
            f"{asked} leaves {number / (x * y * z):.2g} molecules to a cell in so thin or so long a box: "
            "make the cells larger, give more molecules, or a box of more equal sides"
        )
    return int(x), int(y), int(z)


@kernel
def _move(thread, first, last, count, step, air, features):
    """Move a share of the molecules, block by block, and count them by cell."""
    count[:] = 0
    columns, grid, gas, box, workspace = air.columns, air.grid, air.gas, air.box, air.workspace
    law, dt = air.walls.law, step.length
    queue, state = workspace.queue[thread], workspace.random[thread]
    axes = axes_of(step.top, grid, gas, box)
    along_x, along_y, along_z = axes
    smooth_x = law[0] == SPECULAR and law[1] == SPECULAR
    smooth_y = law[2] == SPECULAR and law[3] == SPECULAR
    # a block of molecules at a time, so that its data stay in the cache of the processor
    for b in range(first, last, BLOCK):
        e = min(b + BLOCK, last)
        x, y, z, cell = columns.x[b:e], columns.y[b:e], columns.z[b:e], columns.cell[b:e]
        vx, vy, vz = columns.vx[b:e], columns.vy[b:e], columns.vz[b:e]
        mark = workspace.mark[thread, : e - b]
        mark[:] = 0
        cell[:] = 0
        # a molecule that will hit a wall waits for `bounce` (smooth sides reflect it at once). Those at the sides are
        # found first, because `fall` tests floor and ceiling, and moves the others
        if box.inverse_x == 0.0 and not smooth_x:
            wait_at_walls(x, vx, along_x.low, along_x.high, dt, mark)
        if box.inverse_y == 0.0 and not smooth_y:
            wait_at_walls(y, vy, along_y.low, along_y.high, dt, mark)
        if box.inverse_z == 0.0:
            fall(z, vz, dt, mark, box.gravity, along_z, cell)
        else:
            turn_round(z, vz, dt, mark, along_z, cell)
        # smooth sides reflect at once (`fold`); between others those that do not wait fly on (`glide`); on a periodic
        # axis a molecule that leaves comes back on the other side (`turn_round`)
        if smooth_x:
            fold(x, vx, dt, mark, 1, along_x, cell)
        elif box.inverse_x == 0.0:
            glide(x, vx, dt, mark, along_x, cell)
        else:
            turn_round(x, vx, dt, mark, along_x, cell)
        if smooth_y:
            fold(y, vy, dt, mark, 2, along_y, cell)
        elif box.inverse_y == 0.0:
            glide(y, vy, dt, mark, along_y, cell)
        else:
            turn_round(y, vy, dt, mark, along_y, cell)
        marked = np.uint32(0)
        # few molecules are marked: those that hit a wall in this step, or wait at one, are treated one by one
        # (mark 1: reflected along x, 2: along y, 4: waits)
        for q in range(e - b):  # the next number overwrites one that is not marked: faster than a condition
            queue[marked] = q
            marked += np.uint32(mark[q] != 0)
        counters = workspace.counters[b // BLOCK]
        counters[:] = 0.0
        for k in range(marked):
            q = np.int64(queue[k])
            p = b + q
            if mark[q] >= WAITS:
                state[0] = scramble(step.key ^ (np.uint64(p) * MIX_1))
                bounce(p, step, air, state, counters, features)
            mass = gas.masses[columns.kind[p]] if features.wet else gas.mass
            if mark[q] & 1:
                mirror(p, columns.x, columns.vx, 0, along_x.low, along_x.high, mass, counters)
            if mark[q] & 2:
                mirror(p, columns.y, columns.vy, 2, along_y.low, along_y.high, mass, counters)
            find_cell(p, axes, columns)
        for q in range(e - b):
            count[np.uint32(cell[q])] += np.uint32(1)


@kernel
def _settle(workspace, tallies, threads, piston):
    """Add the counts of walls and contacts to the tallies, in an order that is the same for any number of threads."""
    for wall in range(6):
        impulse = given = hits = 0.0
        for block in range(workspace.counters.shape[0]):
            impulse += workspace.counters[block, 0, wall]
            given += workspace.counters[block, 1, wall]
            hits += workspace.counters[block, 2, wall]
        tallies.impulse[wall] += impulse
        tallies.hits[wall] += np.int64(hits)
        tallies.count[4] += np.int64(hits)
        if piston and wall == 5:
            tallies.work[wall] += given
        else:
            tallies.heat[wall] += given
    for t in range(threads):
        tallies.count[0] += workspace.met[t, 0]


@functools.cache
def specialise(rotates: bool, parallel: bool, wet: bool = False, pool: bool = False) -> Any:
    """Return the kernel that advances by time steps.

    In a ``wet`` box there is liquid, so that there are several kinds of molecules, which enter and leave the gas; with
    a ``pool`` the floor is the surface of the liquid.
    """
    features = Features(rotates, wet, pool)

    @kernel(entry=True, allocates=parallel, parallel=parallel)
    def march(columns, grid, gas, box, walls, workspace, tries, run):
        """Advance by some steps; ``run`` is a `March`.

        Each step: fly, let water evaporate and condense, sort the molecules into cells, collide. (A parallel loop of
        numba can use only tuples that are arguments, so `Air` is made inside each loop.)
        """
        tallies, water, dt, ceilings = run.tallies, run.water, run.length, run.ceilings
        threads = grid.place.shape[0] if parallel else 1
        number = columns.x.size
        cells = grid.number_x * grid.number_y * grid.number_z
        r = gas.radius
        wide_x = box.length_x - (2.0 * r if box.inverse_x == 0.0 else 0.0)
        wide_y = box.length_y - (2.0 * r if box.inverse_y == 0.0 else 0.0)
        for k in range(run.steps):
            start = (run.first + k) * dt
            top = ceilings[k + 1]
            wall_key = scramble(tallies.random[0] + np.uint64(run.first + k) * MIX_1)
            cell_key = scramble(wall_key)
            if wet:
                number = number_present(columns, water)
                workspace.counters[(number + BLOCK - 1) // BLOCK :] = 0.0
            step = Step(start, dt, ceilings[k], top, wall_key)
            # free flight, with the walls
            for t in prange(threads):
                first, last = share_of(t, threads, number)
                here = Air(columns, grid, gas, box, walls, workspace, tries, None)
                _move(t, first, last, grid.place[t], step, here, features)
            if wet:
                air = Air(columns, grid, gas, box, walls, workspace, tries, water)
                among = Step(start, dt, ceilings[k], top, cell_key)
                if pool:
                    pool_step(among, air, features)
                else:
                    mist_step(among, air, features)
                number = number_present(columns, water)
                for t in prange(threads):
                    first, last = share_of(t, threads, number)
                    count_by_cell(columns.cell, grid.place[t], first, last)
            # sort: the places of the molecules in the columns, in the order of their cells; a cell begins at `first`
            #
            #   cell       0        1      2
            #   order    0 5 8  |  3 7  |  1 ...
            #   first    0         3       5
            reserve_places(grid, cells)
            if parallel and k % _SHARED == 0:
                share_cells(grid.first, cells, workspace.cut)
            for t in prange(threads):
                first, last = share_of(t, threads, number)
                index_by_cell(columns.cell, columns.order, grid.place[t], first, last)
            # collide: the volume of a cell is the part that centres can reach
            volume = wide_x * wide_y * (top - (2.0 * r if box.inverse_z == 0.0 else 0.0)) / cells
            # `sweep` times n (n - 1) and the largest relative speed is the number of pairs to draw in a cell
            sweep = 0.5 * run.cross_section * dt / volume
            for t in prange(threads):
                here = Air(columns, grid, gas, box, walls, workspace, tries, None)
                collide(t, sweep, cell_key, here, features)
            _settle(workspace, tallies, threads, walls.law[5] == PISTON)

    return march
