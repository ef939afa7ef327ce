"""Averages up to a frame, computed from the saved molecules: speeds, and number and temperature in each layer."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Running"]

_SPEEDS = 6000  # number of speeds that is enough for a histogram
_LAYERED = ("number_density", "air_density", "layer_pressure", "layer_temperature")
_FEW = {"layer_temperature": 20.0, "number_density": 2.0}  # least number of molecules counted in a layer, for a value

Floats = NDArray[np.float64]


class Running:
    """Averages up to a frame of variables that the file holds only for the whole run, computed from its molecules.

    A histogram of speeds is that of the last frames; these are few, so that a change is seen. The value of a layer is
    the mean over all frames so far. Number and temperature are scaled so that the value at the end is the one of the
    whole run, which was measured in more samples than the file has frames.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run.

    Examples
    --------
    >>> import xarray as xr
    >>> Running(xr.Dataset()).names
    ()
    """

    def __init__(self, dataset: xr.Dataset) -> None:
        self.dataset = dataset
        names: list[str] = []
        if "molecule_speed" in dataset.variables and "speed_bnds" in dataset.variables:
            self.bins = np.append(dataset["speed_bnds"].values[:, 0], dataset["speed_bnds"].values[-1, 1])
            self.speed = dataset["molecule_speed"].transpose("elapsed_time", "molecule").values
            self.frames = max(1, -(-_SPEEDS // self.speed.shape[1]))
            names += ["speed_probability_density"] if "speed_probability_density" in dataset.variables else []
        if "molecule_position" in dataset.variables and "height_bnds" in dataset.variables:
            names += [name for name in _LAYERED if name in dataset.variables]
            self._sum_layers()
        self.names = tuple(names)

    def _sum_layers(self) -> None:
        """Sum the molecules and the squares of their speeds in every layer, up to every frame."""
        data = self.dataset
        bounds = np.append(data["height_bnds"].values[:, 0], data["height_bnds"].values[-1, 1])
        height = data["molecule_position"].transpose("elapsed_time", "molecule", "axis").values[:, :, 2]
        speed = data["molecule_speed"].transpose("elapsed_time", "molecule").values
        frames, layers = len(height), len(bounds) - 1
        count, square = np.zeros((frames, layers)), np.zeros((frames, layers))
        for frame in range(frames):
            count[frame] = np.histogram(height[frame], bounds)[0]
            square[frame] = np.histogram(height[frame], bounds, weights=speed[frame].astype(np.float64) ** 2)[0]
        so_far = np.arange(1.0, frames + 1.0)[:, None]
        self.count = np.cumsum(count, axis=0) / so_far
        self.square = np.cumsum(square, axis=0) / so_far

    def at(self, frame: int) -> xr.Dataset:
        """Return the dataset with the averages up to a frame in place of those of the whole run."""
        held = self.dataset
        return held.assign({name: held[name].copy(data=self.values(name, frame)) for name in self.names})

    def values(self, name: str, frame: int) -> Floats:
        """Return one average up to a frame, in the unit of the file; NaN in layers with too few molecules."""
        if name == "speed_probability_density":
            seen = self.speed[max(0, frame + 1 - self.frames) : frame + 1]
            seen = seen[np.isfinite(seen)]
            share: Floats = np.histogram(seen, self.bins)[0] / max(seen.size, 1) / np.diff(self.bins)
            return share
        with np.errstate(invalid="ignore", divide="ignore"):
            number = self.count[frame] / self.count[-1]
            energy = self.square[frame] / self.square[-1]
            ratio = {"layer_temperature": energy / number, "layer_pressure": energy}.get(name, number)
        few = _FEW["layer_temperature" if name in ("layer_temperature", "layer_pressure") else "number_density"]
        return np.where(self.count[frame] * (frame + 1) >= few, ratio * self.dataset[name].values, np.nan)
