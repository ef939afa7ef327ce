"""Drops as bodies: their molecules, their size, and the places and directions in which molecules leave them."""

import math
from typing import Any, NamedTuple

from atmosbox.engine.core.elementary import cbrt, circle
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.random import uniform

__all__ = [
    "DropRecords",
    "about",
    "placed",
    "radius_of",
    "resize",
    "surface_left",
    "within",
]


class DropRecords(NamedTuple):
    """The data of the drops beside their motion.

    ``record``, ``held : (drop,)``: their indices among the molecules, and the number of molecules in each; ``cube``,
    ``core : (drop,)``: cube of the radius and mass of the nucleus [length^3, mass]; ``alive : (drop,)``: 0 once another
    drop has absorbed it; ``solute : (drop,)``: number of dissolved particles in each, ``rate : (drop,)``: rate at
    which molecules leave it [1/time], see `curvature`; ``merged : (1,)``: number of mergers; then cube of
    the radius in a drop, mass and radius in flight of one molecule, surface tension [energy/length^2], and whether the
    rate at which drops lose molecules depends on their surface area alone.
    """

    record: Any
    held: Any
    cube: Any
    core: Any
    alive: Any
    solute: Any
    rate: Any
    merged: Any
    molecule_cube: float
    molecule_mass: float
    molecule_radius: float
    tension: float
    plain: bool


@kernel
def radius_of(drops, cube, held):
    """Return the radius of a drop of ``held`` molecules [length], from the cube of the radius of its nucleus."""
    return cbrt(cube + held * drops.molecule_cube)


@kernel
def resize(drops, k, kinds, modes):
    """Set radius and mass of drop k from its number of molecules."""
    kind = kinds.table[modes.drops + k]
    kind.radius = radius_of(drops, drops.cube[k], drops.held[k])
    kind.mass = drops.core[k] + drops.held[k] * drops.molecule_mass


@kernel
def surface_left(drops, k):
    """Return the effective area from which a molecule leaves drop k, through the molecule's centre [length^2].

    A light drop is hit more often than one at rest, because it moves too; so it must lose molecules more often.
    """
    if drops.alive[k] == 0 or drops.held[k] < 1:
        return 0.0
    reach = radius_of(drops, drops.cube[k], drops.held[k] - 1) + drops.molecule_radius
    heavy = drops.core[k] + (drops.held[k] - 1) * drops.molecule_mass
    return 4.0 * math.pi * reach * reach * math.sqrt(1.0 + drops.molecule_mass / heavy)


@kernel
def about(nx, ny, nz, state):
    """Draw a direction by the cosine law about a normal."""
    rise = math.sqrt(uniform(state))
    across = math.sqrt(max(1.0 - rise * rise, 0.0))
    cosine, sine = circle(uniform(state))
    # two axes at right angles to the normal: Duff and others 2017, jcgt.org/published/0006/01/01
    sign = 1.0 if nz >= 0.0 else -1.0
    a = -1.0 / (sign + nz)
    b = nx * ny * a
    c, s = across * cosine, across * sine
    return (
        c * (1.0 + sign * nx * nx * a) + s * b + rise * nx,
        c * sign * b + s * (sign + ny * ny * a) + rise * ny,
        -c * sign * nx - s * ny + rise * nz,
    )


@kernel
def within(u, radius, length, inverse):
    """Return a coordinate of a drop, moved inwards if the drop has grown into a wall."""
    return u if inverse != 0.0 else min(max(u, radius), max(length - radius, radius))


@kernel
def placed(u, radius, length, inverse, lowest):
    """Return a coordinate of a molecule, brought back into a periodic box, and whether it is between the walls."""
    if inverse != 0.0:
        return u - math.floor((u - lowest) / length) * length, True
    return u, radius <= u <= length - radius
