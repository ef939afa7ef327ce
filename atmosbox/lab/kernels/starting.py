"""Draw the positions and velocities of molecules for another seed, in a page.

The kernels draw the parts of a declared start in their order, with the same random numbers as
`atmosbox.engine.start`; the engine's own kernels place the molecules and clear the places of drops.
"""

import functools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from atmosbox.engine.core.elementary import log_of_normal
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.lift import Gauges, ceiling_velocity
from atmosbox.engine.core.random import RUN, START, gaussian_pair, uniform
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.advance import dry_loop
from atmosbox.engine.exact.layout import write_column
from atmosbox.engine.exact.rows import LONGEST
from atmosbox.engine.liquid.moist_loop import moist_loop
from atmosbox.engine.start.overlap import clear
from atmosbox.engine.start.scatter import SERIES, crowd, scatter
from atmosbox.lab.kernels.pairwise import pairwise_sum

DRAWN = ("position", "velocity", "rotational_energy")
"""The parts of a start that are drawn; `PLACES`, `VELOCITIES`, `SPINS` are their numbers."""
PLACES, VELOCITIES, SPINS = range(3)
NUMBERED = ("as placed", "at random", "along x")
"""How molecules are numbered after they have been placed, see `Scattered`; `AT_RANDOM`, `ALONG_X` are numbers of it."""
_, AT_RANDOM, ALONG_X = range(3)
_STEP = np.uint64(0x9E3779B97F4A7C15)
_MIX_1, _MIX_2 = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)
_FIRST_OF_RUN, _FIRST_OF_START = (
    np.uint64(0x6A09E667F3BCC909 * (2 * use + 1) & ((1 << 64) - 1)) for use in (RUN, START)
)


class Cleared(NamedTuple):
    """The drops that molecules make room for, and the side of the box: see `clear_of_drops`."""

    centre: Any
    reach: Any
    side: float


class Start(NamedTuple):
    """The data with which the molecules of a box are drawn and placed.

    ``parts : (part,)`` are the numbers of what is drawn, in order, and ``numbered`` is one of those in `NUMBERED`;
    ``scale_height`` is that of the air as it is placed [length], 0 if it is spread evenly; ``planar`` 1 in a plane gas,
    else 0. ``speed`` is the speed of all molecules [length/time], 0 if speeds differ. ``twice`` is twice the kinetic
    energy of all molecules [energy], ``weight`` their mass, and ``rotating`` their rotational energy [energy];
    ``twice`` and ``rotating`` are 0 if the energy stays as drawn. ``warmth`` is kT of
    rotation [energy], ``condensed`` the energy of the liquid [energy]; ``warm`` a speed of molecules that leave the
    warmest wall [length/time], in a box with liquid.

    ``spheres`` and ``bins`` are the arguments of the engine's functions that place molecules; ``factor :
    (molecule,)`` is sqrt(kT / m) [length/time], ``mass`` and ``degrees : (molecule,)`` are mass and rotational degrees
    of freedom. ``spread : (2,)`` is the spacing of molecules [length], and the fastest speed of the walls and of a fall
    over that spacing [length/time]. ``at`` has the data of the gas that the law of the piston needs, without the
    energy, ``layout`` the cells of a column, and ``cleared`` the drops that molecules make room for; each is 0 in a box
    without. ``velocity : (molecule, axis)``, ``key : (3 molecule + 1,)``, ``rank`` and ``other : (molecule,)``,
    ``waiting``, ``partial`` and ``state : (1,)`` are scratch.
    """

    parts: Any
    numbered: int
    scale_height: float
    planar: int
    speed: float
    twice: float
    weight: float
    rotating: float
    warmth: float
    condensed: float
    warm: float
    spheres: Any
    bins: Any
    factor: Any
    mass: Any
    degrees: Any
    spread: Any
    at: Any
    layout: Any
    cleared: Any
    velocity: Any
    key: Any
    rank: Any
    other: Any
    waiting: Any
    partial: Any
    state: Any


def can_start(modes: Modes) -> bool:
    """Return whether a page can start boxes of a set of modes with another seed."""
    return modes.ascends or not modes.piston


@kernel
def _first_state(seed, first):
    """Return the first state of the random numbers of a seed below 2^64: see `random.new_state`."""
    z = (first ^ seed) + _STEP
    z = (z ^ (z >> np.uint64(30))) * _MIX_1
    z = (z ^ (z >> np.uint64(27))) * _MIX_2
    return z ^ (z >> np.uint64(31))


@kernel
def _sort(key, rank, other):
    """Sort keys and write their order, stable for equal keys: a merge sort with runs that double."""
    number = rank.size
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
def _place(start):
    """Place all molecules at random; return whether that was possible: see `random_positions`."""
    state = start.state
    first = uniform(state)
    after = state[0]
    state[0] = np.uint64(first * SERIES)
    given = start.spheres, start.bins, start.scale_height, state
    possible = scatter(*given) or crowd(*given)
    state[0] = after
    return possible


@kernel
def _number(start):
    """Assign a number to each molecule."""
    key = start.key
    for i in range(start.rank.size):
        key[i] = i
        if start.numbered == AT_RANDOM:
            key[i] = uniform(start.state)
        elif start.numbered == ALONG_X:
            key[i] = start.spheres.x[i, 0]
    _sort(key, start.rank, start.other)


@kernel
def _sum(number, start):
    """Return the sum of the first numbers of ``key``, as numpy computes it."""
    return pairwise_sum(start.key, number, start.waiting, start.partial)


@kernel
def _move(start):
    """Draw the velocities of all molecules."""
    v, key, factor = start.velocity, start.key, start.factor
    for k in range(0, 3 * v.shape[0], 2):
        key[k], key[k + 1] = gaussian_pair(start.state)
    for i in range(v.shape[0]):
        square = 0.0
        for axis in range(3):
            v[i, axis] = 0.0 if axis == 1 and start.planar != 0 else key[3 * i + axis]
            square += v[i, axis] * v[i, axis]
        for axis in range(3):
            v[i, axis] = start.speed * v[i, axis] / math.sqrt(square) if start.speed > 0.0 else v[i, axis] * factor[i]
    if start.twice > 0.0:
        _be_at_rest(start)


@kernel
def _be_at_rest(start):
    """Remove the mean motion from the velocities, and scale them to the prescribed energy."""
    v, mass = start.velocity, start.mass
    for axis in range(3):
        momentum = 0.0
        for i in range(mass.size):
            momentum += mass[i] * v[i, axis]
        for i in range(mass.size):
            v[i, axis] -= momentum / start.weight
            start.key[3 * i + axis] = mass[i] * v[i, axis] * v[i, axis]
    v *= math.sqrt(start.twice / _sum(3 * mass.size, start))


@kernel
def _turn(start, energy):
    """Draw the rotational energies of all molecules of the gas: see `rotational_energies`."""
    degrees, state = start.degrees, start.state
    for i in range(degrees.size):
        drawn = -log_of_normal(uniform(state))
        energy[i] = drawn if degrees[i] >= 2.0 else 0.0
    spare, other = False, 0.0
    for i in range(degrees.size):
        if degrees[i] % 2.0 == 1.0:
            deviate = other
            if not spare:
                deviate, other = gaussian_pair(state)
            spare = not spare
            energy[i] += 0.5 * deviate * deviate
        energy[i] *= start.warmth
    if start.rotating > 0.0:
        energy *= start.rotating / _rotational_energy(start, energy)


@kernel
def _rotational_energy(start, energy):
    """Return the sum of the rotational energies of all molecules of the gas."""
    for i in range(energy.size):
        start.key[i] = energy[i]
    return _sum(energy.size, start)


@kernel
def _kinetic_energy(start):
    """Return the kinetic energy of all molecules, see `Account.energy`, and the highest of their speeds."""
    v, highest = start.velocity, 0.0
    for i in range(v.shape[0]):
        square = v[i, 0] * v[i, 0] + v[i, 1] * v[i, 1] + v[i, 2] * v[i, 2]
        highest = max(highest, square)
        start.key[i] = start.mass[i] * square
    return 0.5 * _sum(v.shape[0], start), math.sqrt(highest)


@kernel
def _write_epoch(start, book):
    """Write the length of an epoch of the clocks: 512 to 1024 times the time from a molecule to its neighbour.

    It is a power of two: see `natural_time` and `ParcelSet`.
    """
    v, squares = start.velocity, 0.0
    for axis in range(3):
        for i in range(v.shape[0]):
            start.key[i] = v[i, axis] * v[i, axis]
        squares += _sum(v.shape[0], start)
    time = start.spread[0] / max(math.sqrt(squares / v.shape[0]), start.spread[1])
    power = 1.0
    while power > time:
        power *= 0.5
    while 2.0 * power <= time:
        power *= 2.0
    book.epoch_length[0] = 1024.0 * power


@functools.cache
def starting(modes: Modes, *, wells: bool = False) -> Callable[..., Any]:
    """Return the kernel ``start`` for a set of modes; ``wells`` if molecules attract each other."""
    _, _, wake = (moist_loop if modes.phases else dry_loop)(modes)

    @kernel
    def draw(gas, begun):
        """Draw positions, velocities and rotational energies in their order; return whether there is room."""
        for part in begun.parts:
            if part == PLACES:
                if not _place(begun):
                    return False
                if modes.drops > 0:
                    clear(begun.spheres.x, begun.cleared.centre, begun.cleared.reach, begun.cleared.side, begun.state)
                _number(begun)
            elif part == VELOCITIES:
                _move(begun)
            elif modes.rotation:
                _turn(begun, gas.kinds.rotational_energy[: begun.degrees.size])
            else:  # molecules without rotation: their numbers are drawn, too
                begun.state[0] += _STEP * np.uint64(begun.degrees.size)
        return True

    @kernel
    def start(gas, ascent, book, begun, seed):
        """Give all molecules the positions and velocities of a seed; return whether that was possible."""
        word = np.uint64(seed)
        begun.state[0] = _first_state(word, _FIRST_OF_START)
        if not draw(gas, begun):
            return 1
        for i in range(begun.rank.size):
            molecule, k = gas.molecules[i], begun.rank[i]
            molecule.x = begun.spheres.x[k, 0]
            molecule.y = begun.spheres.x[k, 1]
            molecule.z = begun.spheres.x[k, 2]
            molecule.vx = begun.velocity[i, 0]
            molecule.vy = begun.velocity[i, 1]
            molecule.vz = begun.velocity[i, 2]
        gas.tallies.random[0] = _first_state(word, _FIRST_OF_RUN)
        _write_epoch(begun, book)
        kinetic, fastest = _kinetic_energy(begun)
        energy = kinetic
        if modes.rotation:
            energy += _rotational_energy(begun, gas.kinds.rotational_energy[: begun.degrees.size])
        book.energy[0] = energy + begun.condensed
        if modes.ascends:  # the first velocity of the piston
            a, energy = begun.at, book.energy[0] - begun.condensed
            at = Gauges(a.time, a.number, a.freedom, a.dimensions, energy, a.virial, a.density, a.open_height)
            gas.walls.piston[1] = ceiling_velocity(at, ascent.lift)
        if modes.phases:  # the first event of the liquid
            book.moisture.reservoir.bound[0] = 0.0
            # in a loop, so that it is compiled once: for the molecules, and again for a piston that may be faster
            for speed in (max(fastest, begun.warm), 2.0 * abs(gas.walls.piston[1])):
                wake(gas, book, speed)
        if wells:
            gas.bath.clock[0] = math.inf  # `place` draws it
            return 0
        gas.cells.copies.epoch[LONGEST] = book.epoch_length[0]
        if modes.gravity and modes.rows:
            kT = 2.0 * kinetic / ((2.0 if begun.planar != 0 else 3.0) * gas.molecules.size)
            return 0 if write_column(kT, gas, begun.layout, modes) else 1
        return 0

    return start  # type: ignore[no-any-return]
