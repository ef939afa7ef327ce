"""Advance a box with or without liquid: the loop of the engine for one set of modes.

In Python `ParcelSet`, `MoistParcelSet` and `DropParcelSet` each advance their own box. Here each set of modes has
kernels for that, which all take the same arguments.
"""

import functools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.core.walls import HEAT_BATH, SPECULAR
from atmosbox.engine.exact.exact import specialise
from atmosbox.engine.liquid import drop, moist
from atmosbox.engine.liquid.moist import MoistAscent
from atmosbox.engine.liquid.reservoir import Reservoir, cover

__all__ = ["Moisture", "has_moist_knobs", "moist_knobs", "moist_passing"]


class Moisture(NamedTuple):
    """The data of the liquid of a box.

    ``reservoir`` is the liquid; ``vapours`` the molecules of water in vapour and liquid together, and ``rotations``
    the rotational degrees of freedom of all molecules together; ``drops`` the data of drops that are spheres in the
    box, 0 if there are none.
    """

    reservoir: Reservoir
    vapours: int
    rotations: float
    drops: Any


@functools.cache
def moist_passing(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``advance``, ``draw`` and ``wake`` of one set of modes."""
    if not modes.phases:
        return _dry(modes)

    if modes.drops > 0:
        drop_begin, drop_advance = (kernel(getattr(each, "py_func", each)) for each in drop.specialise(modes))

        @kernel
        def advance(gas, ascent, book, until, most):
            """Resolve events of molecules and of drops."""
            return drop_advance(gas, book.moisture.drops, book.moisture.reservoir, until, most)

        @kernel
        def draw(gas, book, speed):
            """Draw the time at which the next molecule leaves a drop again."""
            drop_begin(gas, book.moisture.drops, book.moisture.reservoir, book.now[0])

    else:
        moist_begin, moist_advance = (kernel(getattr(each, "py_func", each)) for each in moist.specialise(modes))

        if modes.ascends:

            @kernel
            def advance(gas, ascent, book, until, most):
                """Resolve events of molecules and of the liquid, and set a new piston velocity when it is due."""
                wet = book.moisture
                here = MoistAscent(ascent, wet.vapours, wet.rotations)
                return moist_advance(gas, wet.reservoir, here, until, most)

        else:

            @kernel
            def advance(gas, ascent, book, until, most):
                """Resolve events of molecules and of the liquid."""
                return moist_advance(gas, book.moisture.reservoir, until, most)

        @kernel
        def draw(gas, book, speed):
            """Draw the next event of the liquid again, for molecules with speeds up to `speed` [length/time]."""
            moist_begin(gas, book.moisture.reservoir, book.now[0], speed)

    @kernel
    def wake(gas, book, speed):
        """Draw the next event of the liquid again if molecules may now become faster than the bound that was used."""
        if speed > book.moisture.reservoir.bound[0]:
            draw(gas, book, speed)

    return advance, draw, wake


def _dry(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the same kernels for a box without liquid."""
    dry = specialise(modes)[1]
    loop = kernel(getattr(dry, "py_func", dry))

    if modes.ascends:

        @kernel
        def advance(gas, ascent, book, until, most):
            """Resolve events, and change the velocity of the piston when it is due."""
            return loop(gas, ascent, until, most)

    else:

        @kernel
        def advance(gas, ascent, book, until, most):
            """Resolve events."""
            return loop(gas, until, most)

    @kernel
    def wake(gas, book, speed):
        """Do nothing: there is no liquid."""

    return advance, wake, wake


def has_moist_knobs(modes: Modes) -> bool:
    """Return whether a box with liquid has knobs: one with visible drops or with a rising cloud has none."""
    return not modes.drops and (modes.pool or not modes.ascends)


@functools.cache
def moist_knobs(modes: Modes) -> dict[str, Callable[..., Any]]:
    """Return the kernels that knobs of a box with liquid call, by name."""
    if not has_moist_knobs(modes):
        return {}
    _, draw, wake = moist_passing(modes)

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
