"""The piston of a parcel that follows a pressure: asked and turned between events, without leaving compiled code.

A parcel on its way up asks for its velocity thousands of times. What the law of `lift` needs to know of the gas is read
off the tallies here, and all that may meet the ceiling plans its next move anew.
"""

import math
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.lift import Gauges, Lift, ceiling_velocity
from atmosbox.engine.exact.calendar import schedule
from atmosbox.engine.exact.encounter import motion_at, size_and_radius, slots_of
from atmosbox.engine.exact.prediction import CEILING, limits, next_move
from atmosbox.engine.exact.search import CONTACT

__all__ = ["HIGHEST", "LOWEST", "Ascent", "Next", "ahead", "gauges", "replan_under", "turn"]

LOWEST, HIGHEST = 0.6, 1.5
"""How high the ceiling may come, over its height when the cells were laid out, before they are laid out anew."""


class Ascent(NamedTuple):
    """What the kernels know of a box whose piston follows a pressure.

    ``lift`` the law; ``turns : (1,)`` how often the piston has turned; ``filled`` the height for which the cells were
    laid out, ``lowest`` how low the ceiling may come [length]; the energy that there was at the start, and what changes
    of gravity gave [energy]; degrees of freedom of a molecule of dry air, and the diameter of all [length].
    """

    lift: Lift
    turns: Any
    filled: float
    lowest: float
    start_energy: float
    gravity_work: float
    freedom: float
    diameter: float


class Next(IntEnum):
    """What ends a stretch of even motion of the piston: the time asked for, its next turn, or that it is too low."""

    END = 0
    TURN = 1
    CRUSHED = 2


@kernel
def ahead(until, gas, ascent):
    """Return when the piston is next to be asked, or ``until`` if that comes first [time], and which: a `Next`."""
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
    """Return the `Gauges` of a gas at time t, of which so much energy [energy] is that of the liquid."""
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
    """Plan anew, at time ``now``, the moves of all that may meet the ceiling, or that were to meet it.

    Below ``lowest``, the lowest place of the ceiling before it is asked again, a molecule leaves its slot first.
    """
    for i in range(gas.molecules.size):
        if modes.phases and math.isinf(gas.molecules[i].clock):
            continue
        event = gas.events[i]
        slots = slots_of(i, gas)
        size, radius = size_and_radius(i, gas, modes)
        if limits(slots[2], 2, size, radius, gas, modes)[1] < lowest - radius and np.int64(event.what) != CEILING:
            continue
        time, what = next_move(slots, now, motion_at(i, now, gas, modes), size, radius, gas, modes)
        time += now
        if event.contact_time < time:
            what = CONTACT
        event.what = what
        schedule(gas.calendar, i, min(time, event.contact_time))


@kernel
def turn(t, at, gas, ascent, modes):
    """Give the piston its next velocity at time t, the gas being as ``at`` says; tell whether the cells still fit."""
    piston = gas.walls.piston
    velocity = ceiling_velocity(at, ascent.lift)
    ceiling = piston[0] + piston[1] * (t - piston[2])
    piston[0] = ceiling
    piston[1] = velocity
    piston[2] = t
    ascent.turns[0] += 1
    if ceiling > HIGHEST * ascent.filled or ceiling < LOWEST * ascent.filled:
        return False
    lowest = ceiling + (velocity * ascent.lift.interval if velocity < 0.0 else 0.0)
    replan_under(lowest, t, gas, modes)
    return True
