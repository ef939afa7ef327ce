"""The visible drops: their number and sizes."""

from __future__ import annotations

from typing import Any

import numpy as np

from atmosbox.engine import Snapshot
from atmosbox.scene.instruments.instrument import Readings
from atmosbox.scene.units import Scale

__all__ = ["DropSizes"]


class DropSizes:
    """The number of drops, the radius of the largest, and the area of all on which molecules hit them.

    A molecule hits a drop when its centre is half a diameter from the surface of the drop. The area is the mean over
    the samples within a frame; number and radius are those at its end.
    """

    def __init__(self) -> None:
        self._area: list[float] = []
        self._rows: list[tuple[float, float, float]] = []

    def sample(self, parcel: Any, snapshot: Snapshot) -> None:
        """Sum the areas of the drops."""
        reach = parcel.drops()[1] + 0.5 * float(parcel.diameter[0])
        self._area.append(4.0 * np.pi * float(np.sum(reach**2)))

    def end_frame(self, parcel: Any, snapshot: Snapshot) -> None:
        """Count the drops."""
        radius = parcel.drops()[1]
        self._rows.append((float(np.mean(self._area)), float(radius.max()), float(len(radius))))
        self._area = []

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the series; see `Instrument`."""
        if not self._rows:
            return Readings()
        area, largest, count = np.array(self._rows).T
        return Readings(
            drop_area=area * scale.length**2,
            largest_drop_radius=largest * scale.length,
            drop_count=count.astype(np.int64),
        )
