"""A box that is checked and described but never advanced, for descriptions of a scene before a run."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar, Unpack

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.engine import Liquid, Parcel, RandomBath, RefusedError, Snapshot, SquareWell
from atmosbox.engine.core.parcel import Arrangement, Array


class DescribedParcel(Parcel):
    """Molecules in a box without an engine: nothing is compiled for it, and it cannot advance.

    It refuses whatever `Parcel` itself refuses, but does not notice molecules that overlap.

    >>> box = DescribedParcel([[1, 2, 2]], [[1, 0, 0]], length=(4, 4, 4))
    >>> box.volume, box.energy()
    (64.0, (0.5, 0.0, 0.0))
    """

    engine: ClassVar[str] = "none"

    def __init__(
        self, position: ArrayLike, velocity: ArrayLike, *, liquid: Liquid | None = None, well: SquareWell | None = None,
        species: ArrayLike = 0, strength: float = 1.0, bath: RandomBath | None = None, **box: Unpack[Arrangement],
    ) -> None:  # fmt: skip
        super().__init__(position, velocity, **box)

    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        self._molecules = Snapshot(0.0, position, velocity, rotational_energy)

    def snapshot(self) -> Snapshot:
        """Return all molecules in their state at the start."""
        return self._molecules

    def advance(self, until: float, watch: Callable[[float], Any] | None = None) -> None:
        """Refuse: this box is only described."""
        raise RefusedError("a box that is only described cannot advance: build it with an engine")

    def memory(self) -> int:
        """Return the bytes that the molecules take."""
        return sum(int(np.asarray(part).nbytes) for part in self._molecules)

    def _drive(self) -> None:
        """Leave the piston at rest, because its driver would compile kernels."""

    def _piston_turned(self) -> None:
        """Do nothing: no event was predicted."""

    def _field_changes(self, gravity: float) -> None:
        self._gravity = gravity
