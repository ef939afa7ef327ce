"""Advance a box with liquid: the loop of the engine for one set of modes.

Its kernels take the same arguments as those of a box without liquid, `advance.dry_loop`.
"""

import functools
from collections import namedtuple
from collections.abc import Callable
from typing import Any

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.liquid import drop, moist
from atmosbox.engine.liquid.moist import MoistAscent


class Moisture(namedtuple("Moisture", "reservoir vapours rotations drops")):
    """The data of the liquid of a box.

    ``reservoir`` is the liquid; ``vapours`` the molecules of water in vapour and liquid together, and ``rotations``
    the rotational degrees of freedom of all molecules together; ``drops`` the data of drops that are spheres in the
    box, 0 if there are none.
    """


@functools.cache
def moist_loop(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``advance``, ``draw`` and ``wake`` of one set of modes."""
    if modes.drops > 0:
        drop_begin, drop_advance = drop.specialise(modes)

        @kernel(plain=True)
        def advance(gas, ascent, book, until, most):
            """Resolve events of molecules and of drops."""
            return drop_advance(gas, book.moisture.drops, book.moisture.reservoir, until, most)

        @kernel(plain=True)
        def draw(gas, book, speed):
            """Draw the time at which the next molecule leaves a drop again."""
            drop_begin(gas, book.moisture.drops, book.moisture.reservoir, book.now[0])

    else:
        moist_begin, moist_advance = moist.specialise(modes)

        if modes.ascends:

            @kernel(plain=True)
            def advance(gas, ascent, book, until, most):
                """Resolve events of molecules and of the liquid, and set a new piston velocity when it is due."""
                wet = book.moisture
                here = MoistAscent(ascent, wet.vapours, wet.rotations)
                return moist_advance(gas, wet.reservoir, here, until, most)

        else:

            @kernel(plain=True)
            def advance(gas, ascent, book, until, most):
                """Resolve events of molecules and of the liquid."""
                return moist_advance(gas, book.moisture.reservoir, until, most)

        @kernel(plain=True)
        def draw(gas, book, speed):
            """Draw the next event of the liquid again, for molecules with speeds up to `speed` [length/time]."""
            moist_begin(gas, book.moisture.reservoir, book.now[0], speed)

    @kernel(plain=True)
    def wake(gas, book, speed):
        """Draw the next event of the liquid again if molecules may now become faster than the bound that was used."""
        if speed > book.moisture.reservoir.bound[0]:
            draw(gas, book, speed)

    return advance, draw, wake
