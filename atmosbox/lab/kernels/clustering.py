"""Measure and show drops of molecules that attract each other, in a page.

These kernels compute the counts and sums of `atmosbox.scene.instruments.Clusters`, in addition to those of `gauging`.
"""

import math
from collections import namedtuple

import numpy as np

from atmosbox.engine.core.elementary import cbrt, expm1
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.walls import wall_kT
from atmosbox.engine.wells.vicinity import is_inside
from atmosbox.lab.kernels.readings import Reading
from atmosbox.scene.instruments.condensate import CROWDED


class Crowd(namedtuple("Crowd", "members wells drop size liquid virial gas_law full_depth strength work")):
    """The data of the drops.

    ``members`` is the number of molecules that attract each other, which come first. ``wells``, ``drop``, ``size :
    (molecule,)``: for each molecule the number of wells that it is in, the molecule that represents its drop (-1 in the
    vapour), and the size of the drop that it represents; ``liquid`` the density of the liquid in drops [1/length^3].
    ``virial : (1,)`` is the virial at the end of the last frame [energy]; ``gas_law : (2, 4)`` the coefficients of p /
    n k T - 1 of a gas: rows for the powers 1 and 2 of its density, columns for the powers 0 to 3 of e^(strength / kT) -
    1. ``full_depth : (kind, kind)`` is the full depth of the wells [energy], ``strength : (1,)`` their present depth
    over the full one; ``work : (1,)`` the energy that changes of the strength have given to the molecules [energy].
    """


@kernel
def energy_of_wells(wells):
    """Return the potential energy of all pairs that are in each other's well [energy]."""
    total = 0.0
    for pair in np.ndindex(wells.depth.shape):
        total += wells.depth[pair] * wells.number[pair]
    return -total


@kernel
def count_wells(vicinity, stride, wells):
    """Count the wells that each molecule is in."""
    for i in range(wells.size):
        number = 0
        for q in range(i * stride + 1, i * stride + 1 + np.int64(vicinity.entry[i * stride])):
            number += is_inside(vicinity.entry[q])
        wells[i] = number


@kernel
def _one_for_all(i, drop):
    """Return the molecule that represents the drop of molecule i, and shorten the chain of references to it."""
    while drop[i] != i:
        drop[i] = drop[drop[i]]
        i = drop[i]
    return i


@kernel
def _find_drops(vicinity, stride, crowd):
    """Find the drop that each molecule belongs to: see `instruments.drops_of`."""
    wells, drop, entry = crowd.wells, crowd.drop, vicinity.entry
    for i in range(drop.size):
        drop[i] = i if wells[i] >= CROWDED else -1
    for i in range(drop.size):
        for q in range(i * stride + 1, i * stride + 1 + np.int64(entry[i * stride])):
            j = np.int64(entry[q]) >> 1
            if j > i and is_inside(entry[q]) and drop[i] >= 0 and drop[j] >= 0:
                drop[_one_for_all(j, drop)] = _one_for_all(i, drop)
    for i in range(drop.size):
        if drop[i] >= 0:
            drop[i] = _one_for_all(i, drop)
    # molecules at a surface: one next to two drops belongs to the last that is found, in the same order as in Python
    for lower_is_liquid in (True, False):
        for i in range(drop.size):
            for q in range(i * stride + 1, i * stride + 1 + np.int64(entry[i * stride])):
                j = np.int64(entry[q]) >> 1
                inner, outer = (i, j) if lower_is_liquid else (j, i)
                touches = j > i and is_inside(entry[q])
                if touches and wells[inner] >= CROWDED and wells[outer] < CROWDED:
                    drop[outer] = drop[inner]


@kernel
def _gas_pressure(density, kT, strength, law):
    """Return the pressure of a gas by the virial series up to B3; NaN where that is not positive."""
    x = expm1(max(strength, 1e-9) / kT)
    factor, power = 1.0, 1.0
    for k in range(law.shape[0]):
        power *= density
        term = 0.0
        for m in range(law.shape[1] - 1, -1, -1):
            term = term * x + law[k, m]
        factor += power * term
    return density * kT * factor if factor > 0.0 else math.nan


@kernel
def _drop_volume(size, liquid):
    """Return the volume of a drop of ``size`` molecules, out to half the range of the attraction."""
    radius = cbrt(0.75 * size / (math.pi * liquid)) + 0.75
    return 4.0 / 3.0 * math.pi * radius * radius * radius if size > 0.0 else 0.0


@kernel
def _vapour_density(largest, vapour, drops, volume, crowd):
    """Return the density of the free vapour around drops; without a drop, that of all molecules."""
    if largest < 0.1 * crowd.members:
        return crowd.members / volume
    others = max(drops - 1.0, 1.0)
    held = _drop_volume(1.0 * largest, crowd.liquid)
    held += others * _drop_volume((crowd.members - vapour - largest) / others, crowd.liquid)
    return vapour / max(volume - held, 0.1 * volume)


@kernel
def end_clusters(gas, lasted, reading, layout, crowd):
    """Take the readings of the drops at the end of a frame, whose other readings are known."""
    volume = gas.box.length_x * gas.box.length_z * (1.0 if gas.box.planar else gas.box.length_y)
    count_wells(gas.vicinity, layout.stride[0], crowd.wells)
    _find_drops(gas.vicinity, layout.stride[0], crowd)
    crowd.size[:] = 0
    largest = vapour = drops = 0
    for i in range(crowd.members):
        if crowd.drop[i] < 0:
            vapour += 1
            continue
        crowd.size[crowd.drop[i]] += 1
        drops += crowd.size[crowd.drop[i]] == 1
        largest = max(largest, crowd.size[crowd.drop[i]])
    virial = np.sum(gas.tallies.virial)
    bound, kinetic = energy_of_wells(gas.wells), reading[Reading.KINETIC_ENERGY]
    motion = gas.molecules.size * reading[Reading.AIR_TEMPERATURE]
    density = _vapour_density(largest, vapour, drops, volume, crowd)
    kT = wall_kT(gas.bath, 0, reading[Reading.ELAPSED_TIME])
    if not gas.bath.rate > 0.0:
        kT = reading[Reading.WALL_TEMPERATURE + 4]
    reading[Reading.LARGEST_DROP_MOLECULE_COUNT] = largest
    reading[Reading.VAPOR_MOLECULE_COUNT] = vapour
    reading[Reading.DROP_COUNT] = drops
    reading[Reading.ATTRACTION_ENERGY] = bound
    reading[Reading.MOLECULAR_ENERGY] = kinetic + bound
    reading[Reading.HEAT_FROM_BATH] = gas.bath.heat[0]
    reading[Reading.WORK_BY_ATTRACTION] = crowd.work[0]
    reading[Reading.VIRIAL_PRESSURE] = (motion + (virial - crowd.virial[0]) / (3.0 * lasted)) / volume
    reading[Reading.WELL_COUNT] = np.sum(gas.wells.number)
    reading[Reading.AIR_TEMPERATURE_THEORY] = kT
    kT = reading[Reading.AIR_TEMPERATURE]
    reading[Reading.VIRIAL_PRESSURE_THEORY] = _gas_pressure(density, kT, crowd.strength[0], crowd.gas_law)
    crowd.virial[0] = virial
