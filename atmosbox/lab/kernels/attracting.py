"""Change the attraction of molecules, and the temperature of their random bath, with knobs of a page."""

import functools
from collections.abc import Callable
from typing import Any

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
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
    """Return the kernels that only the knobs of such a box call, by name."""
    _, _, replan, _ = specialise(modes)

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

    return {"attract": attract, "warm_bath": warm_bath}
