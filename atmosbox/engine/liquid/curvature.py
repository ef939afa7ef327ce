r"""The effects of a drop's surface and of salt in it: the laws of Kelvin and of Koehler, molecule by molecule.

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

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.liquid.drop_shape import radius_of, surface_left
from atmosbox.engine.liquid.reservoir import evaporation_flux

__all__ = ["given_by_surface", "leaving_rates", "surface_energy"]


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
