"""Advance a box in a page: what `ParcelSet.advance` does between two calls of the engine, as one kernel.

In Python the box acts when the engine stops on the way: because an epoch of its clocks is over, the copies in the rows
of cells are too old, or a row is full. A page has only compiled code, so the kernels here do the same, in the same
order and with the same numbers; a test compares the bytes.
"""

import functools
import math
from collections.abc import Callable
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Cells, Gas, Modes
from atmosbox.engine.exact.epoch import next_time, set_back, whole_epochs
from atmosbox.engine.exact.exact import Status, specialise
from atmosbox.engine.exact.rows import MORE, MOST, row_stride
from atmosbox.engine.exact.turning import Ascent
from atmosbox.lab.kernels.laying_out import LAST, NUMBER, PLACES, choose_cells, follow_molecules, write_cells
from atmosbox.lab.kernels.moist_passing import moist_passing

__all__ = ["Book", "Passed", "ascent_of", "epochs", "passing"]

# The status leaves the engine's loop as a plain number, and compiled code calls no number equal to an enum.
_DONE, _BUSY, _STALLED = Status.DONE.value, Status.BUSY.value, Status.STALLED.value
_ROW_FULL, _EPOCH_OVER = Status.ROW_FULL.value, Status.EPOCH_OVER.value
_CRUSHED, _TURNED, _CROWDED = Status.CRUSHED.value, Status.TURNED.value, Status.CROWDED.value


class Book(NamedTuple):
    """The data of a box besides its gas.

    ``now : (1,)`` is the time that its clocks show [time]; ``epoch_length : (1,)`` the time after which they are set
    back [time]; ``clocks`` those of events that are not events of a molecule [time], see `epoch`; ``energy : (1,)`` the
    energy at the start [energy]; ``moisture`` the liquid, 0 if there is none.
    """

    now: Any
    epoch_length: Any
    clocks: Any
    energy: Any
    moisture: Any


class Passed(IntEnum):
    """Why a call of ``pass_time`` has ended.

    ``DONE``: the requested time is reached; ``BUSY``: the largest number of events is reached; ``STALLED``: events pile
    up without progress; ``FULL``: more molecules have come together in a cell than it has memory for; ``CRUSHED``: the
    piston is too low; ``CROWDED``: there is no free place for a molecule that evaporates.
    """

    DONE = 0
    BUSY = 1
    STALLED = 2
    FULL = 3
    CRUSHED = 4
    CROWDED = 5


@kernel
def ascent_of(ascent, book, filled):
    """Return the ascent with the energy at its start, for cells that were laid out for a ceiling at this height."""
    a = ascent
    return Ascent(a.lift, a.turns, filled, a.lowest, book.energy[0], a.gravity_work, a.freedom, a.diameter)


@kernel
def _stride(layout, modes):
    """Return the present number of words in the row of a cell: with copies of trajectories, or with numbers only."""
    places = layout.shape[PLACES]
    return row_stride(places, modes.mixed) if modes.rows else 1 + places


@kernel
def _as_laid_out(gas, layout, modes):
    """Return the gas with its present cells."""
    c, shape = gas.cells, layout.shape
    cells = Cells(
        c.row, _stride(layout, modes), c.boundary, c.first, c.span, c.slot,
        shape[NUMBER], shape[NUMBER + 1], shape[NUMBER + 2], shape[LAST], shape[LAST + 1], shape[LAST + 2], c.copies,
    )  # fmt: skip
    return Gas(gas.molecules, gas.events, gas.kinds, cells, gas.calendar, gas.box, gas.walls, gas.tallies)


@kernel
def _fits(gas, layout, modes):
    """Return whether there is memory for all cells and their rows."""
    shape = layout.shape
    x, y, z = shape[NUMBER], shape[NUMBER + 1], shape[NUMBER + 2]
    if modes.rows and shape[PLACES] > MOST:
        return False
    return x * y * z * _stride(layout, modes) <= gas.cells.row.size and max(x, y, z) < layout.edge.shape[1]


@kernel
def _longer_rows(gas, layout, modes):
    """Give the rows more places in the same memory; return whether there is enough. Copies of trajectories are lost."""
    row, shape, old = gas.cells.row, layout.shape, _stride(layout, modes)
    shape[PLACES] += MORE if modes.rows else old
    if not _fits(gas, layout, modes):
        return False
    if modes.rows:
        row[:] = 0
        return True
    # rows of numbers become twice as long: from the last to the first, so that none is overwritten before it is moved
    for cell in range(shape[NUMBER] * shape[NUMBER + 1] * shape[NUMBER + 2] - 1, 0, -1):
        for place in range(np.int64(row[cell * old]), -1, -1):
            row[2 * cell * old + place] = row[cell * old + place]
    return True


def epochs(resolve: Callable[..., Any], modes: Modes) -> Callable[..., Any]:
    """Return the kernel ``pass_time`` of a box; ``resolve`` resolves its events up to a local time."""

    @kernel
    def pass_time(gas, ascent, book, layout, until, most):
        """Advance to ``until`` [time since the start], or by ``most`` events; return a `Passed` and the events."""
        done = 0
        while True:
            local = until - gas.walls.epoch[0]
            shifts = local > book.epoch_length[0]
            if shifts and book.now[0] >= book.epoch_length[0]:
                ahead = next_time(gas, book.clocks)
                if modes.ascends:
                    ahead = min(ahead, (ascent.turns[0] + 1) * ascent.lift.interval - gas.walls.epoch[0])
                step = whole_epochs(ahead, book.epoch_length[0])
                shifts = step > 0.0
                if shifts:
                    set_back(step, gas, book.clocks, modes)
                    book.now[0] -= step
                    continue
            goal = book.epoch_length[0] if shifts else local
            status, some = resolve(gas, ascent, book, layout, goal, most - done)
            done += some
            if status != Passed.DONE or not shifts:
                return status.value, done

    made: Callable[..., Any] = pass_time
    return made


@functools.cache
def passing(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``pass_time`` and ``place`` of one set of modes."""
    place_all, _, _, _, refill = (kernel(getattr(each, "py_func", each)) for each in specialise(modes))
    advance, _, wake = moist_passing(modes)

    if modes.ascends:

        @kernel
        def proceed(gas, ascent, book, layout, until, most):
            """Resolve events, and change the velocity of the piston when it is due."""
            here = ascent_of(ascent, book, layout.filled[0])
            return advance(_as_laid_out(gas, layout, modes), here, book, until, most)

    else:

        @kernel
        def proceed(gas, ascent, book, layout, until, most):
            """Resolve events."""
            return advance(_as_laid_out(gas, layout, modes), ascent, book, until, most)

    @kernel
    def refilled(gas, now, layout):
        """Write the copies in all rows again, in longer rows if needed; return whether there was memory for them."""
        if modes.rows:
            while refill(_as_laid_out(gas, layout, modes), now):
                if not _longer_rows(gas, layout, modes):
                    return False
        return True

    @kernel
    def placed(gas, now, layout):
        """Enter all molecules into their cells and plan their events; return whether there was memory."""
        while True:
            gas.calendar.time[:] = math.inf
            gas.calendar.winner[:] = 0
            if place_all(_as_laid_out(gas, layout, modes), now) != _ROW_FULL:
                return True
            if not _longer_rows(gas, layout, modes):
                return False

    if modes.piston and modes.rows and not modes.periodic and not modes.gravity:

        @kernel
        def laid_out(gas, now, layout):
            """Choose cells for the present box; return whether that was possible."""
            piston = gas.walls.piston
            ceiling = piston[0] + piston[1] * (now - piston[2])
            if not (choose_cells(ceiling, gas.molecules.size, gas.box, layout) and _fits(gas, layout, modes)):
                return False
            write_cells(gas, layout, modes)
            return placed(gas, now, layout)

    else:

        @kernel
        def laid_out(gas, now, layout):
            """Return False: a box without a piston keeps its cells."""
            return False

    if modes.gravity and modes.rows and not (modes.piston or modes.mixed):

        @kernel
        def closer(gas, layout):
            """Fit layers to the molecules, because rows are too short; return whether that was possible."""
            return layout.column.wanted > 1 and follow_molecules(gas, layout, modes) and _fits(gas, layout, modes)

    else:

        @kernel
        def closer(gas, layout):
            """Return False: only a column has other layers."""
            return False

    @kernel
    def entered(gas, now, layout, as_they_are):
        """Enter all molecules into the present cells, or into layers fitted to them; return whether that succeeded."""
        while as_they_are or closer(gas, layout):
            if placed(gas, now, layout):
                return True
            as_they_are = False
        return False

    @kernel
    def resolve(gas, ascent, book, layout, stop, most):
        """Resolve events up to the local time `stop`, at most `most` of them; see `ParcelSet._resolve`."""
        done = 0
        while True:
            status, some = proceed(gas, ascent, book, layout, stop, most - done)
            done += some
            book.now[0] = max(book.now[0], min(stop, next_time(gas, book.clocks)))
            if status == _DONE:
                book.now[0] = stop
                return Passed.DONE, done
            if status == _BUSY:
                return Passed.BUSY, done
            if status in (_EPOCH_OVER, _ROW_FULL):
                begins = gas.calendar.time[1] if status == _EPOCH_OVER else book.now[0]
                longer = status == _EPOCH_OVER or _longer_rows(gas, layout, modes)
                if not ((longer and refilled(gas, begins, layout)) or entered(gas, book.now[0], layout, False)):
                    return Passed.FULL, done
            elif status == _STALLED:
                return Passed.STALLED, done
            elif status == _CRUSHED:
                return Passed.CRUSHED, done
            elif status == _CROWDED:
                return Passed.CROWDED, done
            else:
                if status == _TURNED:
                    book.now[0] = gas.walls.piston[2]
                if not laid_out(gas, book.now[0], layout):
                    return Passed.FULL, done
                if status == _TURNED:
                    wake(gas, book, 2.0 * abs(gas.walls.piston[1]))

    @kernel
    def place(gas, book, layout):
        """Place all molecules at the start; return ``DONE`` or ``FULL``."""
        return Passed.DONE.value if entered(gas, book.now[0], layout, True) else Passed.FULL.value

    return epochs(resolve, modes), place
