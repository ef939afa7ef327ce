"""What every instrument does, and what it gives."""

from __future__ import annotations

from typing import Any, Protocol

from atmosbox.engine import Parcel, Snapshot
from atmosbox.scene.units import Scale

__all__ = ["Instrument", "Readings"]


class Readings(dict[str, Any]):
    """Variables and coordinates by name, in SI units."""


class Instrument(Protocol):
    """What every instrument does."""

    def sample(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Read off what a frame takes its mean of."""

    def end_frame(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Read off what stands at the end of a frame, and finish its means."""

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return what has been measured; averages leave out the first ``settle`` frames."""
