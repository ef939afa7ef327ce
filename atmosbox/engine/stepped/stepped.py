r"""The time-stepped engine: all molecules move, then those that overlap and approach collide.

Simple programs work in this way, the applets of many courses among them. A step of length :math:`\Delta t` has two
parts: every molecule moves as if it were alone (`flight`); every pair that now overlaps, and still approaches, gets
the impulse of a collision. A collision comes late by up to one step, so the pair is nearer than it should
be, and a pair that grazes may move apart before it is found. In a dilute gas this makes, with
:math:`\delta = \Delta t \sqrt{kT/m} / \sigma`,

.. math:: \frac{Z - 1}{Z_{exact} - 1} = 1 - \frac{4}{\sqrt{\pi}} \delta, \qquad
          \frac{\nu}{\nu_{exact}} = 1 - \frac{8}{3} \delta^2

(in a plane :math:`3/\sqrt{\pi}` and 1). In a denser gas both ratios are lower by another factor, relative to these,
:math:`1 - 6.6\, \phi\, \delta` (in a plane 2.8), because molecules that overlap leave each other more room. Each
impulse conserves energy to rounding, however large the other errors: so conservation of energy says nothing about
accuracy.

The virial is computed with the actual r, overlap included. So n kT + virial / 3 V is the pressure on the walls: walls
aside, between collisions the sum of r . p changes by twice the kinetic energy alone, and at each collision by the
amount that the virial counts.

While pairs are searched, nothing moves. So all ways of finding the pairs find the same ones: testing all :math:`N (N -
1) / 2`, as applets do, or only those in nearby cells, in a time proportional to N.

The rules that can be chosen:

``PAIRWISE``
    cells; an overlapping pair that approaches, :math:`r \cdot u < 0`, exchanges the momentum along its line of centres.
``INDEX_ORDER``
    the same, but all pairs are tested, in the order of their numbers.
``LOOK_AHEAD``
    all pairs; a pair counts as approaching if it is nearer a short time :math:`\epsilon` later. This misses those that
    graze, :math:`-\epsilon u^2 / 2 < r \cdot u < 0`.
``EVERY_OVERLAP``
    cells; also a pair that already moves apart exchanges its momentum, and so turns back: a common mistake. Alone it
    parts a step later; but if a third molecule comes between, it stays together and collides in every step, the longer
    a run the more such pairs. There are then more than one and a half times as many collisions as theory says; the
    energy does not show it.

``LOOK`` only finds the deepest overlap, before the first step.
"""

import functools
import math
from collections import namedtuple
from typing import Any

from atmosbox.engine.core.hard_sphere import share_energy
from atmosbox.engine.core.jit import by_reference, kernel
from atmosbox.engine.core.pair import nearest_image, reach, resolve
from atmosbox.engine.core.random import uniform
from atmosbox.engine.core.state import Modes
from atmosbox.engine.stepped.flight import fly

RULES = ("pairwise", "index-order", "look-ahead", "every-overlap")
PAIRWISE, INDEX_ORDER, LOOK_AHEAD, EVERY_OVERLAP, LOOK = range(5)
_EPSILON = 1e-3
_MOST_TRIES = 1000


@kernel
def _sort(high, gas):
    """Sort the molecules into cells (a counting sort); the layers of cells are pressed together with the ceiling."""
    x, box, cells = gas.position, gas.box, gas.cells
    start, across, deep = cells.start, cells.number_x, cells.number_y
    along_x, along_y, along_z = across / box.length_x, deep / box.length_y, cells.number_z / high
    start[:] = 0
    for i in range(len(x)):
        a = min(max(int(x[i, 0] * along_x), 0), across - 1)
        b = min(max(int(x[i, 1] * along_y), 0), deep - 1)
        c = min(max(int(x[i, 2] * along_z), 0), cells.number_z - 1)
        cells.cell[i] = (c * deep + b) * across + a
        start[cells.cell[i] + 2] += 1
    for c in range(2, start.size):
        start[c] += start[c - 1]
    for i in range(len(x)):
        k = start[cells.cell[i] + 1]
        cells.order[k] = i
        start[cells.cell[i] + 1] = k + 1


@kernel
def _cells_within(at, reach, number, per_length, inverse):
    """Return the first and the last cell along an axis that lie within reach of a coordinate."""
    first = int((at - reach) * per_length + number) - number
    last = int((at + reach) * per_length)
    return (first, last) if inverse > 0.0 else (min(max(first, 0), number - 1), min(max(last, 0), number - 1))


@kernel
def _image(cell, number, length):
    """Return the cell of a periodic box that one beyond its end repeats, and how far away the image is."""
    if cell < 0:
        return cell + number, -length
    return (cell - number, length) if cell >= number else (cell, 0.0)


@kernel
def _search_cells(high, step, gas, modes):
    """Compare each molecule with those after it in the cells around it."""
    cells, box, position = gas.cells, gas.box, gas.position
    along_x, along_y, along_z = cells.number_x / box.length_x, cells.number_y / box.length_y, cells.number_z / high
    for p in range(cells.order.size):
        i = cells.order[p]
        x, y, z = position[i, 0], position[i, 1], position[i, 2]
        furthest = reach(gas.kinds.table[i if modes.mixed else 0].radius, cells.largest)
        low_x, high_x = _cells_within(x, furthest, cells.number_x, along_x, box.inverse_x)
        low_y, high_y = _cells_within(y, furthest, cells.number_y, along_y, box.inverse_y)
        low_z, high_z = _cells_within(z, furthest, cells.number_z, along_z, box.inverse_z)
        for c in range(low_z, high_z + 1):
            iz, shift_z = _image(c, cells.number_z, high)
            for b in range(low_y, high_y + 1):
                iy, shift_y = _image(b, cells.number_y, box.length_y)
                row = (iz * cells.number_y + iy) * cells.number_x
                a = low_x
                while a <= high_x:
                    ix, shift_x = _image(a, cells.number_x, box.length_x)
                    end = min(ix + high_x - a, cells.number_x - 1)  # up to here the cells lie one after the other
                    for k in range(max(cells.start[row + ix], p + 1), cells.start[row + end + 1]):
                        j = cells.order[k]
                        r = x - position[j, 0] - shift_x, y - position[j, 1] - shift_y, z - position[j, 2] - shift_z
                        _meet(i, j, r, step, gas, modes)
                    a += end - ix + 1


@kernel
def _search_all(step, gas, modes):
    """Compare all pairs, in the order of their numbers."""
    x = gas.position
    for i in range(len(x)):
        for j in range(i + 1, len(x)):
            r = nearest_image(x[i, 0] - x[j, 0], x[i, 1] - x[j, 1], x[i, 2] - x[j, 2], gas.box, modes)
            _meet(i, j, r, step, gas, modes)


@kernel
def _meet(i, j, r, step, gas, modes):
    """Let two molecules collide if they overlap and the rule says so.

    Where molecules rotate: a pair is found if a step ends on the first half of its path through the overlap, with the
    probability (that half) / (path in a step), at most 1. An outcome with another speed is accepted with this
    probability for its reverse. This keeps detailed balance, so that rotation and translation come to one temperature.
    """
    x, v, kinds, box, tallies = gas.position, gas.velocity, gas.kinds, gas.box, gas.tallies
    kind, other = kinds.table[i if modes.mixed else 0], kinds.table[j if modes.mixed else 0]
    rx, ry, rz = r
    apart, contact = rx * rx + ry * ry + rz * rz, reach(kind.radius, other.radius)
    if apart >= contact * contact:
        return
    if step.rule == LOOK:
        depth = 1.0 - math.sqrt(apart) / contact
        if depth > gas.deepest[0]:
            gas.deepest[0], gas.deepest[1], gas.deepest[2] = depth, min(i, j), max(i, j)
        return
    ux, uy, uz = v[i, 0] - v[j, 0], v[i, 1] - v[j, 1], v[i, 2] - v[j, 2]
    square = ux * ux + uy * uy + uz * uz
    closing = rx * ux + ry * uy + rz * uz
    ahead = 0.5 * _EPSILON * square if step.rule == LOOK_AHEAD else 0.0
    if closing == 0.0 or (closing + ahead >= 0.0 and step.rule != EVERY_OVERLAP):
        return
    dx, dy, dz = resolve(rx, ry, rz, ux, uy, uz, kind.mass, other.mass)
    if modes.rotation and (box.exchange >= 1.0 or uniform(tallies.random) < box.exchange):
        spin = kinds.rotational_energy
        relative = 0.5 * kind.mass * other.mass / (kind.mass + other.mass) * square
        half = math.sqrt(max(contact * contact - apart + closing * closing / square, 0.0))
        energy, shared = relative + spin[i] + spin[j], relative
        for _ in range(_MOST_TRIES):
            shared, spin[i], spin[j] = share_energy(
                energy, 2.0 if box.planar else 3.0, kind.rotation, other.rotation, tallies.random
            )
            if uniform(tallies.random) * step.length * math.sqrt(shared / relative * square) < half:
                break
        # the elastic contact turns the relative velocity u into u + d (1 + m_i / m_j); now its length is scaled
        share, scale = 1.0 + kind.mass / other.mass, math.sqrt(shared / relative)
        dx = (scale * (ux + share * dx) - ux) / share
        dy = (scale * (uy + share * dy) - uy) / share
        dz = (scale * (uz + share * dz) - uz) / share
    back = kind.mass / other.mass
    v[i, 0], v[i, 1], v[i, 2] = v[i, 0] + dx, v[i, 1] + dy, v[i, 2] + dz
    v[j, 0], v[j, 1], v[j, 2] = v[j, 0] - back * dx, v[j, 1] - back * dy, v[j, 2] - back * dz
    tallies.count[0] += 1
    layer = min(max(int((x[i, 2] - 0.5 * rz) * tallies.layer_scale), 0), tallies.virial.size - 1)
    tallies.virial[layer] += kind.mass * (rx * dx + ry * dy + rz * dz)


@kernel
def collide(high, step, gas, modes):
    """Let all pairs that overlap collide; ``high`` is the height of the ceiling at the end of the step [length]."""
    if step.rule == INDEX_ORDER or step.rule == LOOK_AHEAD:
        _search_all(step, gas, modes)
    else:
        _sort(high, gas)
        _search_cells(high, step, gas, modes)


class Step(namedtuple("Step", "time length ceiling ceiling_velocity motion smooth_walls rule")):
    """One step: its start and length [time], height [length] and velocity of the ceiling at its start, and the rules.

    The rules are numbers: ``motion`` for the fall and ``smooth_walls`` (`flight`), ``rule`` for pairs.
    """


class Cells(namedtuple("Cells", "number_x number_y number_z largest cell order start")):
    """The cells into which the box is divided, and the molecules sorted by cell.

    ``largest`` is the largest radius [length]; ``cell : (molecule,)`` the cell of each; cell c holds the molecules
    ``order[start[c]]`` to ``order[start[c + 1] - 1]``.
    """


class SteppedGas(namedtuple("SteppedGas", "position velocity kinds box walls tallies cells made deepest")):
    """The molecules with their box.

    ``position``, ``velocity : (molecule, axis)`` [length, length/time]; ``made : (1,)``: energy made by the scheme
    itself [energy]; ``deepest : (3,)``: the deepest overlap at the start, as a share of a diameter, and the two
    molecules. The other parts are described at their types.
    """


@functools.cache
def specialise(modes: Modes) -> Any:
    """Return the kernel that advances a gas by a number of steps, for one set of modes.

    It is called with the gas, a `Step` that has the length and the rules of all, the number of the first step, and how
    many steps to make.
    """

    @kernel(entry=True)
    def march(gas, step, first, steps):
        """Advance by a number of steps: see `specialise`."""
        gas = by_reference(gas)
        height, speed, since = gas.walls.piston
        for k in range(first, first + steps):
            t = k * step.length
            now = Step(t, step.length, height + speed * (t - since), speed, step.motion, step.smooth_walls, step.rule)
            fly(now, gas, modes)
            if modes.contacts:
                collide(now.ceiling + speed * step.length, now, gas, modes)

    return march
