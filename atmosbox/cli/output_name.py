"""Default names of output files, and names that a command refuses."""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Sequence
from pathlib import Path

from atmosbox.cli.request import is_path
from atmosbox.cli.terminal import tell
from atmosbox.errors import FileError

__all__ = ["FIGURES", "beside", "chosen", "for_scene", "netcdf_name", "say_number"]

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

    Examples
    --------
    >>> str(beside(["runs/cold.nc", "warm.nc"], "png"))
    'runs/cold-and-warm.png'
    """
    for file in files:
        if Path(file).name in ("", ".."):
            raise FileError(f"{Path(file)} is a folder: give a file that atmosbox run has written.")
    first = Path(files[0])
    stem = "-and-".join(Path(file).stem for file in files)[:_LONGEST]
    return first.with_name(f"{stem}.{kind}")


def chosen(
    out: str | None, default: Path, *, force: bool, quiet: bool, files: Callable[[Path], Sequence[Path]] | None = None
) -> Path:
    """Return the path of the output file: the one that was asked for, or else the default, with a number if it exists.

    `files` returns the files that are written for a path, if there are several.
    """
    if out is not None:
        return Path(out)
    if force:
        return default
    from atmosbox.file.output_path import unused

    path = unused(default, lambda each: any(map(os.path.lexists, files(each) if files else (each,))))
    if not quiet:
        say_number(default, path)
    return path


def say_number(default: Path, path: Path) -> None:
    """Say that the file has a number in its name, if it has."""
    if path != default:
        tell(f"note: the name {default} is in use, so this file is {path}")


def netcdf_name(path: Path) -> Path:
    """Return the path of the netCDF file to write; refuse the name of a figure."""
    if path.suffix.lower() in FIGURES:
        data = shlex.quote(str(path.with_suffix(".nc")))
        figure = shlex.quote(str(path))
        raise FileError(
            f"{path} is the name of a figure, and this command writes netCDF: "
            f"give --out {data}, then type atmosbox plot {data} --out {figure}."
        )
    return path
