"""What an encounter does: two molecules meet, or one hits a wall."""

import math

import numpy as np

from atmosbox.engine.core.contact import resolve_contact, share_energy
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.random import uniform
from atmosbox.engine.core.walls import resolve_wall_hit

__all__ = ["hit", "meet", "position_at", "write"]


@kernel
def position_at(molecule, t, box, modes):
    """Return position and velocity of a molecule at time t."""
    dt = t - molecule.clock
    vz = molecule.vz
    x = molecule.x + dt * molecule.vx
    y = molecule.y + dt * molecule.vy
    if modes.gravity:
        z = molecule.z + dt * (vz - 0.5 * box.gravity * dt)
        vz = vz - box.gravity * dt
    else:
        z = molecule.z + dt * vz
    return x, y, z, molecule.vx, molecule.vy, vz


@kernel
def write(molecule, t, x, y, z, vx, vy, vz):
    """Give a molecule another place and velocity at time t; what was predicted of it is stale."""
    molecule.x = x
    molecule.y = y
    molecule.z = z
    molecule.vx = vx
    molecule.vy = vy
    molecule.vz = vz
    molecule.clock = t
    molecule.count += 1


@kernel
def meet(i, j, t, x, y, z, vx, vy, vz, molecules, kinds, box, tallies, modes):
    """Resolve a contact; return the new states of both."""
    px, py, pz, wx, wy, wz = position_at(molecules[j], t, box, modes)
    rx = x - px
    ry = y - py
    rz = z - pz
    if modes.periodic:
        rx -= box.length_x * np.rint(rx * box.inverse_x)
        ry -= box.length_y * np.rint(ry * box.inverse_y)
        if not (modes.gravity or modes.piston):
            rz -= box.length_z * np.rint(rz * box.inverse_z)
    ux = vx - wx
    uy = vy - wy
    uz = vz - wz
    mass = kinds.table[0].mass
    other_mass = mass
    rotation = kinds.table[0].rotation
    other_rotation = rotation
    if modes.mixed:
        kind = kinds.table[molecules[i].kind]
        other_kind = kinds.table[molecules[j].kind]
        mass = kind.mass
        other_mass = other_kind.mass
        rotation = kind.rotation
        other_rotation = other_kind.rotation
    dx, dy, dz = resolve_contact(rx, ry, rz, ux, uy, uz, mass, other_mass)
    if modes.rotation and (box.exchange >= 1.0 or uniform(tallies.random) < box.exchange):
        reduced_mass = mass * other_mass / (mass + other_mass)
        spin = kinds.rotational_energy
        relative = 0.5 * reduced_mass * (ux * ux + uy * uy + uz * uz)
        dimensions = 2.0 if box.planar else 3.0
        energy = relative + spin[i] + spin[j]
        # the lower index first: what happens must not depend on which of the two held the event
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
    back = mass / other_mass if modes.mixed else 1.0
    layer = min(max(int((z - 0.5 * rz) * tallies.layer_scale), 0), tallies.virial.size - 1)
    tallies.virial[layer] += mass * (rx * dx + ry * dy + rz * dz)
    write(molecules[i], t, x, y, z, vx + dx, vy + dy, vz + dz)
    write(molecules[j], t, px, py, pz, wx - back * dx, wy - back * dy, wz - back * dz)
    return vx + dx, vy + dy, vz + dz, px, py, pz, wx - back * dx, wy - back * dy, wz - back * dz


@kernel
def hit(i, wall, t, x, y, z, vx, vy, vz, molecules, kinds, box, walls, tallies, modes):
    """Resolve a hit on a wall or the piston; return the new state."""
    mass = kinds.table[0].mass
    radius = kinds.table[0].radius
    rotation = kinds.table[0].rotation
    if modes.mixed:
        kind = kinds.table[molecules[i].kind]
        mass = kind.mass
        radius = kind.radius
        rotation = kind.rotation
    spin = kinds.rotational_energy[i] if modes.rotation else 0.0
    if not modes.rotation:
        rotation = 0.0
    before = 0.5 * mass * (vx * vx + vy * vy + vz * vz) + spin
    since_start = walls.epoch[0] + t
    axis = wall >> 1
    high = wall & 1 == 1
    if axis == 0:
        came = vx
        vx, vy, vz, spin = resolve_wall_hit(
            walls, wall, since_start, vx, vy, vz, spin, mass, rotation, box.planar, tallies.random
        )
        went = vx
        x = box.length_x - radius if high else radius
    elif axis == 1:
        came = vy
        vy, vx, vz, spin = resolve_wall_hit(
            walls, wall, since_start, vy, vx, vz, spin, mass, rotation, box.planar, tallies.random
        )
        went = vy
        y = box.length_y - radius if high else radius
    else:
        came = vz
        vz, vx, vy, spin = resolve_wall_hit(
            walls, wall, since_start, vz, vx, vy, spin, mass, rotation, box.planar, tallies.random
        )
        went = vz
        if modes.piston and high:
            z = walls.piston[0] + walls.piston[1] * (t - walls.piston[2]) - radius
        else:
            z = box.length_z - radius if high else radius
    if modes.rotation:
        kinds.rotational_energy[i] = spin
    gained = 0.5 * mass * (vx * vx + vy * vy + vz * vz) + spin - before
    tallies.hits[wall] += 1
    tallies.impulse[wall] += mass * (came - went) if high else mass * (went - came)
    if modes.piston and wall == 5:
        tallies.work[wall] += gained
    else:
        tallies.heat[wall] += gained
    write(molecules[i], t, x, y, z, vx, vy, vz)
    return x, y, z, vx, vy, vz
