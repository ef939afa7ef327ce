"""Advance a box: the loop over events, and what happens between its stops.

All times are local: they count from ``Walls.epoch``. When the next event lies further ahead of that than the length of
an epoch, all clocks are set back by whole epochs. ``clocks`` are the times of events that belong to no molecule: those
of a liquid, or of a thermostat. Python runs these functions as they are written, and the lab's page compiles them. If
memory is too small, they return ``FULL``; Python makes more and calls again.
"""

import functools
import math
from collections import namedtuple
from collections.abc import Callable
from typing import Any

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.exact import Status, specialise
from atmosbox.engine.exact.layout import CHOOSE, LENGTHEN, NEW_EPOCH, as_laid_out, settling
from atmosbox.engine.exact.rows import START, STOP
from atmosbox.engine.exact.turning import Ascent


@kernel(plain=True)
def next_time(gas, clocks):
    """Return the local time of the next event of a molecule or of one of the clocks [time]."""
    time = gas.calendar.time[1]
    for clock in clocks:
        time = min(time, clock)
    return time


@kernel(plain=True)
def whole_epochs(ahead, length):
    """Return by how much to set clocks back when the next event is at the local time ``ahead`` [time]; 0 for no event.

    The result depends on events alone, not on where a run is cut into pieces.

    >>> whole_epochs(70.0, 32.0), whole_epochs(31.0, 32.0), whole_epochs(math.inf, 32.0)
    (64.0, 32.0, 0.0)
    """
    return 0.0 if math.isinf(ahead) else max(1.0, math.floor(ahead / length)) * length


@kernel(plain=True)
def set_back(step, gas, clocks, modes):
    """Set all clocks of a box back by ``step`` [time]."""
    clock, contact, due = gas.molecules.clock, gas.events.contact_time, gas.calendar.time
    clock -= step
    contact -= step
    due -= step
    clocks -= step
    gas.walls.piston[2] -= step
    gas.walls.epoch[0] += step
    gas.tallies.progress[0] -= step
    if modes.rows:
        gas.cells.copies.epoch[START] -= step
        gas.cells.copies.epoch[STOP] -= step


# The status leaves the engine's loop as a plain number, and compiled code calls no number equal to an enum.
_DONE, _FULL, _CROWDED = Status.DONE.value, Status.FULL.value, Status.CROWDED.value
_EPOCH_OVER, _TURNED = Status.EPOCH_OVER.value, Status.TURNED.value


class Book(namedtuple("Book", "now epoch_length clocks turn energy moisture")):
    """The data of a box besides its gas.

    ``now : (1,)`` is the time that its clocks show [time]; ``epoch_length : (1,)`` the time after which they are set
    back [time]; ``clocks`` those of events that belong to no molecule [time]; ``turn : (1,)`` the time since the start
    at which Python sets the velocity of the piston next [time], ``inf`` if it never does;
    ``energy : (1,)`` the energy at the start [energy]; ``moisture`` the liquid, 0 if there is none.
    """


@kernel(plain=True)
def ascent_of(ascent, book, filled):
    """Return the ascent with the energy at its start, for cells that were laid out for a ceiling at this height."""
    a = ascent
    return Ascent(a.lift, a.turns, filled, a.lowest, book.energy[0], a.gravity_work, a.freedom, a.diameter)


@functools.cache
def dry_loop(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``advance``, ``draw`` and ``wake`` of a box without liquid."""
    loop = specialise(modes)[1]

    @kernel(plain=True)
    def advance(gas, ascent, book, until, most):
        """Resolve events, and change the velocity of a piston that follows a pressure when it is due."""
        if modes.ascends:
            return loop(gas, ascent, until, most)
        return loop(gas, until, most)

    @kernel(plain=True)
    def wake(gas, book, speed):
        """Do nothing: there is no liquid."""

    return advance, wake, wake


@functools.cache
def advancing(modes: Modes, loops: Callable[[Modes], tuple[Callable[..., Any], ...]]) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``pass_time`` and ``settle`` of one set of modes; ``loops`` gives the loop over events."""
    advance, _, wake = loops(modes)
    settle = settling(modes)

    @kernel(plain=True)
    def proceed(gas, ascent, book, layout, until, most):
        """Resolve events in the cells as they are laid out."""
        here = as_laid_out(gas, layout, modes)
        if modes.ascends:
            return advance(here, ascent_of(ascent, book, layout.filled[0]), book, until, most)
        return advance(here, ascent, book, until, most)

    return passing(proceed, settle, wake, modes), settle


def passing(proceed: Callable[..., Any], settle: Callable[..., Any], wake: Callable[..., Any], modes: Modes) -> Any:
    """Return the kernel ``pass_time`` of a box.

    ``proceed`` resolves events up to a local time, ``settle`` does what is due in the cells, and ``wake`` tells the
    liquid that molecules may now be faster.
    """

    @kernel(plain=True)
    def resolve(gas, ascent, book, layout, stop, most):
        """Resolve events up to the local time `stop`, at most `most` of them; return a `Status` and their number."""
        done = 0
        while True:
            if not settle(gas, book.now[0], layout):
                return _FULL, done
            status, some = proceed(gas, ascent, book, layout, stop, most - done)
            done += some
            book.now[0] = max(book.now[0], min(stop, next_time(gas, book.clocks)))
            if status == _DONE:
                book.now[0] = stop
            if status <= _CROWDED and status != _FULL:
                return status, done
            layout.due[0] = CHOOSE
            if status == _FULL:
                layout.due[0] = LENGTHEN
            elif status == _EPOCH_OVER:
                layout.due[0] = NEW_EPOCH
            elif status == _TURNED:
                book.now[0] = gas.walls.piston[2]
                wake(gas, book, 2.0 * abs(gas.walls.piston[1]))

    @kernel(plain=True)
    def pass_time(gas, ascent, book, layout, until, most):
        """Advance to ``until`` [time since the start], or by ``most`` events; return a `Status` and the events."""
        done = 0
        while True:
            local = until - gas.walls.epoch[0]
            shifts = local > book.epoch_length[0]
            if shifts and book.now[0] >= book.epoch_length[0]:
                ahead = min(next_time(gas, book.clocks), book.turn[0] - gas.walls.epoch[0])
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
            if status != _DONE or not shifts:
                return status, done

    return pass_time
