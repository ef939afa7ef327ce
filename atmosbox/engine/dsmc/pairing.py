"""Which molecules of a cell collide: pairs are drawn for many cells at a time, then resolved one after the other.

A processor predicts the result of a comparison and goes on. Random draws cannot be predicted, and after a wrong
prediction the work that it has begun is lost. So the number of tries of each cell is written down first, then the pair
that each try draws, in a loop without a branch; only then are the pairs resolved, their molecules having been fetched
from memory in the meantime. Random numbers are keyed by seed, step and cell: those of a cell depend neither on other
cells nor on the thread that computes it.
"""

import math
from collections import namedtuple

import numpy as np

from atmosbox.engine.core.hard_sphere import share_energy
from atmosbox.engine.core.jit import POSITIVE, kernel, prefetch
from atmosbox.engine.core.random import MIX_2, STEP, scramble, uniform

_HALF = np.uint64(32)
_LOW = np.uint64(0xFFFFFFFF)
_FRACTION = 1.0 / 4294967296.0
_HIGH, _MIDDLE, _PART, _ONE = np.uint64(43), np.uint64(22), np.uint64(21), np.uint64(1)
_MASK, _LAST = np.uint64(0x1FFFFF), np.uint64(0x3FFFFF)
_DECIDE = 1.0 / 4194304.0
_BATCH = 256  # number of tries written down before their pairs are resolved: few enough to stay in the nearest cache
_WIDE = 4  # number of them written at once, even if fewer are needed: this avoids a loop of unknown length
_AHEAD = 16  # a pair is fetched from memory this number of tries ahead
_MANY = 200_000  # this many molecules do not stay in a cache


class Tries(namedtuple("Tries", "word bar cell begin number one other")):
    """A list of tries, for each thread; each step overwrites it.

    ``word : (thread, try)``: a random word; ``bar``: the largest relative speed in its cell [length/time], later the
    squared speed above which this pair collides; ``cell``: its cell; ``begin``, ``number``: where the molecules of
    that cell begin in the index, and how many they are; ``one``, ``other``: the two slots drawn.
    """


def new_tries(threads: int) -> Tries:
    """Return an empty list for each thread, with extra memory at its end for what is fetched ahead."""
    room = (threads, _BATCH + 64)
    return Tries(np.zeros(room, np.uint64), np.zeros(room), *(np.zeros(room, np.uint32) for _ in range(5)))


@kernel
def _draw(number, thread, tries, first, order):
    """Draw the two slots of each try, and the squared speed above which they collide."""
    word, bar, cell = tries.word[thread], tries.bar[thread], tries.cell[thread]
    begin, inside = tries.begin[thread], tries.number[thread]
    one, other = tries.one[thread], tries.other[thread]
    for k in range(number):
        c = np.uint32(cell[k])
        begin[k] = first[c]
        inside[k] = first[c + np.uint32(1)] - first[c]
    for k in range(number):
        draw = scramble(word[k])
        word[k] = draw
        # one word makes three numbers: 21 bits choose a molecule, 21 the other, 22 decide
        many = np.uint64(inside[k])
        i = ((draw >> _HIGH) * many) >> _PART
        j = (((draw >> _MIDDLE) & _MASK) * (many - _ONE)) >> _PART
        j += np.uint64(j >= i)
        one[k] = np.uint64(begin[k]) + i
        other[k] = np.uint64(begin[k]) + j
        enough = np.int64(draw & _LAST) * _DECIDE * bar[k]
        bar[k] = enough * enough
    for k in range(number):
        one[k] = order[one[k]]
        other[k] = order[other[k]]


@kernel
def _fetch(columns, i):
    """Fetch from memory what a try will need; with many molecules, memory takes most of the time."""
    prefetch(columns.vx, i)
    prefetch(columns.vy, i)
    prefetch(columns.vz, i)


@kernel
def _weigh(i, j, columns, gas, mixed):
    """Return half the reduced mass of a pair [mass], and the share of each in a change of their relative velocity."""
    if mixed:
        one, other = gas.masses[columns.kind[i]], gas.masses[columns.kind[j]]
        share = other / (one + other)
        return 0.5 * one * share, share, 1.0 - share
    return 0.25 * gas.mass, 0.5, 0.5


@kernel
def _meet(number, thread, air, features):
    """Resolve the collisions of pairs that are fast enough; return their number."""
    columns, gas, fastest, exchange = air.columns, air.gas, air.grid.fastest, air.box.exchange
    tries, state = air.tries, air.workspace.random[thread]
    word, bar, cell = tries.word[thread], tries.bar[thread], tries.cell[thread]
    one, other = tries.one[thread], tries.other[thread]
    collisions = 0
    many = columns.x.size >= _MANY
    for k in range(number):
        if many:
            _fetch(columns, np.int64(one[k + _AHEAD]))
            _fetch(columns, np.int64(other[k + _AHEAD]))
        i, j = one[k], other[k]
        ux = columns.vx[i] - columns.vx[j]
        uy = columns.vy[i] - columns.vy[j]
        uz = columns.vz[i] - columns.vz[j]
        square = ux * ux + uy * uy + uz * uz
        if bar[k] >= square:
            continue
        speed = math.sqrt(square)
        c = cell[k]
        if speed > fastest[c]:
            fastest[c] = speed
        collisions += 1
        after = speed
        draw = word[k]
        weight, share, other_share = _weigh(i, j, columns, gas, features.wet)
        if features.rotates:
            state[0] = draw
            if exchange >= 1.0 or uniform(state) < exchange:
                energy = weight * speed * speed + columns.spin[i] + columns.spin[j]
                turns_i = gas.rotations[columns.kind[i]] if features.wet else gas.rotation
                turns_j = gas.rotations[columns.kind[j]] if features.wet else gas.rotation
                shared, columns.spin[i], columns.spin[j] = share_energy(energy, 3.0, turns_i, turns_j, state)
                after = math.sqrt(shared / weight)
                draw = state[0]
        # a point on the unit sphere, from one in the unit circle (Marsaglia 1972, doi:10.1214/aoms/1177692644)
        a = b = 0.0
        square = 2.0
        while square >= 1.0:
            draw = scramble(draw)
            a = (np.int64(draw >> _HALF) + 0.5) * (2.0 * _FRACTION) - 1.0
            b = (np.int64(draw & _LOW) + 0.5) * (2.0 * _FRACTION) - 1.0
            square = a * a + b * b
        around = 2.0 * after * math.sqrt(1.0 - square)
        dx = a * around - ux
        dy = b * around - uy
        dz = (1.0 - 2.0 * square) * after - uz
        columns.vx[i] += share * dx
        columns.vy[i] += share * dy
        columns.vz[i] += share * dz
        columns.vx[j] -= other_share * dx
        columns.vy[j] -= other_share * dy
        columns.vz[j] -= other_share * dz
    return collisions


@kernel
def collide(thread, sweep, key, air, features):
    """Resolve the collisions in a thread's share of the cells; count them in the working memory.

    ``sweep`` is half the cross section times the step over the volume of a cell [time/length], ``key`` a random word
    of this step.
    """
    collisions = 0
    grid, workspace, tries, order = air.grid, air.workspace, air.tries, air.columns.order
    word, bar, cell = tries.word[thread], tries.bar[thread], tries.cell[thread]
    written = 0
    for c in range(workspace.cut[thread], workspace.cut[thread + 1]):
        inside = np.int64(grid.first[c + 1]) - np.int64(grid.first[c])
        most = grid.fastest[c]
        seed = scramble(key + np.uint64(c) * MIX_2)
        left = np.int64(sweep * (inside * (inside - 1)) * most + np.int64(seed >> _HALF) * _FRACTION)
        while True:
            at = written & POSITIVE
            # one short loop per column: each becomes one store instruction
            for k in range(_WIDE):
                word[at + k] = seed + np.uint64(k) * STEP
            for k in range(_WIDE):
                bar[at + k] = most
            for k in range(_WIDE):
                cell[at + k] = c
            written += min(left, _WIDE)
            if written >= _BATCH:
                _draw(written, thread, tries, grid.first, order)
                collisions += _meet(written, thread, air, features)
                written = 0
            if left <= _WIDE:
                break
            left -= _WIDE
            seed += np.uint64(_WIDE) * STEP
    _draw(written, thread, tries, grid.first, order)
    collisions += _meet(written, thread, air, features)
    workspace.met[thread, 0] = collisions
