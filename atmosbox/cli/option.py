"""The options that several commands share, each declared once, and the names of output files."""

import os
import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from atmosbox.cli.terminal import say, say_json, tell
from atmosbox.errors import FileError


def text(metavar: str, help: str, *names: str) -> Any:
    """Return an option whose value is a text, with its names if they are not that of the parameter."""
    return typer.Option(*names, metavar=metavar, help=help)


def switch(name: str, help: str) -> Any:
    """Return an option that is given or not."""
    return typer.Option(name, help=help)


def _completed(incomplete: str) -> list[str]:
    """Return the scenes whose names begin with the letters typed so far."""
    from atmosbox import scenarios

    return [name for name in scenarios.names() if name.startswith(incomplete.replace("_", "-"))]


SceneName = typer.Argument(
    metavar="SCENE", help="A name that `atmosbox list` shows, or the path of your own: ./my_scene.py.",
    autocompletion=_completed, show_default=False,
)  # fmt: skip
RunFile = Annotated[str, typer.Argument(metavar="FILE", help="A file that `atmosbox run` has written.")]
Values = Annotated[
    list[str] | None,
    text(
        "NAME=VALUE", "A setting with its unit, such as temperature=25degC; repeatable. --set may be left out.", "--set"
    ),
]
ValuesOfAll = Annotated[
    list[str] | None, text("NAME=VALUE", "A setting for all runs; repeatable. --set may be left out.", "--set")
]
Seed = Annotated[str | None, text("N", "Seed of the random numbers: the same seed, the same run.")]
Engine = Annotated[
    str | None,
    text(
        "NAME[:OPTION=VALUE,...]",
        "The engine: exact, or an approximate one such as stepped:delta=0.02.  "
        "[default: that of the scene; in a page exact]",
    ),
]
Accuracy = Annotated[
    str | None,
    text(
        "TARGET",
        "Pick engine and settings by their measured errors: sketch, lecture, reference, or the largest error of "
        "a run, such as 0.5K or 2%.",
    ),
]
FigureFormat = Annotated[
    Literal["png", "svg", "pdf"] | None, typer.Option(help="The format, where the name of the figure does not say it.")
]
Theme = Annotated[Literal["notes", "slides"], typer.Option(help="For a page or for a screen.")]
Language = Annotated[
    Literal["auto", "en", "de", "es"],
    typer.Option("--language", help="Language of the page; auto takes that of the reader's browser."),
]
PageTheme = Annotated[
    Literal["auto", "light", "dark"], typer.Option(help="Light or dark; auto takes what the reader's computer prefers.")
]
DryRun = Annotated[bool, switch("--dry-run", "Show what would run, compute nothing and write nothing.")]
Json = Annotated[bool, switch("--json", "Print one JSON object and nothing else.")]
Verbose = Annotated[bool, switch("--verbose", "Show the traceback of a bug.")]


@dataclass(frozen=True)
class Sought:
    """The options that say what is to run: a scene, and where its settings come from."""

    scene: Annotated[str | None, SceneName] = None
    values: Values = None
    config: Annotated[str | None, text("FILE", "Settings, and perhaps the scene, from a TOML file.")] = None
    source: Annotated[str | None, text("FILE", "Scene and settings of an earlier run.", "--from")] = None
    seed: Seed = None
    engine: Engine = None
    accuracy: Accuracy = None

    def changes(self) -> dict[str, object]:
        """Return what is given beside the scene, by the names of the options."""
        named = {"values": "set", "source": "from"}
        return {f"--{named.get(name, name)}": value for name, value in vars(self).items() if name != "scene"}


@dataclass(frozen=True)
class Output:
    """The options of a command that writes a file; what ``--out`` and ``--quiet`` mean is said by each command."""

    out: Annotated[str | None, text("FILE", "", "--out", "-o")] = None
    force: Annotated[bool, switch("--force", "Replace the file if there is one.")] = False
    quiet: Annotated[bool, switch("--quiet", "")] = False

    def path(self, default: Path, files: Callable[[Path], Sequence[Path]] = lambda path: [path]) -> Path:
        """Return the path of the file: the one that was asked for, or else the default, with a number if it exists.

        `files` returns the files that are written for a path, if there are several.
        """
        if self.out is not None:
            return Path(self.out)
        return self.numbered(default, lambda path: any(map(os.path.lexists, files(path))))

    def numbered(self, default: Path, taken: Callable[[Path], bool]) -> Path:
        """Return the default path, with a number if it is taken and must not be replaced, and say so."""
        from atmosbox.file.output_path import unused

        path = default if self.force else unused(default, taken)
        self.say_number(default, path)
        return path

    def say_number(self, default: Path, path: Path) -> None:
        """Say that the file has a number in its name, if it has."""
        if path != default and not self.quiet:
            tell(f"note: the name {default} is in use, so this file is {path}")


@dataclass(frozen=True)
class Result(Output):
    """The options of a command that writes a file and prints what is in it, as text or as JSON."""

    as_json: Json = False

    def say(self, path: Path, record: Mapping[str, Any], lines: Sequence[str]) -> None:
        """Print the result as JSON, as the path alone, or as text."""
        if self.as_json:
            say_json(record)
        else:
            say(str(path) if self.quiet else "\n".join(lines))


FIGURES = (".png", ".svg", ".pdf")
_LONGEST = 100  # characters of a name that is made of the names of all files


def for_scene(scene: str, ending: str = ".nc") -> Path:
    """Return the default path, in this folder, of an output file of a scene.

    Examples
    --------
    >>> str(for_scene("lifting_dry")), str(for_scene("./my_scene.py", "-sweep.nc"))
    ('lifting-dry.nc', 'my_scene-sweep.nc')
    """
    from atmosbox import scenarios

    return Path((Path(scene).stem if scenarios.is_path(scene) else scene.replace("_", "-")) + ending)


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
