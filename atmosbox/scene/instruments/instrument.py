"""The methods that every instrument has, and the type of its readings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np

from atmosbox.engine import Parcel, Snapshot
from atmosbox.scene.units import Scale


class Readings(dict[str, Any]):
    """Variables and coordinates by name, in SI units."""


def series(rows: Sequence[Mapping[str, Any]], units: Mapping[str, float]) -> Readings:
    """Return what was read at the end of each frame as series, each in its SI unit; nothing without a frame.

    Parameters
    ----------
    rows
        The values of each frame by name, in the engine's units.
    units
        What these units are in SI, by name of the variable; 1 for a variable that is not named.
    """
    names = rows[0] if rows else ()
    return Readings({name: np.array([row[name] for row in rows]) * units.get(name, 1) for name in names})


class Instrument(Protocol):
    """The methods that every instrument has."""

    def sample(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Take one sample of what is averaged over a frame."""

    def end_frame(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Read what is measured at the end of a frame, and finish the means of the frame."""

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return what has been measured; averages leave out the first ``settle`` frames."""
