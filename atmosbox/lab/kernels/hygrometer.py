"""Measurements of the water in a box, as kernels: the sums of `Water`, `Leaving`, `MoistLift` and `Nuclei`."""

import functools
import math
from collections.abc import Callable
from enum import IntEnum
from typing import Any, NamedTuple

from atmosbox.engine.core.elementary import exp, log
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.schedule import interpolate
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.encounter import motion_at
from atmosbox.engine.liquid.reservoir import (
    CONDENSED,
    EVAPORATED,
    LIQUID,
    RAINED,
    RAINED_ENERGY,
    STICKING,
    THERMAL,
    heat_capacity,
)
from atmosbox.lab.kernels.in_gas import number_in_gas


class Hygrometer(NamedTuple):
    """The data of the instruments for the water of a box.

    ``sums : (10,)`` are sums over the samples of a frame, see `Sampled`; ``before : (2,)`` the numbers of molecules
    that had condensed and evaporated at the end of the last frame; ``met : (4,)`` sums over all frames of the rate of
    evaporation times the temperature of the liquid, of that rate times the temperature of the gas, of the rate itself,
    and the number of frames without liquid.

    ``contact : (term,)`` are the coefficients of the contact value g in powers of phi / (1 - phi), with
    Z = 1 + 4 phi g; ``volatility``, ``power`` and ``binding`` those of the vapour pressure, see `Substance`, up to the
    temperature ``critical`` [energy].

    ``adiabat : (row, place)`` is the temperature of a parcel by theory [energy], for the moments ``moment : (row,)`` of
    the ascent and the logarithms ``log_pressure : (place,)`` of the pressure over the planned one, whose logarithm is
    ``planned : (row,)``; if it depends on the pressure alone, there is one row, and ``planned`` is zero. ``around :
    (place,)`` is the virtual temperature of the environment [energy] for the logarithms ``level : (place,)`` of its
    pressure, and ``mass`` the mass of a molecule of water over that of air. The arrays are empty in a scene without an
    ascent.

    ``width : (bin,)`` [energy], ``mean``, ``error : (bin,)`` [1/energy] are the distribution of the energies of
    molecules that left the liquid; the first ``empty`` bins lie below the binding energy, and ``merged`` bins of the
    engine make one bin. The arrays are empty in a scene that does not show them.
    """

    sums: Any
    before: Any
    met: Any
    contact: Any
    volatility: float
    power: float
    binding: float
    critical: float
    moment: Any
    planned: Any
    log_pressure: Any
    adiabat: Any
    level: Any
    around: Any
    mass: float
    width: Any
    mean: Any
    error: Any
    empty: int
    merged: int


class Sampled(IntEnum):
    """Indices of ``Hygrometer.sums``."""

    KT = 0
    PRESSURE = 1
    LIQUID_KT = 2
    VAPOUR = 3
    LIQUID = 4
    RAIN = 5
    PARCEL_LOG_PRESSURE = 6
    ADIABAT = 7
    ROOM_PRESSURE = 8
    NUMBER = 9


class WaterReading(IntEnum):
    """Indices of the readings of water in ``Gauges.reading``; all in reduced units, ratios by number of molecules."""

    VAPOUR_PRESSURE = 32
    SATURATION = 33
    HUMIDITY = 34
    GAS_KT = 35
    LIQUID_KT = 36
    CONDENSING = 37
    EVAPORATING = 38
    VAPOUR_RATIO = 39
    LIQUID_RATIO = 40
    RAIN_RATIO = 41
    VAPOUR = 42
    LIQUID = 43
    RAINED = 44
    OPEN = 45
    LIQUID_SATURATION = 46
    LEFT_KT = 47
    PARCEL_KT = 48
    PARCEL_PRESSURE = 49
    ADIABAT = 50
    MIDDLE = 51
    MOLECULES = 52
    SATURATION_RATIO = 53
    SALTED_RADIUS = 54
    PURE_RADIUS = 55
    BUOYANCY = 56


@kernel
def saturation_pressure(kT, water):
    """Return the saturation vapour pressure over a liquid [energy/length^3]: see `Substance`."""
    kT = min(kT, water.critical)
    return water.volatility * exp(water.power * log(kT) - water.binding / kT) if kT > 0.0 else 0.0


@functools.cache
def hygrometry(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``begin``, ``sample``, ``condensed_energy`` and ``end_frame`` of one set of modes."""
    if not modes.phases:
        return _nothing()

    @kernel
    def factor(density, diameter, water):
        """Return the compressibility factor of spheres of this density [1/length^3]."""
        if not modes.contacts:
            return 1.0
        filled = math.pi / 6.0 * density * (diameter * diameter * diameter)
        x = filled / (1.0 - filled)
        value = 0.0
        for k in range(water.contact.size - 1, -1, -1):
            value = value * x + water.contact[k]
        return 1.0 + 4.0 * filled * (value / (1.0 - filled))

    @kernel
    def liquid_kT(reservoir):
        """Return the temperature of the liquid [energy]; NaN if there are neither liquid nor nuclei."""
        capacity = heat_capacity(reservoir)
        return reservoir.energy[THERMAL] / capacity if capacity > 0.0 else math.nan

    @kernel
    def adiabat(time, logarithm, lift, water):
        """Return the temperature of a parcel by theory [energy], given the logarithm of its pressure."""
        moment = interpolate(time, lift.course_time, lift.course_moment)
        row = 0
        while row < water.moment.size - 2 and water.moment[row + 1] < moment:
            row += 1
        here = interpolate(logarithm - water.planned[row], water.log_pressure, water.adiabat[row])
        if water.moment.size < 2:
            return here
        then = interpolate(logarithm - water.planned[row + 1], water.log_pressure, water.adiabat[row + 1])
        return here + (then - here) * (moment - water.moment[row]) / (water.moment[row + 1] - water.moment[row])

    @kernel
    def room(gas, drops, volume):
        """Return the share of the volume of a box that the excluded volume of drops leaves free."""
        taken = 0.0
        for k in range(drops.record.size):
            if drops.alive[k] == 1:
                reach = gas.kinds.table[modes.drops + k].radius + drops.molecule_radius
                taken += reach * reach * reach
        return 1.0 - 4.0 / 3.0 * math.pi * taken / volume

    @kernel
    def mean_radius(gas, drops, salted):
        """Return the mean radius of the drops with salt, or of those without [length]."""
        total = number = 0.0
        for k in range(drops.record.size):
            if drops.alive[k] == 1 and (drops.solute[k] > 0.0) == salted:
                total += gas.kinds.table[modes.drops + k].radius
                number += 1.0
        return total / number if number > 0.0 else math.nan

    @kernel
    def sample(gas, ascent, book, energy, height, gauges):
        """Sample vapour pressure, temperatures, and the amounts of vapour, liquid and rain."""
        wet, water, box = book.moisture, gauges.water, gas.box
        reservoir, sums = wet.reservoir, water.sums
        missing = reservoir.top[0]
        number, vapour = number_in_gas(gas, modes), wet.vapours - missing
        air = number - vapour
        rotations = wet.rotations - reservoir.rotation * missing
        kT = 2.0 * energy / (3.0 * number + rotations)
        wide = reservoir.diameter
        x = box.length_x - (wide if box.inverse_x == 0.0 else 0.0)
        y = box.length_y - (wide if box.inverse_y == 0.0 else 0.0)
        z = height - (wide if box.inverse_z == 0.0 else 0.0)
        density = number / (x * y * z)
        pressure = vapour / (x * y * z) * kT * factor(number / (box.length_x * box.length_y * height), wide, water)
        sums[Sampled.KT] += kT
        sums[Sampled.PRESSURE] += pressure
        sums[Sampled.LIQUID_KT] += liquid_kT(reservoir)
        sums[Sampled.VAPOUR] += vapour / air if air > 0 else math.nan
        sums[Sampled.LIQUID] += reservoir.count[LIQUID] / air if air > 0 else math.nan
        sums[Sampled.RAIN] += reservoir.count[RAINED] / air if air > 0 else math.nan
        sums[Sampled.NUMBER] += 1.0
        if modes.ascends:
            logarithm = log(density * kT * (1.0 + ascent.lift.measured[0] * density))
            sums[Sampled.PARCEL_LOG_PRESSURE] += logarithm
            if water.adiabat.size > 0:
                sums[Sampled.ADIABAT] += adiabat(gas.walls.epoch[0] + book.now[0], logarithm, ascent.lift, water)
        if modes.drops > 0:
            volume = box.length_x * box.length_y * height
            sums[Sampled.ROOM_PRESSURE] += pressure / room(gas, wet.drops, volume)

    @kernel
    def condensed_energy(gas, book):
        """Return the energy of the liquid, of its vapour's binding, of the rain and of drops [energy]."""
        wet = book.moisture
        reservoir = wet.reservoir
        energy = reservoir.binding_energy * (wet.vapours - reservoir.top[0])
        energy += reservoir.energy[THERMAL] + reservoir.energy[RAINED_ENERGY]
        if modes.drops > 0:
            for k in range(wet.drops.record.size):
                if wet.drops.alive[k] == 1:
                    at = motion_at(wet.drops.record[k], book.now[0], gas, modes)
                    kind = gas.kinds.table[modes.drops + k]
                    energy += 0.5 * kind.mass * (at.vx * at.vx + at.vy * at.vy + at.vz * at.vz)
                    energy += 4.0 * math.pi * wet.drops.tension * kind.radius * kind.radius
        return energy

    @kernel
    def begin(gas, book, gauges):
        """Begin to measure."""
        count, water = book.moisture.reservoir.count, gauges.water
        water.sums[:] = 0.0
        water.met[:] = 0.0
        water.before[0], water.before[1] = count[CONDENSED], count[EVAPORATED]
        gauges.reading[WaterReading.MOLECULES] = number_in_gas(gas, modes)

    @kernel
    def end_leaving(reservoir, water):
        """Read the energies of the molecules that have left the liquid: see `instruments.Leaving`."""
        total = 0.0
        for k in range(reservoir.spectrum.size):
            total += reservoir.spectrum[k]
        for k in range(water.width.size):
            water.mean[k] = water.error[k] = 0.0 if total > 0.0 else math.nan
            if k < water.empty or not total > 0.0:
                continue
            number = 0.0
            first = (k - water.empty) * water.merged
            for each in range(first, first + water.merged):
                number += reservoir.spectrum[each]
            share = number / total
            water.mean[k] = share / water.width[k]
            water.error[k] = math.sqrt(share * (1.0 - share) / total) / water.width[k]

    @kernel
    def end_frame(gas, ascent, book, time, lasted, gauges):
        """Read the counters, and complete the means of the frame."""
        reading, water, wet = gauges.reading, gauges.water, book.moisture
        reservoir, sums = wet.reservoir, water.sums
        count = reservoir.count
        for k in range(sums.size):
            if k != Sampled.NUMBER:
                sums[k] /= max(sums[Sampled.NUMBER], 1.0)
        kT, liquid = sums[Sampled.KT], sums[Sampled.LIQUID_KT]
        saturation = saturation_pressure(kT, water)
        reading[WaterReading.VAPOUR_PRESSURE] = sums[Sampled.PRESSURE]
        reading[WaterReading.SATURATION] = saturation
        reading[WaterReading.HUMIDITY] = sums[Sampled.PRESSURE] / saturation if saturation > 0.0 else math.nan
        reading[WaterReading.GAS_KT] = kT
        reading[WaterReading.LIQUID_KT] = liquid
        reading[WaterReading.CONDENSING] = (count[CONDENSED] - water.before[0]) / lasted
        reading[WaterReading.EVAPORATING] = (count[EVAPORATED] - water.before[1]) / lasted
        reading[WaterReading.VAPOUR_RATIO] = sums[Sampled.VAPOUR]
        reading[WaterReading.LIQUID_RATIO] = sums[Sampled.LIQUID]
        reading[WaterReading.RAIN_RATIO] = sums[Sampled.RAIN]
        reading[WaterReading.VAPOUR] = wet.vapours - reservoir.top[0]
        reading[WaterReading.LIQUID] = count[LIQUID]
        reading[WaterReading.RAINED] = count[RAINED]
        reading[WaterReading.MOLECULES] = number_in_gas(gas, modes)
        reading[WaterReading.OPEN] = reservoir.rates[STICKING]
        reading[WaterReading.LIQUID_SATURATION] = saturation_pressure(liquid, water) if liquid >= 0.0 else math.nan
        # the temperature of the liquid when molecules left it; while there was none, that of the gas
        rate = reading[WaterReading.EVAPORATING]
        if liquid >= 0.0:
            water.met[0] += rate * liquid
        else:
            water.met[3] += 1.0
        water.met[1] += rate * kT
        water.met[2] += rate
        warm = water.met[1] if water.met[3] > 0.0 else water.met[0]
        reading[WaterReading.LEFT_KT] = warm / water.met[2] if water.met[2] > 0.0 else math.nan
        if water.width.size > 0:
            end_leaving(reservoir, water)
        if modes.ascends and water.adiabat.size > 0:
            lift = ascent.lift
            reading[WaterReading.PARCEL_KT] = kT
            reading[WaterReading.PARCEL_PRESSURE] = exp(sums[Sampled.PARCEL_LOG_PRESSURE])
            reading[WaterReading.ADIABAT] = sums[Sampled.ADIABAT]
            reading[WaterReading.MIDDLE] = interpolate(time - 0.5 * lasted, lift.course_time, lift.course_moment)
            if water.level.size > 0:
                vapour, held = sums[Sampled.VAPOUR], sums[Sampled.LIQUID]
                dense = kT * (1.0 + vapour) / (1.0 + water.mass * (vapour + held))
                beside = interpolate(sums[Sampled.PARCEL_LOG_PRESSURE], water.level, water.around)
                reading[WaterReading.BUOYANCY] = dense / beside - 1.0
        if modes.drops > 0:
            reading[WaterReading.SATURATION_RATIO] = sums[Sampled.ROOM_PRESSURE] / saturation_pressure(liquid, water)
            reading[WaterReading.SALTED_RADIUS] = mean_radius(gas, wet.drops, True)
            reading[WaterReading.PURE_RADIUS] = mean_radius(gas, wet.drops, False)
        water.before[0], water.before[1] = count[CONDENSED], count[EVAPORATED]
        sums[:] = 0.0

    return begin, sample, condensed_energy, end_frame


def _nothing() -> tuple[Callable[..., Any], ...]:
    """Return the same kernels for a box without water."""

    @kernel
    def begin(gas, book, gauges):
        """Do nothing."""

    @kernel
    def sample(gas, ascent, book, energy, height, gauges):
        """Do nothing."""

    @kernel
    def condensed_energy(gas, book):
        """Return zero: there is no water."""
        return 0.0

    @kernel
    def end_frame(gas, ascent, book, time, lasted, gauges):
        """Do nothing."""

    return begin, sample, condensed_energy, end_frame
