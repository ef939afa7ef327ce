"""The visible drops: their number and sizes; and drops with salt beside drops of pure water."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from atmosbox import theory as law
from atmosbox.engine import Snapshot
from atmosbox.scene.instruments.instrument import Readings, padded, series
from atmosbox.scene.instruments.water import gas_kT, vapour_pressure
from atmosbox.scene.units import Scale


class DropSizes:
    """The number of drops, the radius of the largest, and the area of all on which molecules hit them.

    A molecule hits a drop when its centre is half a diameter from the surface of the drop. The area is the mean over
    the samples within a frame; number and radius are those at its end.
    """

    def __init__(self) -> None:
        self._area: list[float] = []
        self._rows: list[dict[str, float]] = []

    def sample(self, parcel: Any, snapshot: Snapshot) -> None:
        """Sum the areas of the drops."""
        reach = parcel.drops()[1] + 0.5 * float(parcel.diameter[0])
        self._area.append(4.0 * np.pi * float(np.sum(reach**2)))

    def end_frame(self, parcel: Any, snapshot: Snapshot) -> None:
        """Count the drops."""
        radius = parcel.drops()[1]
        area = float(np.mean(self._area))
        self._rows.append({"drop_area": area, "largest_drop_radius": float(radius.max()), "drop_count": len(radius)})
        self._area = []

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the series; see `Instrument`."""
        return series(self._rows, {"drop_area": scale.length**2, "largest_drop_radius": scale.length})


class Nuclei:
    """The number of molecules in each drop, the mean radius of those with and of those without salt, and the humidity.

    The sizes are those at the end of a frame. The humidity is the mean over its samples: the vapour pressure in the
    space outside the drops, over the saturation vapour pressure at the temperature of the liquid. With the temperature
    of the gas, which defines relative humidity, it would scatter far more.

    Parameters
    ----------
    width
        Ratio of the width of the drops in the box to that of real drops; radii are those of real drops.
    radius
        Radii for which theory gives the humidity over a drop [m].
    """

    def __init__(self, width: float, radius: ArrayLike) -> None:
        self.width = width
        self.radius = np.asarray(radius, np.float64)
        self._looks: list[tuple[float, float]] = []
        self._held: list[np.ndarray] = []
        self._rows: list[tuple[float, ...]] = []

    def sample(self, parcel: Any, snapshot: Snapshot) -> None:
        """Measure the vapour pressure."""
        reach = parcel.drops()[1] + 0.5 * float(parcel.diameter[0])
        room = 1.0 - 4.0 / 3.0 * math.pi * float(np.sum(reach**3)) / parcel.volume
        self._looks.append((vapour_pressure(parcel, gas_kT(parcel)) / room, parcel.liquid_kT))

    def end_frame(self, parcel: Any, snapshot: Snapshot) -> None:
        """Measure the drops."""
        _, radius, held = parcel.drops()
        salted = parcel.dissolved > 0.0
        self._held.append(held)
        mean = (float(radius[of].mean()) if of.any() else math.nan for of in (salted, ~salted))
        self._rows.append((*np.mean(self._looks, axis=0), *mean))
        self._looks = []

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the series; see `Instrument`."""
        if not self._held:
            return Readings()
        pressure, kT, salted, pure = np.array(self._rows).T
        found = Readings(
            radius=self.radius,
            drop_molecule_count=padded(self._held, 0),
            saturation_ratio=pressure * scale.pressure / law.saturation_vapor_pressure(kT * scale.temperature),
        )
        for name, radius in (("salted_drop_radius", salted), ("pure_drop_radius", pure)):
            if np.isfinite(radius).any():
                found[name] = radius * scale.length / self.width
        return found
