"""The equation of state of spheres or of discs, by the number of dimensions."""

from collections.abc import Callable
from typing import NamedTuple

from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, require_dimensions
from atmosbox.theory.disc import (
    FREEZING_PACKING_FRACTION_DISCS,
    compressibility_factor_discs,
    inverse_compressibility_discs,
    packing_fraction_discs,
)
from atmosbox.theory.entropy import excess_chemical_potential, excess_chemical_potential_discs
from atmosbox.theory.equation_of_state import (
    FREEZING_PACKING_FRACTION,
    compressibility_factor,
    inverse_compressibility,
    packing_fraction,
)


class Crowding(NamedTuple):
    """Properties of a gas as functions of its packing fraction, and the packing fraction at which it freezes."""

    chemical_potential: Callable[[ArrayLike], FloatArray]
    compressibility_factor: Callable[[ArrayLike], FloatArray]
    stiffness: Callable[[ArrayLike], FloatArray]
    packing_fraction: Callable[[ArrayLike, ArrayLike], FloatArray]
    freezing: float


_SPHERES = Crowding(
    excess_chemical_potential,
    compressibility_factor,
    inverse_compressibility,
    packing_fraction,
    FREEZING_PACKING_FRACTION,
)
_DISCS = Crowding(
    excess_chemical_potential_discs,
    compressibility_factor_discs,
    inverse_compressibility_discs,
    packing_fraction_discs,
    FREEZING_PACKING_FRACTION_DISCS,
)


def crowding(dimensions: int) -> Crowding:
    """Return the equation of state of spheres or of discs."""
    require_dimensions(dimensions)
    return _DISCS if dimensions == 2 else _SPHERES
