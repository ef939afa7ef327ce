"""Advance molecules that attract each other: the loop over events, and lists of neighbours that grow.

Python runs these functions as they are written, and the lab's page compiles them: see `atmosbox.engine.exact.advance`.
"""

import functools
from collections import namedtuple
from collections.abc import Callable
from typing import Any

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.advance import passing
from atmosbox.engine.exact.exact import Status
from atmosbox.engine.exact.layout import LENGTHEN, NOTHING, double_rows
from atmosbox.engine.wells.vicinity import Vicinity
from atmosbox.engine.wells.well_events import WellGas, specialise

_FULL = Status.FULL.value


class Lists(namedtuple("Lists", "stride due")):
    """The lists of neighbours.

    ``stride : (1,)`` is the present number of words of a list, ``due : (1,)`` what is to be done with the lists before
    the next event: see `layout`.
    """


@kernel(plain=True)
def as_listed(gas, lists):
    """Return the gas with the present length of its lists."""
    v = gas.vicinity
    vicinity = Vicinity(
        v.entry, lists.stride[0], v.anchor, v.width, v.cell, v.next, v.previous, v.first, v.mark, v.found, v.gap,
        v.reach, v.number_x, v.number_y, v.number_z, v.inverse_x, v.inverse_y, v.inverse_z,
    )  # fmt: skip
    return WellGas(
        gas.molecules, gas.events, gas.kinds, gas.calendar, gas.box, gas.walls, gas.tallies, gas.wells, vicinity,
        gas.bath,
    )  # fmt: skip


@functools.cache
def advancing(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``pass_time`` and ``settle`` of one set of modes."""
    place_all, advance, _, _ = specialise(modes)

    @kernel(plain=True)
    def settle(gas, now, lists):
        """Do what is due in the lists at a local time; return whether there was memory for it."""
        while lists.due[0] != NOTHING:
            full = lists.due[0] == LENGTHEN or place_all(as_listed(gas, lists), now) == _FULL
            if full and not double_rows(gas.vicinity.entry, gas.molecules.size, lists.stride[0]):
                return False
            if full:
                lists.stride[0] *= 2
            if not full or lists.due[0] == LENGTHEN:
                lists.due[0] = NOTHING
        return True

    @kernel(plain=True)
    def proceed(gas, ascent, book, lists, until, most):
        """Resolve events."""
        return advance(as_listed(gas, lists), until, most)

    @kernel(plain=True)
    def wake(gas, book, speed):
        """Do nothing: there is no liquid."""

    return passing(proceed, settle, wake, modes), settle
