"""Air with liquid water in it, from event to event: what the liquid does stands between what the molecules do.

Three clocks run beside the calendar of the molecules: when one of them may meet the mist, when one leaves the
liquid, and when one rains out. Each is a Poisson process, drawn anew whenever the liquid has changed, which its
lack of memory allows. A molecule of speed w relative to the air meets the mist at the rate A w Z / 4 V, Z because
molecules crowd at any surface as they do at a wall; drawn is the time for the fastest of all, and what is drawn
is accepted in proportion to the speed.
"""

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.random import uniform
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.calendar import next_event
from atmosbox.engine.exact.encounter import position_at, write
from atmosbox.engine.exact.exact import BUSY, CROWDED, DONE, LOOK, MET, ROW_FULL, STALLED, piled_up, proceed
from atmosbox.engine.exact.prediction import plan
from atmosbox.engine.liquid.insertion import FREE, TAKEN, look_for_room
from atmosbox.engine.liquid.phase import enter, withdraw
from atmosbox.engine.liquid.reservoir import (
    AIR_MET,
    LIQUID,
    THERMAL,
    condense,
    direction,
    evaporate,
    evaporation_rate,
    exchange,
    leave,
    rain_out,
    wait,
)

__all__ = ["ceiling_at", "renew", "specialise"]

_MAY_MEET, _LEAVES, _RAINS = range(3)


@kernel
def ceiling_at(t, box, walls, modes):
    """Return how high the box is [length] and how fast its ceiling moves [length/time]."""
    if modes.piston:
        return walls.piston[0] + walls.piston[1] * (t - walls.piston[2]), walls.piston[1]
    return box.length_z, 0.0


@kernel
def _volume(t, diameter, box, walls, ledger, number, modes):
    """Return the volume that the centres of molecules can reach, over Z [length^3].

    At any surface molecules crowd as at a wall, Z times as densely as in open space: that is what a pressure of n k T Z
    means (Carnahan and Starling 1969, doi:10.1063/1.1672048). Z is that of spheres of one size.
    """
    height, _ = ceiling_at(t, box, walls, modes)
    volume = box.length_x - (diameter if box.inverse_x == 0.0 else 0.0)
    volume *= box.length_y - (diameter if box.inverse_y == 0.0 else 0.0)
    volume *= height - (diameter if box.inverse_z == 0.0 else 0.0)
    filled = number * math.pi / 6.0 * ledger.mean_cube / (box.length_x * box.length_y * height)
    return volume * (1.0 - filled) ** 3 / (1.0 + filled + filled * filled - filled * filled * filled)


@kernel
def renew(t, tallies, ledger):
    """Draw anew when the next molecule leaves the liquid, and when the next rains."""
    ledger.clock[_LEAVES] = t + wait(evaporation_rate(ledger), tallies.random)
    ledger.clock[_RAINS] = t + wait(ledger.rain * (ledger.count[LIQUID] - ledger.keeps), tallies.random)


@kernel
def _next_meeting(t, molecules, box, walls, tallies, ledger, modes):
    """Draw when the next molecule may meet the mist."""
    if modes.pool:
        return
    present = molecules.size - ledger.top[0]
    volume = _volume(t, ledger.diameter, box, walls, ledger, present, modes)
    ledger.bound[1] = volume
    rate = molecules.size * ledger.area * ledger.bound[0] / (4.0 * volume)
    ledger.clock[_MAY_MEET] = t + wait(rate, tallies.random)


@kernel
def _touch(
    i, t, x, y, z, vx, vy, vz, flow, molecules, events, kinds, cells, calendar, box, walls, tallies, ledger, modes
):
    """Let molecule i meet the liquid, which flows upwards with the air: it stays, or leaves with another energy."""
    number = np.int64(molecules[i].kind)
    kind = kinds.table[number]
    mass = kind.mass
    spin = kinds.rotational_energy[i] if modes.rotation else 0.0
    rotation = kind.rotation if modes.rotation else 0.0
    energy = 0.5 * mass * (vx * vx + vy * vy + vz * vz) + spin
    if modes.pool:
        tallies.hits[4] += 1
        tallies.count[4] += 1
        tallies.impulse[4] -= mass * vz
    if number == ledger.kind and (ledger.sticking >= 1.0 or uniform(tallies.random) < ledger.sticking):
        condense(ledger, energy)
        withdraw(i, molecules, events, kinds, cells, calendar, ledger, modes)
        renew(t, tallies, ledger)
        return
    speed = math.sqrt(2.0 / mass)
    relative = energy - 0.5 * mass * (vz * vz - (vz - flow) * (vz - flow))
    flight, new_spin = exchange(ledger, relative, rotation, tallies.random)
    ex, ey, ez = direction(modes.pool, tallies.random)
    speed *= math.sqrt(flight)
    wx, wy, wz = speed * ex, speed * ey, speed * ez + flow
    given = 0.5 * mass * (wx * wx + wy * wy + wz * wz) + new_spin - energy
    if ledger.energy[THERMAL] - given >= 0.0:
        ledger.energy[THERMAL] -= given
        ledger.count[AIR_MET] += 1
        vx, vy, vz = wx, wy, wz
        if modes.rotation:
            kinds.rotational_energy[i] = new_spin
        renew(t, tallies, ledger)
    elif modes.pool:
        vz = -vz
    if modes.pool:
        tallies.impulse[4] += mass * vz
        z = kind.radius
    write(molecules[i], t, x, y, z, vx, vy, vz)
    plan(i, t, x, y, z, vx, vy, vz, molecules, events, kinds, cells, calendar, box, walls, modes)


@kernel
def _may_meet(t, molecules, events, kinds, cells, calendar, box, walls, tallies, ledger, modes):
    """Let a molecule, drawn at random, meet the mist with a chance in proportion to its speed."""
    i = min(int(uniform(tallies.random) * molecules.size), molecules.size - 1)
    chance = uniform(tallies.random)
    if math.isinf(molecules[i].clock):
        return
    x, y, z, vx, vy, vz = position_at(molecules[i], t, box, modes)
    height, rise = ceiling_at(t, box, walls, modes)
    flow = rise * z / height
    speed = math.sqrt(vx * vx + vy * vy + (vz - flow) * (vz - flow))
    diameter = 2.0 * kinds.table[molecules[i].kind].radius
    volume = _volume(t, diameter, box, walls, ledger, molecules.size - ledger.top[0], modes)
    speed *= ledger.bound[1] / volume
    accepted = chance * ledger.bound[0] < speed
    ledger.bound[0] = max(ledger.bound[0], speed)
    if accepted:
        _touch(
            i, t, x, y, z, vx, vy, vz, flow,
            molecules, events, kinds, cells, calendar, box, walls, tallies, ledger, modes,
        )  # fmt: skip


@kernel
def _emit(t, molecules, events, kinds, cells, calendar, box, walls, tallies, ledger, modes):
    """Let a molecule leave the liquid; return a status."""
    i = ledger.absent[ledger.top[0] - 1]
    height, rise = ceiling_at(t, box, walls, modes)
    found, x, y, z = look_for_room(i, t, height, molecules, events, kinds, cells, box, tallies, modes)
    if found != FREE:
        return CROWDED if found == TAKEN else ROW_FULL
    mass = kinds.table[ledger.kind].mass
    flow = 0.0 if modes.pool else rise * z / height
    flight, spin = evaporate(ledger, tallies.random)
    speed = math.sqrt(2.0 * flight / mass)
    ex, ey, ez = direction(modes.pool, tallies.random)
    vx, vy, vz = speed * ex, speed * ey, speed * ez + flow
    energy = 0.5 * mass * (vx * vx + vy * vy + vz * vz) + spin
    if flow != 0.0 and energy + ledger.binding_energy > ledger.energy[THERMAL]:
        # only the last molecule can lack what the flow of the air adds: it leaves as if the air were at rest
        vz = speed * ez
        energy = flight + spin
    leave(ledger, energy)
    if modes.pool:
        tallies.impulse[4] += mass * vz
    enter(
        i, t, x, y, z, vx, vy, vz, spin, molecules, events, kinds, cells, calendar, box, walls, ledger, modes
    )  # fmt: skip
    renew(t, tallies, ledger)
    if speed > ledger.bound[0]:
        ledger.bound[0] = speed
        _next_meeting(t, molecules, box, walls, tallies, ledger, modes)
    return DONE


@functools.cache
def specialise(modes: Modes) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Return the kernels of one set of modes: ``begin``, which draws the first times, and ``advance``."""

    @kernel(entry=True)
    def begin(molecules, box, walls, tallies, ledger, now, speed):
        """Draw the times of the liquid at time ``now``, when molecules may be as fast as ``speed`` [length/time]."""
        ledger.bound[0] = speed
        _next_meeting(now, molecules, box, walls, tallies, ledger, modes)
        renew(now, tallies, ledger)

    @kernel(entry=True)
    def advance(molecules, events, kinds, cells, calendar, box, walls, tallies, ledger, until, most):
        """Resolve events of molecules and of the liquid up to time ``until``; return a status and how many."""
        done = 0
        looked = 0
        clock = ledger.clock
        while done < most:
            due = min(clock[_MAY_MEET], clock[_LEAVES], clock[_RAINS])
            status, some = proceed(
                molecules, events, kinds, cells, calendar, box, walls, tallies, min(until, due), most - done, modes
            )
            done += some + 1
            if done - looked >= LOOK:
                _, t = next_event(calendar)
                if piled_up(min(t, due), done - looked, molecules.size, box, tallies):
                    return STALLED, done
                looked = done
            if modes.pool and status == MET:
                i, t = next_event(calendar)
                x, y, z, vx, vy, vz = position_at(molecules[i], t, box, modes)
                _touch(
                    i, t, x, y, z, vx, vy, vz, 0.0,
                    molecules, events, kinds, cells, calendar, box, walls, tallies, ledger, modes,
                )  # fmt: skip
                continue
            if status == BUSY:
                continue
            if status != DONE or due > until:
                return status, done
            if clock[_MAY_MEET] == due:
                _may_meet(due, molecules, events, kinds, cells, calendar, box, walls, tallies, ledger, modes)
                _next_meeting(due, molecules, box, walls, tallies, ledger, modes)
            elif clock[_LEAVES] == due:
                status = _emit(due, molecules, events, kinds, cells, calendar, box, walls, tallies, ledger, modes)
                if status != DONE:
                    return status, done
            else:
                rain_out(ledger)
                renew(due, tallies, ledger)
        return BUSY, done

    return begin, advance
