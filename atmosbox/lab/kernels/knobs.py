"""The kernels that knobs call: walls and thermostat, the pool, the moment of an ascent, gravity, and attraction.

``set_gravity`` does what `ParcelSet.set_gravity` does. Gravity is a number among the arguments of each kernel that
moves molecules. This kernel uses the old one. It brings all molecules to the present and chooses layers of cells; then
the page writes the new gravity into the arguments of all kernels, and calls ``place``.
"""

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.schedule import interpolate
from atmosbox.engine.core.state import Modes
from atmosbox.engine.core.walls import HEAT_BATH, SPECULAR
from atmosbox.engine.exact.advance import dry_loop
from atmosbox.engine.exact.encounter import kind_of
from atmosbox.engine.exact.exact import Status
from atmosbox.engine.exact.layout import Column, Layout, write_column
from atmosbox.engine.liquid.moist_loop import moist_loop
from atmosbox.engine.liquid.reservoir import cover
from atmosbox.engine.wells.well_events import specialise
from atmosbox.lab.kernels.clustering import energy_of_wells
from atmosbox.lab.kernels.readings import ENERGY
from atmosbox.lab.kernels.starting import kinetic_energy


@functools.cache
def knobs(modes: Modes, *, wells: bool = False) -> dict[str, Callable[..., Any]]:
    """Return the kernels that knobs of a box call, by name; ``wells`` if molecules attract each other."""
    _, draw, wake = (moist_loop if modes.phases else dry_loop)(modes)
    _, _, replan, _ = specialise(modes)

    @kernel
    def warm_walls(gas, book, first, last, kT):
        """Set the temperature of heat baths [energy]: see `set_wall_kT`; with liquid, of any wall, see `set_wall`."""
        walls = gas.walls
        if modes.phases:
            wake(gas, book, math.sqrt(8.0 * kT / gas.kinds.table[book.moisture.reservoir.kind].mass))
        for wall in range(first, last):
            if modes.phases:
                walls.law[wall] = HEAT_BATH
                walls.accommodation[wall] = 1.0
            if walls.law[wall] == HEAT_BATH:
                for k in range(walls.schedule[wall], walls.schedule[wall + 1]):
                    walls.schedule_kT[k] = kT
        return 0

    @kernel
    def smooth_walls(gas, first, last):
        """Make heat baths smooth walls again."""
        for wall in range(first, last):
            gas.walls.law[wall] = SPECULAR
            gas.walls.accommodation[wall] = 0.0
        return 0

    @kernel
    def cover_pool(gas, book, share):
        """Set the share of the pool that is open: see `MoistAccount.set_open_pool`."""
        cover(book.moisture.reservoir, share)
        draw(gas, book, book.moisture.reservoir.bound[0])
        return 0

    @kernel
    def set_gravity(gas, book, begun, gauges, gravity):
        """Prepare the box for another gravity [length/time^2]; return ``DONE``, or ``FULL`` if memory is too short."""
        gauges.before[ENERGY] += (gravity - gas.box.gravity) * _bring_to_now(gas, book.now[0], modes)
        kinetic, _ = kinetic_energy(gas, begun)
        kT = 2.0 * kinetic / ((2.0 if gas.box.planar else 3.0) * gas.molecules.size)
        for wall in range(6):  # of the molecules or of the warmest wall, whichever is higher: see `ParcelSet`
            if gas.walls.law[wall] == HEAT_BATH:
                kT = max(kT, gas.walls.schedule_kT[gas.walls.schedule[wall]])
        layout, c = begun.layout, begun.layout.column
        weight = begun.weight / gas.molecules.size * gravity
        column = Column(weight, kT, c.wanted, c.thinnest, c.count, c.old)
        other = Layout(layout.shape, layout.due, layout.filled, layout.edge, layout.radius, column)
        return Status.DONE.value if write_column(kT, gas, other, modes) else Status.FULL.value

    @kernel
    def attract(gas, book, crowd, gauges, strength):
        """Change the depth of all wells: see `AttractingParcelSet.set_strength`."""
        work = -energy_of_wells(gas.wells)
        for pair in np.ndindex(crowd.full_depth.shape):
            gas.wells.depth[pair] = strength * crowd.full_depth[pair]
        work += energy_of_wells(gas.wells)
        crowd.work[0] += work
        gauges.before[ENERGY] += work
        crowd.strength[0] = strength
        replan(gas, book.now[0])
        return 0

    found = {"lead": lead} if modes.ascends else {}
    if wells:
        found |= {"attract": attract, "warm_bath": warm_bath}
    elif can_set_gravity(modes):
        found["set_gravity"] = set_gravity
    if modes.drops or (modes.phases and modes.ascends and not modes.pool):  # visible drops, or a cloud that rises
        return found
    found |= {"cover_pool": cover_pool} if modes.pool else {}
    return found | {"warm_walls": warm_walls} | ({"smooth_walls": smooth_walls} if modes.phases else {})


@kernel
def warm_bath(gas, kT):
    """Set the temperature of the random bath [energy]: see `AttractingParcelSet.set_bath_kT`."""
    gas.bath.schedule_kT[:] = kT
    return 0


@kernel
def lead(gas, ascent, book, towards):
    """Move the parcel to another moment of its planned ascent, at its pace, and stop there: see `Course.lead`."""
    time, lift = gas.walls.epoch[0] + book.now[0], ascent.lift
    here = interpolate(time, lift.course_time, lift.course_moment)
    times, moments = lift.course_time, lift.course_moment
    times[0], moments[0] = 0.0, here
    times[1], moments[1] = time, here
    times[2], moments[2] = time + abs(towards - here), towards
    times[3], moments[3] = math.inf, towards
    return 0


def can_set_gravity(modes: Modes) -> bool:
    """Return whether a page can change gravity in boxes of a set of modes: columns of one gas without a piston."""
    return modes.gravity and modes.rows and not (modes.piston or modes.mixed or modes.phases)


@kernel
def _inside(x, side, inverse):
    """Return a coordinate inside of a periodic box, x modulo its side as numpy computes it, but never the side itself.

    All steps but the last difference are exact.
    """
    if inverse == 0.0:
        return x
    left, step = abs(x), side
    while 2.0 * step <= left:
        step *= 2.0
    while step >= side:
        left -= step if left >= step else 0.0
        step *= 0.5
    if x < 0.0 and left > 0.0:
        left = side - left
    return left if left < side else 0.0


@kernel
def _bring_to_now(gas, now, modes):
    """Give every molecule its present position and velocity; return the sum of mass times height."""
    box, heights = gas.box, 0.0
    for i in range(gas.molecules.size):
        molecule = gas.molecules[i]
        mass, _, _ = kind_of(i, gas, modes)
        dt = now - molecule.clock
        molecule.x = _inside(molecule.x + dt * molecule.vx, box.length_x, box.inverse_x)
        molecule.y = _inside(molecule.y + dt * molecule.vy, box.length_y, box.inverse_y)
        molecule.z = molecule.z + dt * molecule.vz - 0.5 * box.gravity * dt * dt
        molecule.vz -= box.gravity * dt
        molecule.clock = now
        heights += mass * molecule.z
    return heights
