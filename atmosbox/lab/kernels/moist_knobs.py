"""The kernels that knobs of a box with liquid call."""

import functools
import math
from collections.abc import Callable
from typing import Any

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.core.walls import HEAT_BATH, SPECULAR
from atmosbox.engine.liquid.moist_loop import moist_loop
from atmosbox.engine.liquid.reservoir import cover

__all__ = ["has_moist_knobs", "moist_knobs"]


def has_moist_knobs(modes: Modes) -> bool:
    """Return whether a box with liquid has knobs: one with visible drops or with a rising cloud has none."""
    return not modes.drops and (modes.pool or not modes.ascends)


@functools.cache
def moist_knobs(modes: Modes) -> dict[str, Callable[..., Any]]:
    """Return the kernels that knobs of a box with liquid call, by name."""
    if not has_moist_knobs(modes):
        return {}
    _, draw, wake = moist_loop(modes)

    @kernel
    def warm_walls(gas, book, first, last, kT):
        """Make walls heat baths of a temperature [energy]: see `set_wall`, and `set_wall_kT` for present heat baths."""
        walls = gas.walls
        wake(gas, book, math.sqrt(8.0 * kT / gas.kinds.table[book.moisture.reservoir.kind].mass))
        for wall in range(first, last):
            walls.law[wall] = HEAT_BATH
            walls.accommodation[wall] = 1.0
            for k in range(walls.schedule[wall], walls.schedule[wall + 1]):
                walls.schedule_kT[k] = kT
        return 0

    @kernel
    def smooth_walls(gas, first, last):
        """Make heat baths smooth walls again."""
        walls = gas.walls
        for wall in range(first, last):
            walls.law[wall] = SPECULAR
            walls.accommodation[wall] = 0.0
        return 0

    @kernel
    def cover_pool(gas, book, share):
        """Set the share of the pool that is open: see `MoistAccount.set_open_pool`."""
        cover(book.moisture.reservoir, share)
        draw(gas, book, book.moisture.reservoir.bound[0])
        return 0

    found = {"warm_walls": warm_walls, "smooth_walls": smooth_walls}
    return found | ({"cover_pool": cover_pool} if modes.pool else {})
