"""What passes time in a box, with liquid in it or without: the loop of the engine for one set of modes, and its clocks.

In Python `ParcelSet`, `MoistParcelSet` and `DropParcelSet` each say how time passes in them. Here it is said once for
each set of modes, in kernels that all take the same arguments.
"""

import functools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

from atmosbox.engine.core.elementary import log
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.core.walls import HEAT_BATH, SPECULAR
from atmosbox.engine.exact.exact import specialise
from atmosbox.engine.liquid import drop, moist
from atmosbox.engine.liquid.moist import MoistAscent
from atmosbox.engine.liquid.reservoir import Reservoir

__all__ = ["Moisture", "liquid_now", "moist_knobs", "moist_passing"]

_NEVER = -600.0
_CLOCKS = 3


class Moisture(NamedTuple):
    """What a box knows of its liquid.

    ``reservoir`` the liquid when the pool is open; ``cover : (2,)`` which part of the vapour sticks, and the logarithm
    of the rate of leaving, as the pool is covered now. ``vapours`` molecules of water in vapour and liquid, and
    ``rotations`` rotational degrees of freedom of all molecules, together. ``drops`` what is known of those that can be
    seen, 0 if there are none.
    """

    reservoir: Reservoir
    cover: Any
    vapours: int
    rotations: float
    drops: Any


@kernel
def liquid_now(moisture):
    """Return the reservoir with the rates of a pool that is covered as it is now."""
    r, cover = moisture.reservoir, moisture.cover
    return Reservoir(
        r.energy, r.count, r.clock, r.bound, r.absent, r.top, r.spectrum, r.surface, r.bin_width, cover[1], r.area,
        r.binding_energy, r.molecule_capacity, r.nuclei, cover[0], r.rain, r.keeps, r.rotation, r.diameter,
        r.mean_cube, r.kind,
    )  # fmt: skip


@functools.cache
def moist_passing(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``advance``, ``soonest``, ``shift``, ``draw`` and ``wake`` of one set of modes."""
    if not modes.phases:
        return _dry(modes)

    if modes.drops > 0:
        drop_begin, drop_advance = (kernel(getattr(each, "py_func", each)) for each in drop.specialise(modes))

        @kernel
        def advance(gas, ascent, book, until, most):
            """Resolve events of molecules and of drops."""
            return drop_advance(gas, book.moisture.drops, liquid_now(book.moisture), until, most)

        @kernel
        def draw(gas, book, speed):
            """Draw anew when the next molecule leaves a drop."""
            drop_begin(gas, book.moisture.drops, liquid_now(book.moisture), book.now[0])

    else:
        moist_begin, moist_advance = (kernel(getattr(each, "py_func", each)) for each in moist.specialise(modes))

        if modes.ascends:

            @kernel
            def advance(gas, ascent, book, until, most):
                """Resolve events of molecules and of the liquid, and turn the piston as it is due."""
                wet = book.moisture
                here = MoistAscent(ascent, wet.vapours, wet.rotations)
                return moist_advance(gas, liquid_now(wet), here, until, most)

        else:

            @kernel
            def advance(gas, ascent, book, until, most):
                """Resolve events of molecules and of the liquid."""
                return moist_advance(gas, liquid_now(book.moisture), until, most)

        @kernel
        def draw(gas, book, speed):
            """Draw anew when the liquid does something, for molecules that may be as fast as a speed [length/time]."""
            moist_begin(gas, liquid_now(book.moisture), book.now[0], speed)

    @kernel
    def soonest(gas, book):
        """Return the local time of what happens next."""
        time, clock = gas.calendar.time[1], book.moisture.reservoir.clock
        for k in range(_CLOCKS):
            time = min(time, clock[k])
        return time

    @kernel
    def shift(step, book):
        """Let the clocks of the liquid read small numbers again."""
        clock = book.moisture.reservoir.clock
        for k in range(_CLOCKS):
            clock[k] -= step

    @kernel
    def wake(gas, book, speed):
        """Draw anew if something now moves so fast that molecules may become faster than has been reckoned with."""
        if speed > book.moisture.reservoir.bound[0]:
            draw(gas, book, speed)

    return advance, soonest, shift, draw, wake


def _dry(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the same kernels for a box without liquid."""
    dry = specialise(modes)[1]
    loop = kernel(getattr(dry, "py_func", dry))

    if modes.ascends:

        @kernel
        def advance(gas, ascent, book, until, most):
            """Resolve events, and turn the piston as it is due."""
            return loop(gas, ascent, until, most)

    else:

        @kernel
        def advance(gas, ascent, book, until, most):
            """Resolve events."""
            return loop(gas, until, most)

    @kernel
    def soonest(gas, book):
        """Return the local time of the next event."""
        return gas.calendar.time[1]

    @kernel
    def shift(step, book):
        """Do nothing: there is no liquid."""

    @kernel
    def wake(gas, book, speed):
        """Do nothing: there is no liquid."""

    return advance, soonest, shift, wake, wake


@functools.cache
def moist_knobs(modes: Modes) -> dict[str, Callable[..., Any]]:
    """Return the kernels that knobs of a box with liquid call, by name."""
    _, _, _, draw, wake = moist_passing(modes)

    @kernel
    def warm_walls(gas, book, first, last, kT):
        """Make heat baths of some walls [energy]: see `set_wall`, and of those that are some `set_wall_kT`."""
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
        """Make smooth walls of heat baths again."""
        walls = gas.walls
        for wall in range(first, last):
            walls.law[wall] = SPECULAR
            walls.accommodation[wall] = 0.0
        return 0

    @kernel
    def cover_pool(gas, book, share):
        """Leave a share of the pool open: see `MoistAccount.set_open_pool`."""
        reservoir, cover = book.moisture.reservoir, book.moisture.cover
        cover[0] = reservoir.sticking * share
        cover[1] = reservoir.log_rate + (max(log(share), _NEVER) if share > 0.0 else _NEVER)
        draw(gas, book, reservoir.bound[0])
        return 0

    found = {"warm_walls": warm_walls, "smooth_walls": smooth_walls}
    return found | ({"cover_pool": cover_pool} if modes.pool else {})
