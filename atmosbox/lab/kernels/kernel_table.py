"""The kernels that a page calls, by name, for one set of modes."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.lift import interpolate
from atmosbox.engine.core.state import Modes
from atmosbox.engine.core.walls import HEAT_BATH
from atmosbox.engine.exact.advance import Passed, advancing, dry_loop
from atmosbox.engine.exact.layout import PLACE
from atmosbox.engine.liquid.moist_loop import moist_loop
from atmosbox.lab.kernels.attracting import attracting
from atmosbox.lab.kernels.averaging import begin_averages_anew
from atmosbox.lab.kernels.clustering import clustering
from atmosbox.lab.kernels.gauging import gauging
from atmosbox.lab.kernels.knobs import can_set_gravity, gravity_setter, moist_knobs
from atmosbox.lab.kernels.picture import picture
from atmosbox.lab.kernels.starting import can_start, starting


@kernel
def warm_walls(gas, first, last, kT):
    """Set the temperature of the heat baths among some walls [energy]: see `ParcelSet.set_wall_kT`."""
    walls = gas.walls
    for wall in range(first, last):
        if walls.law[wall] == HEAT_BATH:
            for k in range(walls.schedule[wall], walls.schedule[wall + 1]):
                walls.schedule_kT[k] = kT
    return 0


@kernel
def lead(gas, ascent, book, towards):
    """Move the parcel to another moment of its planned ascent, at its pace, and stop there: see `Course.lead`."""
    time, lift = gas.walls.epoch[0] + book.now[0], ascent.lift
    here = interpolate(time, lift.course_time, lift.course_moment)
    times, moments = lift.course_time, lift.course_moment
    times[0], moments[0] = 0.0, here
    times[1], moments[1] = time, here
    times[2], moments[2] = time + abs(towards - here), towards
    times[3], moments[3] = math.inf, towards
    return 0


def kernels(modes: Modes, *, wells: bool = False) -> dict[str, Callable[..., Any]]:
    """Return the kernels for a set of modes by name; ``wells`` if molecules attract each other."""
    found: dict[str, Callable[..., Any]] = {"lead": lead} if modes.ascends else {}
    found |= {"start": starting(modes, wells=wells)} if can_start(modes) else {}
    found |= {"set_gravity": gravity_setter(modes)} if can_set_gravity(modes) and not wells else {}
    found |= moist_knobs(modes) if modes.phases else {"warm_walls": warm_walls}
    found |= {"look": picture(modes), "begin_averages_anew": begin_averages_anew}
    found |= zip(("begin", "sample", "end_frame", "note_frame"), gauging(modes, wells=wells), strict=True)
    if wells:
        return found | attracting(modes) | clustering(modes)
    pass_time, settle = advancing(modes, moist_loop if modes.phases else dry_loop)

    @kernel
    def place(gas, book, layout):
        """Enter all molecules into their cells and plan their events; return ``DONE`` or ``FULL``."""
        layout.due[0] = PLACE
        return Passed.DONE.value if settle(gas, book.now[0], layout) else Passed.FULL.value

    return found | {"pass_time": pass_time, "place": place}
