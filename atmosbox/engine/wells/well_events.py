"""The loop over events for molecules that attract each other.

Every molecule has one event, as in `exact`: the next core or edge that it reaches with a neighbour, the end of its
shell, or a wall, whichever comes first. In addition the bath draws velocities again at times of its own.
"""

import functools
import math
from collections import namedtuple
from collections.abc import Callable
from typing import Any

import numpy as np

from atmosbox.engine.core.elementary import log_of_normal
from atmosbox.engine.core.jit import POSITIVE, kernel
from atmosbox.engine.core.motion import time_to_leave, time_to_leave_in_gravity
from atmosbox.engine.core.pair import nearest_image
from atmosbox.engine.core.random import gaussian_pair, uniform
from atmosbox.engine.core.square_well import CAPTURE, CORE, RELEASE, resolve_crossing, time_to_crossing
from atmosbox.engine.core.state import Modes, Motion
from atmosbox.engine.core.walls import wall_kT
from atmosbox.engine.exact.calendar import next_event, schedule
from atmosbox.engine.exact.encounter import hit, kind_of, motion_at, write
from atmosbox.engine.exact.exact import CHECK_EVERY, Status, fetch_ahead, piled_up
from atmosbox.engine.exact.prediction import call
from atmosbox.engine.exact.search import CONTACT
from atmosbox.engine.wells.vicinity import bring_back, enter, is_inside, renew, set_inside, time_to_leave_shell, well_of

SHELL = CONTACT + 4
"""Which event comes first: 0 to 5 a wall, 6 to 8 `CORE`, `CAPTURE` or `RELEASE` of a pair, 10 the end of the shell."""
_BATH = 3


class WellGas(namedtuple("WellGas", "molecules events kinds calendar box walls tallies wells vicinity bath")):
    """All data of these kernels; the parts are described at the types of these names: see `state.Gas`."""


@kernel
def _next_wall(i, at, gas, modes):
    """Return when molecule i next hits a wall [time from now], ``inf`` if never, and the number of the wall."""
    box = gas.box
    _, radius, _ = kind_of(i, gas, modes)
    time = math.inf
    what = 0
    if box.inverse_x == 0.0:
        time, what = time_to_leave(at.x, at.vx, radius, box.length_x - radius)
    if box.inverse_y == 0.0:
        after, up = time_to_leave(at.y, at.vy, radius, box.length_y - radius)
        if after < time:
            time, what = after, 2 + up
    if box.inverse_z == 0.0:
        if modes.gravity:
            after, up = time_to_leave_in_gravity(at.z, at.vz, radius, box.length_z - radius, box.gravity)
        else:
            after, up = time_to_leave(at.z, at.vz, radius, box.length_z - radius)
        if after < time:
            time, what = after, 4 + up
    return time, what


@kernel
def _plan(i, t, at, gas, modes):
    """Predict the next event of molecule i, whose `Motion` at time t is ``at``, and enter it in the calendar."""
    vicinity, event = gas.vicinity, gas.events[i]
    time, what = _next_wall(i, at, gas, modes)
    after = time_to_leave_shell(i, at, gas, modes)
    if after < time:
        time, what = after, SHELL
    partner = -1
    well = well_of(i, i, gas, modes)
    start = (i * vicinity.stride) & POSITIVE
    for q in range(start + 1, start + 1 + np.int64(vicinity.entry[start])):
        entry = np.int64(vicinity.entry[q])
        j = entry >> 1
        other = motion_at(j, t, gas, modes)
        r = nearest_image(at.x - other.x, at.y - other.y, at.z - other.z, gas.box, modes)
        u = at.vx - other.vx, at.vy - other.vy, at.vz - other.vz
        if modes.mixed:
            well = well_of(i, j, gas, modes)
        after, which = time_to_crossing(r, u, well, is_inside(entry), time)
        if after < time:
            time, what = after, CONTACT + which
            partner = j
    if partner >= 0:
        event.partner = partner
        event.partner_count = gas.molecules[partner].count
    event.what = what
    schedule(gas.calendar, i, t + time)


@kernel
def _meet(i, j, t, at, which, gas, modes):
    """Resolve the event of a pair at its core or edge; return the `Motion` of both after it."""
    wells, tallies = gas.wells, gas.tallies
    other = motion_at(j, t, gas, modes)
    r = nearest_image(at.x - other.x, at.y - other.y, at.z - other.z, gas.box, modes)
    u = (at.vx - other.vx, at.vy - other.vy, at.vz - other.vz)
    mass, _, _ = kind_of(i, gas, modes)
    other_mass, _, _ = kind_of(j, gas, modes)
    d, happened = resolve_crossing(r, u, which, mass, other_mass, well_of(i, j, gas, modes).depth)
    if happened == CORE:
        tallies.count[0] += 1
    else:
        wells.count[happened - CAPTURE] += 1
        if happened in (CAPTURE, RELEASE):
            set_inside(i, j, happened == CAPTURE, gas.vicinity)
            lower = min(gas.molecules[i].kind, gas.molecules[j].kind)
            higher = max(gas.molecules[i].kind, gas.molecules[j].kind)
            wells.number[lower, higher] += 1 if happened == CAPTURE else -1
    layer = min(max(int((at.z - 0.5 * r[2]) * tallies.layer_scale), 0), tallies.virial.size - 1)
    tallies.virial[layer] += mass * (r[0] * d[0] + r[1] * d[1] + r[2] * d[2])
    wells.stress[0] += mass * r[0] * d[0]
    wells.stress[1] += mass * r[1] * d[1]
    wells.stress[2] += mass * r[2] * d[2]
    back = mass / other_mass if modes.mixed else 1.0
    one = Motion(at.x, at.y, at.z, at.vx + d[0], at.vy + d[1], at.vz + d[2])
    two = Motion(other.x, other.y, other.z, other.vx - back * d[0], other.vy - back * d[1], other.vz - back * d[2])
    write(i, t, one, gas)
    write(j, t, two, gas)
    return one, two


@kernel
def _draw_anew(t, gas, modes):
    """Draw the velocity of a random molecule again at time t; return its number, and its `Motion` after it."""
    bath, state = gas.bath, gas.tallies.random
    number = gas.molecules.size
    i = min(int(uniform(state) * number), number - 1)
    at = motion_at(i, t, gas, modes)
    mass, _, _ = kind_of(i, gas, modes)
    before = 0.5 * mass * (at.vx * at.vx + at.vy * at.vy + at.vz * at.vz)
    thermal_speed = math.sqrt(wall_kT(bath, 0, gas.walls.epoch[0] + t) / mass)
    vx, vy = gaussian_pair(state)
    vz, _ = gaussian_pair(state)
    after = Motion(
        at.x, at.y, at.z, thermal_speed * vx, 0.0 if gas.box.planar else thermal_speed * vy, thermal_speed * vz
    )
    bath.heat[0] += 0.5 * mass * (after.vx * after.vx + after.vy * after.vy + after.vz * after.vz) - before
    bath.clock[0] = t + time_until_bath(number, gas)
    gas.wells.count[_BATH] += 1
    write(i, t, after, gas)
    return i, after


@kernel
def time_until_bath(number, gas):
    """Return the time until the bath acts on one of ``number`` molecules [time from now]."""
    rate = gas.bath.rate * number
    return -log_of_normal(uniform(gas.tallies.random)) / rate if rate > 0.0 else math.inf


@kernel
def proceed(gas, until, most, modes):
    """Resolve events up to time ``until``, at most ``most`` of them; return a `Status` and their number."""
    tallies = gas.tallies
    done = 0
    status = Status.BUSY
    stale = wall_hits = renewed = 0
    while done < most:
        i, t = next_event(gas.calendar)
        drawn = gas.bath.clock[0] < t
        if drawn:
            t = gas.bath.clock[0]
        if not t <= until:
            status = Status.DONE
            break
        if done & (CHECK_EVERY - 1) == CHECK_EVERY - 1 and piled_up(t, CHECK_EVERY, gas):
            status = Status.STALLED
            break
        j = -1
        if drawn:
            i, at = _draw_anew(t, gas, modes)
            other = at
        else:
            fetch_ahead(gas, gas.vicinity.entry, 0, gas.vicinity.stride)
            event = gas.events[i]
            what = np.int64(event.what)
            at = motion_at(i, t, gas, modes)
            other = at
            if what == SHELL:
                at = bring_back(i, at, gas)
                if renew(i, at, False, gas, modes):
                    status = Status.FULL
                    break
                renewed += 1
            elif what < CONTACT:
                at = hit(i, what, t, at, gas, modes)
                wall_hits += 1
            else:
                j = np.int64(event.partner)
                if j != i and gas.molecules[j].count == event.partner_count:
                    at, other = _meet(i, j, t, at, what - CONTACT, gas, modes)
                else:
                    stale += 1 if j != i else 0
                    j = -1
        done += 1
        # the events of both are predicted again; in one loop, so that the code is compiled once
        m = i
        while True:
            _plan(m, t, at, gas, modes)
            if j < 0:
                break
            m = j
            j = -1
            at = other
    tallies.count[1] += renewed
    tallies.count[3] += stale
    tallies.count[4] += wall_hits
    return status, done


@functools.cache
def specialise(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels of one set of modes: ``place``, ``advance``, ``replan`` and ``overlap``."""

    @kernel(entry=True)
    def place(gas, now):
        """Make the lists of all molecules at time ``now`` and have their events predicted; stop at a full list."""
        vicinity = gas.vicinity
        vicinity.first[:] = -1
        vicinity.cell[:] = -1
        vicinity.mark[:] = 0
        for i in range(gas.molecules.size):
            at = bring_back(i, motion_at(i, now, gas, modes), gas)
            vicinity.entry[i * vicinity.stride] = 0
            vicinity.previous[i] = -1
            vicinity.next[i] = -1
            vicinity.anchor[i, 3] = vicinity.width[vicinity.width.size - 1]
            enter(i, at.x, at.y, at.z, vicinity)
            call(i, now, gas)
        for i in range(gas.molecules.size):
            if renew(i, motion_at(i, now, gas, modes), True, gas, modes):
                return Status.FULL.value
        wells = gas.wells
        wells.number[:] = 0
        for i in range(gas.molecules.size):
            start = i * vicinity.stride
            for q in range(start + 1, start + 1 + np.int64(vicinity.entry[start])):
                entry = np.int64(vicinity.entry[q])
                if is_inside(entry) and entry >> 1 > i:
                    one, two = gas.molecules[i].kind, gas.molecules[entry >> 1].kind
                    wells.number[min(one, two), max(one, two)] += 1
        gas.bath.clock[0] = now + time_until_bath(gas.molecules.size, gas)
        return Status.DONE.value

    @kernel(entry=True)
    def advance(gas, until, most):
        """Resolve events up to time ``until``, at most ``most`` of them; return a `Status` as a number and how many."""
        status, done = proceed(gas, until, most, modes)
        return status.value, done

    @kernel(entry=True)
    def replan(gas, now):
        """Have the events of all molecules predicted again at time ``now``."""
        for i in range(gas.molecules.size):
            call(i, now, gas)

    @kernel(entry=True)
    def overlap(gas):
        """Return the deepest overlap of two cores at the start, in diameters, and the two molecules."""
        vicinity = gas.vicinity
        deepest = -1.0
        first = second = -1
        for i in range(gas.molecules.size):
            at, start = gas.molecules[i], i * vicinity.stride
            for q in range(start + 1, start + 1 + np.int64(vicinity.entry[start])):
                j = np.int64(vicinity.entry[q]) >> 1
                other = gas.molecules[j]
                rx, ry, rz = nearest_image(at.x - other.x, at.y - other.y, at.z - other.z, gas.box, modes)
                core = well_of(i, j, gas, modes).core
                depth = 1.0 - math.sqrt((rx * rx + ry * ry + rz * rz) / core) if core > 0.0 else -1.0
                if depth > deepest:
                    deepest, first, second = depth, min(i, j), max(i, j)
        return deepest, first, second

    return place, advance, replan, overlap
