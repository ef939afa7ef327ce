r"""Direct simulation Monte Carlo: molecules fly freely for a step, then collide with whom chance chooses nearby.

In a dilute gas it matters only that molecules collide as often as they should, with partners from where they
are. So nobody asks who hits whom: cells, smaller than a mean free path, hold some ten molecules each, and after
every step of free flight, shorter than a mean free time, pairs are drawn within each cell [1]_. A pair with
relative speed c sweeps the volume :math:`\pi\sigma^2 c\,\Delta t` during the step, so it collides with
probability

.. math:: P = \frac{\pi \sigma^2 c\, \Delta t}{V_{cell}}.

Testing all pairs would cost the square of their number. Bird's *no time counter* [2]_ draws only

.. math:: \frac{n (n - 1)}{2} \frac{\pi \sigma^2 c_{max}\, \Delta t}{V_{cell}}

of them and accepts each with probability :math:`c / c_{max}`, which is the same. A collision keeps the
momentum and energy of its pair to rounding and turns the relative velocity to any direction, as spheres do
whose impact parameter is random. Molecules take no room: the gas is ideal.

Random numbers are keyed by seed, step and cell: no cell's depend on what happens elsewhere, and so the
run is the same for any number of threads.

References
----------
.. [1] Bird, G. A. (1994), Molecular Gas Dynamics and the Direct Simulation of Gas Flows, Oxford.
.. [2] Bird, G. A. (1989), Prog. Astronaut. Aeronaut. 118, 211, doi:10.2514/5.9781600865923.0211.0226.
"""

import functools
import math
from typing import Any

import numpy as np

from atmosbox.engine._jit import kernel, prange, prefetch
from atmosbox.engine.contact import share_energy
from atmosbox.engine.random import uniform
from atmosbox.engine.streaming import bounce, fall, glide, turn_round, wait_at_ends, wait_at_walls
from atmosbox.engine.swarm import BLOCK, index_by_cell, reserve_places, share_of

__all__ = ["scramble", "specialise"]

_STEP = np.uint64(0x9E3779B97F4A7C15)
_MIX_1 = np.uint64(0xBF58476D1CE4E5B9)
_MIX_2 = np.uint64(0x94D049BB133111EB)
_HALF = np.uint64(32)
_LOW = np.uint64(0xFFFFFFFF)
_FRACTION = 1.0 / 4294967296.0
_HIGH, _MIDDLE, _PART, _ONE = np.uint64(43), np.uint64(22), np.uint64(21), np.uint64(1)
_MASK, _LAST = np.uint64(0x1FFFFF), np.uint64(0x3FFFFF)
_DECIDE = 1.0 / 4194304.0
_TOGETHER = 64
_MANY = 200_000


@kernel
def scramble(word):
    """Return a random word that depends on another and on nothing else (see `random`).

    Examples
    --------
    >>> scramble(np.uint64(1)) == scramble(np.uint64(2))
    False
    """
    z = word + _STEP
    z = (z ^ (z >> np.uint64(30))) * _MIX_1
    z = (z ^ (z >> np.uint64(27))) * _MIX_2
    return z ^ (z >> np.uint64(31))


@kernel
def _collide_in_cell(c, first, number, sweep, word, state, swarm, fastest, gas, exchange, rotates):
    """Let pairs of one cell collide; return how many did.

    ``sweep`` is half the cross section times the step over the volume of the cell [time/length], ``word`` a random
    word of this cell and step.
    """
    most = fastest[c]
    tries = np.int64(sweep * (number * (number - 1)) * most + np.int64(word >> _HALF) * _FRACTION)
    collisions = 0
    seen = most
    order = swarm.order
    many = np.uint64(number)
    begin = np.uint64(first)
    for _ in range(tries):
        word += _STEP
        draw = scramble(word)
        # one word makes three numbers: 21 bits choose a molecule, 21 another, 22 decide
        i = ((draw >> _HIGH) * many) >> _PART
        j = (((draw >> _MIDDLE) & _MASK) * (many - _ONE)) >> _PART
        j += np.uint64(j >= i)
        i = np.uint32(order[begin + i])
        j = np.uint32(order[begin + j])
        ux = swarm.vx[i] - swarm.vx[j]
        uy = swarm.vy[i] - swarm.vy[j]
        uz = swarm.vz[i] - swarm.vz[j]
        square = ux * ux + uy * uy + uz * uz
        enough = np.int64(draw & _LAST) * _DECIDE * most
        if enough * enough >= square:
            continue
        speed = math.sqrt(square)
        seen = max(seen, speed)
        collisions += 1
        after = speed
        if rotates:
            state[0] = draw
            if exchange >= 1.0 or uniform(state) < exchange:
                energy = 0.25 * gas.mass * speed * speed + swarm.spin[i] + swarm.spin[j]
                shared, swarm.spin[i], swarm.spin[j] = share_energy(energy, 3.0, gas.rotation, gas.rotation, state)
                after = math.sqrt(4.0 * shared / gas.mass)
        # a point on the unit sphere, from one in the unit circle (Marsaglia 1972, doi:10.1214/aoms/1177692644)
        a = b = 0.0
        square = 2.0
        while square >= 1.0:
            word += _STEP
            draw = scramble(word)
            a = (np.int64(draw >> _HALF) + 0.5) * (2.0 * _FRACTION) - 1.0
            b = (np.int64(draw & _LOW) + 0.5) * (2.0 * _FRACTION) - 1.0
            square = a * a + b * b
        around = 2.0 * after * math.sqrt(1.0 - square)
        dx = 0.5 * (a * around - ux)
        dy = 0.5 * (b * around - uy)
        dz = 0.5 * ((1.0 - 2.0 * square) * after - uz)
        swarm.vx[i] += dx
        swarm.vy[i] += dy
        swarm.vz[i] += dz
        swarm.vx[j] -= dx
        swarm.vy[j] -= dy
        swarm.vz[j] -= dz
    fastest[c] = seen
    return collisions


@kernel
def _move(first, last, count, start, dt, ceiling, top, key, swarm, grid, gas, box, walls, thread, desk, rotates):
    """Move a share of the molecules, block by block, and count them by cell."""
    count[:] = 0
    flight, queue, state = desk.flight[thread], desk.queue[thread], desk.random[thread]
    r = gas.radius
    nx, ny, nz = grid.number_x, grid.number_y, grid.number_z
    high_x, high_y, high_z = box.length_x - r, box.length_y - r, top - r
    per_x = nx / (box.length_x if box.inverse_x > 0.0 else high_x - r)
    per_y = ny / (box.length_y if box.inverse_y > 0.0 else high_y - r)
    per_z = nz / (top if box.inverse_z > 0.0 else high_z - r)
    low_x = 0.0 if box.inverse_x > 0.0 else r
    low_y = 0.0 if box.inverse_y > 0.0 else r
    low_z = 0.0 if box.inverse_z > 0.0 else r
    for b in range(first, last, BLOCK):
        e = min(b + BLOCK, last)
        x, y, z, cell = swarm.x[b:e], swarm.y[b:e], swarm.z[b:e], swarm.cell[b:e]
        vx, vy, vz = swarm.vx[b:e], swarm.vy[b:e], swarm.vz[b:e]
        free = flight[: e - b]
        free[:] = dt
        cell[:] = 0
        if box.inverse_x == 0.0:
            wait_at_walls(x, vx, r, high_x, dt, free)
        if box.inverse_y == 0.0:
            wait_at_walls(y, vy, r, high_y, dt, free)
        if box.inverse_z == 0.0:
            wait_at_ends(z, vz, r, high_z, box.gravity, dt, free)
        if box.inverse_x == 0.0:
            glide(x, vx, free, r, high_x, per_x, nx - 1, 1, cell)
        else:
            turn_round(x, vx, free, box.length_x, per_x, nx - 1, 1, cell)
        if box.inverse_y == 0.0:
            glide(y, vy, free, r, high_y, per_y, ny - 1, nx, cell)
        else:
            turn_round(y, vy, free, box.length_y, per_y, ny - 1, nx, cell)
        if box.inverse_z == 0.0:
            fall(z, vz, free, r, max(ceiling, top) - r, box.gravity, per_z, nz - 1, nx * ny, cell)
        else:
            turn_round(z, vz, free, box.length_z, per_z, nz - 1, nx * ny, cell)
        waiting = 0
        for q in range(e - b):  # a list, without a branch
            queue[waiting] = q
            waiting += np.int64(free[q] == 0.0)
        books = desk.books[b // BLOCK]
        books[:] = 0.0
        for k in range(waiting):
            p = b + np.int64(queue[k])
            state[0] = scramble(key ^ (np.uint64(p) * _MIX_1))
            bounce(p, start, dt, ceiling, swarm, gas, box, walls, state, books, rotates)
            ix = min(np.int64((swarm.x[p] - low_x) * per_x), nx - 1)
            iy = min(np.int64((swarm.y[p] - low_y) * per_y), ny - 1)
            iz = min(np.int64((swarm.z[p] - low_z) * per_z), nz - 1)
            swarm.cell[p] = (iz * ny + iy) * nx + ix
        for q in range(e - b):
            count[np.uint32(cell[q])] += np.int32(1)


@kernel
def _fetch(first, last, swarm):
    """Fetch what the next cell will need: at many molecules memory is what takes the time."""
    for q in range(first, last):
        i = np.int64(swarm.order[np.uint32(q)])
        prefetch(swarm.vx, i)
        prefetch(swarm.vy, i)
        prefetch(swarm.vz, i)


@kernel
def _collide(thread, threads, cells, sweep, key, swarm, grid, gas, exchange, desk, rotates):
    """Let a share of the cells collide: every so-many-th group of cells, so that dense regions are shared, too."""
    collisions = 0
    state = desk.random[thread]
    many = swarm.x.size >= _MANY
    for c0 in range(thread * _TOGETHER, cells, threads * _TOGETHER):
        for c in range(c0, min(c0 + _TOGETHER, cells)):
            first = np.int64(grid.first[c])
            number = np.int64(grid.first[c + 1]) - first
            if many:
                _fetch(first + number, np.int64(grid.first[min(c + 2, cells)]), swarm)
            if number > 1:
                word = scramble(key + np.uint64(c) * _MIX_2)
                collisions += _collide_in_cell(
                    c, first, number, sweep, word, state, swarm, grid.fastest, gas, exchange, rotates
                )
    desk.met[thread, 0] = collisions


@kernel
def _settle(desk, tallies, threads, piston):
    """Add up what walls and contacts did, in an order that no number of threads can change."""
    for wall in range(6):
        impulse = given = hits = 0.0
        for block in range(desk.books.shape[0]):
            impulse += desk.books[block, 0, wall]
            given += desk.books[block, 1, wall]
            hits += desk.books[block, 2, wall]
        tallies.impulse[wall] += impulse
        tallies.hits[wall] += np.int64(hits)
        tallies.count[4] += np.int64(hits)
        if piston and wall == 5:
            tallies.work[wall] += given
        else:
            tallies.heat[wall] += given
    for t in range(threads):
        tallies.count[0] += desk.met[t, 0]


@functools.cache
def specialise(rotates: bool, parallel: bool) -> Any:
    """Return the kernel that marches: with or without rotation, on one thread or on several."""

    @kernel(entry=True, allocates=parallel, parallel=parallel)
    def march(first_step, steps, dt, ceilings, swarm, grid, gas, cross_section, box, walls, tallies, desk):
        """Advance by so many steps; ``ceilings : (step + 1,)`` is how high the ceiling is before and after each."""
        threads = grid.place.shape[0] if parallel else 1
        number = swarm.x.size
        cells = grid.number_x * grid.number_y * grid.number_z
        r = gas.radius
        wide_x = box.length_x - (2.0 * r if box.inverse_x == 0.0 else 0.0)
        wide_y = box.length_y - (2.0 * r if box.inverse_y == 0.0 else 0.0)
        for k in range(steps):
            start = (first_step + k) * dt
            ceiling = ceilings[k]
            top = ceilings[k + 1]
            wall_key = scramble(tallies.random[0] + np.uint64(first_step + k) * _MIX_1)
            cell_key = scramble(wall_key)
            for t in prange(threads):
                first, last = share_of(t, threads, number)
                _move(
                    first, last, grid.place[t], start, dt, ceiling, top, wall_key, swarm, grid, gas, box, walls,
                    t, desk, rotates,
                )  # fmt: skip
            reserve_places(grid, cells)
            for t in prange(threads):
                first, last = share_of(t, threads, number)
                index_by_cell(swarm.cell, swarm.order, grid.place[t], first, last)
            volume = wide_x * wide_y * (top - (2.0 * r if box.inverse_z == 0.0 else 0.0)) / cells
            sweep = 0.5 * cross_section * dt / volume
            for t in prange(threads):
                _collide(t, threads, cells, sweep, cell_key, swarm, grid, gas, box.exchange, desk, rotates)
            _settle(desk, tallies, threads, walls.law[5] == 3)

    return march
