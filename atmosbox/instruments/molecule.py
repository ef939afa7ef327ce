"""Where every molecule is."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.parcel import Parcel, Snapshot
from atmosbox.instruments.instrument import Readings
from atmosbox.units import Scale

__all__ = ["Molecules"]


class Molecules:
    """Places and speeds of all molecules, for those who asked for them with ``--save-molecules``."""

    def __init__(self) -> None:
        self._position: list[NDArray[np.float32]] = []
        self._speed: list[NDArray[np.float32]] = []

    def look(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Need no look between frames."""

    def close(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Remember all molecules, in single precision."""
        self._position.append(snapshot.position.astype(np.float32))
        self._speed.append(np.sqrt(np.sum(snapshot.velocity**2, axis=1)).astype(np.float32))

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return places and speeds."""
        return Readings(
            molecule_position=np.array(self._position) * np.float32(scale.length),
            molecule_speed=np.array(self._speed) * np.float32(scale.velocity),
        )
