"""Advance molecules that attract each other, in a page, with the engine's own loop, and change them with knobs."""

import functools
import math
from collections.abc import Callable
from typing import Any

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.exact import Status
from atmosbox.engine.exact.layout import PLACE
from atmosbox.engine.wells.well_advance import advancing
from atmosbox.engine.wells.well_events import specialise
from atmosbox.lab.kernels.readings import ENERGY


@kernel
def energy_of_wells(wells):
    """Return the potential energy of all pairs that are in each other's well [energy]."""
    total = 0.0
    for one in range(wells.depth.shape[0]):
        for two in range(wells.depth.shape[1]):
            total += wells.depth[one, two] * wells.number[one, two]
    return -total


@functools.cache
def attracting(modes: Modes) -> dict[str, Callable[..., Any]]:
    """Return the kernels that replace those of another box, or that only its knobs call, by name."""
    pass_time, settle = advancing(modes)
    _, _, replan, _ = specialise(modes)

    @kernel
    def place(gas, book, layout):
        """List the neighbours of all molecules at the start; keep the first time of the bath if it is drawn already."""
        state, clock = gas.tallies.random[0], gas.bath.clock[0]
        layout.due[0] = PLACE
        placed = settle(gas, book.now[0], layout)
        if not math.isinf(clock):
            gas.tallies.random[0] = state
            gas.bath.clock[0] = clock
        return Status.DONE.value if placed else Status.FULL.value

    @kernel
    def attract(gas, book, crowd, gauges, strength):
        """Change the depth of all wells: see `AttractingParcelSet.set_strength`."""
        depth, work = gas.wells.depth, -energy_of_wells(gas.wells)
        for one in range(depth.shape[0]):
            for two in range(depth.shape[1]):
                depth[one, two] = strength * crowd.full_depth[one, two]
        work += energy_of_wells(gas.wells)
        crowd.work[0] += work
        gauges.before[ENERGY] += work
        crowd.strength[0] = strength
        replan(gas, book.now[0])
        return 0

    @kernel
    def warm_bath(gas, kT):
        """Set the temperature of the random bath [energy]: see `AttractingParcelSet.set_bath_kT`."""
        gas.bath.schedule_kT[:] = kT
        return 0

    return {"pass_time": pass_time, "place": place, "attract": attract, "warm_bath": warm_bath}
