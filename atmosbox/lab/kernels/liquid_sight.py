"""The picture of the liquid in a box: the data that `atmosbox.page.page_liquid` draws, as a kernel."""

import functools
import math
from collections.abc import Callable
from typing import Any

from atmosbox.engine.core.elementary import cbrt
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.encounter import motion_at
from atmosbox.engine.liquid.reservoir import LIQUID, RAINED

__all__ = ["liquid_sight"]


@functools.cache
def liquid_sight(modes: Modes) -> Callable[..., Any]:
    """Return the kernel of one set of modes that writes which drops are drawn."""
    if not modes.phases:

        @kernel
        def look_at_nothing(gas, book, sight):
            """Do nothing: there is no liquid."""

        return look_at_nothing  # type: ignore[no-any-return]

    @kernel
    def draw_layer(number, what, sight):
        """Draw this number of molecules as a layer on the floor."""
        if number > 0 and sight.water > 0:
            row = sight.drops[sight.many[0]]
            row[0] = row[1] = 0.0
            row[2] = min(number / sight.water, 1.0)
            row[3] = what
            sight.many[0] += 1

    @kernel
    def draw_mist(number, sight):
        """Draw this number of molecules as clumps, which are all alike and have fixed places."""
        if number <= 0:
            return
        many = min(sight.spread.shape[0], number)
        radius = sight.clump * cbrt(number / many)
        for k in range(many):
            for axis in range(3):
                sight.drops[k, axis] = sight.spread[k, axis] * sight.length[axis] * sight.unit
            sight.drops[k, 3] = radius
        sight.many[0] = many

    @kernel
    def draw_drops(gas, book, sight):
        """Draw the drops at their positions, in their size."""
        drops, box = book.moisture.drops, gas.box
        for k in range(drops.record.size):
            if drops.alive[k] == 1:
                row = sight.drops[sight.many[0]]
                at = motion_at(drops.record[k], book.now[0], gas, modes)
                row[0] = (at.x - math.floor(at.x * box.inverse_x) * box.length_x) * sight.unit
                row[1] = (at.y - math.floor(at.y * box.inverse_y) * box.length_y) * sight.unit
                row[2] = (at.z - math.floor(at.z * box.inverse_z) * box.length_z) * sight.unit
                row[3] = gas.kinds.table[modes.drops + k].radius * sight.unit
                sight.many[0] += 1

    @kernel
    def look_at_liquid(gas, book, sight):
        """Write the drops, clumps or layers to draw, in the unit of the page."""
        count = book.moisture.reservoir.count
        sight.many[0] = 0
        if modes.drops > 0:
            draw_drops(gas, book, sight)
        elif modes.pool:
            draw_layer(count[LIQUID], sight.layers[0], sight)
        else:
            draw_mist(count[LIQUID], sight)
        draw_layer(count[RAINED], sight.layers[1], sight)

    return look_at_liquid  # type: ignore[no-any-return]
