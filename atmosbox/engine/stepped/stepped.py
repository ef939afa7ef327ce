r"""The time-stepped engine: all molecules move, then those that overlap and approach collide.

Simple programs work in this way. A step of length :math:`\Delta t` has three parts: every molecule moves as if alone
(`flight`, `bounce`); the pairs that now overlap are found (`neighbourhood`); every pair that overlaps and still
approaches gets the impulse of a collision (`pair`). Each collision comes late by up to one step, so the pair is nearer
than it should be, and a pair that grazes may move apart before it is found. With
:math:`\delta = \Delta t \sqrt{kT/m} / \sigma` this makes, in a dilute gas,

.. math:: \frac{Z - 1}{Z_{exact} - 1} = 1 - \frac{4}{\sqrt{\pi}} \delta, \qquad
          \frac{\nu}{\nu_{exact}} = 1 - \frac{8}{3} \delta^2

(in a plane :math:`3/\sqrt{\pi}` and 1). In a denser gas both are lower still, by the factor :math:`1 - 6.6\, \phi\,
\delta` (in a plane 2.8), because molecules that overlap have more free space. Each impulse conserves energy to
rounding, however large the other errors: so conservation of energy says nothing about accuracy.

The virial is computed with the actual r, overlap included. So n kT + virial / 3 V is the pressure on the walls: walls
aside, between collisions the sum of r . p changes by twice the kinetic energy alone, and at each collision by the
amount that the virial counts.

Rotation takes part in the energy of a contact as in the exact engine, with one difference. Fast pairs are found too
rarely; so an outcome is accepted with the probability that its reverse would be found. This keeps detailed balance, and
rotation and translation at one temperature, for any step.

Notes
-----
The rare events, hits on walls and collisions, are computed one after the other in the order of the molecules in
memory, whichever thread found them; so a run has the same bits for any number of threads.
"""

import functools
import math
from typing import Any, NamedTuple

import numpy as np

from atmosbox.engine.core.compiler import prange
from atmosbox.engine.core.hard_sphere import share_energy
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.pair import nearest_image, reach, resolve
from atmosbox.engine.core.random import uniform
from atmosbox.engine.core.state import Modes
from atmosbox.engine.stepped.bounce import MIRROR, bounce
from atmosbox.engine.stepped.filing import count_up, file_molecules
from atmosbox.engine.stepped.flight import PARABOLA, SEMI_IMPLICIT, drift
from atmosbox.engine.stepped.neighbourhood import find_pairs

__all__ = ["Filed", "Rules", "State", "Step", "SteppedGas", "specialise"]

_SINGLE = 2.0**-23


class State(NamedTuple):
    """The molecules, in an order that keeps neighbours near each other in memory.

    ``position``, ``velocity : (axis, slot)`` [length, length/time], ``name : (slot,)`` index of the molecule,
    ``size : (slot,)`` its radius [length], ``cell : (slot,)`` its cell, ``hitting : (slot,)`` memory for the slots of
    those that come near a wall, ``before : (part, 2, BLOCK)`` for old coordinates of some of them (`flight`).
    """

    position: Any
    velocity: Any
    name: Any
    size: Any
    cell: Any
    hitting: Any
    before: Any


class Step(NamedTuple):
    """One step: its start and its length [time], height [length] and velocity of the ceiling then, and the rules.

    ``motion`` is the rule for the fall (`flight`), ``rule`` the rule for smooth walls (`bounce`).
    """

    time: float
    length: float
    ceiling: float
    ceiling_velocity: float
    motion: int
    rule: int


class Filed(NamedTuple):
    """The molecules sorted by cell.

    ``pairs : (part, pair, 2)`` are the slots of overlapping pairs, in the order of the records.
    """

    state: State
    records: Any
    grid: Any
    box: Any
    pairs: Any


class SteppedGas(NamedTuple):
    """The data for everything that is computed for one molecule after the other; see the types of its parts.

    ``numbers : (part, 2)``: number of pairs found, and of molecules that came near a wall; ``seen : (1,)``: number of
    overlapping pairs that were moving apart; ``made : (1,)``: energy made by the scheme itself [energy];
    ``total_mass``: mass of all molecules [mass]; ``pairs``: see `Filed`.
    """

    state: State
    kinds: Any
    box: Any
    walls: Any
    tallies: Any
    pairs: Any
    numbers: Any
    seen: Any
    made: Any
    total_mass: float


class Rules(NamedTuple):
    """The rules of a run: the length of a step [time], fall, smooth walls, and which pairs collide.

    ``motion`` is the rule for the fall (`flight`), ``rule`` the rule for smooth walls (`bounce`), ``approaching``
    whether pairs that move apart are left unchanged.
    """

    step_length: float
    motion: int
    rule: int
    approaching: bool


_MOST_TRIES = 1000
"""Largest number of draws of an outcome; only grazing pairs come near it."""


@kernel
def _meet(p, q, gas, rules, modes):
    """Resolve the collision of two molecules that overlap and approach; count those that overlap and move apart.

    A pair is found if a step ends on the first half of its path through the overlap: with the probability (that half) /
    (path in a step), at most 1. An outcome with another speed is accepted with this probability for its reverse.
    """
    state, kinds, box, tallies, seen = gas.state, gas.kinds, gas.box, gas.tallies, gas.seen
    x = state.position
    v = state.velocity
    rx, ry, rz = nearest_image(x[0, p] - x[0, q], x[1, p] - x[1, q], x[2, p] - x[2, q], box, modes)
    i = np.int64(state.name[p])
    j = np.int64(state.name[q])
    kind = kinds.table[i if modes.mixed else 0]
    other = kinds.table[j if modes.mixed else 0]
    contact = reach(kind.radius, other.radius)
    if rx * rx + ry * ry + rz * rz >= contact * contact:
        return
    ux = v[0, p] - v[0, q]
    uy = v[1, p] - v[1, q]
    uz = v[2, p] - v[2, q]
    closing = rx * ux + ry * uy + rz * uz
    if closing >= 0.0:
        seen[0] += 1
        if rules.approaching or closing == 0.0:
            return
    dx, dy, dz = resolve(rx, ry, rz, ux, uy, uz, kind.mass, other.mass)
    if modes.rotation and (box.exchange >= 1.0 or uniform(tallies.random) < box.exchange):
        spin = kinds.rotational_energy
        square = ux * ux + uy * uy + uz * uz
        relative = 0.5 * kind.mass * other.mass / (kind.mass + other.mass) * square
        energy = relative + spin[i] + spin[j]
        half = math.sqrt(max(contact * contact - rx * rx - ry * ry - rz * rz + closing * closing / square, 0.0))
        shared = relative
        for _ in range(_MOST_TRIES):
            shared, spin[i], spin[j] = share_energy(
                energy, 2.0 if box.planar else 3.0, kind.rotation, other.rotation, tallies.random
            )
            if uniform(tallies.random) * rules.step_length * math.sqrt(shared / relative * square) < half:
                break
        # the elastic contact turns the relative velocity u into u + d (1 + m_i / m_j); now its length is scaled
        share = 1.0 + kind.mass / other.mass
        scale = math.sqrt(shared / relative)
        dx = (scale * (ux + share * dx) - ux) / share
        dy = (scale * (uy + share * dy) - uy) / share
        dz = (scale * (uz + share * dz) - uz) / share
    back = kind.mass / other.mass if modes.mixed else 1.0
    v[0, p] += dx
    v[1, p] += dy
    v[2, p] += dz
    v[0, q] -= back * dx
    v[1, q] -= back * dy
    v[2, q] -= back * dz
    tallies.count[0] += 1
    layer = min(max(int((x[2, p] - 0.5 * rz) * tallies.layer_scale), 0), tallies.virial.size - 1)
    tallies.virial[layer] += kind.mass * (rx * dx + ry * dy + rz * dz)


@functools.cache
def specialise(modes: Modes, parallel: bool) -> Any:
    """Return the kernel that advances by time steps, for one set of modes, on one thread or on several.

    It is called as ``march(state, records, radius, grid, box, gas, rules, span)``. ``radius`` is that of the records,
    passed separately because the compiler knows from its type None that all are equal; ``span`` is the number of the
    first step, the number of steps, and a phase. The kernel returns the number of complete steps, and stops early if
    ``gas.pairs`` is too short; ``gas.numbers[:, 0]`` then tells the length that is needed, and the step that has begun
    is completed when the kernel is called again with phase 1. With phase 2 nothing moves and nothing collides: only
    the pairs are found.

    A parallel loop can use a tuple only if it is an argument, not part of another: so tuples are put together inside.
    """

    @kernel(entry=True, parallel=parallel)
    def march(state, records, radius, grid, box, gas, rules, span):
        """Advance by a number of steps: see `specialise`."""
        kinds, walls, pairs, numbers, made = gas.kinds, gas.walls, gas.pairs, gas.numbers, gas.made
        step_length, motion, rule = rules.step_length, rules.motion, rules.rule
        first, steps, phase = span
        molecules = state.name.size
        parts = pairs.shape[0] if parallel else 1
        crude = motion != PARABOLA or rule != MIRROR
        fall_heat = 0.0
        if motion != PARABOLA:
            fall = box.gravity * step_length
            fall_heat = 0.5 * fall * fall
            if motion == SEMI_IMPLICIT:
                fall_heat = -fall_heat
        for it in range(steps):
            time = (first + it) * step_length
            speed = walls.piston[1]
            ceiling = walls.piston[0] + speed * (time - walls.piston[2])
            length = step_length if phase != 2 else 0.0
            step = Step(time, length, ceiling, speed, motion, rule)
            top = ceiling + speed * length
            layers = max(1, min(grid.number_z, int(top / grid.thinnest)))
            if phase != 1:
                if modes.gravity and phase == 0:
                    made[0] += fall_heat * gas.total_mass
                for part in prange(parts):
                    low, high = molecules * part // parts, molecules * (part + 1) // parts
                    here = Filed(state, records, grid, box, pairs)
                    numbers[part, 1] = drift(part, low, high, step, layers, here, modes)
                for part in range(parts):
                    begin = molecules * part // parts
                    for k in range(begin, begin + numbers[part, 1]):
                        p = np.int64(state.hitting[k])
                        if phase == 0:
                            extra = bounce(p, step, gas, modes)
                            if crude:
                                mass = kinds.table[np.int64(state.name[p]) if modes.mixed else 0].mass
                                made[0] += extra - fall_heat * mass
                        x, y, z = state.position[0, p], state.position[1, p], state.position[2, p]
                        ix = min(max(int(x * grid.inverse_x), 0), grid.number_x - 1)
                        iy = min(max(int(y * grid.inverse_y), 0), grid.number_y - 1)
                        iz = min(max(int(z * (layers / top)), 0), layers - 1)
                        c = (iz * grid.number_y + iy) * grid.number_x + ix
                        state.cell[p] = c
                        records.histogram[part, c] += 1
                if modes.contacts:
                    count_up(records, grid.number_x * grid.number_y * layers, grid.number_x, molecules)
                    for part in prange(parts):
                        file_molecules(
                            state, records, radius, part, molecules * part // parts, molecules * (part + 1) // parts
                        )
            if modes.contacts:
                # single precision rounds each coordinate by up to half a unit in its last digit
                slack = 4.0 * _SINGLE * max(box.length_x, box.length_y, top)
                for part in prange(parts):
                    low, high = molecules * part // parts, molecules * (part + 1) // parts
                    here = Filed(state, records, grid, box, pairs)
                    numbers[part, 0] = find_pairs(part, low, high, layers, slack, radius, here, modes)
                for part in range(parts):
                    if numbers[part, 0] > pairs.shape[1]:
                        return it
                if phase != 2:
                    for part in range(parts):
                        for k in range(numbers[part, 0]):
                            p = np.int64(pairs[part, k, 0])
                            q = np.int64(pairs[part, k, 1])
                            _meet(p, q, gas, rules, modes)
            if phase == 1:
                phase = 0
        return steps

    return march
