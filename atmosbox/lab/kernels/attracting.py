"""Advance molecules that attract each other, in a page, and change them with knobs.

This is for attracting molecules what `passing` is for hard spheres: what `AttractingParcelSet` does between two calls
of the engine, in the same order and with the same numbers. The only thing to handle here is a list of neighbours that
is too short.
"""

import functools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.epoch import next_time
from atmosbox.engine.exact.exact import Status
from atmosbox.engine.wells.vicinity import Vicinity
from atmosbox.engine.wells.well_events import WellGas, specialise
from atmosbox.lab.kernels.passing import Passed, epochs

__all__ = ["Lists", "attracting", "energy_of_wells", "warm_bath"]

# The status leaves the engine's loop as a plain number, and compiled code calls no number equal to an enum.
_DONE, _BUSY, _ROW_FULL = Status.DONE.value, Status.BUSY.value, Status.ROW_FULL.value


class Lists(NamedTuple):
    """The sizes of the lists of neighbours, and the depth of the wells.

    ``stride : (1,)`` is the present number of words of a list, ``longest`` the number that there is memory for;
    ``full_depth : (kind, kind)`` the full depth of the wells [energy], ``strength : (1,)`` their present depth over
    the full one; ``work : (1,)`` the energy that changes of the strength have given to the molecules [energy].
    """

    stride: Any
    longest: int
    full_depth: Any
    strength: Any
    work: Any


@kernel
def energy_of_wells(wells):
    """Return the potential energy of all pairs that are in each other's well [energy]."""
    total = 0.0
    for one in range(wells.depth.shape[0]):
        for two in range(wells.depth.shape[1]):
            total += wells.depth[one, two] * wells.number[one, two]
    return -total


@kernel
def warm_bath(bath, kT):
    """Set the temperature of the random bath [energy]: see `AttractingParcelSet.set_bath_kT`."""
    bath.schedule_kT[:] = kT
    return 0


@kernel
def _as_listed(gas, lists):
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


@kernel
def _longer_lists(gas, lists):
    """Make all lists twice as long, in the same memory; return whether there is enough memory."""
    old = lists.stride[0]
    if 2 * old > lists.longest:
        return False
    entry = gas.vicinity.entry
    # from the last list to the first, so that no list is overwritten before it has been moved
    for i in range(gas.molecules.size - 1, 0, -1):
        for q in range(entry[i * old], -1, -1):
            entry[2 * i * old + q] = entry[i * old + q]
    lists.stride[0] = 2 * old
    return True


@functools.cache
def attracting(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``pass_time``, ``place`` and ``attract`` of one set of modes."""
    place_all, advance, replan, _ = (kernel(getattr(each, "py_func", each)) for each in specialise(modes))

    @kernel
    def resolve(gas, ascent, book, lists, stop, most):
        """Resolve events up to the local time `stop`, at most `most` of them; see `ParcelSet._resolve`."""
        done = 0
        while True:
            status, some = advance(_as_listed(gas, lists), stop, most - done)
            done += some
            book.now[0] = max(book.now[0], min(stop, next_time(gas, book.clocks)))
            if status == _DONE:
                book.now[0] = stop
                return Passed.DONE, done
            if status == _BUSY:
                return Passed.BUSY, done
            if status != _ROW_FULL:
                return Passed.STALLED, done
            if not _longer_lists(gas, lists):
                return Passed.FULL, done

    @kernel
    def place(gas, book, lists):
        """List the neighbours of all molecules at the start; keep the first time of the bath if it is drawn already."""
        state, clock = gas.tallies.random[0], gas.bath.clock[0]
        placed = place_all(_as_listed(gas, lists), book.now[0]) == _DONE
        while not placed and _longer_lists(gas, lists):
            placed = place_all(_as_listed(gas, lists), book.now[0]) == _DONE
        if not math.isinf(clock):
            gas.tallies.random[0] = state
            gas.bath.clock[0] = clock
        return Passed.DONE.value if placed else Passed.FULL.value

    @kernel
    def attract(gas, book, lists, strength):
        """Change the depth of all wells: see `AttractingParcelSet.set_strength`."""
        wells = gas.wells
        before = energy_of_wells(wells)
        for one in range(wells.depth.shape[0]):
            for two in range(wells.depth.shape[1]):
                wells.depth[one, two] = strength * lists.full_depth[one, two]
        lists.strength[0] = strength
        lists.work[0] += energy_of_wells(wells) - before
        replan(gas, book.now[0])
        return 0

    return epochs(resolve, modes), place, attract
