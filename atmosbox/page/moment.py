"""The molecules of a run, frame by frame, however its file holds them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import FileError
from atmosbox.file.provenance import parameters
from atmosbox.page.page_box import Box

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Moments", "moments"]

_NEEDED = ("molecule_position", "molecule_speed", "molecule_mass", "molecule_diameter", "box_side", "wall_law")

Floats = NDArray[np.floating]
Whole = NDArray[np.integer]


class Moments(NamedTuple):
    """The molecules of a run.

    Attributes
    ----------
    scene, seed, engine
        What made the run.
    discs : bool
        Whether it is a flat scene, whose molecules are called discs.
    box : Box
        The box at the first frame.
    time : (frame,)
        In the unit of the file.
    side : (frame, axis)
        Sides of the box [m].
    position, speed : (frame, molecule, axis) and (frame, molecule)
        Of the molecules [m, m/s], NaN in the liquid.
    mass, diameter : (molecule,)
        Of each [kg, m].
    water : (molecule,) or None
        Which are water.
    drops : (frame, drop, 4) or None
        Places and radii of drops that can be seen [m].
    liquid, rained : (frame,)
        Numbers of molecules in the liquid, and of those that have rained out.
    """

    scene: str
    seed: int | None
    engine: str
    discs: bool
    box: Box
    time: Floats
    side: Floats
    position: Floats
    speed: Floats
    mass: Floats
    diameter: Floats
    water: NDArray[np.bool_] | None
    drops: Floats | None
    liquid: Whole
    rained: Whole


def moments(dataset: xr.Dataset) -> Moments:
    """Return the molecules of a run.

    Parameters
    ----------
    dataset : xarray.Dataset
        A run with ``--save-molecules``, or one of a flat scene, which always keeps its discs.

    Returns
    -------
    Moments
        The molecules.

    Raises
    ------
    FileError
        If the run holds no molecules or no frame, or does not say in which box they are.

    Examples
    --------
    >>> import xarray as xr
    >>> moments(xr.Dataset(attrs={"atmosbox_parameters": '{"scene": "./mine.py"}'}))
    Traceback (most recent call last):
    atmosbox.errors.FileError: The run holds no molecules: type atmosbox run ./mine.py --save-molecules.
    """
    made = parameters(dataset)
    scene = str(made.get("scene", ""))
    source = dataset.encoding.get("source") or "The run"
    again = f"type atmosbox run {scene} --save-molecules"
    if "rung" in dataset.dims:
        raise FileError(f"{source} holds a comparison of engines and no molecules: type atmosbox plot to draw it.")
    discs = "disc_position" in dataset
    if not discs and "molecule_position" not in dataset:
        raise FileError(f"{source} holds no molecules: {again}.")
    if dataset.sizes.get("elapsed_time", 0) == 0:
        raise FileError(f"{source} holds no frame, for the run was stopped before its first: {again}.")
    missing = [name for name in _NEEDED if name not in dataset]
    if missing and not discs:
        raise FileError(f"{source} was written by an earlier atmosbox and lacks {missing[0]}: {again}.")
    settings = made.get("settings", {})
    seed = settings.get("seed")
    frames = dataset.sizes["elapsed_time"]
    held = _discs(dataset) if discs else _molecules(dataset)
    counts: dict[str, Any] = {
        name: dataset[variable].values if variable in dataset else np.zeros(frames, np.int64)
        for name, variable in (("liquid", "liquid_molecule_count"), ("rained", "rained_molecule_count"))
    }
    return Moments(
        scene=scene,
        seed=None if seed is None else int(seed),
        engine=str(made.get("engine", "exact")),
        discs=discs,
        time=dataset["elapsed_time"].values,
        **held,
        **counts,
    )


def _molecules(dataset: xr.Dataset) -> dict[str, Any]:
    """Return what the instrument of ``--save-molecules`` has kept."""
    position = dataset["molecule_position"].values
    side = dataset["box_side"].values
    walls = tuple(dataset["wall_law"].attrs["flag_meanings"].split()[int(law)] for law in dataset["wall_law"].values)
    drops = None
    if "drop_position" in dataset:
        drops = np.concatenate((dataset["drop_position"].values, dataset["drop_radius"].values[:, :, None]), axis=2)
    planar = position.shape[1] > 0 and float(np.ptp(position[0, :, 1])) == 0.0 and position.shape[1] > 1
    return {
        "box": Box(
            length=_three(side[0]),
            walls=walls,
            wall_temperature=_wall_temperature(dataset),
            planar=planar,
            gravity="potential_energy" in dataset and bool(dataset["potential_energy"].values.any()),
            reach=float(side[:, 2].max()),
        ),
        "side": side,
        "position": position,
        "speed": dataset["molecule_speed"].values,
        "mass": dataset["molecule_mass"].values,
        "diameter": dataset["molecule_diameter"].values,
        "water": dataset["species"].values == 1 if "species" in dataset else None,
        "drops": drops,
    }


def _discs(dataset: xr.Dataset) -> dict[str, Any]:
    """Return the discs that a flat scene keeps."""
    position = dataset["disc_position"].values
    length = dataset["box_length"].values
    return {
        "box": Box(
            length=_three(length),
            wall_temperature=_wall_temperature(dataset),
            planar=True,
        ),
        "side": np.tile(length, (len(position), 1)),
        "position": position,
        "speed": np.linalg.norm(dataset["disc_velocity"].values, axis=2),
        "mass": dataset["disc_mass"].values,
        "diameter": dataset["disc_diameter"].values,
        "water": None,
        "drops": None,
    }


def _wall_temperature(dataset: xr.Dataset) -> tuple[float | None, ...]:
    """Return the temperatures of the six walls at the first frame [K]."""
    if "wall_temperature" not in dataset:
        return (None,) * 6
    return tuple(float(value) if np.isfinite(value) else None for value in dataset["wall_temperature"].values[0])


def _three(sides: Floats) -> tuple[float, float, float]:
    """Return the three sides as plain numbers."""
    x, y, z = (float(side) for side in sides)
    return x, y, z
