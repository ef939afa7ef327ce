"""The methods that every instrument has, and the type of its readings."""

from __future__ import annotations

from typing import Any, Protocol

from atmosbox.engine import Parcel, Snapshot
from atmosbox.scene.units import Scale


class Readings(dict[str, Any]):
    """Variables and coordinates by name, in SI units."""


class Instrument(Protocol):
    """The methods that every instrument has."""

    def sample(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Take one sample of what is averaged over a frame."""

    def end_frame(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Read what is measured at the end of a frame, and finish the means of the frame."""

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return what has been measured; averages leave out the first ``settle`` frames."""
