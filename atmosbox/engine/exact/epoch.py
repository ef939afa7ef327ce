"""Clocks that always read small numbers, so that times keep their precision for ever.

All times that the engine works with are local: they count from ``Walls.epoch``. When the next event lies further ahead
of that than the length of an epoch, all clocks are set back by whole epochs.

Python runs these functions as they are written; the kernels of the lab's page compile them. ``clocks`` are the times of
events that belong to no molecule: those of a liquid, or of a bath.
"""

import math

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.exact.rows import START, STOP

__all__ = ["next_time", "set_back", "whole_epochs"]


@kernel(plain=True)
def next_time(gas, clocks):
    """Return the local time of the next event of a molecule or of one of the clocks [time]."""
    time = gas.calendar.time[1]
    for clock in clocks:
        time = min(time, clock)
    return time


@kernel(plain=True)
def whole_epochs(ahead, length):
    """Return by how much to set clocks back when the next event is at the local time ``ahead`` [time]; 0 for no event.

    The result depends on events alone, not on where a run is cut into pieces.

    Examples
    --------
    >>> whole_epochs(70.0, 32.0), whole_epochs(31.0, 32.0), whole_epochs(math.inf, 32.0)
    (64.0, 32.0, 0.0)
    """
    return 0.0 if math.isinf(ahead) else max(1.0, math.floor(ahead / length)) * length


@kernel(plain=True)
def set_back(step, gas, clocks, modes):
    """Set all clocks of a box back by ``step`` [time]."""
    clock, contact, due = gas.molecules.clock, gas.events.contact_time, gas.calendar.time
    clock -= step
    contact -= step
    due -= step
    clocks -= step
    gas.walls.piston[2] -= step
    gas.walls.epoch[0] += step
    gas.tallies.progress[0] -= step
    if modes.rows:
        gas.cells.copies.epoch[START] -= step
        gas.cells.copies.epoch[STOP] -= step
