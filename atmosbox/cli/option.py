"""The options and arguments that several commands share, and the default names of output files."""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from atmosbox.cli.request import is_path
from atmosbox.cli.terminal import tell
from atmosbox.errors import FileError

Format = Literal["png", "svg", "pdf"]
"""The formats of a figure."""
Theme = Annotated[Literal["notes", "slides"], typer.Option(help="For a page or for a screen.")]
"""What a figure is for."""


def _completed(incomplete: str) -> list[str]:
    """Return the scenes whose names begin with the letters typed so far."""
    from atmosbox import scenarios

    return [name for name in scenarios.names() if name.startswith(incomplete.replace("_", "-"))]


def out_option(help: str) -> Any:
    """Return the option ``--out`` of a command that writes a file."""
    return typer.Option("--out", "-o", metavar="FILE", help=help)


def quiet_option(help: str) -> Any:
    """Return the option ``--quiet``."""
    return typer.Option("--quiet", help=help)


SceneName = typer.Argument(
    metavar="SCENE", help="A name that `atmosbox list` shows, or the path of your own: ./my_scene.py.",
    autocompletion=_completed, show_default=False,
)  # fmt: skip
RunFile = Annotated[str, typer.Argument(metavar="FILE", help="A file that `atmosbox run` has written.")]
Values = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="A setting with its unit, such as temperature=25degC; repeatable. --set may be left out.",
    ),
]
ValuesOfAll = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="NAME=VALUE", help="A setting for all runs; repeatable. --set may be left out."),
]
Config = Annotated[
    str | None, typer.Option("--config", metavar="FILE", help="Settings, and perhaps the scene, from a TOML file.")
]
Source = Annotated[str | None, typer.Option("--from", metavar="FILE", help="Scene and settings of an earlier run.")]
Seed = Annotated[
    str | None,
    typer.Option("--seed", metavar="N", help="Seed of the random numbers: the same seed, the same run."),
]
Engine = Annotated[
    str | None,
    typer.Option(
        "--engine",
        metavar="NAME[:OPTION=VALUE,...]",
        help="The engine: exact, or an approximate one such as stepped:delta=0.02.  [default: that of the scene]",
    ),
]
Accuracy = Annotated[
    str | None,
    typer.Option(
        "--accuracy",
        metavar="TARGET",
        help="Pick engine and settings by their measured errors: sketch, lecture, reference, or the largest error of "
        "a run, such as 0.5K or 2%.",
    ),
]
Language = Annotated[
    Literal["auto", "en", "de", "es"],
    typer.Option("--language", help="Language of the page; auto takes that of the reader's browser."),
]
PageTheme = Annotated[
    Literal["auto", "light", "dark"], typer.Option(help="Light or dark; auto takes what the reader's computer prefers.")
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
Verbose = Annotated[bool, typer.Option("--verbose", help="Say more, with the traceback of a bug.")]
Force = Annotated[bool, typer.Option("--force", help="Replace the file if there is one.")]


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
