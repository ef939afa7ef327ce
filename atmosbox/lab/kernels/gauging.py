"""Measurements in a page: thermometer, barometer, layers, speeds, light and heavy discs, a rising parcel.

These kernels measure what the instruments of `atmosbox.scene.instruments` measure, from the sums over molecules of
`sums`. `plan` says which variables are shown, and in which unit; the averages of many frames are in `averaging`.
"""

import functools
import math
from collections import namedtuple
from collections.abc import Callable
from typing import Any

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.schedule import interpolate
from atmosbox.engine.core.state import Modes
from atmosbox.engine.core.walls import HEAT_BATH, wall_kT
from atmosbox.engine.exact.advance import ascent_of
from atmosbox.engine.exact.turning import gauges as ledger_gauges
from atmosbox.lab.kernels.averaging import update
from atmosbox.lab.kernels.clustering import end_clusters, energy_of_wells
from atmosbox.lab.kernels.flowing import begin_wind, can_flow, end_wind, sample_wind, write_adiabat
from atmosbox.lab.kernels.hygrometer import begin_water, condensed_energy, end_water, sample_water
from atmosbox.lab.kernels.readings import ENERGY, TIME, Reading
from atmosbox.lab.kernels.sums import Sum, ceiling, sum_up
from atmosbox.lab.kernels.two_gases import end_mixing


class Gauges(
    namedtuple(
        "Gauges",
        "reading means samples before barometer whole parts fast sides speeds layers virial running mixture water flow",
    )
):
    """The data of the instruments of a box.

    ``reading : (Reading,)`` has the last readings, ``means : (Reading,)`` the sums over the samples of a frame of those
    that are means, and ``samples : (1,)`` their number. ``before : (8,)`` are the impulses of the walls and the time at
    the end of the last frame, and the energy at the start of all frames with what changes of gravity and of attraction
    have given since [energy]. ``barometer`` says which walls measure the pressure: 0 all, 4 the floor only.

    ``whole`` is a single bin; ``parts`` are those of the layers, whose mean motion is not counted as warmth; ``fast``
    bins of speed; ``sides`` light and heavy discs, or two gases that mix across the box.

    ``speeds : (bin,)`` is the share of molecules by speed [1/velocity]; ``layers : (5 layer,)`` are number, energy,
    degrees of freedom, virial per time and wind along x of each layer, in the last frame, and ``virial : (layer,)`` the
    virial at its end. ``running : (3,)`` has sums of the mean energies of light and heavy discs [energy], and the
    number of frames. ``mixture`` are two gases that mix; ``water`` vapour and
    liquid, 0 in a box without water; ``flow`` is the wind, 0 with kernels that do not measure it.
    """


@kernel
def _sample_layers(gas, gauges):
    """Add the molecules of each layer, and the energy of their disordered motion: see `layer_sample`."""
    parts = gauges.parts
    planes = 2.0 if gas.box.planar else 3.0
    for part in range(parts.rows * parts.columns):
        sums, layer = parts.sums[part], part // parts.columns
        if sums[Sum.NUMBER] > 0.0:
            square = sums[Sum.X] * sums[Sum.X] + sums[Sum.Y] * sums[Sum.Y] + sums[Sum.Z] * sums[Sum.Z]
            gauges.layers[layer] += sums[Sum.NUMBER]
            gauges.layers[parts.rows + layer] += sums[Sum.KINETIC] - 0.5 * square / sums[Sum.MASS]
            gauges.layers[2 * parts.rows + layer] += planes * (sums[Sum.NUMBER] - 1.0)


@kernel
def _pressure(gas, now, lasted, gauges):
    """Return the pressure of the frame from the impulses on the walls [energy/length^3]: see `open_faces`."""
    box, whole = gas.box, gauges.whole.sums[0]
    mean = whole[Sum.DIAMETER] / max(whole[Sum.NUMBER], 1.0)
    has_x, has_y, has_z = box.inverse_x == 0.0, box.inverse_y == 0.0 and not box.planar, box.inverse_z == 0.0
    x, z = box.length_x - mean * has_x, ceiling(gas, now) - mean * has_z
    y = 1.0 if box.planar else box.length_y - mean * has_y
    faces = y * z * has_x, x * z * has_y, x * y * has_z  # 0 where there is no wall
    impulse = area = 0.0
    for wall in range(6):
        if gauges.barometer == 0 or gauges.barometer == wall:
            impulse += gas.tallies.impulse[wall] - gauges.before[wall]
            area += faces[wall // 2]
    return impulse / (area * lasted) if area > 0.0 and lasted > 0.0 else math.nan


@kernel
def _end_lift(gas, ascent, book, gauges):
    """Read the state of a rising parcel from its energy ledger: see `instruments.Lift`."""
    lift, reading = ascent.lift, gauges.reading
    here = ascent_of(ascent, book, ascent.filled)
    at = ledger_gauges(book.now[0], gas.molecules.size, ascent.freedom, 0.0, gas, here)
    kT = 2.0 * at.energy / (at.freedom * max(at.number, 1))
    reading[Reading.PARCEL_TEMPERATURE] = kT
    reading[Reading.PARCEL_PRESSURE] = at.density * kT * (1.0 + lift.measured[0] * at.density)
    reading[Reading.MOMENT] = interpolate(reading[Reading.ELAPSED_TIME], lift.course_time, lift.course_moment)


@kernel
def _begin_frame(gas, time, gauges):
    """Keep what a frame begins with."""
    for wall in range(6):
        gauges.before[wall] = gas.tallies.impulse[wall]
    for layer in range(gauges.virial.size):
        gauges.virial[layer] = gas.tallies.virial[layer]
    gauges.before[TIME] = time
    gauges.samples[0] = 0.0
    gauges.reading[Reading.MOLECULES_IN_GAS] = gauges.whole.sums[0, Sum.NUMBER]


@functools.cache
def gauging(modes: Modes, *, wells: bool = False) -> dict[str, Callable[..., Any]]:
    """Return the kernels ``begin``, ``sample``, ``end_frame`` and ``note_frame`` of one set of modes."""
    flows = can_flow(modes)

    @kernel
    def energy_now(gas, book, gauges):
        """Return the energy of all molecules now, from their sums, of their attraction and of the liquid [energy]."""
        whole = gauges.whole.sums[0]
        energy = whole[Sum.KINETIC] + whole[Sum.ROTATION] + gas.box.gravity * whole[Sum.WEIGHT]
        if wells:
            energy += energy_of_wells(gas.wells)
        return energy + condensed_energy(gas, book, modes) if modes.phases else energy

    @kernel
    def sample(gas, ascent, book, gauges):
        """Take a sample for the means of a frame."""
        if gauges.samples[0] == 0.0:
            gauges.means[:] = 0.0
            gauges.speeds[:] = 0.0
            gauges.layers[:] = 0.0
        gauges.samples[0] += 1.0
        sum_up(gas, book.now[0], gauges, modes)
        whole = gauges.whole.sums[0]
        planes = 2.0 if gas.box.planar else 3.0
        gauges.means[Reading.AIR_TEMPERATURE] += 2.0 * whole[Sum.KINETIC] / (planes * whole[Sum.NUMBER])
        for k in range(gauges.speeds.size):
            gauges.speeds[k] += gauges.fast.sums[k, Sum.NUMBER]
        if gauges.layers.size > 0:
            _sample_layers(gas, gauges)
        if flows:
            sample_wind(gas, gauges)
        if modes.phases:
            sample_water(gas, ascent, book, gauges, modes)
        return 0

    @kernel
    def begin(gas, ascent, book, gauges, crowd):
        """Begin to measure."""
        sum_up(gas, book.now[0], gauges, modes)
        _begin_frame(gas, gas.walls.epoch[0] + book.now[0], gauges)
        gauges.before[ENERGY] = energy_now(gas, book, gauges)
        gauges.running[:] = 0.0
        gauges.mixture.off[:] = math.inf
        gauges.mixture.mean[:] = math.nan
        gauges.mixture.error[:] = math.nan
        if flows:
            begin_wind(gauges.flow)
        if modes.phases:
            begin_water(book, gauges)
        if wells:
            crowd.virial[0] = np.sum(gas.tallies.virial)
        return 0

    @kernel
    def end_frame(gas, ascent, book, gauges, layout, crowd):
        """Take the readings at the end of a frame, which is the moment of its last sample, and complete its means."""
        reading, now, samples = gauges.reading, book.now[0], max(gauges.samples[0], 1.0)
        time = gas.walls.epoch[0] + now
        lasted = time - gauges.before[TIME]
        total = energy_now(gas, book, gauges)
        given = passed = 0.0
        for wall in range(6):
            given += gas.tallies.heat[wall] + gas.tallies.work[wall]
            passed += abs(gas.tallies.heat[wall]) + abs(gas.tallies.work[wall])
        if wells:
            given += gas.bath.heat[0]
            passed += abs(gas.bath.heat[0])
        largest = max(abs(total), abs(gauges.before[ENERGY]), passed, gauges.whole.sums[0, Sum.KINETIC])
        for k in range(reading.size):
            reading[k] = gauges.means[k] / samples
        reading[Reading.ELAPSED_TIME] = time
        reading[Reading.AIR_PRESSURE] = _pressure(gas, now, lasted, gauges)
        off = abs(total - gauges.before[ENERGY] - given)
        reading[Reading.LEDGER_RESIDUAL] = off / largest if largest > 0.0 else 0.0
        reading[Reading.COLLISION_COUNT] = gas.tallies.count[0]
        reading[Reading.KINETIC_ENERGY] = gauges.whole.sums[0, Sum.KINETIC]
        reading[Reading.GRAVITY] = gas.box.gravity
        for wall in range(6):
            warm = gas.walls.law[wall] == HEAT_BATH
            reading[Reading.WALL_TEMPERATURE + wall] = wall_kT(gas.walls, wall, time) if warm else math.nan
        for k in range(gauges.speeds.size):
            width = gauges.fast.edges[k + 1] - gauges.fast.edges[k]
            gauges.speeds[k] /= samples * gauges.whole.sums[0, Sum.NUMBER] * width
        layers = gauges.virial.size
        for layer in range(layers):
            for k in range(3):
                gauges.layers[k * layers + layer] /= samples
            gauges.layers[3 * layers + layer] = (gas.tallies.virial[layer] - gauges.virial[layer]) / lasted
        if gauges.running.size > 0:  # the mean energies of the light and of the heavy discs since the start
            gauges.running[2] += 1.0
            for k in range(2):
                half = gauges.sides.sums[k]
                gauges.running[k] += half[Sum.KINETIC] / max(half[Sum.NUMBER], 1.0)
                reading[Reading.RUNNING_ENERGY_LIGHT + k] = gauges.running[k] / gauges.running[2]
        if gauges.sides.columns > 1:
            end_mixing(time, gauges)
        if flows:
            end_wind(gauges)
        if modes.phases:
            end_water(gas, ascent, book, time, lasted, gauges, modes)
        elif modes.ascends:
            _end_lift(gas, ascent, book, gauges)
        if wells:
            end_clusters(gas, lasted, reading, layout, crowd)
        _begin_frame(gas, time, gauges)
        return 0

    @kernel
    def note_frame(gas, gauges, speeds, layers):
        """Add the frame that has ended to the averages."""
        update(gauges.speeds, speeds, 0, gas.box)
        update(gauges.layers, layers, gauges.parts.rows, gas.box)
        if flows:
            write_adiabat(gas.box, layers.mean, gauges.flow)
        return 0

    return {"begin": begin, "sample": sample, "end_frame": end_frame, "note_frame": note_frame}
