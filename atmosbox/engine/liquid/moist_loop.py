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


class Moisture(namedtuple("Moisture", "reservoir vapours rotations drops")):
    """The data of the liquid of a box.

    ``reservoir`` is the liquid; ``vapours`` the molecules of water in vapour and liquid together, and ``rotations``
    the rotational degrees of freedom of all molecules together; ``drops`` the data of drops that are spheres in the
    box, 0 if there are none.
    """


@functools.cache
def moist_loop(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``advance``, ``draw`` and ``wake`` of one set of modes."""
    begin, loop = (drop if modes.drops else moist).specialise(modes)

    @kernel(plain=True)
    def advance(gas, ascent, book, until, most):
        """Resolve events of molecules, liquid and drops, and set a new velocity of the piston when it is due."""
        wet = book.moisture
        if modes.drops:
            return loop(gas, wet.drops, wet.reservoir, until, most)
        if modes.ascends:
            return loop(gas, wet, ascent, until, most)
        return loop(gas, wet.reservoir, until, most)

    @kernel(plain=True)
    def draw(gas, book, speed):
        """Draw the next event of the liquid again, for molecules with speeds up to `speed` [length/time]."""
        if modes.drops:
            begin(gas, book.moisture.drops, book.moisture.reservoir, book.now[0])
        else:
            begin(gas, book.moisture.reservoir, book.now[0], speed)

    @kernel(plain=True)
    def wake(gas, book, speed):
        """Draw the next event of the liquid again if molecules may now become faster than the bound that was used."""
        if speed > book.moisture.reservoir.bound[0]:
            draw(gas, book, speed)

    return advance, draw, wake
