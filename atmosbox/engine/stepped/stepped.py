r"""The time-stepped engine: all molecules move, then those that overlap and approach collide.

Simple programs work in this way, the applets of many courses among them. A step of length :math:`\Delta t` has two
parts: every molecule moves as if it were alone (`flight`); every pair that now overlaps, and still approaches, gets
the impulse of a collision (`collide`). A collision comes late by up to one step, so the pair is nearer than it should
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
"""

import functools
from typing import Any, NamedTuple

from atmosbox.engine.core.jit import by_reference, kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.stepped.collide import collide
from atmosbox.engine.stepped.flight import fly

__all__ = ["Cells", "Step", "SteppedGas", "specialise"]


class Step(NamedTuple):
    """One step: its start and length [time], height [length] and velocity of the ceiling at its start, and the rules.

    The rules are numbers: ``motion`` for the fall and ``smooth_walls`` (`flight`), ``rule`` for pairs (`collide`).
    """

    time: float
    length: float
    ceiling: float
    ceiling_velocity: float
    motion: int
    smooth_walls: int
    rule: int


class Cells(NamedTuple):
    """The cells into which the box is divided, and the molecules sorted by cell.

    ``largest`` is the largest radius [length]; ``cell : (molecule,)`` the cell of each; cell c holds the molecules
    ``order[start[c]]`` to ``order[start[c + 1] - 1]``.
    """

    number_x: int
    number_y: int
    number_z: int
    largest: float
    cell: Any
    order: Any
    start: Any


class SteppedGas(NamedTuple):
    """The molecules with their box.

    ``position``, ``velocity : (molecule, axis)`` [length, length/time]; ``made : (1,)``: energy made by the scheme
    itself [energy]; ``deepest : (3,)``: the deepest overlap at the start, as a share of a diameter, and the two
    molecules. The other parts are described at their types.
    """

    position: Any
    velocity: Any
    kinds: Any
    box: Any
    walls: Any
    tallies: Any
    cells: Cells
    made: Any
    deepest: Any


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
