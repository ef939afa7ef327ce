"""The methods that every instrument has, and the type of its readings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import Parcel, Snapshot
from atmosbox.scene.units import Scale


class Readings(dict[str, Any]):
    """Variables and coordinates by name, in SI units."""


def series(rows: Sequence[Mapping[str, Any]], units: Mapping[str, float]) -> Readings:
    """Return the values of each frame as series in SI units; nothing without a frame.

    ``units`` are the engine's units in SI, by the name of the variable; 1 for one that is not named.
    """
    names = rows[0] if rows else ()
    return Readings({name: np.array([row[name] for row in rows]) * units.get(name, 1) for name in names})


def bins(name: str, edges: NDArray[np.float64]) -> Readings:
    """Return the middles and the bounds of bins, as a coordinate of this name."""
    return Readings({name: 0.5 * (edges[1:] + edges[:-1]), f"{name}_bnds": np.stack([edges[:-1], edges[1:]], axis=1)})


def padded(rows: Sequence[NDArray[Any]], fill: float) -> NDArray[Any]:
    """Return arrays of different lengths as one : (row, longest, ...); the rest of the shorter ones is filled."""
    most = max(map(len, rows))
    rest = (np.full((most - len(row), *row.shape[1:]), fill, row.dtype) for row in rows)
    return np.stack([np.concatenate(each) for each in zip(rows, rest, strict=True)])


class Instrument(Protocol):
    """The methods that every instrument has."""

    def sample(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Take one sample of what is averaged over a frame; an instrument without averages inherits this."""
        return

    def end_frame(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Read what is measured at the end of a frame, and finish the means of the frame."""

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return what has been measured; averages leave out the first ``settle`` frames."""
