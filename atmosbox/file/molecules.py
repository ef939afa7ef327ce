"""The molecules of a saved run and their box, in SI units, frame by frame, for pages, films and pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import Command, FileError, Given, Option
from atmosbox.file.provenance import parameters

if TYPE_CHECKING:
    import xarray as xr

_EACH = ("position", "speed", "mass", "diameter")
_MOLECULES = {each: f"molecule_{each}" for each in _EACH} | {"side": "box_side", "walls": "wall_law"}
_DISCS = {each: f"disc_{each}" for each in _EACH} | {"speed": "disc_velocity", "side": "box_length"}
_OPTIONAL = {each: f"{each}_molecule_count" for each in ("liquid", "rained")}
_OPTIONAL |= {"wall_temperature": "wall_temperature", "neighbours": "molecule_neighbour_count"}
"""The variables of the fields of `Molecules`, for molecules and for discs."""

Floats = NDArray[np.floating]
Whole = NDArray[np.integer]


class Molecules(NamedTuple):
    """The molecules of a run and their box.

    Attributes
    ----------
    discs : bool
        Whether it is a planar scene, whose molecules are called discs.
    time : (frame,)
        Times of the frames, in the unit of the file.
    position, speed : (frame, molecule, axis) and (frame, molecule)
        Positions and speeds of the molecules [m, m s-1], NaN for a molecule in the liquid.
    mass, diameter : (molecule,)
        Mass and diameter of each molecule [kg, m].
    water : (molecule,) or None
        Which molecules are water; None if there is no water.
    side : (frame, axis)
        Sides of the box [m].
    walls : (wall,)
        Kind of each wall: ``specular``, ``periodic``, ``heat_bath``, ``piston`` or ``pool``, in the order x low,
        x high, y low, y high, z low, z high.
    wall_temperature : (frame, wall)
        Temperatures of the walls [K], NaN for a wall that has none.
    planar, gravity : bool
        Whether nothing moves along y, and whether molecules fall.
    drops : (frame, drop, 4) or None
        Positions and radii of drops [m], NaN for a drop that is not there.
    liquid, rained : (frame,) or None
        Numbers of molecules in the liquid, and of those that have rained out.
    neighbours : (frame, molecule) or None
        If molecules attract each other: the number of molecules in whose wells each molecule is.
    right : (molecule,) or None
        Which molecules belong to the second of two gases.
    """

    discs: bool
    time: Floats
    position: Floats
    speed: Floats
    mass: Floats
    diameter: Floats
    water: NDArray[np.bool_] | None
    side: Floats
    walls: tuple[str, ...]
    wall_temperature: Floats
    planar: bool
    gravity: bool
    drops: Floats | None = None
    liquid: Whole | None = None
    rained: Whole | None = None
    neighbours: Whole | None = None
    right: NDArray[np.bool_] | None = None

    @property
    def step(self) -> float:
        """The median distance that a molecule moves between two frames, in units of the longest side of the box."""
        if len(self.position) < 2:
            return 1.0
        moved = np.linalg.norm(np.diff(self.position, axis=0), axis=2)
        seen = moved[np.isfinite(moved)]
        return float(np.median(seen) / self.side.max()) if seen.size else 1.0


def molecules(dataset: xr.Dataset, *otherwise: Given | str) -> Molecules:
    """Return the molecules of a run with ``--save-molecules``, or of a planar scene, and their box.

    If there are none, the message ends with `otherwise`: what else a user can do.

    >>> import xarray as xr
    >>> molecules(xr.Dataset(attrs={"atmosbox_parameters": '{"scene": "./mine.py"}'}))
    Traceback (most recent call last):
    atmosbox.errors.FileError: The run holds no molecules: type atmosbox.run("./mine.py", save_molecules=True).
    """
    source = dataset.encoding.get("source") or "The run"
    if "configuration" in dataset.dims:
        draw = Command("plot", (str(source),))
        raise FileError(f"{source} holds a comparison of engines and no molecules", draw, " to draw it")
    discs = "disc_position" in dataset
    again = Command("run", (str(parameters(dataset).get("scene", "SCENE")), Option("save_molecules", True)))
    if not discs and "molecule_position" not in dataset:
        raise FileError(f"{source} holds no molecules", again, *otherwise)
    if dataset.sizes.get("elapsed_time", 0) == 0:
        raise FileError(f"{source} holds no frame, for the run was stopped before its first", again)
    needed = _DISCS if discs else _MOLECULES
    missing = [name for name in needed.values() if name not in dataset]
    if missing:
        raise FileError(f"{source} was written by an earlier atmosbox and lacks {missing[0]}", again)
    held: dict[str, Any] = {field: _values(dataset, name) for field, name in {**needed, **_OPTIONAL}.items()}
    frames, position = dataset.sizes["elapsed_time"], held["position"]
    if discs:
        held |= {"planar": True, "gravity": False, "water": None, "walls": ("specular",) * 6}
        held |= {"speed": np.linalg.norm(held["speed"], axis=2), "side": np.tile(held["side"], (frames, 1))}
    else:
        names = dataset["wall_law"].attrs["flag_meanings"].split()
        held["walls"] = walls = tuple(names[int(law)] for law in held["walls"])
        held["planar"] = position.shape[1] > 1 and float(np.ptp(position[0, :, 1])) == 0.0
        held["gravity"] = _falls(dataset)
        held["water"] = dataset["species"].values == 1 if "species" in dataset else None
        held["right"] = dataset["gas"].values == 1 if "gas" in dataset else None
        if held["neighbours"] is not None:
            periodic = [law == "periodic" for law in walls[::2]]
            held["position"] = _about_the_drop(position, held["neighbours"][-1], held["side"], periodic)
        if "drop_position" in dataset:
            radius = _values(dataset, "drop_radius")[:, :, None]
            held["drops"] = np.concatenate((_values(dataset, "drop_position"), radius), axis=2)
    if held["wall_temperature"] is None:
        held["wall_temperature"] = np.full((frames, 6), np.nan)
    return Molecules(discs=discs, time=dataset["elapsed_time"].values, **held)


def _falls(dataset: xr.Dataset) -> bool:
    """Return whether molecules have potential energy of gravity, and not only of each other's wells."""
    if "potential_energy" not in dataset:
        return False
    potential = dataset["potential_energy"].values
    wells = dataset["attraction_energy"].values if "attraction_energy" in dataset else 0.0
    return bool((np.abs(potential - wells) > 1e-9 * np.abs(potential).max(initial=0.0)).any())


def _about_the_drop(position: Any, neighbours: Any, side: Any, periodic: list[bool]) -> Any:
    """Return positions shifted along periodic axes, so that the drop of the last frame is in the middle of the box.

    All frames are shifted by the same share of the box. The middle of the drop along a periodic axis is a circular
    mean, weighted with molecules that have more than four neighbours.
    """
    weight = np.maximum(neighbours.astype(np.float64) - 4.0, 0.0) ** 2
    moved = position.astype(np.float64)
    for axis in np.flatnonzero(periodic):
        angle = 2.0 * np.pi * moved[-1, :, axis] / side[-1, axis]
        middle = np.arctan2(weight @ np.sin(angle), weight @ np.cos(angle)) / (2.0 * np.pi)
        moved[:, :, axis] = np.mod(moved[:, :, axis] + (0.5 - middle) * side[:, axis, None], side[:, axis, None])
    return moved.astype(position.dtype)


def _values(dataset: xr.Dataset, name: str) -> Any:
    """Return a variable with its dimensions in the order of `Molecules`; None if there is none."""
    order = ("elapsed_time", "molecule", "drop", "wall", "axis")
    return dataset[name].transpose(*order, missing_dims="ignore").values if name in dataset else None
