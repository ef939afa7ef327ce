"""Where every molecule is."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.parcel import Snapshot
from atmosbox.instruments.instrument import Readings
from atmosbox.units import DRY_AIR, WATER, Scale

__all__ = ["Molecules"]

Single = NDArray[np.float32]


class Molecules:
    """Places and speeds of all molecules, for those who asked for them with ``--save-molecules``.

    A molecule that is in the liquid has neither, and reads NaN. Where there is water, it is told which molecules
    are water.
    """

    def __init__(self) -> None:
        self._position: list[Single] = []
        self._speed: list[Single] = []
        self._mass: NDArray[np.float64] | None = None

    def look(self, parcel: Any, snapshot: Snapshot) -> None:
        """Need no look between frames."""

    def close(self, parcel: Any, snapshot: Snapshot) -> None:
        """Remember all molecules, in single precision."""
        present = parcel.present
        position = np.full((present.size, 3), np.nan, np.float32)
        speed = np.full(present.size, np.nan, np.float32)
        position[present] = snapshot.position
        speed[present] = np.sqrt(np.sum(snapshot.velocity**2, axis=1))
        self._position.append(position)
        self._speed.append(speed)
        if hasattr(parcel, "vapour"):
            if self._mass is None:
                self._mass = np.zeros(present.size)  # only water may never have been in the gas
            self._mass[present] = parcel.mass

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return places and speeds, and what each molecule is."""
        found = Readings(
            molecule_position=np.array(self._position) * np.float32(scale.length),
            molecule_speed=np.array(self._speed) * np.float32(scale.velocity),
        )
        if self._mass is not None:
            between = 0.5 * (DRY_AIR.molecule_mass + WATER.molecule_mass)
            found["species"] = (self._mass * scale.mass < between).astype(np.int8)
        return found
