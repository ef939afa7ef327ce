"""Where molecules stand and how fast they are at the start of another seed, in a page.

It draws and places as the functions of `atmosbox.engine.start` do, in the same order and with the same numbers; what
pushes overlapping molecules apart is the engine's own kernel. `start_recipe` tells how a scene uses these functions.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.random import RUN, START, gaussian_pair, uniform
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.rows import LONGEST, STOP, TOP_SPEED
from atmosbox.engine.exact.rows import START as BEGUN
from atmosbox.engine.start import overlap

__all__ = ["ALONG_X", "AS_PLACED", "PATIENCE", "SHUFFLED", "STEP", "Start", "can_start", "start", "start_in_cells"]

AS_PLACED, SHUFFLED, ALONG_X = range(3)
"""How molecules that have been placed are numbered: as they were, in random order, or from left to right."""
PATIENCE, _ROUNDS, _GAP = 100, 8, 1e-6
STEP = 0x9E3779B97F4A7C15
"""What the state of the random numbers grows by with each."""
_STEP = np.uint64(STEP)
_MIX_1, _MIX_2 = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)
_FIRST_OF_RUN, _FIRST_OF_START = (
    np.uint64(0x6A09E667F3BCC909 * (2 * use + 1) & ((1 << 64) - 1)) for use in (RUN, START)
)
_push = kernel(getattr(overlap._push, "py_func", overlap._push))


class Start(NamedTuple):
    """How the molecules of a box are drawn and placed.

    ``place``, ``order``, ``motion`` after how many random numbers those of each begin; ``numbered`` one of `AS_PLACED`,
    `SHUFFLED`, `ALONG_X`; ``speed`` that all molecules have [length/time], 0 where speeds differ. ``spheres`` and
    ``bins`` are what the engine pushes apart; ``factor : (molecule,)`` is sqrt(kT / m) [length/time], ``spread : (2,)``
    how far molecules are from each other [length], and the fastest speed of the walls [length/time]. ``velocity :
    (molecule, axis)``, ``key``, ``rank`` and ``other : (molecule,)`` and ``state : (1,)`` are scratch.
    """

    place: int
    order: int
    motion: int
    numbered: int
    speed: float
    spheres: Any
    bins: Any
    factor: Any
    spread: Any
    velocity: Any
    key: Any
    rank: Any
    other: Any
    state: Any


def can_start(modes: Modes) -> bool:
    """Tell whether boxes of a set of modes can be begun in the page: cells and piston must not follow the energy."""
    return not (modes.gravity or modes.piston or modes.phases)


@kernel
def _first_state(seed, first):
    """Return the first state of the random numbers of a seed below 2^64: see `random.new_state`."""
    z = (first ^ seed) + _STEP
    z = (z ^ (z >> np.uint64(30))) * _MIX_1
    z = (z ^ (z >> np.uint64(27))) * _MIX_2
    return z ^ (z >> np.uint64(31))


@kernel
def _skip(seed, number, state):
    """Let the random numbers of a start go on after so many."""
    state[0] = _first_state(seed, _FIRST_OF_START) + _STEP * np.uint64(number)


@kernel
def _sort(key, rank, other):
    """Write down in which order keys rise, of equal ones the first first: runs that double are merged."""
    number = key.size
    for k in range(number):
        rank[k] = k
    width = 1
    while width < number:
        for low in range(0, number, 2 * width):
            middle, high = min(low + width, number), min(low + 2 * width, number)
            a, b = low, middle
            for k in range(low, high):
                if b >= high or (a < middle and key[rank[a]] <= key[rank[b]]):
                    other[k] = rank[a]
                    a += 1
                else:
                    other[k] = rank[b]
                    b += 1
        for k in range(number):
            rank[k] = other[k]
        width *= 2


@kernel
def _place(seed, start):
    """Place all molecules at random and push apart those that overlap; tell whether that was possible."""
    spheres, state = start.spheres, start.state
    x, low, high = spheres.x, spheres.low, spheres.high
    _skip(seed, start.place, state)
    for i in range(x.shape[0]):
        for axis in range(3):
            x[i, axis] = low[i, axis] + uniform(state) * (high[i, axis] - low[i, axis])
    for _ in range(PATIENCE):
        spheres.moved[:] = True
        if _push(spheres, start.bins, _ROUNDS, _GAP) == 0:
            return True
    return False


@kernel
def _number(seed, start):
    """Decide which number each molecule has."""
    key, rank = start.key, start.rank
    for i in range(rank.size):
        rank[i] = i
    if start.numbered == AS_PLACED:
        return
    _skip(seed, start.order, start.state)
    for i in range(key.size):
        key[i] = uniform(start.state) if start.numbered == SHUFFLED else start.spheres.x[i, 0]
    _sort(key, rank, start.other)


@kernel
def _move(seed, start):
    """Draw the velocities of all molecules."""
    state, v, factor = start.state, start.velocity, start.factor
    _skip(seed, start.motion, state)
    number = 3 * v.shape[0]
    for k in range(0, number, 2):
        one, two = gaussian_pair(state)
        v[k // 3, k % 3] = one
        if k + 1 < number:
            v[(k + 1) // 3, (k + 1) % 3] = two
    for i in range(v.shape[0]):
        size = 0.0
        if start.speed > 0.0:
            size = math.sqrt(v[i, 0] * v[i, 0] + v[i, 1] * v[i, 1] + v[i, 2] * v[i, 2])
        for axis in range(3):
            v[i, axis] = start.speed * v[i, axis] / size if start.speed > 0.0 else v[i, axis] * factor[i]


@kernel
def start(gas, book, begun, seed):
    """Place and move all molecules as the start of a seed does; tell whether that was possible."""
    word = np.uint64(seed)
    if not _place(word, begun):
        return 1
    _number(word, begun)
    _move(word, begun)
    squares = 0.0
    for i in range(gas.molecules.size):
        molecule, k = gas.molecules[i], begun.rank[i]
        molecule.x = begun.spheres.x[k, 0]
        molecule.y = begun.spheres.x[k, 1]
        molecule.z = begun.spheres.x[k, 2]
        molecule.vx = begun.velocity[i, 0]
        molecule.vy = begun.velocity[i, 1]
        molecule.vz = begun.velocity[i, 2]
        squares += molecule.vx * molecule.vx + molecule.vy * molecule.vy + molecule.vz * molecule.vz
    gas.tallies.random[0] = _first_state(word, _FIRST_OF_RUN)
    # the largest power of two within the time in which a molecule passes its neighbour's place: see `natural_time`
    spread = begun.spread[0] / max(math.sqrt(squares / gas.molecules.size), begun.spread[1])
    power = 1.0
    while power > spread:
        power *= 0.5
    while 2.0 * power <= spread:
        power *= 2.0
    book.epoch_length[0] = 1024.0 * power
    return 0


@kernel
def start_in_cells(gas, book, begun, seed):
    """Do the same where molecules are entered in cells, whose copies of them are to be written anew."""
    failed = start(gas, book, begun, seed)
    epoch = gas.cells.copies.epoch
    epoch[BEGUN] = 0.0
    epoch[STOP] = math.inf
    epoch[TOP_SPEED] = 0.0
    epoch[LONGEST] = book.epoch_length[0]
    return failed
