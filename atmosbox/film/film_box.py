"""What the file of a run says of its molecules and their box, in lengths that can be read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import FileError
from atmosbox.plot.curve import read
from atmosbox.theory.constants import DRY_AIR

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Box", "box", "has_discs", "has_molecules"]

_MOST = 4000  # molecules that are drawn
_UNITS = (("nm", 1e-9), ("um", 1e-6), ("mm", 1e-3), ("m", 1.0), ("km", 1e3))
_SMALLEST = 0.18  # diameter of a molecule on the page, in distances from one to the next if they stood in rows
_TO_SIZE, _MANY_TIMES = 1.05, 1000.0

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Box:
    """The molecules of a run and their box, frame by frame.

    Parameters
    ----------
    position : ndarray, (frame, molecule, 3)
        Places of the molecules [unit]; NaN while one is in the liquid.
    speed : ndarray, (frame, molecule)
        Their speeds [m s-1].
    diameter : ndarray, (molecule,)
        How wide they are drawn [unit].
    water : ndarray of bool, (molecule,)
        Which of them are water.
    side : ndarray, (frame, 3)
        Lengths of the box [unit].
    walls : tuple of str
        What its six walls are: "specular", "periodic", "heat_bath", "piston" or "pool".
    wall_temperature : ndarray, (frame, 6)
        Temperatures of the walls [K]; NaN where a wall has none.
    drops : ndarray, (frame, drop, 4)
        Places and radii of the drops that can be seen [unit].
    liquid : ndarray of int, (frame,), or None
        How many molecules are in the liquid, where there may be one.
    unit : str
        The unit of length.
    widened : float
        How many times as wide as those of air the molecules are drawn.
    molecules : int
        How many there are; more may be than are drawn.

    Examples
    --------
    >>> still = Box(np.zeros((1, 1, 3)), np.zeros((1, 1)), np.ones(1), np.zeros(1, bool), np.full((1, 3), 30.0),
    ...             ("specular",) * 6, np.full((1, 6), np.nan), np.zeros((1, 0, 4)), None, "nm", 2.7, 1)
    >>> still.exaggeration
    'molecules drawn 2.7 times as wide as those of air'
    """

    position: NDArray[np.float32]
    speed: NDArray[np.float32]
    diameter: Floats
    water: NDArray[np.bool_]
    side: Floats
    walls: tuple[str, ...]
    wall_temperature: Floats
    drops: Floats
    liquid: NDArray[np.int64] | None
    unit: str
    widened: float
    molecules: int

    @property
    def exaggeration(self) -> str:
        """How large the molecules are drawn, in words."""
        if self.widened < _TO_SIZE:
            return "molecules drawn to size"
        if self.widened < _MANY_TIMES:
            return f"molecules drawn {self.widened:.2g} times as wide as those of air"
        return f"molecules drawn {float(f'{np.median(self.diameter) * dict(_UNITS)[self.unit]:.2g}'):g} m wide"

    @property
    def step(self) -> float:
        """How far a molecule typically is from where it was in the frame before, in sides of the box."""
        if len(self.position) < 2:
            return 1.0
        moved = np.linalg.norm(np.diff(self.position, axis=0), axis=2)
        seen = moved[np.isfinite(moved)]
        return float(np.median(seen) / self.side.max()) if seen.size else 1.0


def has_molecules(dataset: xr.Dataset) -> bool:
    """Tell whether a file holds places of molecules.

    Examples
    --------
    >>> import xarray as xr
    >>> has_molecules(xr.Dataset())
    False
    """
    return "molecule_position" in dataset.variables


def has_discs(dataset: xr.Dataset) -> bool:
    """Tell whether a file holds the discs of a flat scene.

    Examples
    --------
    >>> import xarray as xr
    >>> has_discs(xr.Dataset())
    False
    """
    return "disc_position" in dataset.variables


def box(dataset: xr.Dataset) -> Box:
    """Return the molecules of a run and their box.

    Parameters
    ----------
    dataset : xarray.Dataset
        A run that has saved its molecules.

    Returns
    -------
    Box
        At most 4000 molecules, evenly chosen, in a unit in which the box is some tens wide.

    Raises
    ------
    FileError
        If the file lacks the molecules or their box.

    Examples
    --------
    >>> import xarray as xr
    >>> box(xr.Dataset())
    Traceback (most recent call last):
    atmosbox.errors.FileError: The file has no molecules to film: run the scene again with --save-molecules.
    """
    if not has_molecules(dataset):
        raise FileError("The file has no molecules to film: run the scene again with --save-molecules.")
    place = read(dataset, "molecule_position").transpose("elapsed_time", "molecule", "axis").values
    side = read(dataset, "box_side").transpose("elapsed_time", "axis").values
    frames, molecules = place.shape[:2]
    shown = np.unique(np.linspace(0, molecules - 1, min(molecules, _MOST)).round().astype(int))
    unit, factor = next((each for each in _UNITS if side.max() < 1e3 * each[1]), _UNITS[-1])
    true = read(dataset, "molecule_diameter").values[shown]
    drawn = np.maximum(true, _SMALLEST * side.max() / max(shown.size, 100) ** (1.0 / 3.0))
    species = read(dataset, "species").values[shown] if "species" in dataset.variables else np.zeros(shown.size)
    count = dataset.variables.get("liquid_molecule_count")
    return Box(
        position=(place[:, shown] / np.float32(factor)).astype(np.float32),
        speed=read(dataset, "molecule_speed").transpose("elapsed_time", "molecule").values[:, shown],
        diameter=drawn / factor,
        water=species == 1,
        side=side / factor,
        walls=_walls(dataset),
        wall_temperature=read(dataset, "wall_temperature").transpose("elapsed_time", "wall").values,
        drops=_drops(dataset, frames) / factor,
        liquid=None if count is None else count.values.astype(np.int64),
        unit=unit,
        widened=float(np.median(drawn)) / DRY_AIR.diameter,
        molecules=molecules,
    )


def _walls(dataset: xr.Dataset) -> tuple[str, ...]:
    """Return what the six walls are."""
    laws = read(dataset, "wall_law")
    names = str(laws.attrs.get("flag_meanings", "")).split()
    values = [int(value) for value in laws.values]
    if len(values) != 6 or not all(0 <= value < len(names) for value in values):
        raise FileError("The file does not say what its walls are: run the scene again with this version of atmosbox.")
    return tuple(names[value] for value in values)


def _drops(dataset: xr.Dataset, frames: int) -> Floats:
    """Return places and radii of drops; none where the file knows of none."""
    if "drop_position" not in dataset.variables:
        return np.zeros((frames, 0, 4))
    place = read(dataset, "drop_position").transpose("elapsed_time", "drop", "axis").values
    radius = read(dataset, "drop_radius").transpose("elapsed_time", "drop").values
    return np.concatenate([place, radius[:, :, None]], axis=2)
