"""The constants of nature, and the two kinds of molecules of the atmosphere, in SI units.

References
----------
.. [1] E. Tiesinga et al., CODATA recommended values of the fundamental physical constants: 2018, Rev. Mod.
   Phys. 93, 025010 (2021), https://doi.org/10.1103/RevModPhys.93.025010.
"""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["AVOGADRO", "BOLTZMANN", "DRY_AIR", "GAS_CONSTANT", "STANDARD_GRAVITY", "WATER", "Species"]

BOLTZMANN = 1.380649e-23
"""Energy per temperature, k_B, exact [1]_ [J K-1]."""
AVOGADRO = 6.02214076e23
"""Molecules in a mole, exact [1]_ [mol-1]."""
GAS_CONSTANT = BOLTZMANN * AVOGADRO
"""Molar gas constant R = k_B N_A, exact but for rounding [J mol-1 K-1]."""
STANDARD_GRAVITY = 9.80665
"""Standard acceleration of free fall [m s-2]."""


@dataclass(frozen=True)
class Species:
    """A kind of molecule: a hard sphere with a mass, a diameter and ways to rotate.

    Parameters
    ----------
    name
        Its name in meteorology.
    molar_mass, molecule_mass
        Mass of a mole [kg mol-1]; mass of one molecule [kg].
    diameter
        Distance between the centres of two such molecules in contact [m].
    rotational_dof
        Number of rotational degrees of freedom.

    Examples
    --------
    The gas constant of dry air, 287 J kg-1 K-1, is that of one molecule over its mass:

    >>> round(BOLTZMANN / DRY_AIR.molecule_mass, 2)
    287.05
    """

    name: str
    molar_mass: float
    molecule_mass: float
    diameter: float
    rotational_dof: int


DRY_AIR = Species("dry air", 28.9647e-3, 28.9647e-3 / AVOGADRO, 0.37e-9, 2)
"""Dry air as one gas: mean molar mass 28.9647 g/mol, linear molecules."""
WATER = Species("water", 18.01528e-3, 18.01528e-3 / AVOGADRO, 0.265e-9, 3)
"""Water vapour: 18.01528 g/mol, bent molecules that rotate about three axes."""
