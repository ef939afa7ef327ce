"""A molecule leaves the box or enters it: it condenses, or it evaporates.

The data of a molecule stay in memory. A molecule that is not in the box is in no cell, has no event, and its clock
reads infinity; predictions of contacts with it are stale.
"""

import math

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.exact.calendar import schedule
from atmosbox.engine.exact.encounter import size_and_radius, slots_of, write
from atmosbox.engine.exact.membership import Change, change
from atmosbox.engine.exact.prediction import call

__all__ = ["enter", "take_out", "withdraw"]


@kernel
def take_out(i, gas, modes):
    """Remove a molecule or a drop from its cells and from the calendar."""
    event = gas.events[i]
    if modes.contacts:
        size, _ = size_and_radius(i, gas, modes)
        change(Change.REMOVE, i, size, slots_of(i, gas), gas.cells, modes)
    molecule = gas.molecules[i]
    molecule.clock = math.inf
    molecule.vx = 0.0
    molecule.vy = 0.0
    molecule.vz = 0.0
    molecule.count += 1
    if modes.rotation:
        gas.kinds.rotational_energy[i] = 0.0
    event.contact_time = math.inf
    schedule(gas.calendar, i, math.inf)


@kernel
def withdraw(i, gas, reservoir, modes):
    """Remove molecule i from the box: it is absent until it evaporates."""
    take_out(i, gas, modes)
    reservoir.absent[reservoir.top[0]] = i
    reservoir.top[0] += 1


@kernel
def enter(i, t, at, spin, gas, reservoir, modes):
    """Put molecule i, the last absent one, into the box at time t, where `find_place` has found a place for it."""
    reservoir.top[0] -= 1
    if modes.contacts:
        size, _ = size_and_radius(i, gas, modes)
        change(Change.ADD, i, size, slots_of(i, gas), gas.cells, modes)
    write(i, t, at, gas)
    if modes.rotation:
        gas.kinds.rotational_energy[i] = spin
    call(i, t, gas)
