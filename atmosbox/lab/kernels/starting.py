"""Draw the positions and velocities of molecules for another seed, in a page.

The kernels draw the parts of a declared start in their order, with the same random numbers as
`atmosbox.engine.start`; the engine's own kernels place the molecules and clear the places of drops.
"""

import functools
import math
from collections import namedtuple
from collections.abc import Callable
from typing import Any

import numpy as np

from atmosbox.engine.core.elementary import log_of_normal
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.lift import Gauges, ceiling_velocity
from atmosbox.engine.core.random import RUN, START, STEP, gaussian_pair, scramble, uniform
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
_FIRST_OF_RUN, _FIRST_OF_START = (
    np.uint64(0x6A09E667F3BCC909 * (2 * use + 1) & ((1 << 64) - 1)) for use in (RUN, START)
)


class Cleared(namedtuple("Cleared", "centre reach side")):
    """The drops that molecules make room for, and the side of the box: see `clear_of_drops`."""


class Start(
    namedtuple(
        "Start",
        "parts numbered scale_height speed twice weight rotating warmth condensed warm spheres bins "
        "factor mass degrees spread at layout cleared velocity key rank state",
    )
):
    """The data with which the molecules of a box are drawn and placed.

    ``parts : (part,)`` are the numbers of what is drawn, in order, and ``numbered`` is one of those in `NUMBERED`;
    ``scale_height`` is that of the air as it is placed [length], 0 if it is spread evenly. ``speed`` is the speed
    of all molecules [length/time], 0 if speeds differ. ``twice`` is twice the kinetic energy of all molecules
    [energy], ``weight`` their mass, and ``rotating`` their rotational energy [energy]; ``twice`` and ``rotating``
    are 0 if the energy stays as drawn. ``warmth`` is kT of rotation [energy], ``condensed`` the energy of the
    liquid [energy]; ``warm`` a speed of molecules that leave the warmest wall [length/time], in a box with liquid.

    ``spheres`` and ``bins`` are the arguments of the engine's functions that place molecules; ``factor :
    (molecule,)`` is sqrt(kT / m) [length/time], ``mass`` and ``degrees : (molecule,)`` are mass and rotational
    degrees of freedom. ``spread : (2,)`` is the spacing of molecules [length], and the fastest speed of the walls
    and of a fall over that spacing [length/time]. ``at`` has the data of the gas that the law of the piston needs,
    without the energy, ``layout`` the cells of a column, and ``cleared`` the drops that molecules make room for;
    each is 0 in a box without. ``velocity : (molecule, axis)``, ``key : (3 molecule + 1,)``, ``rank : (molecule,)``
    and ``state : (1,)`` are scratch.
    """


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
    """Assign a number to each molecule: sort their keys, stably, by insertion at distances that are halved (Shell)."""
    key, rank = start.key, start.rank
    for i in range(rank.size):
        rank[i], key[i] = i, i
        if start.numbered == AT_RANDOM:
            key[i] = uniform(start.state)
        elif start.numbered == ALONG_X:
            key[i] = start.spheres.x[i, 0]
    gap = rank.size // 2
    while gap > 0:
        for i in range(gap, rank.size):
            one, to = rank[i], i
            while to >= gap and (key[one], one) < (key[rank[to - gap]], rank[to - gap]):
                rank[to] = rank[to - gap]
                to -= gap
            rank[to] = one
        gap //= 2


@kernel
def _move(start, planar):
    """Draw the velocities of all molecules; without mean motion and of the prescribed energy if the start is exact."""
    v, key, factor, mass = start.velocity, start.key, start.factor, start.mass
    for k in range(0, 3 * mass.size, 2):
        key[k], key[k + 1] = gaussian_pair(start.state)
    for i in range(mass.size):
        square = 0.0
        for axis in range(3):
            v[i, axis] = 0.0 if planar and axis == 1 else key[3 * i + axis]
            square += v[i, axis] * v[i, axis]
        for axis in range(3):
            v[i, axis] = start.speed * v[i, axis] / math.sqrt(square) if start.speed > 0.0 else v[i, axis] * factor[i]
    if not start.twice > 0.0:
        return
    for axis in range(3):
        momentum = 0.0
        for i in range(mass.size):
            momentum += mass[i] * v[i, axis]
        for i in range(mass.size):
            v[i, axis] -= momentum / start.weight
            key[3 * i + axis] = mass[i] * v[i, axis] * v[i, axis]
    v *= math.sqrt(start.twice / pairwise_sum(key, 0, 3 * mass.size))


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
        energy *= start.rotating / pairwise_sum(energy, 0, energy.size)


@kernel
def kinetic_energy(gas, start):
    """Return the kinetic energy of all molecules of the gas, see `Account.energy`, and the highest of their speeds."""
    highest, number = 0.0, start.mass.size
    for i in range(number):
        molecule = gas.molecules[i]
        square = molecule.vx * molecule.vx + molecule.vy * molecule.vy + molecule.vz * molecule.vz
        highest = max(highest, square)
        start.key[i] = start.mass[i] * square
    return 0.5 * pairwise_sum(start.key, 0, number), math.sqrt(highest)


@kernel
def _write_epoch(start, book):
    """Write the length of an epoch of the clocks: 512 to 1024 times the time from a molecule to its neighbour.

    It is a power of two: see `natural_time` and `ParcelSet`.
    """
    v, squares = start.velocity, 0.0
    for axis in range(3):
        for i in range(v.shape[0]):
            start.key[i] = v[i, axis] * v[i, axis]
        squares += pairwise_sum(start.key, 0, v.shape[0])
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
    def start(gas, ascent, book, begun, seed):
        """Give all molecules the positions and velocities of a seed; return 1 if that is not possible, else 0."""
        begun.state[0] = scramble(_FIRST_OF_START ^ np.uint64(seed))
        for part in begun.parts:
            if part == PLACES:
                if not _place(begun):
                    return 1
                if modes.drops > 0:
                    clear(begun.spheres.x, begun.cleared.centre, begun.cleared.reach, begun.cleared.side, begun.state)
                _number(begun)
            elif part == VELOCITIES:
                _move(begun, gas.box.planar)
            elif modes.rotation:
                _turn(begun, gas.kinds.rotational_energy[: begun.degrees.size])
            else:  # molecules without rotation: their numbers are drawn, too
                begun.state[0] += STEP * np.uint64(begun.degrees.size)
        for i in range(begun.rank.size):
            molecule, k = gas.molecules[i], begun.rank[i]
            molecule.x = begun.spheres.x[k, 0]
            molecule.y = begun.spheres.x[k, 1]
            molecule.z = begun.spheres.x[k, 2]
            molecule.vx = begun.velocity[i, 0]
            molecule.vy = begun.velocity[i, 1]
            molecule.vz = begun.velocity[i, 2]
        gas.tallies.random[0] = scramble(_FIRST_OF_RUN ^ np.uint64(seed))
        _write_epoch(begun, book)
        kinetic, fastest = kinetic_energy(gas, begun)
        energy = kinetic
        if modes.rotation:
            energy += pairwise_sum(gas.kinds.rotational_energy, 0, begun.degrees.size)
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
            kT = 2.0 * kinetic / ((2.0 if gas.box.planar else 3.0) * gas.molecules.size)
            return 0 if write_column(kT, gas, begun.layout, modes) else 1
        return 0

    return start  # type: ignore[no-any-return]
