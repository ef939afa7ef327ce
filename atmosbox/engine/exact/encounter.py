"""Encounters: two molecules collide, or one hits a wall."""

import math

import numpy as np

from atmosbox.engine.core.hard_sphere import share_energy
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.pair import nearest_image, resolve
from atmosbox.engine.core.random import uniform
from atmosbox.engine.core.state import Motion
from atmosbox.engine.core.walls import resolve_wall_hit


@kernel
def motion_at(i, t, gas, modes):
    """Return the `Motion` of molecule i at time t."""
    molecule = gas.molecules[i]
    dt = t - molecule.clock
    vz = molecule.vz
    x = molecule.x + dt * molecule.vx
    y = molecule.y + dt * molecule.vy
    if modes.gravity:
        z = molecule.z + dt * (vz - 0.5 * gas.box.gravity * dt)
        vz = vz - gas.box.gravity * dt
    else:
        z = molecule.z + dt * vz
    return Motion(x, y, z, molecule.vx, molecule.vy, vz)


@kernel
def write(i, t, at, gas):
    """Set position and velocity of molecule i at time t; all contacts predicted with it become stale."""
    molecule = gas.molecules[i]
    molecule.x, molecule.y, molecule.z = at.x, at.y, at.z
    molecule.vx, molecule.vy, molecule.vz = at.vx, at.vy, at.vz
    molecule.clock = t
    molecule.count += 1


@kernel
def kind_of(i, gas, modes):
    """Return mass [mass], radius [length] and rotational degrees of freedom of molecule i."""
    kind = gas.kinds.table[np.int64(gas.molecules[i].kind) if modes.mixed else 0]
    return kind.mass, kind.radius, kind.rotation if modes.rotation else 0.0


@kernel
def size_and_radius(i, gas, modes):
    """Return the size class and the radius [length] of molecule i."""
    table = gas.kinds.table
    if modes.mixed:
        kind = table[gas.molecules[i].kind]
        return np.int64(kind.size_class), kind.radius
    return np.int64(0), table[0].radius


@kernel
def slots_of(i, gas):
    """Return the slots of molecule i along x, y and z: see `cells`."""
    event = gas.events[i]
    return np.int64(event.slot_x), np.int64(event.slot_y), np.int64(event.slot_z)


@kernel
def meet(i, j, t, at, gas, modes):
    """Resolve the contact of molecule i, whose `Motion` is ``at``, with j; return the `Motion` of both after it."""
    box, tallies = gas.box, gas.tallies
    other = motion_at(j, t, gas, modes)
    rx, ry, rz = nearest_image(at.x - other.x, at.y - other.y, at.z - other.z, box, modes)
    ux, uy, uz = at.vx - other.vx, at.vy - other.vy, at.vz - other.vz
    mass, _, rotation = kind_of(i, gas, modes)
    other_mass, _, other_rotation = kind_of(j, gas, modes)
    dx, dy, dz = resolve(rx, ry, rz, ux, uy, uz, mass, other_mass)
    # rotation takes part in a share of the contacts: then the energy of the pair is redistributed
    if modes.rotation and (box.exchange >= 1.0 or uniform(tallies.random) < box.exchange):
        reduced_mass = mass * other_mass / (mass + other_mass)
        spin = gas.kinds.rotational_energy
        relative = 0.5 * reduced_mass * (ux * ux + uy * uy + uz * uz)
        dimensions = 2.0 if box.planar else 3.0
        energy = relative + spin[i] + spin[j]
        # the lower index first: the result must not depend on which of the two held the event
        if i < j:
            shared, spin[i], spin[j] = share_energy(energy, dimensions, rotation, other_rotation, tallies.random)
        else:
            shared, spin[j], spin[i] = share_energy(energy, dimensions, other_rotation, rotation, tallies.random)
        # the elastic contact turns the relative velocity u into u + d (1 + m_i / m_j); now its length is scaled
        share = 1.0 + mass / other_mass
        scale = math.sqrt(shared / relative)
        dx = (scale * (ux + share * dx) - ux) / share
        dy = (scale * (uy + share * dy) - uy) / share
        dz = (scale * (uz + share * dz) - uz) / share
    # the virial of the contact is counted in the layer of the point midway between the two
    layer = min(max(int((at.z - 0.5 * rz) * tallies.layer_scale), 0), tallies.virial.size - 1)
    tallies.virial[layer] += mass * (rx * dx + ry * dy + rz * dz)
    back = mass / other_mass if modes.mixed else 1.0
    one = Motion(at.x, at.y, at.z, at.vx + dx, at.vy + dy, at.vz + dz)
    two = Motion(other.x, other.y, other.z, other.vx - back * dx, other.vy - back * dy, other.vz - back * dz)
    write(i, t, one, gas)
    write(j, t, two, gas)
    return one, two


@kernel
def hit(i, wall, t, at, gas, modes):
    """Resolve a hit of molecule i, whose `Motion` is ``at``, on a wall or the piston; return its `Motion` after it."""
    box, walls, tallies = gas.box, gas.walls, gas.tallies
    mass, radius, rotation = kind_of(i, gas, modes)
    spin = gas.kinds.rotational_energy[i] if modes.rotation else 0.0
    before = 0.5 * mass * (at.vx * at.vx + at.vy * at.vy + at.vz * at.vz) + spin
    velocity, spin, change = resolve_wall_hit(
        wall, walls.epoch[0] + t, (at.vx, at.vy, at.vz), spin, (mass, rotation), walls, box.planar, tallies.random
    )
    vx, vy, vz = velocity
    # the centre is set to exactly one radius from the wall, without the rounding of the flight
    x, y, z = at.x, at.y, at.z
    high = wall & 1 == 1
    if wall >> 1 == 0:
        x = box.length_x - radius if high else radius
    elif wall >> 1 == 1:
        y = box.length_y - radius if high else radius
    elif modes.piston and high:
        z = walls.piston[0] + walls.piston[1] * (t - walls.piston[2]) - radius
    else:
        z = box.length_z - radius if high else radius
    if modes.rotation:
        gas.kinds.rotational_energy[i] = spin
    # the energy that the molecule gained was given by the wall: as work if it is the piston, else as heat
    gained = 0.5 * mass * (vx * vx + vy * vy + vz * vz) + spin - before
    tallies.hits[wall] += 1
    tallies.impulse[wall] += -mass * change if high else mass * change
    if modes.piston and wall == 5:
        tallies.work[wall] += gained
    else:
        tallies.heat[wall] += gained
    after = Motion(x, y, z, vx, vy, vz)
    write(i, t, after, gas)
    return after
