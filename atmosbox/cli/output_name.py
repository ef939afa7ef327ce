"""Default names of output files, and names that a command refuses."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path

from atmosbox.cli.request import is_path
from atmosbox.errors import FileError

__all__ = ["FIGURES", "beside", "for_scene", "netcdf_name"]

FIGURES = (".png", ".svg", ".pdf")
_LONGEST = 100  # characters of a name that is made of the names of all files


def for_scene(scene: str, ending: str = ".nc") -> Path:
    """Return the default path, in this folder, of an output file of a scene.

    Examples
    --------
    >>> str(for_scene("lifting_dry")), str(for_scene("./my_scene.py", "-sweep.nc"))
    ('lifting-dry.nc', 'my_scene-sweep.nc')
    """
    return Path((Path(scene).stem if is_path(scene) else scene.replace("_", "-")) + ending)


def beside(files: Sequence[str], kind: str) -> Path:
    """Return the path of an output file of this kind, beside the first file and named after all files.

    Raises
    ------
    FileError
        If one of the files is a folder.

    Examples
    --------
    >>> str(beside(["runs/cold.nc", "warm.nc"], "png"))
    'runs/cold-and-warm.png'
    """
    for file in files:
        if Path(file).name in ("", ".."):
            raise FileError(f"{Path(file)} is a folder: give a file that atmosbox run has written.")
    first = Path(files[0])
    stem = "-and-".join(Path(file).stem for file in files)
    if len(stem) > _LONGEST and len(files) > 1:
        stem = f"{first.stem[:_LONGEST]}-and-{len(files) - 1}-more"
    return first.with_name(f"{stem}.{kind}")


def netcdf_name(out: str | None, default: Path) -> Path:
    """Return the path of the netCDF file to write; refuse the name of a figure."""
    path = default if out is None else Path(out)
    if path.suffix.lower() in FIGURES:
        data = shlex.quote(str(path.with_suffix(".nc")))
        figure = shlex.quote(str(path))
        raise FileError(
            f"{path} is the name of a figure, and this command writes netCDF: "
            f"give --out {data}, then type atmosbox plot {data} --out {figure}."
        )
    return path
