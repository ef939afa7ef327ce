"""Advance molecules that attract each other: the loop over events, and lists of neighbours that grow.

Python runs these functions as they are written, and the lab's page compiles them: see `atmosbox.engine.exact.advance`.
"""

import functools
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.advance import passing
from atmosbox.engine.exact.exact import Status
from atmosbox.engine.exact.layout import LENGTHEN, NOTHING
from atmosbox.engine.wells.vicinity import Vicinity
from atmosbox.engine.wells.well_events import WellGas, specialise

_ROW_FULL = Status.ROW_FULL.value


class Lists(NamedTuple):
    """The lists of neighbours.

    ``stride : (1,)`` is the present number of words of a list, ``due : (1,)`` what is to be done with the lists before
    the next event: see `layout`.
    """

    stride: Any
    due: Any


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


@kernel(plain=True)
def _double(gas, lists):
    """Make all lists twice as long, in the same memory; return whether there is enough memory."""
    old, entry = lists.stride[0], gas.vicinity.entry
    if 2 * old * gas.molecules.size > entry.size:
        return False
    # from the last list to the first, so that no list is overwritten before it has been moved
    for i in range(gas.molecules.size - 1, 0, -1):
        for q in range(np.int64(entry[i * old]), -1, -1):
            entry[2 * i * old + q] = entry[i * old + q]
    lists.stride[0] = 2 * old
    return True


@functools.cache
def advancing(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``pass_time`` and ``settle`` of one set of modes."""
    place_all, advance, _, _ = specialise(modes)

    @kernel(plain=True)
    def settle(gas, now, lists):
        """Do what is due in the lists at a local time; return whether there was memory for it."""
        while lists.due[0] != NOTHING:
            full = lists.due[0] == LENGTHEN or place_all(as_listed(gas, lists), now) == _ROW_FULL
            if full and not _double(gas, lists):
                return False
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
