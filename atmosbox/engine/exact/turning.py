"""The piston of a parcel that follows a pressure gets new velocities between events, inside compiled code.

A parcel on its ascent sets the velocity of its piston thousands of times. What the law of `lift` needs to know of the
gas is computed from the tallies here, and the next move of all molecules that may meet the ceiling is predicted again.
"""

import math
from collections import namedtuple
from enum import IntEnum

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.lift import Gauges, ceiling_velocity
from atmosbox.engine.exact.encounter import motion_at, size_and_radius, slots_of
from atmosbox.engine.exact.prediction import CEILING, limits, plan_move

LOWEST, HIGHEST = 0.6, 1.5
"""Lowest and highest ceiling, relative to its height when the cells were laid out; beyond, they are laid out again."""


class Ascent(namedtuple("Ascent", "lift turns filled lowest start_energy gravity_work freedom diameter")):
    """The data that the kernels need for a piston that follows a pressure.

    ``lift``: the law; ``turns : (1,)``: how often the velocity of the piston has been set; ``filled``: the height for
    which the cells were laid out, ``lowest``: how low the ceiling may come [length]; the energy at the start, and the
    energy from changes of gravity [energy]; degrees of freedom of a molecule of dry air, and the diameter of all
    [length].
    """


class Next(IntEnum):
    """What ends an interval of constant piston velocity: the time asked for, the next setting, or too low a ceiling."""

    END = 0
    TURN = 1
    CRUSHED = 2


@kernel
def ahead(until, gas, ascent):
    """Return when the velocity of the piston must next be set, or ``until`` if that is earlier [time]; and a `Next`."""
    piston = gas.walls.piston
    stop = until
    what = Next.END
    asked = (ascent.turns[0] + 1) * ascent.lift.interval - gas.walls.epoch[0]
    if asked <= stop:
        stop = asked
        what = Next.TURN
    if piston[1] < 0.0:
        crushed = piston[2] + (piston[0] - ascent.lowest) / -piston[1]
        if crushed < stop:
            stop = crushed
            what = Next.CRUSHED
    return stop, what


@kernel
def gauges(t, number, freedom, condensed, gas, ascent):
    """Return the `Gauges` of a gas at time t; ``condensed`` is the energy of the liquid [energy]."""
    box, tallies, piston = gas.box, gas.tallies, gas.walls.piston
    open_height = piston[0] + piston[1] * (t - piston[2]) - ascent.diameter
    share = box.length_x - (ascent.diameter if box.inverse_x == 0.0 else 0.0)
    if not box.planar:
        share *= box.length_y - (ascent.diameter if box.inverse_y == 0.0 else 0.0)
    share *= open_height
    given = virial = 0.0
    for wall in range(6):
        given += tallies.heat[wall]
    for wall in range(6):
        given += tallies.work[wall]
    for layer in range(tallies.virial.size):
        virial += tallies.virial[layer]
    return Gauges(
        gas.walls.epoch[0] + t,
        number,
        freedom,
        2.0 if box.planar else 3.0,
        ascent.start_energy + (given + ascent.gravity_work) - condensed,
        virial,
        number / share if number > 0 else 0.0,
        open_height,
    )


@kernel
def replan_under(lowest, now, gas, modes):
    """Predict again, at time ``now``, the next moves of all molecules that may meet the ceiling, or were to meet it.

    A molecule whose slot ends below ``lowest``, the lowest height of the ceiling until it is set again, is skipped.
    """
    for i in range(gas.molecules.size):
        if modes.phases and math.isinf(gas.molecules[i].clock):
            continue
        size, radius = size_and_radius(i, gas, modes)
        slots = slots_of(i, gas)
        top = limits(slots[2], 2, size, radius, gas, modes)[1]
        if top >= lowest - radius or np.int64(gas.events[i].what) == CEILING:
            plan_move(i, slots, now, motion_at(i, now, gas, modes), size, radius, gas, modes)


@kernel
def turn(t, at, gas, ascent, modes):
    """Set the velocity of the piston at time t for the gauges ``at``; return whether the cells still fit the box."""
    piston = gas.walls.piston
    velocity = ceiling_velocity(at, ascent.lift)
    ceiling = piston[0] + piston[1] * (t - piston[2])
    piston[0], piston[1], piston[2] = ceiling, velocity, t
    ascent.turns[0] += 1
    if ceiling > HIGHEST * ascent.filled or ceiling < LOWEST * ascent.filled:
        return False
    lowest = ceiling + (velocity * ascent.lift.interval if velocity < 0.0 else 0.0)
    replan_under(lowest, t, gas, modes)
    return True
