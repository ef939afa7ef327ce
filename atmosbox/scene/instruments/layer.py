"""Density, temperature and pressure by height."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import Parcel, Snapshot
from atmosbox.engine.core.measure import layer_sample
from atmosbox.scene.instruments.flow import Flow
from atmosbox.scene.instruments.instrument import Readings, bins
from atmosbox.scene.statistics import average_beside, block_average
from atmosbox.scene.units import Scale

Array = NDArray[np.float64]
_BLOCKS = 20


class Layers:
    """Density, temperature and pressure of layers of equal thickness between floor and ceiling.

    The pressure is the sum of the kinetic part and the collision part: n kT + virial / d V in d dimensions, 3 or 2.

    Parameters
    ----------
    number
        Number of layers; the box must count its virial in as many layers.
    memory
        Correlation time of the energy of the column [reduced time], see `atmosbox.scene.statistics.average_beside`.
    flow
        Where the air turns over, the instrument that measures its wind in cells, as many above each other as there are
        layers; it comes before this one. The mean motion of each cell is not counted as warmth.
    gas
        The name of one of several gases: only number density and temperature are measured then, as
        ``GAS_number_density`` and ``GAS_layer_temperature``, which the scene declares among its ``variables``.
    which : (molecule,), optional
        The molecules of this gas.
    """

    def __init__(
        self, number: int, memory: float = 0.0, *, flow: Flow | None = None, gas: str = "",
        which: NDArray[np.bool_] | None = None,
    ) -> None:  # fmt: skip
        self.number = number
        self.columns = 1 if flow is None else flow.shape[1]
        self._flow = flow
        self._gas = gas
        self._which = which
        self.memory = memory
        self._energy: list[float] = []
        self._sum = np.zeros((3, number))
        self._looks = self._samples = 0
        self._virial = np.zeros(number)
        self._time = 0.0
        self._lasted = 0.0
        self._frames: list[Array] = []
        self._volume = 1.0
        self._height = 1.0
        self._mass = 1.0
        self._dimensions = 3.0

    def sample(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Count the molecules of each layer and sum the energy of their disordered motion."""
        self._looks += 1
        if self._flow is not None:
            self._sum += self._flow.layers()
            return
        measured: Any = parcel
        if self._which is not None:
            measured = SimpleNamespace(length=parcel.length, planar=parcel.planar, mass=parcel.mass[self._which])
            position, velocity = snapshot.position[self._which], snapshot.velocity[self._which]
            snapshot = snapshot._replace(position=position, velocity=velocity)
        self._sum += np.stack(layer_sample(measured, snapshot, self.number))

    def end_frame(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Finish the sums of a frame."""
        self._lasted = parcel.time - self._time
        rate = (parcel.virial - self._virial) / self._lasted
        self._energy.append(sum(parcel.energy()))
        self._frames.append(np.stack([*(self._sum / max(self._looks, 1)), rate]))
        self._sum = np.zeros((3, self.number))
        self._looks, self._samples = 0, self._looks
        self._virial = parcel.virial
        self._time = parcel.time
        self._height = float(parcel.length[2])
        self._volume = parcel.volume / self.number
        self._mass = float(parcel.mass.mean())
        self._dimensions = 2.0 if parcel.planar else 3.0

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the profiles with their standard errors, to first order in the deviations from the mean state.

        A temperature of f squares of velocities scatters by sqrt(2 / f) of it even if all are independent.
        """
        frames = np.array(self._frames[settle:])
        edges = np.linspace(0.0, self._height, self.number + 1) * scale.length
        out = bins("height", edges)
        if len(frames) < 2:
            return out
        number, energy, freedom, rate = np.moveaxis(frames, 1, 0)
        volume, dimensions = self._volume, self._dimensions
        mean_number, mean_freedom = number.mean(axis=0), freedom.mean(axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            kT = np.where(mean_freedom > 0.0, 2.0 * energy.mean(axis=0) / mean_freedom, np.nan)
            warmer = (2.0 * energy - kT * freedom) / mean_freedom
        unit = {
            "number_density": (scale.number_density, number / volume),
            "air_density": (scale.mass_density * self._mass, number / volume),
            "layer_temperature": (scale.temperature, kT + warmer),
            "layer_pressure": (scale.pressure, (number * kT + mean_number * warmer + rate / dimensions) / volume),
        }
        if self._gas:
            unit = {f"{self._gas}_{name}": unit[name] for name in ("number_density", "layer_temperature")}
        slow, blocks = np.array(self._energy[settle:]), min(_BLOCKS, len(frames) // 2)
        for name, (factor, values) in unit.items():
            if blocks < 2:
                mean, error = block_average(values, len(frames))
            else:
                mean, error = average_beside(values, slow, self.memory / self._lasted, blocks)
            if name == "layer_temperature":  # blocks cannot tell the error where hardly any molecule has been seen
                counted = np.maximum(freedom.sum(axis=0) * self._samples, 1e-9)
                error = np.maximum(error, mean * np.sqrt(2.0 / counted))
            out[name] = factor * mean
            out[f"{name}_se"] = factor * error
        return out
