"""The molecules of a planar scene as numbers: positions, speeds, diameters, and the two axes of their plane."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.colors import LogNorm, Normalize
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from atmosbox.plot.curve import read
from atmosbox.plot.unit import convert

# The colour scale is logarithmic if the fastest discs are more than this many times as fast as the median disc.
_WIDE_SPREAD = 10.0


class Discs(NamedTuple):
    """The discs of a planar scene: their position and speed in every frame, their diameter and mass."""

    place: NDArray[np.float64]
    """Positions, (frame, molecule, 2), in the unit of length that is shown."""
    speed: NDArray[np.float64]
    """Speeds, (frame, molecule), in the unit ``speed_unit``."""
    diameter: NDArray[np.float64]
    """Diameters, (molecule,), in the unit of length that is shown."""
    mass: NDArray[np.float64]
    """Masses, (molecule,), in the unit of the file."""
    box: NDArray[np.float64]
    """The lower and the upper corner of the box, (2, 2), in the unit of length that is shown."""
    speed_unit: str
    """The unit of the speeds, that of the file."""

    @property
    def heavy(self) -> NDArray[np.bool_]:
        """Which discs belong to the heavier half; none if all masses are equal."""
        heavy = np.zeros(self.mass.size, dtype=bool)
        if self.mass.size and self.mass.min() < self.mass.max():
            heavy[np.argsort(self.mass, kind="stable")[self.mass.size // 2 :]] = True
        return heavy


def discs(dataset: xr.Dataset, unit: str) -> Discs:
    """Return the discs of a planar scene.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run, as `draw_discs` takes it.
    unit : str
        The unit of length to show.

    Returns
    -------
    Discs
        The discs.

    Raises
    ------
    FileError
        If the file lacks one of the variables.

    Examples
    --------
    >>> import xarray as xr
    >>> discs(xr.Dataset(), "m")
    Traceback (most recent call last):
    atmosbox.errors.FileError: The file has no variable 'disc_position', which its figure needs: run the scene again \
with this version of atmosbox.
    """
    position, velocity = (
        read(dataset, name).transpose("elapsed_time", "molecule", "axis") for name in ("disc_position", "disc_velocity")
    )
    plane = _plane(position.values)
    places = convert(position.values[:, :, plane], str(position.attrs.get("units", "m")), unit, name="disc_position")
    diameter = read(dataset, "disc_diameter")
    sizes = convert(diameter.values, str(diameter.attrs.get("units", "m")), unit, name="disc_diameter")
    return Discs(
        places,
        np.linalg.norm(velocity.values, axis=2),
        sizes,
        read(dataset, "disc_mass").values,
        _box(dataset, places, sizes, plane, unit),
        str(velocity.attrs.get("units", "m s-1")),
    )


def axis_names(dataset: xr.Dataset) -> tuple[str, str]:
    """Return the names of the two axes of a planar scene.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run.

    Returns
    -------
    tuple of str
        The two axes along which the molecules move.

    Raises
    ------
    FileError
        If the file holds no positions of discs.

    Examples
    --------
    >>> import xarray as xr
    >>> places = [[[0.0, 7.0, 1.0], [1.0, 7.0, 0.0]]]
    >>> axis_names(xr.Dataset({"disc_position": (("elapsed_time", "molecule", "axis"), places)}))
    ('x', 'z')
    """
    position = read(dataset, "disc_position").transpose("elapsed_time", "molecule", "axis")
    first, second = _plane(position.values)
    return "xyz"[first], "xyz"[second]


def colour_scale(speed: NDArray[np.float64]) -> Normalize:
    """Return the colour scale of speeds: from zero, or logarithmic if the fastest are far above the median.

    Parameters
    ----------
    speed : ndarray
        All speeds that are to be shown, in any shape and unit.

    Returns
    -------
    matplotlib.colors.Normalize
        The scale.

    Examples
    --------
    >>> colour_scale(np.linspace(0.0, 900.0, 100)).vmax
    1000.0
    """
    moving = speed[speed > 0.0]
    if not moving.size:
        return Normalize(0.0, 1.0)
    low, middle, high = (float(value) for value in np.percentile(moving, (3, 50, 97)))
    if high > _WIDE_SPREAD * middle:
        return LogNorm(low, high)
    return Normalize(0.0, float(MaxNLocator(4).tick_values(0.0, high)[-1]))


def _plane(position: NDArray[np.float64]) -> list[int]:
    """Return the two axes along which the positions (time, molecule, axis) spread most, in order."""
    spread = np.nanmax(position, axis=(0, 1)) - np.nanmin(position, axis=(0, 1))
    return sorted(int(axis) for axis in np.argsort(-spread, kind="stable")[:2])


def _box(
    dataset: xr.Dataset, places: NDArray[np.float64], sizes: NDArray[np.float64], plane: list[int], unit: str
) -> NDArray[np.float64]:
    """Return the lower and the upper corner of the box."""
    if "box_length" in dataset.variables:
        length = read(dataset, "box_length")
        ends = convert(length.values, str(length.attrs.get("units", "m")), unit, name="box_length")
        return np.stack((np.zeros(2), ends[plane] if ends.ndim else np.full(2, ends)))
    radius = sizes[None, :, None] / 2
    return np.stack((np.nanmin(places - radius, axis=(0, 1)), np.nanmax(places + radius, axis=(0, 1))))
