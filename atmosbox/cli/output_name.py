"""The file that a command writes where no name was given, and names that cannot be meant."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path

from atmosbox.cli.request import is_path
from atmosbox.errors import FileError

__all__ = ["FIGURES", "beside", "for_scene", "netcdf_name"]

FIGURES = (".png", ".svg", ".pdf")
_LONGEST = 100  # characters of a name that is made of those of all files


def for_scene(scene: str, ending: str = ".nc") -> Path:
    """Return the file, in this folder, of what is made of a scene.

    Examples
    --------
    >>> str(for_scene("lifting_dry")), str(for_scene("./my_scene.py", "-sweep.nc"))
    ('lifting-dry.nc', 'my_scene-sweep.nc')
    """
    return Path((Path(scene).stem if is_path(scene) else scene.replace("_", "-")) + ending)


def beside(files: Sequence[str], kind: str) -> Path:
    """Return the file of a kind beside the first file, named after all of them.

    Raises
    ------
    FileError
        If one of them is a folder, which has no name to take.

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
    """Return the netCDF file that is to be written, or refuse a name that is that of a figure."""
    path = default if out is None else Path(out)
    if path.suffix.lower() in FIGURES:
        data = shlex.quote(str(path.with_suffix(".nc")))
        figure = shlex.quote(str(path))
        raise FileError(
            f"{path} is the name of a figure, and this command writes netCDF: "
            f"give --out {data}, then type atmosbox plot {data} --out {figure}."
        )
    return path
