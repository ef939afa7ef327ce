"""The lapse rate that stirring produces in a column."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import Snapshot
from atmosbox.engine.core.measure import layer_sample
from atmosbox.scene.instruments.instrument import Readings
from atmosbox.scene.units import Scale

__all__ = ["Stirrer", "weighted_slope"]

Array = NDArray[np.float64]


def weighted_slope(x: Array, y: Array, weight: Array) -> float:
    """Return the slope of the straight line through points with weights, by least squares.

    Parameters
    ----------
    x, y, weight : (point,)
        Coordinates of the points, and their weights.

    Examples
    --------
    >>> weighted_slope(np.arange(3.0), np.array([1.0, 3.0, 9.0]), np.array([1.0, 1.0, 0.0]))
    2.0
    """
    away = x - np.sum(weight * x) / np.sum(weight)
    return float(np.sum(weight * away * y) / np.sum(weight * away * away))


class Stirrer:
    """The lapse rate of stirred air between two heights, frame by frame.

    The lapse rate is the slope of the line through the temperatures of the layers, weighted by degrees of freedom.

    Parameters
    ----------
    layers
        Number of layers between floor and ceiling.
    low, high
        The heights [reduced length]; only layers that are wholly between them count.
    """

    def __init__(self, layers: int, low: float, high: float) -> None:
        self._layers = layers
        self._between = low, high
        self._sum = np.zeros((2, layers))
        self._rows: list[float] = []

    def sample(self, parcel: Any, snapshot: Snapshot) -> None:
        """Sum the energy of the disordered motion and the degrees of freedom of each layer."""
        _, energy, freedom = layer_sample(parcel, snapshot, self._layers)
        self._sum += energy, freedom

    def end_frame(self, parcel: Any, snapshot: Snapshot) -> None:
        """Compute the slope from the sums of a frame."""
        edges = np.linspace(0.0, float(parcel.length[2]), self._layers + 1)
        inside = (edges[:-1] >= self._between[0]) & (edges[1:] <= self._between[1])
        energy, freedom = self._sum
        inside &= freedom > 0.0
        middle = 0.5 * (edges[1:] + edges[:-1])[inside]
        slope = weighted_slope(middle, 2.0 * energy[inside] / freedom[inside], freedom[inside])
        self._rows.append(-slope)
        self._sum = np.zeros((2, self._layers))

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the series; see `Instrument`."""
        if not self._rows:
            return Readings()
        return Readings(lapse_rate=np.array(self._rows) * scale.temperature / scale.length)
