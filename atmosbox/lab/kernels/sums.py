"""Sums over the molecules, in bins of kind, height, place along x, and speed: what the instruments of a page sum up.

An instrument in Python sums with numpy what its page sums here: all quantities, for the bins that are declared for it.
"""

import math
from collections import namedtuple
from enum import IntEnum

import numpy as np

from atmosbox.engine.core.elementary import circle
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.exact.encounter import kind_of, motion_at

Sum = IntEnum("Sum", "NUMBER MASS X Y Z KINETIC ROTATION WEIGHT DIAMETER UPRIGHT COSINE", start=0)
"""Indices of ``Bins.sums``: number, mass, momentum along the axes, kinetic and rotational energy, mass times height,
diameter, square of the velocity along z, and the cosine that falls from 1 to -1 across the bins along x."""


class Bins(namedtuple("Bins", "kind rows columns low width edges sums")):
    """Bins of molecules, and the sums over the molecules of each.

    ``kind : (molecule,)`` is the number of the kind of each, empty if they are alike; ``rows`` the number of layers
    between floor and ceiling; ``columns`` that of equal parts along x, from ``low`` on, over ``width`` [length];
    ``edges : (speed + 1,)`` those of bins of speed, a single number if there are none [velocity]. The bins are in the
    order of kind, row, column, speed. ``sums : (bin, quantity)`` has no rows in a scene that has no use for them.
    """


@kernel
def is_away(i, gas, modes):
    """Return whether record i is a drop, or a molecule in the liquid, and not a molecule in the gas."""
    if not modes.phases:
        return False
    molecule = gas.molecules[i]
    return math.isinf(molecule.clock) or (modes.drops > 0 and np.int64(molecule.kind) >= modes.drops)


@kernel
def ceiling(gas, now):
    """Return the height of the ceiling [length]."""
    piston = gas.walls.piston
    return piston[0] + piston[1] * (now - piston[2])


@kernel
def sum_up(gas, now, gauges, modes):
    """Write the sums over all molecules of the gas, for each group of bins."""
    height, groups = ceiling(gas, now), (gauges.whole, gauges.parts, gauges.fast, gauges.sides)
    for bins in groups:
        bins.sums[:] = 0.0
    for i in range(gas.molecules.size):
        if is_away(i, gas, modes):
            continue
        at = motion_at(i, now, gas, modes)
        mass, radius, _ = kind_of(i, gas, modes)
        square = at.vx * at.vx + at.vy * at.vy + at.vz * at.vz
        for bins in groups:
            if bins.sums.size == 0:
                continue
            # by rounding, a molecule that touches a wall may be a little beyond the bins
            share = (at.x - bins.low) / bins.width
            share = min(max(share - math.floor(share) if gas.box.inverse_x != 0.0 else share, 0.0), 1.0)
            row = min(max(int(at.z / height * bins.rows), 0), bins.rows - 1)
            if bins.kind.size > 0:
                row += bins.kind[i] * bins.rows
            place = row * bins.columns + min(int(share * bins.columns), bins.columns - 1)
            speeds = bins.edges.size - 1
            if speeds > 0:
                speed, low, high = math.sqrt(square), bins.edges[0], bins.edges[speeds]
                if not low <= speed <= high:
                    continue
                place = place * speeds + min(int((speed - low) / (high - low) * speeds), speeds - 1)
            sums = bins.sums[place]
            sums[Sum.NUMBER] += 1.0
            sums[Sum.MASS] += mass
            sums[Sum.X] += mass * at.vx
            sums[Sum.Y] += mass * at.vy
            sums[Sum.Z] += mass * at.vz
            sums[Sum.KINETIC] += 0.5 * mass * square
            sums[Sum.WEIGHT] += mass * at.z
            sums[Sum.DIAMETER] += 2.0 * radius
            sums[Sum.UPRIGHT] += at.vz * at.vz
            if modes.rotation:
                sums[Sum.ROTATION] += gas.kinds.rotational_energy[i]
            if bins.columns > 1:
                cosine, _ = circle(0.5 * share)
                sums[Sum.COSINE] += cosine
