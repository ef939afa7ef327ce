r"""What the surface of a drop and the salt in it change: the laws of Kelvin and of Koehler, molecule by molecule.

A drop of n molecules has the surface energy :math:`E(n) = 4 \pi \gamma r(n)^2`. When a molecule leaves, the surface
shrinks, and :math:`\Delta E = E(n) - E(n - 1)` goes into the thermal energy U of the liquid; when one comes, the
liquid pays it back. So :math:`U' = U + \Delta E - \varphi` is left where a molecule has left, both in the ledger and in
the rate :math:`R` of `reservoir`: the balance stays detailed. For a large heat capacity the rate is that of a flat
surface times :math:`e^{\Delta E / kT}`, which for many molecules is Kelvin's :math:`e^{2 \gamma v / r k T}`.

Of s dissolved particles and n molecules there are (n + s)! / n! s! arrangements, if neither minds who is beside it
(an ideal solution). One molecule fewer means fewer of them, by n / (n + s): this is the activity of the water, and by
it the rate is smaller. Both together are Koehler's law.

The tension is taken as independent of temperature: then the whole of it is energy, and none of it heat.

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
    """Return the energy of the surface of a drop [energy], from the cube of its nucleus and its molecules."""
    radius = radius_of(drops, cube, held)
    return 4.0 * math.pi * drops.tension * (radius * radius)


@kernel
def given_by_surface(drops, k, held):
    """Return what the surface of drop k gives when it shrinks from so many molecules to one fewer [energy]."""
    cube = drops.cube[k]
    return surface_energy(drops, cube, held) - surface_energy(drops, cube, held - 1)


@kernel
def leaving_rates(drops, reservoir):
    """Note how often a molecule leaves each drop [1/time]; return how often one leaves any."""
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
