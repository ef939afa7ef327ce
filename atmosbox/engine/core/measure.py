"""Quantities measured from the molecules: layers, speeds, momentum, mean free path. Measuring changes nothing."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.parcel import Parcel, Snapshot

Array = NDArray[np.float64]


class Layers(NamedTuple):
    """Sums over the molecules of each layer at one time; add the sums of several samples, then divide.

    ``number : (layer,)`` molecules; ``energy : (layer,)`` kinetic energy relative to the layer's mean
    motion [energy]; ``freedom : (layer,)`` degrees of freedom that share this energy: those of the mean motion are
    not counted.
    """

    number: Array
    energy: Array
    freedom: Array


def layer_sample(parcel: Parcel, snapshot: Snapshot, layers: int) -> Layers:
    r"""Return the number of molecules, and the energy of their disordered motion, in layers of equal thickness.

    The temperature of a layer is ``2 * energy / freedom``, because
    :math:`\langle \sum m (v - \bar v)^2 \rangle = d (n - 1) k T` for n molecules in d dimensions. Two molecules that
    move as one have no temperature:

    >>> from atmosbox.engine import ParcelSet
    >>> pair = ParcelSet([[1, 1, 1], [3, 3, 1]], [[1, 0, 0], [1, 0, 0]], length=(4, 4, 4))
    >>> layer_sample(pair, pair.snapshot(), 2).energy.tolist()
    [0.0, 0.0]
    """
    height = float(parcel.length[2])
    layer = np.clip((snapshot.position[:, 2] / height * layers).astype(np.int64), 0, layers - 1)
    mass = parcel.mass
    number = np.bincount(layer, minlength=layers).astype(np.float64)
    weight = np.bincount(layer, mass, minlength=layers)
    energy = np.zeros(layers)
    for axis in range(3):
        v = snapshot.velocity[:, axis]
        drift = np.bincount(layer, mass * v, minlength=layers) / np.where(weight > 0.0, weight, 1.0)
        energy += 0.5 * np.bincount(layer, mass * (v - drift[layer]) ** 2, minlength=layers)
    dimensions = 2.0 if parcel.planar else 3.0
    return Layers(number, energy, dimensions * np.maximum(number - 1.0, 0.0))


def temperature(parcel: Parcel, snapshot: Snapshot) -> float:
    """Return kT of the translational motion of all molecules [energy], NaN if there are none.

    The box is at rest, so the mean motion is not subtracted: every component of every velocity counts.

    >>> from atmosbox.engine import ParcelSet
    >>> pair = ParcelSet([[1, 1, 1], [3, 3, 1]], [[1, 0, 0], [-1, 1, 1]], length=(4, 4, 4))
    >>> round(temperature(pair, pair.snapshot()), 6)
    0.666667
    """
    if not parcel.number:
        return math.nan
    twice = float(np.sum(parcel.mass[:, None] * snapshot.velocity**2))
    return twice / ((2.0 if parcel.planar else 3.0) * parcel.number)


def speed_counts(snapshot: Snapshot, edges: Array) -> Array:
    """Return the number of molecules in bins of speed with these edges [length/time]; faster ones are not counted.

    >>> from atmosbox.engine import ParcelSet
    >>> pair = ParcelSet([[1, 1, 1], [3, 3, 1]], [[1, 0, 0], [0, 2, 0]], length=(4, 4, 4))
    >>> speed_counts(pair.snapshot(), np.array([0.0, 1.5, 3.0]))
    array([1., 1.])
    """
    speed = np.sqrt(np.sum(snapshot.velocity**2, axis=1))
    return np.histogram(speed, edges)[0].astype(np.float64)


def momentum(parcel: Parcel, snapshot: Snapshot) -> Array:
    """Return the total momentum along the three axes [momentum].

    >>> from atmosbox.engine import ParcelSet
    >>> pair = ParcelSet([[1, 1, 1], [3, 3, 1]], [[1, 0, 0], [0, 2, 0]], length=(4, 4, 4))
    >>> momentum(pair, pair.snapshot())
    array([1., 2., 0.])
    """
    return np.asarray(np.sum(parcel.mass[:, None] * snapshot.velocity, axis=0))


def mean_free_path(contacts: int, path: float) -> float:
    """Return the mean free path [length]: the path that all molecules flew together, divided by the number of flights.

    Every contact ends two free flights.

    >>> mean_free_path(5, 20.0)
    2.0
    """
    return path / (2.0 * contacts) if contacts else math.inf
