r"""A gas of hard spheres in a cube with walls: how dense it is at a pressure, how often its molecules collide.

Near a wall a molecule has fewer partners, so collisions are rarer than in open space, and Z - 1 is a little smaller.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from atmosbox.theory.collision import collision_rate, contact_share
from atmosbox.theory.equation_of_state import compressibility_factor, contact_value, packing_fraction
from atmosbox.theory.maxwell import mean_speed


class WalledGas(NamedTuple):
    """A gas in a cube, in units of the diameter and the mass of a molecule, with kT = 1."""

    density: float
    """Number density in the space that centres can reach [1/diameter^3]."""
    side: float
    """Side of that space [diameter]."""
    factor: float
    """Compressibility factor Z [1]."""
    collision_rate: float
    """Collisions of a molecule [1/time]."""
    memory: float
    """Correlation time of the energy of the gas between its walls [time]."""


def walled_gas(pressure: float, molecules: int, *, ideal: bool = False) -> WalledGas:
    r"""Return the gas of a pressure in a cube.

    Parameters
    ----------
    pressure
        Pressure [kT/diameter^3].
    molecules
        Number of molecules.
    ideal
        Whether molecules have no volume and collide in pairs chosen at random: then Z is 1.

    Notes
    -----
    A surplus of energy leaves with the molecules that hit a wall, :math:`2kT` each of the :math:`\tfrac32 kT` that a
    molecule has, and must first be conducted to the walls: its correlation time is :math:`L / 2\bar c + L^2 / 3 \pi^2
    D`, with the diffusivity :math:`D = 0.678 / \tfrac32 n \sigma^2` of a thin gas (Chapman and Enskog), which is the
    least value.

    Examples
    --------
    Spheres push each other apart, so at one pressure they are less dense than points:

    >>> walled_gas(0.1, 200).density < walled_gas(0.1, 200, ideal=True).density == 0.1
    True
    """
    density, factor, share, side = pressure, 1.0, 1.0, 1.0
    for _ in range(200):
        before = density, factor
        density *= math.sqrt(pressure / (density * factor))
        possible = min(density, 0.9)
        filled = packing_fraction(possible, 1.0)
        side = (molecules / possible) ** (1.0 / 3.0)
        excess = float(compressibility_factor(filled)) - 1.0
        share = _share(float(filled), side, molecules)
        factor = 1.0 if ideal else 1.0 + excess * share
        if (density, factor) == before:
            break
    rate = float(collision_rate(density, 1.0, 1.0, 1.0))
    if ideal:
        rate *= (1.0 - 1.0 / molecules) / float(contact_value(packing_fraction(density, 1.0)))
    else:
        rate *= share
    side = (molecules / density) ** (1.0 / 3.0)
    diffusivity = 0.678 / (1.5 * density)
    memory = side / (2.0 * float(mean_speed(1.0, 1.0))) + side**2 / (3.0 * math.pi**2 * diffusivity)
    return WalledGas(density, side, factor, rate, memory)


def _share(filled: float, side: float, molecules: int) -> float:
    """Return the share of the contacts in open space that molecules have in a cube with walls.

    To lowest order in the packing fraction phi, by the surface tension of spheres at a hard wall, three molecules and a
    wall that exclude each other lower Z - 1 in a cube of side L by 27/4 phi sigma / L; that a partner, too, has N - 1
    partners raises it by 3 phi / N. Measured from the collisions of 200 molecules, in 12 runs each: 1.24 +- 0.08 % less
    at 500 bar and 2.85 +- 0.07 % at 1000 bar, where both together are 1.23 % and 2.76 %.
    """
    return contact_share((side,) * 3, 1.0, molecules) * (1.0 - filled * (6.75 / side - 3.0 / molecules))
