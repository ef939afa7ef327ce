"""A molecule leaves the box or comes into it: it condenses, or it evaporates.

Nothing is rebuilt. A molecule that is not in the box stands in no cell, its event never comes, and its clock
reads infinity; a prediction that names it is stale.
"""

import math

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.exact.calendar import schedule
from atmosbox.engine.exact.encounter import write
from atmosbox.engine.exact.prediction import plan, size_and_radius
from atmosbox.engine.liquid.insertion import STRIKE, WRITE, enlist

__all__ = ["enter", "take_out", "withdraw"]


@kernel
def take_out(i, molecules, events, kinds, cells, calendar, modes):
    """Take a molecule or a drop out of its cells, and of time."""
    if modes.contacts:
        size, _ = size_and_radius(i, molecules, kinds, modes)
        enlist(STRIKE, i, size, (events[i].slot_x, events[i].slot_y, events[i].slot_z), cells, modes)
    molecule = molecules[i]
    molecule.clock = math.inf
    molecule.vx = 0.0
    molecule.vy = 0.0
    molecule.vz = 0.0
    molecule.count += 1
    if modes.rotation:
        kinds.rotational_energy[i] = 0.0
    events[i].contact_time = math.inf
    schedule(calendar, i, math.inf)


@kernel
def withdraw(i, molecules, events, kinds, cells, calendar, ledger, modes):
    """Take molecule i out of the box: it is absent until it evaporates."""
    take_out(i, molecules, events, kinds, cells, calendar, modes)
    ledger.absent[ledger.top[0]] = i
    ledger.top[0] += 1


@kernel
def enter(
    i, t, x, y, z, vx, vy, vz, spin, molecules, events, kinds, cells, calendar, box, walls, ledger, modes
):  # fmt: skip
    """Put molecule i, the last that is absent, where `look_for_room` has found a place for it."""
    ledger.top[0] -= 1
    if modes.contacts:
        size, _ = size_and_radius(i, molecules, kinds, modes)
        enlist(WRITE, i, size, (events[i].slot_x, events[i].slot_y, events[i].slot_z), cells, modes)
    write(molecules[i], t, x, y, z, vx, vy, vz)
    if modes.rotation:
        kinds.rotational_energy[i] = spin
    plan(i, t, x, y, z, vx, vy, vz, molecules, events, kinds, cells, calendar, box, walls, modes)
