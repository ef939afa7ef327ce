"""Clocks that always read small numbers, so that time keeps its digits for ever.

All times that the engine works with are local: they count from ``Walls.epoch``. When the next thing that happens lies
ahead of that by more than the length of an epoch, all clocks are set back by whole epochs.

Python runs these functions as they are written; the kernels of a page compile them. ``clocks`` are those of what is no
event of a molecule: of a liquid, or of a bath.
"""

import math

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.exact.rows import START, STOP

__all__ = ["next_time", "set_back", "whole_epochs"]


@kernel(plain=True)
def next_time(gas, clocks):
    """Return the local time of what happens next [time]."""
    time = gas.calendar.time[1]
    for clock in clocks:
        time = min(time, clock)
    return time


@kernel(plain=True)
def whole_epochs(ahead, length):
    """Return by how much to set clocks back when the next thing happens at a local time, 0 if nothing does [time].

    It depends on events alone, never on where a run is cut.

    Examples
    --------
    >>> whole_epochs(70.0, 32.0), whole_epochs(31.0, 32.0), whole_epochs(math.inf, 32.0)
    (64.0, 32.0, 0.0)
    """
    return 0.0 if math.isinf(ahead) else max(1.0, math.floor(ahead / length)) * length


@kernel(plain=True)
def set_back(step, gas, clocks, modes):
    """Let all clocks of a box read so much less [time]."""
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
