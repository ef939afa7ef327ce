"""How time passes: what is done between one stretch of events and the next, in one call.

The loop over events stops on the way: an epoch of the clocks is over, the copies in the rows of cells are too old, a
row is full, the piston has moved far. What is to be done then stands here, compiled, and it is the same in Python and
in a web page (`atmosbox.lab`). What compiled code cannot do is to take more memory: it returns to whoever called it,
and goes on where it was when it is called again.
"""

import functools
import math
from collections.abc import Callable
from enum import IntEnum
from typing import Any, NamedTuple

from atmosbox.engine.core.jit import by_reference, kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.core.walls import HEAT_BATH, wall_kT
from atmosbox.engine.exact.calendar import next_event
from atmosbox.engine.exact.encounter import kind_of
from atmosbox.engine.exact.exact import Status, advance, enter_all
from atmosbox.engine.exact.laying_out import STRIDE, as_laid_out, choose_cells, fits, write_cells
from atmosbox.engine.exact.rows import START, STOP, fill

__all__ = ["FILL", "LAY_OUT", "NOTHING", "NOW", "PLACE", "WHEN", "Book", "Passed", "pass_time", "passing"]

# The status leaves a loop as a plain number, and compiled code calls no number equal to an enum.
_BUSY, _STALLED, _CROWDED = Status.BUSY.value, Status.STALLED.value, Status.CROWDED.value
_ROW_FULL, _EPOCH_OVER, _OUTGROWN = Status.ROW_FULL.value, Status.EPOCH_OVER.value, Status.OUTGROWN.value
_CRUSHED, _TURNED = Status.CRUSHED.value, Status.TURNED.value

NOTHING, FILL, PLACE, LAY_OUT = range(4)
"""What is due before the next event: to write the copies in all rows, to place all molecules, to choose cells."""
NOW, WHEN = range(2)


class Book(NamedTuple):
    """What a box knows beside its gas.

    ``time : (2,)`` the local time now, and at which rows are to be filled [time]; ``due : (1,)`` what is to be done
    before the next event; ``turns : (1,)`` how often the piston has turned, and the ``interval`` from one turn to the
    next, ``inf`` if nobody turns it [time]; ``epoch_length`` after what time the clocks begin anew [time]; ``lowest``
    how low the ceiling may come [length]; ``start_energy`` [energy].
    """

    time: Any
    due: Any
    turns: Any
    interval: float
    epoch_length: float
    lowest: float
    start_energy: float


class Beside(NamedTuple):
    """What dry air has beside its molecules.

    ``clock : (k,)`` when something else happens than events of molecules [time]: nothing does; an ``ascent``
    (`turning.Ascent`) if compiled code turns the piston, else any number.
    """

    clock: Any
    ascent: Any


class Passed(IntEnum):
    """How far time has passed.

    ``DONE`` the time asked for is reached; ``BUSY`` as many events are resolved as were asked for; ``FULL`` the cells
    that are wanted now need more memory; ``CRAMPED`` a row has as many places as one may have; ``OUTGROWN`` the cells
    must be laid out anew in a way that compiled code does not know; ``STALLED`` events pile up without progress;
    ``CROWDED`` a molecule that evaporates finds no free place; ``CRUSHED`` the piston has come too low.
    """

    DONE = 0
    BUSY = 1
    FULL = 2
    CRAMPED = 3
    OUTGROWN = 4
    STALLED = 5
    CROWDED = 6
    CRUSHED = 7


@kernel
def _rebase(step, gas, more, book, modes):
    """Let all clocks read small numbers again, so that time keeps its digits for ever."""
    for i in range(gas.molecules.size):
        gas.molecules[i].clock -= step
        gas.events[i].contact_time -= step
    times = gas.calendar.time
    for k in range(times.size):
        times[k] -= step
    if modes.rows:
        gas.cells.copies.epoch[START] -= step
        gas.cells.copies.epoch[STOP] -= step
    gas.walls.piston[2] -= step
    gas.tallies.progress[0] -= step
    gas.walls.epoch[0] += step
    book.time[NOW] -= step
    for k in range(more.clock.size):
        more.clock[k] -= step


@kernel
def _longer_rows(gas, layout):
    """Ask for rows of more places, all empty; tell whether a row may have so many."""
    layout.shape[STRIDE] += layout.longer
    gas.cells.row[:] = 0
    return layout.shape[STRIDE] <= layout.longest


@kernel
def _jammed(gas, book, modes):
    """Tell whether the piston has heated the molecules a million times, as only one that crushes them can.

    Between jammed spheres the gaps close while the speeds grow as one over them: the events have no end.
    """
    kinetic = mass_of_all = hottest = 0.0
    number = 0
    for i in range(gas.molecules.size):
        m = gas.molecules[i]
        if (modes.phases and math.isinf(m.clock)) or (modes.drops > 0 and m.kind >= modes.drops):
            continue
        mass, _, _ = kind_of(i, gas, modes)
        kinetic += 0.5 * mass * (m.vx * m.vx + m.vy * m.vy + m.vz * m.vz)
        mass_of_all += mass
        number += 1
    for wall in range(6):
        if gas.walls.law[wall] == HEAT_BATH:
            hottest = max(hottest, wall_kT(gas.walls, wall, gas.walls.epoch[0] + book.time[NOW]))
    speed = gas.walls.piston[1]
    return kinetic > 1e6 * (book.start_energy + 2.0 * mass_of_all * speed * speed + 2.0 * number * hottest)


@kernel
def _next_time(gas, more):
    """Return the local time of what happens next [time]."""
    _, time = next_event(gas.calendar)
    for k in range(more.clock.size):
        time = min(time, more.clock[k])
    return time


@kernel
def _cells_chosen(gas, book, layout, modes):
    """Choose cells for the box as it is now; tell how that went."""
    if modes.piston and modes.rows and not modes.gravity and not modes.phases:
        piston = gas.walls.piston
        ceiling = piston[0] + piston[1] * (book.time[NOW] - piston[2])
        if not choose_cells(ceiling, gas.molecules.size, gas.box, layout):
            return Passed.OUTGROWN.value
        if not fits(gas.cells, layout):
            return Passed.FULL.value
        write_cells(gas, layout, modes)
        return Passed.DONE.value
    return Passed.OUTGROWN.value


@kernel
def _prepare(gas, book, layout, modes):
    """Do what is due before the next event; tell how that went: ``DONE`` if there can be events now."""
    while book.due[0] != NOTHING:
        if book.due[0] == LAY_OUT:
            how = _cells_chosen(gas, book, layout, modes)
            if how != Passed.DONE.value:
                return how
            book.due[0] = PLACE
        if modes.rows and not fits(gas.cells, layout):
            return Passed.FULL.value
        here = by_reference(as_laid_out(gas, layout))
        if book.due[0] == PLACE:
            gas.calendar.time[:] = math.inf
            gas.calendar.winner[:] = 0
            if enter_all(book.time[NOW], here, modes):
                return Passed.FULL.value
            book.time[WHEN] = book.time[NOW]
            book.due[0] = FILL if modes.rows else NOTHING
        if modes.rows:
            if not fill(book.time[WHEN], here, modes):
                book.due[0] = NOTHING
            elif not _longer_rows(gas, layout):
                return Passed.CRAMPED.value
    return Passed.DONE.value


@kernel
def pass_time(gas, more, book, layout, until, most, modes, advance):
    """Let time pass until ``until`` [time since the start], or for so many events; tell how far, and how many.

    Parameters
    ----------
    gas
        The box: see `state.Gas`.
    more
        What there is beside: a NamedTuple such as `Beside`, whose ``clock : (k,)`` tells when something else happens
        than events of molecules [time].
    book, layout
        See `Book` and `laying_out.Layout`; any number is in its place where neighbours are not found by cells.
    until, most
        Until when [time since the start], and how many events at most.
    modes
        What the box requires.
    advance
        The loop over events: it takes gas, more, until when [local time], how many events at most, and modes; it
        returns a `Status`, as a number, and how many events there were.
    """
    gas, more = by_reference(gas), by_reference(more)
    time, piston, done = book.time, gas.walls.piston, 0
    while True:
        if modes.attracts:
            here = gas
        else:
            how = _prepare(gas, book, layout, modes)
            if how != Passed.DONE.value:
                return how, done
            here = by_reference(as_laid_out(gas, layout))
        if done >= most:
            return Passed.BUSY.value, done
        # how far the clocks may go
        local = until - gas.walls.epoch[0]
        goal = local
        if local > book.epoch_length:
            if time[NOW] < book.epoch_length:
                goal = book.epoch_length
            else:
                # by how much they go back depends on events alone, never on where a run is cut
                ahead = min(_next_time(gas, more), (book.turns[0] + 1) * book.interval - gas.walls.epoch[0])
                if not math.isinf(ahead):  # or nothing is left to happen at all
                    step = max(1.0, math.floor(ahead / book.epoch_length)) * book.epoch_length
                    _rebase(step, gas, more, book, modes)
                    continue
        stop = goal
        if modes.piston and not modes.ascends and piston[1] < 0.0:
            stop = min(goal, piston[2] + (piston[0] - book.lowest) / -piston[1])
            if stop <= time[NOW] and stop < goal:
                return Passed.CRUSHED.value, done
        # events
        status, some = advance(here, more, stop, most - done, modes)
        done += some
        first = _next_time(gas, more)
        time[NOW] = max(time[NOW], min(stop, first))
        if status == _EPOCH_OVER:
            time[WHEN] = gas.calendar.time[1]
            book.due[0] = FILL
        elif status == _ROW_FULL:
            if not modes.rows:
                return Passed.FULL.value, done
            time[WHEN] = time[NOW]
            book.due[0] = FILL
            if not _longer_rows(gas, layout):
                return Passed.CRAMPED.value, done
        elif status == _OUTGROWN:
            book.due[0] = LAY_OUT
        elif status == _TURNED:
            time[NOW] = piston[2]
            book.due[0] = LAY_OUT
        elif status == _STALLED:
            time[NOW] = min(first, stop)
            return Passed.STALLED.value, done
        elif status == _CROWDED:
            time[NOW] = min(first, stop)
            return Passed.CROWDED.value, done
        elif status == _CRUSHED:
            time[NOW] = piston[2] + (piston[0] - book.lowest) / -piston[1]
            return Passed.CRUSHED.value, done
        elif modes.piston and piston[1] < 0.0 and _jammed(gas, book, modes):
            time[NOW] = min(first, stop)
            return Passed.CRUSHED.value, done
        elif status == _BUSY:
            return Passed.BUSY.value, done
        else:
            time[NOW] = stop
            if stop < goal:
                return Passed.CRUSHED.value, done
            if goal == local:
                return Passed.DONE.value, done


@functools.cache
def passing(modes: Modes) -> Callable[..., Any]:
    """Return what lets time pass in a box of dry air, for one set of modes."""

    @kernel(entry=True)
    def pass_dry(gas, more, book, layout, until, most):
        """Let time pass: see `pass_time`."""
        return pass_time(gas, more, book, layout, until, most, modes, advance)

    return pass_dry  # type: ignore[no-any-return]
