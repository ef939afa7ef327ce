"""The equation of state of spheres or of discs, by the number of dimensions."""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple, cast

from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, require_dimensions
from atmosbox.theory.disc import (
    FREEZING_PACKING_FRACTION_DISCS,
    DiscForm,
    compressibility_factor_discs,
    inverse_compressibility_discs,
    packing_fraction_discs,
)
from atmosbox.theory.entropy import excess_chemical_potential, excess_chemical_potential_discs
from atmosbox.theory.equation_of_state import (
    FREEZING_PACKING_FRACTION,
    Form,
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


def crowding(dimensions: int, form: Form | DiscForm | None) -> Crowding:
    """Return the equation of state of spheres or of discs."""
    require_dimensions(dimensions)
    if dimensions == 2:
        plane = cast("DiscForm", form or "henderson")
        return Crowding(
            partial(excess_chemical_potential_discs, form=plane),
            partial(compressibility_factor_discs, form=plane),
            partial(inverse_compressibility_discs, form=plane),
            packing_fraction_discs,
            FREEZING_PACKING_FRACTION_DISCS,
        )
    space = cast("Form", form or "kolafa")
    return Crowding(
        partial(excess_chemical_potential, form=space),
        partial(compressibility_factor, form=space),
        partial(inverse_compressibility, form=space),
        packing_fraction,
        FREEZING_PACKING_FRACTION,
    )
