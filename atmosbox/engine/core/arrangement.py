"""What a box may be given by name, and what may move its piston."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol, TypedDict

from numpy.typing import ArrayLike

from atmosbox.engine.core.walls import Wall

if TYPE_CHECKING:
    from atmosbox.engine.core.parcel import Parcel

__all__ = ["Arrangement", "Driver"]


class Driver(Protocol):
    """What moves the piston: asked for its velocity at every multiple of ``interval``."""

    interval: float

    def velocity(self, parcel: Parcel) -> float:
        """Return the velocity [length/time] from now until the next multiple of the interval."""


class Arrangement(TypedDict, total=False):
    """What a `Parcel` may be given by name: see there."""

    length: Sequence[float]
    walls: Sequence[Wall]
    mass: ArrayLike
    diameter: ArrayLike
    rotation: ArrayLike
    rotational_energy: ArrayLike | None
    gravity: float
    planar: bool
    collision_number: float
    layers: int
    seed: int
    driver: Driver | None
    collisions: bool
