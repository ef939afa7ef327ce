"""A saved run for other programs: its molecules for OVITO and VMD, its numbers as tables for a spreadsheet.

Extended XYZ is a text format that OVITO, VMD and ASE read. It is written in angstrom, picoseconds and dalton if the
box is small, and in metres and kilograms if it is larger than a micrometre.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from atmosbox.errors import FileError
from atmosbox.file.molecules import molecules

if TYPE_CHECKING:
    import xarray as xr

_SMALL = 1e-6  # m; a box that is larger is written in metres
_DALTON = 1.66053906892e-27  # kg, CODATA 2022
_NAMES = ("N", "O")  # for a molecule of air and of water: some programs know only chemical elements
_LABELLED = ("wall", "axis")


def extended_xyz(dataset: xr.Dataset) -> bytes:
    """Return the molecules of a run as extended XYZ, one frame after the other.

    A molecule of air is called N and one of water O, since some programs know only chemical elements. A molecule that
    is in the liquid is left out of the frame; when it returns, it has the same ``id``. The second line of each frame
    has the box as ``Lattice``, the ``Time`` in picoseconds, which sides are periodic, and the units.

    References
    ----------
    https://github.com/libAtoms/extxyz

    >>> from atmosbox import run
    >>> lines = extended_xyz(run("elastic-collisions", duration="2 s", molecules=2)).decode().splitlines()
    >>> lines[0], lines[1].partition(" Properties=")[2].split()[0]
    ('2', 'species:S:1:pos:R:3:velo:R:3:mass:R:1:radius:R:1:id:I:1')
    """
    held = molecules(dataset)
    name = "disc_velocity" if held.discs else "molecule_velocity"
    if name not in dataset:
        source = dataset.encoding.get("source") or "The run"
        raise FileError(f"{source} holds speeds and no velocities, as atmosbox once saved them: run the scene again.")
    length, per_second, kilogram, units = 1.0, 1.0, 1.0, "m m/s kg"
    if float(held.side.max()) < _SMALL:
        length, per_second, kilogram, units = 1e10, 1e-2, 1.0 / _DALTON, "angstrom angstrom/ps dalton"
    velocity = dataset[name].transpose("elapsed_time", "molecule", "axis").values
    picoseconds = held.time * {"s": 1e12, "ns": 1e3, "ps": 1.0}[str(dataset["elapsed_time"].attrs["units"])]
    names = np.array([_NAMES[int(wet)] for wet in (np.zeros(len(held.mass)) if held.water is None else held.water)])
    periodic = " ".join("T" if held.walls[axis] == "periodic" else "F" for axis in (0, 2, 4))
    mass, radius = held.mass * kilogram, 0.5 * held.diameter * length
    text = io.StringIO()
    for frame, time in enumerate(picoseconds):
        there = np.flatnonzero(np.isfinite(held.position[frame, :, 0]))
        x, y, z = (f"{side:.9g}" for side in held.side[frame] * length)
        text.write(
            f'{len(there)}\nLattice="{x} 0 0 0 {y} 0 0 0 {z}" '
            f"Properties=species:S:1:pos:R:3:velo:R:3:mass:R:1:radius:R:1:id:I:1 "
            f'Time={time:.9g} pbc="{periodic}" units="{units}"\n'
        )
        place, motion = held.position[frame] * length, velocity[frame] * per_second
        for k in there:
            numbers = " ".join(f"{number:.7g}" for number in (*place[k], *motion[k], mass[k], radius[k]))
            text.write(f"{names[k]} {numbers} {k + 1}\n")
    return text.getvalue().encode()


def tables(dataset: xr.Dataset) -> dict[str, bytes]:
    """Return the tables of a run or a sweep as CSV, by name: ``headlines``, and one for each dimension.

    A column is headed by the name of the variable and its unit; all units but that of time are SI. A variable with a
    value for each wall or axis becomes one column for each. Molecules are left out: a trajectory is not a table.

    >>> from atmosbox import run
    >>> made = tables(run("elastic-collisions", duration="2 s"))
    >>> made["headlines"].decode().splitlines()[0]
    'name,what it is,value,standard error,theory,unit'
    >>> made["elapsed_time"].decode().partition(",")[0]
    'elapsed_time [s]'
    """
    made = {"headlines": _headlines(dataset)} if json.loads(dataset.attrs.get("atmosbox_headlines", "[]")) else {}
    for dimension in map(str, dataset.dims):
        if dimension not in dataset.coords or dimension in (*_LABELLED, "member"):
            continue
        columns = [_headed(dataset[dimension])]
        for name, values in dataset.variables.items():
            extra = [dim for dim in values.dims if dim != dimension]
            if name == dimension or dimension not in values.dims or not set(extra) <= set(_LABELLED):
                continue
            if not extra:
                columns.append(_headed(dataset[name]))
            elif len(extra) == 1:
                labels = dataset[extra[0]].values
                columns += [_headed(dataset[name].isel({extra[0]: k}), label) for k, label in enumerate(labels)]
        if len(columns) > 1:
            head, body = zip(*columns, strict=True)
            made[dimension] = as_csv([head, *zip(*body, strict=True)])
    return made


def _headed(values: xr.DataArray, which: object = "") -> tuple[str, list[object]]:
    """Return a column: its heading and its cells, empty for values that are not finite."""
    unit = str(values.attrs.get("units", ""))
    name = f"{values.name}{which and f' {which}'}{f' [{unit}]' if unit not in ('', '1') else ''}"
    return name, ["" if isinstance(each, float) and not np.isfinite(each) else each for each in values.values.tolist()]


def _headlines(dataset: xr.Dataset) -> bytes:
    """Return the table of headlines, one in each row."""
    rows: list[tuple[object, ...]] = [("name", "what it is", "value", "standard error", "theory", "unit")]
    for name in json.loads(dataset.attrs["atmosbox_headlines"]):
        if name in dataset and dataset[name].ndim == 0:
            attributes = dataset[name].attrs
            numbers = [float(dataset[key]) if key in dataset else "" for key in (name, f"{name}_se", f"{name}_theory")]
            rows.append((name, attributes["long_name"], *numbers, attributes["units"]))
    return as_csv(rows)


def as_csv(rows: Iterable[Iterable[object]]) -> bytes:
    """Return rows as CSV."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue().encode()
