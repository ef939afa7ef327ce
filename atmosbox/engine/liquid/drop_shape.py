r"""Drops as bodies: their molecules, their size, and the effects of their surface and of salt (Kelvin, Koehler).

A drop of n molecules has the surface energy :math:`E(n) = 4 \pi \gamma r(n)^2`. When a molecule leaves, the surface
shrinks, and :math:`\Delta E = E(n) - E(n - 1)` becomes thermal energy U of the liquid; when one enters, the
liquid loses that energy again. So :math:`U' = U + \Delta E - \varphi` is left after a molecule has left, both in the
ledger and in the rate :math:`R` of `reservoir`: detailed balance still holds. For a large heat capacity the rate is
that of a flat surface times :math:`e^{\Delta E / kT}`, which for many molecules is Kelvin's
:math:`e^{2 \gamma v / r k T}`.

There are (n + s)! / n! s! arrangements of n molecules and s dissolved particles if all arrangements have the same
energy (an ideal solution). With one molecule fewer there are fewer arrangements, by the factor n / (n + s): this is the
activity of the water, and the rate is smaller by this factor. Both effects together are Koehler's law.

The surface tension is assumed to be independent of temperature: then all of it is energy, and no entropy is in it.

References
----------
Koehler, H. (1936), The nucleus in and the growth of hygroscopic droplets, doi:10.1039/TF9363201152.
"""

import math
from collections import namedtuple

from atmosbox.engine.core.elementary import cbrt
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.liquid.reservoir import LEAVES, evaporation_flux, renew, wait


@kernel
def surface_energy(drops, cube, held):
    """Return the surface energy of a drop [energy], from the cube of its nucleus' radius and its molecules."""
    radius = radius_of(drops, cube, held)
    return 4.0 * math.pi * drops.tension * (radius * radius)


@kernel
def given_by_surface(drops, k, held):
    """Return the surface energy that drop k loses when it shrinks from ``held`` molecules to one fewer [energy]."""
    cube = drops.cube[k]
    return surface_energy(drops, cube, held) - surface_energy(drops, cube, held - 1)


class DropRecords(
    namedtuple(
        "DropRecords",
        "record held cube core alive solute rate merged molecule_cube molecule_mass molecule_radius tension plain",
    )
):
    """The data of the drops beside their motion.

    ``record``, ``held : (drop,)``: their indices among the molecules, and the number of molecules in each; ``cube``,
    ``core : (drop,)``: cube of the radius and mass of the nucleus [length^3, mass]; ``alive : (drop,)``: 0 once another
    drop has absorbed it; ``solute : (drop,)``: number of dissolved particles in each, ``rate : (drop,)``: rate at
    which molecules leave it [1/time], see the head of this file; ``merged : (1,)``: number of mergers; then cube of
    the radius in a drop, mass and radius in flight of one molecule, surface tension [energy/length^2], and whether the
    rate at which drops lose molecules depends on their surface area alone.
    """


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
def leaving_rates(drops, reservoir):
    """Store the rate at which molecules leave each drop [1/time]; return the sum of these rates."""
    total = 0.0
    for k in range(drops.record.size):
        held = drops.held[k]
        rate = 0.0
        surface = surface_left(drops, k)
        if surface > 0.0:
            activity = held / (held + drops.solute[k])
            rate = surface * activity * evaporation_flux(reservoir, given_by_surface(drops, k, held))
        drops.rate[k] = rate
        total += rate
    return total


@kernel
def redraw(t, gas, drops, reservoir):
    """Compute the surface, or the rates of the drops, and draw the time at which the next molecule leaves."""
    if not drops.plain:
        reservoir.clock[LEAVES] = t + wait(leaving_rates(drops, reservoir), gas.tallies.random)
        return
    surface = 0.0
    for k in range(drops.record.size):
        surface += surface_left(drops, k)
    reservoir.surface[0] = surface
    renew(t, gas.tallies.random, reservoir)
