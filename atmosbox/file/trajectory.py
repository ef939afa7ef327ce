"""The molecules of a saved run for programs that show trajectories: OVITO and VMD.

Extended XYZ is a text format that OVITO, VMD and ASE read. It is written in angstrom, picoseconds and dalton if the
box is small, and in metres and kilograms if it is larger than a micrometre.
"""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import FileError
from atmosbox.file.molecules import Molecules, molecules

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["extended_xyz"]

_SMALL = 1e-6  # m; a box that is larger is written in metres
_DALTON = 1.66053906892e-27  # kg, CODATA 2022
_NAMES = ("N", "O")  # for a molecule of air and of water: readers allow only names of elements


class _Units(NamedTuple):
    """The factors from SI units to the units of the trajectory, and the names of those units."""

    length: float
    velocity: float
    mass: float
    names: str


def _units(held: Molecules) -> _Units:
    """Return the units for a box: angstrom, angstrom per picosecond and dalton, or SI."""
    if float(held.side.max()) < _SMALL:
        return _Units(1e10, 1e-2, 1.0 / _DALTON, "angstrom angstrom/ps dalton")
    return _Units(1.0, 1.0, 1.0, "m m/s kg")


def _velocity(dataset: xr.Dataset, held: Molecules) -> NDArray[Any]:
    """Return the velocities; refuse a run that was saved with speeds only."""
    name = "disc_velocity" if held.discs else "molecule_velocity"
    if name not in dataset:
        source = dataset.encoding.get("source") or "The run"
        raise FileError(f"{source} holds speeds and no velocities, as atmosbox once saved them: run the scene again.")
    found: NDArray[Any] = dataset[name].transpose("elapsed_time", "molecule", "axis").values
    return found


def _time(dataset: xr.Dataset) -> NDArray[Any]:
    """Return the times of the frames in picoseconds."""
    scale = {"s": 1e12, "ns": 1e3, "ps": 1.0}[str(dataset["elapsed_time"].attrs["units"])]
    return np.asarray(dataset["elapsed_time"].values) * scale


def extended_xyz(dataset: xr.Dataset) -> bytes:
    """Return the molecules of a run as extended XYZ, one frame after the other.

    A molecule of air is called N and one of water O, since readers allow only names of elements. A molecule that is in
    the liquid is left out of the frame; when it returns, it has the same ``id``. The second line of each frame has the
    box as ``Lattice``, the ``Time`` in picoseconds, which sides are periodic, and the units.

    Parameters
    ----------
    dataset : xarray.Dataset
        A run with its molecules.

    Returns
    -------
    bytes
        The file.

    Raises
    ------
    FileError
        If the run holds no molecules, or no velocities.

    References
    ----------
    https://github.com/libAtoms/extxyz

    Examples
    --------
    >>> from atmosbox import run
    >>> lines = extended_xyz(run("elastic-collisions", duration="2 s", molecules=2)).decode().splitlines()
    >>> lines[0], lines[1].partition(" Properties=")[2].split()[0]
    ('2', 'species:S:1:pos:R:3:velo:R:3:mass:R:1:radius:R:1:id:I:1')
    """
    held = molecules(dataset)
    velocity, unit = _velocity(dataset, held), _units(held)
    names = np.array([_NAMES[int(wet)] for wet in (np.zeros(len(held.mass)) if held.water is None else held.water)])
    periodic = " ".join("T" if held.walls[axis] == "periodic" else "F" for axis in (0, 2, 4))
    mass, radius = held.mass * unit.mass, 0.5 * held.diameter * unit.length
    text = io.StringIO()
    for frame, time in enumerate(_time(dataset)):
        there = np.flatnonzero(np.isfinite(held.position[frame, :, 0]))
        x, y, z = (f"{side:.9g}" for side in held.side[frame] * unit.length)
        text.write(
            f'{len(there)}\nLattice="{x} 0 0 0 {y} 0 0 0 {z}" '
            f"Properties=species:S:1:pos:R:3:velo:R:3:mass:R:1:radius:R:1:id:I:1 "
            f'Time={time:.9g} pbc="{periodic}" units="{unit.names}"\n'
        )
        place, motion = held.position[frame] * unit.length, velocity[frame] * unit.velocity
        for k in there:
            numbers = " ".join(f"{number:.7g}" for number in (*place[k], *motion[k], mass[k], radius[k]))
            text.write(f"{names[k]} {numbers} {k + 1}\n")
    return text.getvalue().encode()
