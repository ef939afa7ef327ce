"""Measurements of the water in a box, as kernels: the sums of `Water`, `Leaving`, `MoistLift` and `Nuclei`."""

import math
from collections import namedtuple

import numpy as np

from atmosbox.engine.core.elementary import exp, log
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.schedule import interpolate
from atmosbox.engine.exact.encounter import motion_at
from atmosbox.engine.liquid.reservoir import CONDENSED, EVAPORATED, LIQUID, RAINED, STICKING, THERMAL, heat_capacity
from atmosbox.lab.kernels.readings import Reading
from atmosbox.lab.kernels.sums import Sum, ceiling


class Hygrometer(
    namedtuple(
        "Hygrometer",
        "before met contact volatility power binding critical moment planned log_pressure adiabat level "
        "around mass width mean error empty merged",
    )
):
    """The data of the instruments for the water of a box.

    ``before : (2,)`` are the numbers of molecules that had condensed and evaporated at the end of the last frame;
    ``met : (4,)`` sums over all frames of the rate of evaporation times the temperature of the liquid, of that rate
    times the temperature of the gas, of the rate itself, and the number of frames without liquid.

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


@kernel
def saturation_pressure(kT, water):
    """Return the saturation vapour pressure over a liquid [energy/length^3]: see `Substance`."""
    kT = min(kT, water.critical)
    return water.volatility * exp(water.power * log(kT) - water.binding / kT) if kT > 0.0 else 0.0


@kernel
def _factor(density, diameter, water, modes):
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
def _adiabat(time, logarithm, lift, water):
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
def _room(gas, drops, volume, modes):
    """Return the share of the volume of a box that the excluded volume of drops leaves free."""
    taken = 0.0
    for k in range(drops.record.size):
        if drops.alive[k] == 1:
            reach = gas.kinds.table[modes.drops + k].radius + drops.molecule_radius
            taken += reach * reach * reach
    return 1.0 - 4.0 / 3.0 * math.pi * taken / volume


@kernel
def _mean_radius(gas, drops, salted, modes):
    """Return the mean radius of the drops with salt, or of those without [length]."""
    total = number = 0.0
    for k in range(drops.record.size):
        if drops.alive[k] == 1 and (drops.solute[k] > 0.0) == salted:
            total += gas.kinds.table[modes.drops + k].radius
            number += 1.0
    return total / number if number > 0.0 else math.nan


@kernel
def sample_water(gas, ascent, book, gauges, modes):
    """Sample vapour pressure, temperatures, and the amounts of vapour, liquid and rain."""
    wet, water, box, means = book.moisture, gauges.water, gas.box, gauges.means
    reservoir, whole, height = wet.reservoir, gauges.whole.sums[0], ceiling(gas, book.now[0])
    number, missing, wide = whole[Sum.NUMBER], reservoir.top[0], reservoir.diameter
    vapour = wet.vapours - missing
    air = number - vapour
    rotations = wet.rotations - reservoir.rotation * missing
    kT = 2.0 * (whole[Sum.KINETIC] + whole[Sum.ROTATION]) / (3.0 * number + rotations)
    x = box.length_x - (wide if box.inverse_x == 0.0 else 0.0)
    y = box.length_y - (wide if box.inverse_y == 0.0 else 0.0)
    z = height - (wide if box.inverse_z == 0.0 else 0.0)
    volume = box.length_x * box.length_y * height
    density = number / (x * y * z)
    pressure = vapour / (x * y * z) * kT * _factor(number / volume, wide, water, modes)
    means[Reading.GAS_TEMPERATURE] += kT
    means[Reading.WATER_VAPOR_PARTIAL_PRESSURE] += pressure
    capacity = heat_capacity(reservoir)  # 0 if there are neither liquid nor nuclei
    means[Reading.LIQUID_TEMPERATURE] += reservoir.energy[THERMAL] / capacity if capacity > 0.0 else math.nan
    means[Reading.HUMIDITY_MIXING_RATIO] += vapour / air if air > 0.0 else math.nan
    means[Reading.CLOUD_LIQUID_WATER_MIXING_RATIO] += reservoir.count[LIQUID] / air if air > 0.0 else math.nan
    means[Reading.RAIN_MIXING_RATIO] += reservoir.count[RAINED] / air if air > 0.0 else math.nan
    if modes.ascends:
        logarithm = log(density * kT * (1.0 + ascent.lift.measured[0] * density))
        means[Reading.PARCEL_PRESSURE] += logarithm
        if water.adiabat.size > 0:
            time = gas.walls.epoch[0] + book.now[0]
            means[Reading.ADIABAT_TEMPERATURE] += _adiabat(time, logarithm, ascent.lift, water)
    if modes.drops > 0:
        means[Reading.SATURATION_RATIO] += pressure / _room(gas, wet.drops, volume, modes)


@kernel
def condensed_energy(gas, book, modes):
    """Return the energy of the liquid, of its vapour's binding, of the rain and of drops [energy]."""
    wet, reservoir = book.moisture, book.moisture.reservoir
    thermal, rained = reservoir.energy[0], reservoir.energy[1]
    energy = reservoir.binding_energy * (wet.vapours - reservoir.top[0]) + (thermal + rained)
    if modes.drops > 0:
        for k in range(wet.drops.record.size):
            if wet.drops.alive[k] == 1:
                at = motion_at(wet.drops.record[k], book.now[0], gas, modes)
                kind = gas.kinds.table[modes.drops + k]
                energy += 0.5 * kind.mass * (at.vx * at.vx + at.vy * at.vy + at.vz * at.vz)
                energy += 4.0 * math.pi * wet.drops.tension * kind.radius * kind.radius
    return energy


@kernel
def begin_water(book, gauges):
    """Begin to measure."""
    count, water = book.moisture.reservoir.count, gauges.water
    water.met[:] = 0.0
    water.before[0], water.before[1] = count[CONDENSED], count[EVAPORATED]


@kernel
def _end_leaving(reservoir, water):
    """Read the energies of the molecules that have left the liquid: see `instruments.Leaving`."""
    total = np.sum(reservoir.spectrum)
    for k in range(water.width.size):
        water.mean[k] = water.error[k] = 0.0 if total > 0 else math.nan
        if k >= water.empty and total > 0:
            first = (k - water.empty) * water.merged
            share = np.sum(reservoir.spectrum[first : first + water.merged]) / total
            water.mean[k] = share / water.width[k]
            water.error[k] = math.sqrt(share * (1.0 - share) / total) / water.width[k]


@kernel
def end_water(gas, ascent, book, time, lasted, gauges, modes):
    """Read the counters, and what follows from the means of the frame."""
    reading, water, wet = gauges.reading, gauges.water, book.moisture
    reservoir, count, met = wet.reservoir, wet.reservoir.count, water.met
    kT, liquid = reading[Reading.GAS_TEMPERATURE], reading[Reading.LIQUID_TEMPERATURE]
    pressure, saturation = reading[Reading.WATER_VAPOR_PARTIAL_PRESSURE], saturation_pressure(kT, water)
    rate = (count[EVAPORATED] - water.before[1]) / lasted
    reading[Reading.SATURATION_VAPOR_PRESSURE] = saturation
    reading[Reading.RELATIVE_HUMIDITY] = pressure / saturation if saturation > 0.0 else math.nan
    reading[Reading.CONDENSATION_RATE] = (count[CONDENSED] - water.before[0]) / lasted
    reading[Reading.EVAPORATION_RATE] = rate
    reading[Reading.VAPOR_MOLECULE_COUNT] = wet.vapours - reservoir.top[0]
    reading[Reading.LIQUID_MOLECULE_COUNT] = count[LIQUID]
    reading[Reading.RAINED_MOLECULE_COUNT] = count[RAINED]
    reading[Reading.POOL_OPEN_SHARE] = reservoir.rates[STICKING]
    saturation = saturation_pressure(liquid, water) if liquid >= 0.0 else math.nan
    reading[Reading.LIQUID_SATURATION_VAPOR_PRESSURE] = saturation
    # the temperature of the liquid when molecules left it; while there was none, that of the gas
    if liquid >= 0.0:
        met[0] += rate * liquid
    else:
        met[3] += 1.0
    met[1] += rate * kT
    met[2] += rate
    warm = met[1] if met[3] > 0.0 else met[0]
    reading[Reading.TEMPERATURE_OF_THOSE_THAT_LEFT] = warm / met[2] if met[2] > 0.0 else math.nan
    _end_leaving(reservoir, water)
    if modes.ascends:
        lift, logarithm = ascent.lift, reading[Reading.PARCEL_PRESSURE]
        reading[Reading.PARCEL_TEMPERATURE] = kT
        reading[Reading.PARCEL_PRESSURE] = exp(logarithm)
        reading[Reading.MOMENT] = interpolate(time - 0.5 * lasted, lift.course_time, lift.course_moment)
        if water.level.size > 0:
            vapour = reading[Reading.HUMIDITY_MIXING_RATIO]
            held = vapour + reading[Reading.CLOUD_LIQUID_WATER_MIXING_RATIO]
            dense = kT * (1.0 + vapour) / (1.0 + water.mass * held)
            beside = interpolate(logarithm, water.level, water.around)
            reading[Reading.PARCEL_BUOYANCY] = dense / beside - 1.0
    if modes.drops > 0:
        reading[Reading.SATURATION_RATIO] /= saturation
        reading[Reading.SALTED_DROP_RADIUS] = _mean_radius(gas, wet.drops, True, modes)
        reading[Reading.PURE_DROP_RADIUS] = _mean_radius(gas, wet.drops, False, modes)
    water.before[0], water.before[1] = count[CONDENSED], count[EVAPORATED]
