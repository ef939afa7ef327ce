"""The exact engine: time jumps from one event to the next, and nothing in between is approximated.

Every molecule has one event, the first of three: its next contact, the next boundary of a cell that it reaches, its
next hit on a wall. The calendar tells which event of all molecules is the next. It is resolved, and the events of the
molecules whose velocity it changed are predicted again. If the partner of a contact has had another encounter since the
contact was predicted, the prediction is stale: nothing happens, and the events of the molecule are predicted again. The
order of events is exact to rounding.

The loop over events is `proceed`: read it first. `specialise` makes the kernels for one set of `Modes`, the features
that a scene needs; the code of all other features is not compiled.
"""

import functools
import math
from collections.abc import Callable
from enum import IntEnum
from typing import Any

import numpy as np

from atmosbox.engine.core.jit import POSITIVE, by_reference, kernel, prefetch
from atmosbox.engine.core.pair import nearest_image, reach
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.calendar import next_event
from atmosbox.engine.exact.cells import slots_at, turns_past
from atmosbox.engine.exact.crossing import Crossed, cross, is_wall
from atmosbox.engine.exact.encounter import hit, meet, motion_at, size_and_radius
from atmosbox.engine.exact.membership import Change, change, listed, places
from atmosbox.engine.exact.prediction import CEILING, call, plan
from atmosbox.engine.exact.rows import STOP, fill
from atmosbox.engine.exact.search import CONTACT
from atmosbox.engine.exact.turning import Next, ahead, gauges, replan_under, turn


class Status(IntEnum):
    """Why the loop over events has stopped.

    ``DONE``: the requested time is reached; ``BUSY``: as many events are resolved as were requested; ``STALLED``: very
    many events in a vanishing time; ``FULL``: the row of a cell must become longer; ``CRUSHED``: the piston has come
    too low; ``CROWDED``: there is no free place for a molecule that evaporates; ``MEETS_LIQUID``: the next event is a
    molecule that meets a pool or a drop, which the caller resolves; ``EPOCH_OVER``: the copies in the rows must be
    written again before the next event; ``OUTGROWN``: a molecule has risen above the cells, which must be chosen again;
    ``TURNED``: the piston has a new velocity, and the cells must be chosen again because the height of the box has
    changed too much.
    """

    DONE = 0
    BUSY = 1
    STALLED = 2
    FULL = 3
    CRUSHED = 4
    CROWDED = 5
    MEETS_LIQUID = 6
    EPOCH_OVER = 7
    OUTGROWN = 8
    TURNED = 9


CHECK_EVERY = 1024
"""Number of events between two checks whether the run has stalled."""
_FLOOR, _CEILING = 4, 5  # numbers of walls; `CEILING` is the event with a ceiling that moves


@kernel
def fetch_ahead(gas, also, start, step):
    """Ask the processor for the data of the molecules whose events may come next, before they are needed.

    Number ``start + step * i`` of the array ``also`` belongs to molecule i. These are the molecules in the nodes 2 to 7
    of the calendar's tree. Each node holds the molecule of the earlier event of the two nodes below it, so the next
    event of all is in node 1::

                  1
              2       3
            4   5   6   7
    """
    calendar = gas.calendar
    for node in range(2, 8):
        i = np.int64(calendar.winner[node])
        prefetch(gas.molecules, i)
        prefetch(gas.events, i)
        prefetch(also, start + step * i)


@kernel
def piled_up(t, events, gas):
    """Count ``events`` more events up to time t; return whether there are too many of them in a vanishing time."""
    progress = gas.tallies.progress
    if t - progress[0] > gas.box.stall:
        progress[0] = t
        progress[1] = 0.0
    progress[1] += events
    return progress[1] > 100_000 + 64 * gas.molecules.size


@kernel
def proceed(gas, until, most, modes):
    """Resolve events up to time ``until``, at most ``most`` of them; return a `Status` and their number."""
    tallies = gas.tallies
    done = 0
    status = Status.BUSY
    contacts = entered = left = stale = wall_hits = 0
    epoch_end = gas.cells.copies.epoch[STOP]
    while done < most:
        # the molecule of the next event, and its time; reasons to stop before it
        i, t = next_event(gas.calendar)
        if not t <= until:
            status = Status.DONE
            break
        if modes.rows and t > epoch_end:
            status = Status.EPOCH_OVER
            break
        if done & (CHECK_EVERY - 1) == CHECK_EVERY - 1 and piled_up(t, CHECK_EVERY, gas):
            status = Status.STALLED
            break
        fetch_ahead(gas, gas.calendar.time, gas.calendar.leaf, 1)
        # what comes: 0 to 5 a boundary or a wall, 6 a contact, 7 the moving ceiling
        event = gas.events[i]
        what = np.int64(event.what)
        # fly the molecule from its own clock to the event: no other molecule moves
        at = motion_at(i, t, gas, modes)
        j = -1
        other = at
        boundary = CONTACT  # at no boundary
        if what < CONTACT and not is_wall(i, what, gas, modes):
            # a boundary between cells: the molecule's motion does not change, only its cells and its event do
            if modes.rows:
                boundary = what  # `plan`, below, enters it into the new cells
                entered += 1
            else:
                crossed = cross(i, what, t, at, gas, modes)
                if crossed == Crossed.FULL:
                    status = Status.FULL
                    break
                entered += 1 if crossed == Crossed.ENTERED else 0
                left += 1 if crossed == Crossed.LEFT else 0
                done += 1
                continue
        elif what == CONTACT:
            # a contact, if the partner has had no other encounter since the prediction
            j = np.int64(event.partner)
            if j != i and gas.molecules[j].count == event.partner_count:
                if (
                    modes.drops > 0
                    and max(np.int64(gas.molecules[i].kind), np.int64(gas.molecules[j].kind)) >= modes.drops
                ):
                    status = Status.MEETS_LIQUID
                    break
                at, other = meet(i, j, t, at, gas, modes)
                contacts += 1
            else:
                # a contact with itself only asks for new predictions; at the time of its clock it is a request by
                # `call`, which is not counted as stale
                stale += 1 if j != i or gas.molecules[i].clock < t else 0
                j = -1
        else:
            # a wall; under a piston 5 is the upper end of the cells
            if modes.pool and what == _FLOOR:
                status = Status.MEETS_LIQUID
                break
            if modes.rows and modes.piston and what == _CEILING:
                status = Status.OUTGROWN
                break
            at = hit(i, _CEILING if what == CEILING else what, t, at, gas, modes)
            wall_hits += 1
        done += 1
        # predict the next events of i and, after a contact, of j: in one loop, so that `plan` is compiled only once
        full = False
        m = i
        while True:
            full |= plan(m, t, at, boundary, gas, modes)
            if j < 0:
                break
            m = j
            j = -1
            at = other
        if full:
            status = Status.FULL
            break
    for k, more in enumerate((contacts, entered, left, stale, wall_hits)):
        tallies.count[k] += more
    return status, done


@functools.cache
def _laying_out(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``place`` and ``refill``."""

    @kernel(entry=True)
    def place(gas, now):
        """Enter all molecules into their cells at time ``now``, and request predictions for all; stop at a full row."""
        gas = by_reference(gas)
        cells = gas.cells
        row = cells.row
        row[:] = 0
        for i in range(gas.molecules.size):
            if modes.phases and math.isinf(gas.molecules[i].clock):
                continue  # it is in the liquid
            at = motion_at(i, now, gas, modes)
            size, _ = size_and_radius(i, gas, modes)
            # in a periodic box: moved by whole lengths into the one that begins at the lowest boundary
            dx, dy, dz = turns_past(at.x, 0, size, gas), turns_past(at.y, 1, size, gas), turns_past(at.z, 2, size, gas)
            molecule = gas.molecules[i]
            molecule.x -= dx
            molecule.y -= dy
            molecule.z -= dz
            slots = slots_at(at.x - dx, at.y - dy, at.z - dz, size, cells, modes)
            cells.slot[i, 0], cells.slot[i, 1], cells.slot[i, 2] = slots
            call(i, now, gas)
            if modes.contacts and not modes.rows:
                if change(Change.TEST, i, size, slots, cells, modes):
                    return Status.FULL.value
                change(Change.ADD, i, size, slots, cells, modes)
        if modes.rows and fill(now, gas, modes):
            return Status.FULL.value
        return Status.DONE.value

    @kernel(entry=True)
    def refill(gas, now):
        """Write the copies in all rows again at time ``now``; return whether a row is too short."""
        gas = by_reference(gas)
        return fill(now, gas, modes)

    return place, refill


@functools.cache
def _checking(modes: Modes) -> Any:
    """Return the kernel ``overlap``."""

    @kernel(entry=True)
    def overlap(gas):
        """Return the deepest overlap, in diameters, and the two molecules; all clocks must read the same time."""
        gas = by_reference(gas)
        cells = gas.cells
        deepest = -1.0
        first = second = -1
        for cell in range(cells.number_x * cells.number_y * cells.number_z):
            start = (cell * cells.stride) & POSITIVE
            for p in range(places(start, cells, modes)):
                i = listed(start, p, cells, modes)
                for q in range(p):
                    j = listed(start, q, cells, modes)
                    if i < 0 or j < 0:
                        continue
                    one, two = gas.molecules[i], gas.molecules[j]
                    _, radius = size_and_radius(i, gas, modes)
                    _, other_radius = size_and_radius(j, gas, modes)
                    rx, ry, rz = nearest_image(one.x - two.x, one.y - two.y, one.z - two.z, gas.box, modes)
                    distance = reach(radius, other_radius)
                    depth = 1.0 - math.sqrt(rx * rx + ry * ry + rz * rz) / distance if distance > 0.0 else -1.0
                    if depth > deepest:
                        deepest, first, second = depth, min(i, j), max(i, j)
        return deepest, first, second

    return overlap


@functools.cache
def specialise(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels of one set of modes: ``place``, ``advance``, ``replan_ceiling``, ``overlap`` and ``refill``.

    The flags are constants in the kernels, so that numba leaves out what is switched off. The kernels are compiled once
    for each set of flags, and kept on disk. Kernels that use only few flags are shared by all sets that differ in the
    other flags.
    """
    of_events = ("rotation", "pool", "drops", "images", "ascends")
    place, refill = _laying_out(modes.without("piston", *of_events))
    overlap = _checking(modes.without("contacts", "spanning", "phases", *of_events))

    @kernel(entry=True)
    def replan_ceiling(gas, now, lowest):
        """Predict again, at ``now``, the moves of all molecules that may meet a ceiling coming down to ``lowest``."""
        gas = by_reference(gas)
        replan_under(lowest, now, gas, modes)

    @kernel(entry=True)
    def advance(gas, until, most):
        """Resolve events up to time ``until``, at most ``most`` of them; return a `Status` as a number and how many.

        The status is a plain number: to make an enum, numba would call Python, where a signal such as Ctrl-C could
        raise an exception that compiled code cannot handle.
        """
        gas = by_reference(gas)
        status, done = proceed(gas, until, most, modes)
        return status.value, done

    @kernel(entry=True)
    def ascend(gas, ascent, until, most):
        """Do what ``advance`` does, and set the velocity of the piston whenever that is due."""
        gas, ascent = by_reference(gas), by_reference(ascent)
        done = 0
        while True:
            # up to the time at which the piston gets its next velocity, which is then set (`turning`)
            stop, then = ahead(until, gas, ascent)
            status, some = proceed(gas, stop, most - done, modes)
            done += some
            if status != Status.DONE or then == Next.END:
                return status.value, done
            if then == Next.CRUSHED:
                return Status.CRUSHED.value, done
            at = gauges(stop, gas.molecules.size, ascent.freedom, 0.0, gas, ascent)
            if not turn(stop, at, gas, ascent, modes):
                return Status.TURNED.value, done

    return place, ascend if modes.ascends else advance, replan_ceiling, overlap, refill
