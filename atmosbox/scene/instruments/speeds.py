"""The speeds of the molecules."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import Parcel, Snapshot
from atmosbox.engine.core.measure import speed_counts
from atmosbox.scene.instruments.instrument import Readings, bins
from atmosbox.scene.statistics import block_average
from atmosbox.scene.units import Scale

Array = NDArray[np.float64]


class Speeds:
    """Histogram of the speeds of the molecules, and their mean speed in each frame.

    Parameters
    ----------
    edges : (bin + 1,)
        Bounds of the bins [reduced velocity].
    blocks
        Number of blocks of frames from which the standard errors are read; fewer where molecules collide rarely.
    """

    def __init__(self, edges: Array, blocks: int = 20) -> None:
        self.blocks = blocks
        self.edges = np.asarray(edges, np.float64)
        self._counts = np.zeros(self.edges.size - 1)
        self._seen = 0
        self._sum = 0.0
        self._mean: list[float] = []
        self._frames: list[Array] = []

    def sample(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Count the molecules by speed."""
        self._counts += speed_counts(snapshot, self.edges)
        self._seen += parcel.number
        self._sum += float(np.sqrt((snapshot.velocity**2).sum(axis=1)).sum())

    def end_frame(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Finish the counts of a frame."""
        self._frames.append(self._counts / max(self._seen, 1) / np.diff(self.edges))
        self._mean.append(self._sum / max(self._seen, 1))
        self._counts = np.zeros_like(self._counts)
        self._seen, self._sum = 0, 0.0

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the mean speeds, and the histogram with its standard errors."""
        out = bins("speed", self.edges * scale.velocity)
        out["mean_molecular_speed"] = np.array(self._mean) * scale.velocity
        frames = np.array(self._frames[settle:])
        if len(frames) >= 2:
            mean, error = block_average(frames, min(self.blocks, len(frames)))
            out["speed_probability_density"] = mean / scale.velocity
            out["speed_probability_density_se"] = error / scale.velocity
        return out
