"""Measurements in a page: thermometer, barometer, layers, speeds, light and heavy discs, a rising parcel, mixing.

These kernels compute the sums of `atmosbox.scene.instruments`. `plan` says which of them are shown and in which
unit; the averages of many frames are in `averaging`.
"""

import functools
import math
from collections.abc import Callable
from enum import IntEnum
from typing import Any, NamedTuple

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.core.walls import HEAT_BATH, wall_kT
from atmosbox.engine.exact.advance import ascent_of
from atmosbox.engine.exact.encounter import kind_of, motion_at
from atmosbox.engine.exact.turning import gauges as ledger_gauges
from atmosbox.lab.kernels.flowing import ALOFT, ROLLS, WIND, Flow, across, flowing
from atmosbox.lab.kernels.hygrometer import Hygrometer, hygrometry
from atmosbox.lab.kernels.in_gas import is_away, number_in_gas
from atmosbox.lab.kernels.two_gases import Mixture, mixing


class Gauges(NamedTuple):
    """The data of the instruments of a box.

    ``reading : (Reading,)`` has the last readings. ``warmth : (2,)`` is the sum of kT over the samples of a frame
    [energy], and their number; ``before : (8,)`` the impulses of the walls and the time at the end of the last frame,
    and the energy at the start of all frames with what changes of gravity have given since [energy]. ``barometer`` says
    which walls measure the pressure: 0 all, 4 the floor only.

    ``edges : (bin + 1,)`` are the edges of the bins of speed [velocity], ``counts : (bin,)`` the molecules in them, and
    ``speeds : (bin,)`` the share of molecules by speed [1/velocity]. ``sums : (4, layer)`` are number, energy, degrees
    of freedom and, at the end of the last frame, virial of each layer; ``layers : (5 layer,)`` the same of the last
    frame, with virial per time, and the wind along x; ``scratch : (6, part)`` is scratch for the parts of layers, whose
    mean motion is not counted as warmth. All are empty in a scene that does not show them.

    ``half : (molecule,)`` is 0 for a light disc and 1 for a heavy one, empty if molecules are alike; ``running : (8,)``
    has sums of the mean energies of both halves [energy], the number of frames, the first energy, and the first
    momentum. ``mixture`` are two gases that mix; ``water`` vapour and liquid, 0 in a box without water;
    ``flow`` is the wind, 0 with kernels that do not measure it.
    """

    reading: Any
    warmth: Any
    before: Any
    barometer: int
    edges: Any
    counts: Any
    speeds: Any
    sums: Any
    layers: Any
    scratch: Any
    half: Any
    running: Any
    mixture: Mixture
    water: Hygrometer | int
    flow: Flow | int


class Reading(IntEnum):
    """Indices of ``Gauges.reading``; all readings are in reduced units. Those of water follow: `WaterReading`."""

    TIME = 0
    KT = 1
    PRESSURE = 2
    LEDGER = 3
    CONTACTS = 4
    LIGHT = 5
    HEAVY = 6
    ENERGY_CHANGE = 7
    MOMENTUM = 8
    PARCEL_KT = 9
    PARCEL_PRESSURE = 10
    MOMENT = 11
    KINETIC = 12
    AMPLITUDE = 13
    ENTROPY = 14
    WALL_KT = 15
    WIND = WIND
    ROLLS = ROLLS
    ALOFT = ALOFT
    GRAVITY = 24


_TIME, ENERGY = 6, 7
"""Indices of ``Gauges.before``."""


@functools.cache
def gauging(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``begin``, ``sample`` and ``end_frame`` of one set of modes."""
    begin_mixing, end_mixing = mixing(modes)
    begin_wind, note_wind, sample_wind, end_wind = flowing(modes)
    begin_water, sample_water, condensed_energy, end_water = hygrometry(modes)

    @kernel
    def ceiling(gas, now):
        """Return the height of the ceiling [length]."""
        piston = gas.walls.piston
        return piston[0] + piston[1] * (now - piston[2])

    @kernel
    def energies(gas, now):
        """Return kinetic, rotational and potential energy [energy], and the total momentum along x, y and z."""
        kinetic = rotational = potential = px = py = pz = 0.0
        for i in range(gas.molecules.size):
            if is_away(i, gas, modes):
                continue
            at = motion_at(i, now, gas, modes)
            mass, _, _ = kind_of(i, gas, modes)
            kinetic += 0.5 * mass * (at.vx * at.vx + at.vy * at.vy + at.vz * at.vz)
            potential += mass * gas.box.gravity * at.z
            px += mass * at.vx
            py += mass * at.vy
            pz += mass * at.vz
            if modes.rotation:
                rotational += gas.kinds.rotational_energy[i]
        return kinetic, rotational, potential, px, py, pz

    @kernel
    def sample_layers(gas, now, sums, scratch, flow):
        """Count the molecules of each layer, and the energy of their disordered motion: see `layer_sample`."""
        layers, parts = sums.shape[1], scratch.shape[1]
        columns = parts // layers
        height = ceiling(gas, now)
        planes = 2.0 if gas.box.planar else 3.0
        scratch[:] = 0.0
        for i in range(gas.molecules.size):
            at = motion_at(i, now, gas, modes)
            mass, _, _ = kind_of(i, gas, modes)
            part = min(max(int(at.z / height * layers), 0), layers - 1)
            if columns > 1:
                column = int(across(at.x, gas.box) * columns)
                part = part * columns + min(max(column, 0), columns - 1)
            scratch[0, part] += 1.0
            scratch[1, part] += mass
            scratch[2, part] += mass * at.vx
            scratch[3, part] += mass * at.vy
            scratch[4, part] += mass * at.vz
            scratch[5, part] += 0.5 * mass * (at.vx * at.vx + at.vy * at.vy + at.vz * at.vz)
            note_wind(part, at.vz, flow)
        for part in range(parts):
            number, weight, energy = scratch[0, part], scratch[1, part], scratch[5, part]
            px, py, pz = scratch[2, part], scratch[3, part], scratch[4, part]
            layer = part // columns
            if number > 0.0:
                sums[0, layer] += number
                sums[1, layer] += energy - 0.5 * (px * px + py * py + pz * pz) / weight
                sums[2, layer] += planes * (number - 1.0)
        mass, _, _ = kind_of(0, gas, modes)
        sample_wind(scratch, mass, gas.molecules.size, flow)

    @kernel
    def sample(gas, ascent, book, gauges):
        """Take a sample for the means of a frame."""
        now = book.now[0]
        twice = 0.0
        bins = gauges.counts.size
        for i in range(gas.molecules.size):
            if is_away(i, gas, modes):
                continue
            at = motion_at(i, now, gas, modes)
            mass, _, _ = kind_of(i, gas, modes)
            square = at.vx * at.vx + at.vy * at.vy + at.vz * at.vz
            twice += mass * square
            if bins > 0:
                speed = math.sqrt(square)
                low, high = gauges.edges[0], gauges.edges[bins]
                if low <= speed <= high:
                    gauges.counts[min(int((speed - low) / (high - low) * bins), bins - 1)] += 1.0
        planes = 2.0 if gas.box.planar else 3.0
        gauges.warmth[0] += twice / (planes * number_in_gas(gas, modes))
        gauges.warmth[1] += 1.0
        if modes.phases:
            kinetic, rotational, _, _, _, _ = energies(gas, now)
            sample_water(gas, ascent, book, kinetic + rotational, ceiling(gas, now), gauges)
        if gauges.sums.shape[1] > 0:
            sample_layers(gas, now, gauges.sums, gauges.scratch, gauges.flow)
        return 0

    @kernel
    def open_faces(gas, now):
        """Return the areas of the walls across x, y and z that centres of molecules can reach: see `open_faces`."""
        mean = 0.0
        for i in range(gas.molecules.size):
            if not is_away(i, gas, modes):
                _, radius, _ = kind_of(i, gas, modes)
                mean += 2.0 * radius
        mean /= max(number_in_gas(gas, modes), 1)
        box = gas.box
        x = box.length_x - (mean if box.inverse_x == 0.0 else 0.0)
        y = 1.0 if box.planar else box.length_y - (mean if box.inverse_y == 0.0 else 0.0)
        z = ceiling(gas, now) - (mean if box.inverse_z == 0.0 else 0.0)
        ax = y * z if box.inverse_x == 0.0 else 0.0
        ay = x * z if box.inverse_y == 0.0 and not box.planar else 0.0
        az = x * y if box.inverse_z == 0.0 else 0.0
        return ax, ay, az

    @kernel
    def pressure(gas, now, lasted, gauges):
        """Return the pressure of the frame from the impulses on the walls [energy/length^3]."""
        ax, ay, az = open_faces(gas, now)
        impulse = area = 0.0
        for wall in range(6):
            if gauges.barometer == 0 or gauges.barometer == wall:
                impulse += gas.tallies.impulse[wall] - gauges.before[wall]
                area += ax if wall < 2 else (ay if wall < 4 else az)
        return impulse / (area * lasted) if area > 0.0 and lasted > 0.0 else math.nan

    @kernel
    def end_halves(gas, book, total, px, py, pz, gauges):
        """Measure the energies of the light and of the heavy discs, and check the balance of their momentum."""
        light = heavy = mass_sum = 0.0
        lighter = heavier = 0
        for i in range(gas.molecules.size):
            at = motion_at(i, book.now[0], gas, modes)
            mass, _, _ = kind_of(i, gas, modes)
            mass_sum += mass
            energy = 0.5 * mass * (at.vx * at.vx + at.vy * at.vy + at.vz * at.vz)
            if gauges.half[i] == 0:
                light += energy
                lighter += 1
            else:
                heavy += energy
                heavier += 1
        outward = gas.tallies.impulse
        px -= outward[0] - outward[1]
        py -= outward[2] - outward[3]
        pz -= outward[4] - outward[5]
        running = gauges.running
        if running[2] == 0.0:
            running[3], running[4], running[5], running[6] = total, px, py, pz
        running[0] += light / max(lighter, 1)
        running[1] += heavy / max(heavier, 1)
        running[2] += 1.0
        size = math.sqrt(2.0 * mass_sum * running[3])
        gone = (px - running[4]) ** 2 + (py - running[5]) ** 2 + (pz - running[6]) ** 2
        gauges.reading[Reading.LIGHT] = running[0] / running[2]
        gauges.reading[Reading.HEAVY] = running[1] / running[2]
        gauges.reading[Reading.ENERGY_CHANGE] = total / running[3] - 1.0
        gauges.reading[Reading.MOMENTUM] = math.sqrt(gone) / size if size > 0.0 else 0.0

    if modes.ascends and not modes.phases:

        @kernel
        def end_lift(gas, ascent, book, gauges):
            """Read the state of a rising parcel from its energy ledger: see `instruments.Lift`."""
            lift = ascent.lift
            here = ascent_of(ascent, book, ascent.filled)
            at = ledger_gauges(book.now[0], gas.molecules.size, ascent.freedom, 0.0, gas, here)
            kT = 2.0 * at.energy / (at.freedom * max(at.number, 1))
            gauges.reading[Reading.PARCEL_KT] = kT
            gauges.reading[Reading.PARCEL_PRESSURE] = at.density * kT * (1.0 + lift.measured[0] * at.density)
            time, turns = gauges.reading[Reading.TIME], lift.course_time
            moment = lift.course_moment[0]
            for k in range(1, turns.size):
                if time >= turns[k]:
                    moment = lift.course_moment[k]
                elif time > turns[k - 1]:
                    share = (time - turns[k - 1]) / (turns[k] - turns[k - 1])
                    moment = lift.course_moment[k - 1] + share * (lift.course_moment[k] - lift.course_moment[k - 1])
            gauges.reading[Reading.MOMENT] = moment

    else:

        @kernel
        def end_lift(gas, ascent, book, gauges):
            """Read nothing: this box does not rise, or `end_water` reads its state."""

    @kernel
    def begin(gas, ascent, book, gauges):
        """Begin to measure."""
        now = book.now[0]
        kinetic, rotational, potential, _, _, _ = energies(gas, now)
        for wall in range(6):
            gauges.before[wall] = gas.tallies.impulse[wall]
        gauges.before[_TIME] = gas.walls.epoch[0] + now
        gauges.before[ENERGY] = kinetic + rotational + potential + condensed_energy(gas, book)
        gauges.warmth[:] = 0.0
        gauges.counts[:] = 0.0
        gauges.sums[:] = 0.0
        for layer in range(gauges.sums.shape[1]):
            gauges.sums[3, layer] = gas.tallies.virial[layer]
        gauges.running[:] = 0.0
        begin_mixing(gauges.mixture)
        begin_wind(gauges.flow)
        begin_water(gas, book, gauges)
        return 0

    @kernel
    def end_frame(gas, ascent, book, gauges):
        """Take the readings at the end of a frame, and complete the means of the frame."""
        reading, now = gauges.reading, book.now[0]
        time = gas.walls.epoch[0] + now
        lasted = time - gauges.before[_TIME]
        kinetic, rotational, potential, px, py, pz = energies(gas, now)
        total = kinetic + rotational + potential + condensed_energy(gas, book)
        given = passed = 0.0
        for wall in range(6):
            given += gas.tallies.heat[wall] + gas.tallies.work[wall]
            passed += abs(gas.tallies.heat[wall]) + abs(gas.tallies.work[wall])
        largest = max(abs(total), abs(gauges.before[ENERGY]), passed)
        reading[Reading.TIME] = time
        reading[Reading.KT] = gauges.warmth[0] / max(gauges.warmth[1], 1.0)
        reading[Reading.PRESSURE] = pressure(gas, now, lasted, gauges)
        reading[Reading.LEDGER] = abs(total - gauges.before[ENERGY] - given) / largest if largest > 0.0 else 0.0
        reading[Reading.CONTACTS] = gas.tallies.count[0]
        reading[Reading.KINETIC] = kinetic
        reading[Reading.GRAVITY] = gas.box.gravity
        for wall in range(6):
            warm = gas.walls.law[wall] == HEAT_BATH
            reading[Reading.WALL_KT + wall] = wall_kT(gas.walls, wall, time) if warm else math.nan
            gauges.before[wall] = gas.tallies.impulse[wall]
        gauges.before[_TIME] = time
        samples = max(gauges.warmth[1], 1.0)
        for k in range(gauges.counts.size):
            width = gauges.edges[k + 1] - gauges.edges[k]
            gauges.speeds[k] = gauges.counts[k] / (samples * gas.molecules.size) / width
        layers = gauges.sums.shape[1]
        for layer in range(layers):
            for k in range(3):
                gauges.layers[k * layers + layer] = gauges.sums[k, layer] / samples
                gauges.sums[k, layer] = 0.0
            gauges.layers[3 * layers + layer] = (gas.tallies.virial[layer] - gauges.sums[3, layer]) / lasted
            gauges.sums[3, layer] = gas.tallies.virial[layer]
        if gauges.half.size > 0:
            end_halves(gas, book, total, px, py, pz, gauges)
        if gauges.mixture.right.size > 0:
            reading[Reading.AMPLITUDE], reading[Reading.ENTROPY] = end_mixing(gas, now, time, gauges.mixture)
        end_lift(gas, ascent, book, gauges)
        end_wind(gas, now, gauges)
        end_water(gas, ascent, book, time, lasted, gauges)
        gauges.warmth[:] = 0.0
        gauges.counts[:] = 0.0
        return 0

    return begin, sample, end_frame
