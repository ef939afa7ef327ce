"""All extremes by name, family by family."""

from collections.abc import Mapping
from types import MappingProxyType

from atmosbox.trade.extremes import (
    clock,
    density,
    extreme_contact,
    extreme_number,
    extreme_piston,
    extreme_start,
    extreme_wall,
    gravity,
    step,
    unlike,
)
from atmosbox.trade.extremes.extreme import Extreme, extremes_of

__all__ = ["EXTREMES", "FAMILIES"]

FAMILIES: Mapping[str, tuple[Extreme, ...]] = MappingProxyType(
    {
        "steps": tuple(extremes_of(step)),
        "how many": tuple(extremes_of(extreme_number)),
        "how dense": tuple(extremes_of(density)),
        "how unlike": tuple(extremes_of(unlike)),
        "walls": tuple(extremes_of(extreme_wall)),
        "gravity": tuple(extremes_of(gravity)),
        "contacts": tuple(extremes_of(extreme_contact)),
        "starts": tuple(extremes_of(extreme_start)),
        "pistons": tuple(extremes_of(extreme_piston)),
        "time": tuple(extremes_of(clock)),
    }
)
"""The extremes by what they are about."""

EXTREMES: Mapping[str, Extreme] = MappingProxyType({each.name: each for family in FAMILIES.values() for each in family})
"""The extremes by name."""
