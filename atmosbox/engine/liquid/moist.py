"""The loop over events of moist air: events of the liquid happen between the events of molecules.

Beside the calendar of the molecules there are three clocks: when a molecule may meet the mist, when one leaves the
liquid, and when one rains out. Each is a Poisson process, so it has no memory and its time may be drawn again whenever
the liquid has changed. A molecule of speed w relative to the air meets the mist at the rate A w Z / 4 V. Z is the
compressibility factor: molecules are denser by this factor at any surface, as at a wall. The time is drawn for the
largest speed of all, and a meeting is accepted with a probability proportional to the speed of its molecule.
"""

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from atmosbox.engine.core.jit import by_reference, kernel
from atmosbox.engine.core.random import uniform
from atmosbox.engine.core.state import Modes, Motion
from atmosbox.engine.exact.calendar import next_event
from atmosbox.engine.exact.encounter import kind_of, motion_at, write
from atmosbox.engine.exact.exact import Status, piled_up, proceed
from atmosbox.engine.exact.prediction import call
from atmosbox.engine.exact.turning import Next, ahead, gauges, turn
from atmosbox.engine.liquid.insertion import Place, enter, find_place, withdraw
from atmosbox.engine.liquid.reservoir import (
    AIR_MET,
    LEAVES,
    MAY_MEET,
    RAINED_ENERGY,
    RAINS,
    THERMAL,
    condense,
    direction,
    emitted,
    exchange,
    rain_out,
    renew,
    stays,
    wait,
)


@kernel
def ceiling_at(t, gas, modes):
    """Return the height of the box [length] and the velocity of its ceiling [length/time] at time t."""
    if modes.piston:
        piston = gas.walls.piston
        return piston[0] + piston[1] * (t - piston[2]), piston[1]
    return gas.box.length_z, 0.0


@kernel
def _volume(t, diameter, gas, reservoir, modes):
    """Return the volume that centres of molecules can reach, divided by Z [length^3].

    At any surface molecules are Z times as dense as in open space, as at a wall: this is what a pressure of n k T Z
    means (Carnahan and Starling 1969, doi:10.1063/1.1672048). Z is that of spheres of one size.
    """
    box = gas.box
    number = gas.molecules.size - reservoir.top[0]
    height, _ = ceiling_at(t, gas, modes)
    volume = box.length_x - (diameter if box.inverse_x == 0.0 else 0.0)
    volume *= box.length_y - (diameter if box.inverse_y == 0.0 else 0.0)
    volume *= height - (diameter if box.inverse_z == 0.0 else 0.0)
    filled = number * math.pi / 6.0 * reservoir.mean_cube / (box.length_x * box.length_y * height)
    free = 1.0 - filled
    return volume * free * free * free / (1.0 + filled + filled * filled - filled * filled * filled)


@kernel
def _next_meeting(t, gas, reservoir, modes):
    """Draw the time at which the next molecule may meet the mist."""
    if modes.pool:
        return
    volume = _volume(t, reservoir.diameter, gas, reservoir, modes)
    reservoir.bound[1] = volume
    rate = gas.molecules.size * reservoir.area * reservoir.bound[0] / (4.0 * volume)
    reservoir.clock[MAY_MEET] = t + wait(rate, gas.tallies.random)


@kernel
def _touch(i, t, at, flow, gas, reservoir, modes):
    """Resolve a meeting of molecule i with the liquid, which flows upwards with the air: it stays, or leaves again."""
    tallies = gas.tallies
    mass, radius, rotation = kind_of(i, gas, modes)
    spin = gas.kinds.rotational_energy[i] if modes.rotation else 0.0
    energy = 0.5 * mass * (at.vx * at.vx + at.vy * at.vy + at.vz * at.vz) + spin
    if modes.pool:
        tallies.hits[4] += 1
        tallies.count[4] += 1
        tallies.impulse[4] -= mass * at.vz
    # a vapour molecule sticks, always or with some probability
    is_vapour = np.int64(gas.molecules[i].kind) == reservoir.kind
    if is_vapour and stays(reservoir, tallies.random):
        condense(reservoir, energy)
        withdraw(i, gas, reservoir, modes)
        renew(t, tallies.random, reservoir)
        return
    # all others leave again, with a share of the energy that they and the liquid have, relative to the flow
    relative = energy - 0.5 * mass * (at.vz * at.vz - (at.vz - flow) * (at.vz - flow))
    flight, new_spin = exchange(reservoir, relative, rotation, tallies.random)
    ex, ey, ez = direction(modes.pool, tallies.random)
    speed = math.sqrt(2.0 / mass) * math.sqrt(flight)
    wx, wy, wz = speed * ex, speed * ey, speed * ez + flow
    given = 0.5 * mass * (wx * wx + wy * wy + wz * wz) + new_spin - energy
    vx, vy, vz = at.vx, at.vy, at.vz
    if reservoir.energy[THERMAL] - given >= 0.0:
        reservoir.energy[THERMAL] -= given
        reservoir.count[AIR_MET] += 1
        vx, vy, vz = wx, wy, wz
        if modes.rotation:
            gas.kinds.rotational_energy[i] = new_spin
        renew(t, tallies.random, reservoir)
    elif modes.pool:
        vz = -vz
    z = at.z
    if modes.pool:
        tallies.impulse[4] += mass * vz
        z = radius
    after = Motion(at.x, at.y, z, vx, vy, vz)
    write(i, t, after, gas)
    call(i, t, gas)


@kernel
def _may_meet(t, gas, reservoir, modes):
    """Draw a molecule, and let it meet the mist with a probability proportional to its speed."""
    state = gas.tallies.random
    i = min(int(uniform(state) * gas.molecules.size), gas.molecules.size - 1)
    chance = uniform(state)
    if math.isinf(gas.molecules[i].clock):
        return
    at = motion_at(i, t, gas, modes)
    height, rise = ceiling_at(t, gas, modes)
    flow = rise * at.z / height
    speed = math.sqrt(at.vx * at.vx + at.vy * at.vy + (at.vz - flow) * (at.vz - flow))
    _, radius, _ = kind_of(i, gas, modes)
    speed *= reservoir.bound[1] / _volume(t, 2.0 * radius, gas, reservoir, modes)
    accepted = chance * reservoir.bound[0] < speed
    reservoir.bound[0] = max(reservoir.bound[0], speed)
    if accepted:
        _touch(i, t, at, flow, gas, reservoir, modes)


@kernel
def _emit(t, gas, reservoir, modes):
    """Take a molecule out of the liquid and put it into the gas; return a `Status`."""
    state = gas.tallies.random
    i = reservoir.absent[reservoir.top[0] - 1]
    height, rise = ceiling_at(t, gas, modes)
    found, x, y, z = find_place(i, t, height, gas, modes)
    if found != Place.FREE:
        return Status.CROWDED if found == Place.TAKEN else Status.FULL
    mass = gas.kinds.table[reservoir.kind].mass
    flow = 0.0 if modes.pool else rise * z / height
    (vx, vy, vz), spin, speed = emitted(mass, flow, modes.pool, reservoir, state)
    if modes.pool:
        gas.tallies.impulse[4] += mass * vz
    enter(i, t, Motion(x, y, z, vx, vy, vz), spin, gas, reservoir, modes)
    renew(t, state, reservoir)
    if speed > reservoir.bound[0]:
        reservoir.bound[0] = speed
        _next_meeting(t, gas, reservoir, modes)
    return Status.DONE


@kernel
def _proceed(gas, reservoir, until, most, modes):
    """Resolve events of molecules and of the liquid up to time ``until``; return a `Status` and their number."""
    done = 0
    clock = reservoir.clock
    while done < most:
        # events of molecules, up to the next event of the liquid
        due = min(clock[MAY_MEET], clock[LEAVES], clock[RAINS])
        status, some = proceed(gas, min(until, due), most - done, modes)
        done += some + 1
        if piled_up(min(next_event(gas.calendar)[1], due), some + 1, gas):
            return Status.STALLED, done
        if modes.pool and status == Status.MEETS_LIQUID:
            i, t = next_event(gas.calendar)
            _touch(i, t, motion_at(i, t, gas, modes), 0.0, gas, reservoir, modes)
            continue
        if status == Status.BUSY:
            continue
        if status != Status.DONE or due > until:
            return status, done
        if clock[MAY_MEET] == due:
            _may_meet(due, gas, reservoir, modes)
            _next_meeting(due, gas, reservoir, modes)
        elif clock[LEAVES] == due:
            status = _emit(due, gas, reservoir, modes)
            if status != Status.DONE:
                return status, done
        else:
            rain_out(reservoir)
            renew(due, gas.tallies.random, reservoir)
    return Status.BUSY, done


@kernel
def _gauges(t, gas, moisture, ascent):
    """Return the `Gauges` of moist air at time t."""
    reservoir = moisture.reservoir
    missing = reservoir.top[0]
    number = gas.molecules.size - missing
    vapour = moisture.vapours - missing
    condensed = reservoir.binding_energy * vapour + (reservoir.energy[THERMAL] + reservoir.energy[RAINED_ENERGY])
    freedom = 3.0 + (moisture.rotations - reservoir.rotation * missing) / max(number, 1)
    return gauges(t, number, freedom, condensed, gas, ascent)


@kernel
def _wake(t, gas, reservoir, modes):
    """Draw the times of the liquid again at time t if the piston may make molecules faster than was assumed."""
    speed = 2.0 * abs(gas.walls.piston[1])
    if speed > reservoir.bound[0]:
        reservoir.bound[0] = speed
        _next_meeting(t, gas, reservoir, modes)
        renew(t, gas.tallies.random, reservoir)


@functools.cache
def specialise(modes: Modes) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Return the kernels of one set of modes: ``begin``, which draws the first times, and ``advance``."""

    @kernel(entry=True)
    def begin(gas, reservoir, now, speed):
        """Draw the times of the liquid at time ``now``; molecules may be as fast as ``speed`` [length/time]."""
        gas, reservoir = by_reference(gas), by_reference(reservoir)
        reservoir.bound[0] = speed
        _next_meeting(now, gas, reservoir, modes)
        renew(now, gas.tallies.random, reservoir)

    @kernel(entry=True)
    def advance(gas, reservoir, until, most):
        """Resolve events of molecules and of the liquid up to ``until``; return a `Status` as a number and how many."""
        gas, reservoir = by_reference(gas), by_reference(reservoir)
        status, done = _proceed(gas, reservoir, until, most, modes)
        return status.value, done

    @kernel(entry=True)
    def ascend(gas, moisture, ascent, until, most):
        """Do what ``advance`` does, and set the velocity of the piston whenever that is due."""
        gas, moisture, ascent = by_reference(gas), by_reference(moisture), by_reference(ascent)
        reservoir = moisture.reservoir
        done = 0
        while True:
            stop, then = ahead(until, gas, ascent)
            status, some = _proceed(gas, reservoir, stop, most - done, modes)
            done += some
            if status != Status.DONE or then == Next.END:
                return status.value, done
            if then == Next.CRUSHED:
                return Status.CRUSHED.value, done
            if not turn(stop, _gauges(stop, gas, moisture, ascent), gas, ascent, modes):
                return Status.TURNED.value, done
            _wake(stop, gas, reservoir, modes)

    return begin, ascend if modes.ascends else advance
