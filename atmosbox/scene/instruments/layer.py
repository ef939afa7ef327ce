"""Density, temperature and pressure by height."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import Parcel, Snapshot
from atmosbox.engine.core.measure import layer_sample
from atmosbox.scene.instruments.instrument import Readings
from atmosbox.scene.units import Scale

__all__ = ["Layers"]

Array = NDArray[np.float64]
_BLOCKS = 20


class Layers:
    """Density, temperature and pressure of layers of equal thickness between floor and ceiling.

    The pressure is that of the motion and of the contacts: n kT + virial / d V in d dimensions, 3 or 2.

    Parameters
    ----------
    number
        How many layers; the box must count its virial by as many.
    """

    def __init__(self, number: int) -> None:
        self._number = number
        self._sum = np.zeros((3, number))
        self._looks = 0
        self._virial = np.zeros(number)
        self._time = 0.0
        self._frames: list[Array] = []
        self._volume = 1.0
        self._height = 1.0
        self._mass = 1.0
        self._dimensions = 3.0

    def sample(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Count the molecules of each layer and the energy of their disordered motion."""
        self._sum += np.stack(layer_sample(parcel, snapshot, self._number))
        self._looks += 1

    def end_frame(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Close the sums of a frame."""
        lasted = parcel.time - self._time
        rate = (parcel.virial - self._virial) / lasted
        self._frames.append(np.stack([*(self._sum / max(self._looks, 1)), rate]))
        self._sum = np.zeros((3, self._number))
        self._looks = 0
        self._virial = parcel.virial
        self._time = parcel.time
        self._height = float(parcel.length[2])
        self._volume = parcel.volume / self._number
        self._mass = float(parcel.mass.mean())
        self._dimensions = 2.0 if parcel.planar else 3.0

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the profiles with the standard errors of 20 blocks."""
        frames = np.array(self._frames[settle:])
        edges = np.linspace(0.0, self._height, self._number + 1) * scale.length
        out = Readings(height=0.5 * (edges[1:] + edges[:-1]), height_bnds=np.stack([edges[:-1], edges[1:]], axis=1))
        if len(frames) < 2:
            return out
        blocks = min(_BLOCKS, len(frames))
        parts = np.array([part.mean(axis=0) for part in np.array_split(frames, blocks)])
        number, energy, freedom, virial = np.moveaxis(parts, 1, 0)
        with np.errstate(invalid="ignore", divide="ignore"):
            kT = np.where(freedom > 0.0, 2.0 * energy / freedom, np.nan)
        pressure = (number * kT + virial / self._dimensions) / self._volume
        density = number / self._volume
        whole = frames.mean(axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            whole_kT = np.where(whole[2] > 0.0, 2.0 * whole[1] / whole[2], np.nan)
        unit = {
            "number_density": (scale.number_density, whole[0] / self._volume, density),
            "air_density": (scale.mass_density * self._mass, whole[0] / self._volume, density),
            "layer_temperature": (scale.temperature, whole_kT, kT),
            "layer_pressure": (
                scale.pressure,
                (whole[0] * whole_kT + whole[3] / self._dimensions) / self._volume,
                pressure,
            ),
        }
        for name, (factor, mean, part) in unit.items():
            out[name] = factor * mean
            out[f"{name}_se"] = factor * part.std(axis=0, ddof=1) / math.sqrt(blocks)
        return out
