"""The command ``animate``."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from atmosbox.cli.application import app, examples
from atmosbox.cli.option import Force, RunFile, Theme, Verbose
from atmosbox.cli.terminal import guarded


class Film(StrEnum):
    """The formats of a film."""

    gif = "gif"
    mp4 = "mp4"


@app.command(
    epilog=examples(
        "atmosbox animate temperature.nc",
        "atmosbox animate lifting-dry.nc --format mp4 --theme slides --seconds 8",
        "atmosbox animate lifting-dry.nc --graphs --out lift.gif --force",
    )
)
@guarded
def animate(
    file: RunFile,
    out: Annotated[
        str | None, typer.Option(metavar="FILE", help="The film.  [default: beside FILE, by its name]")
    ] = None,
    format: Annotated[
        Film | None,
        typer.Option(help="The format, where the name of the film does not say it; mp4 needs atmosbox[movie]."),
    ] = None,
    seconds: Annotated[
        float | None, typer.Option(metavar="S", help="How long it lasts at most.  [default: 12]", show_default=False)
    ] = None,
    fps: Annotated[
        float | None,
        typer.Option(
            metavar="N", help="Pictures a second.  [default: 10, or 20 where motion is smooth]", show_default=False
        ),
    ] = None,
    graphs: Annotated[bool, typer.Option("--graphs", help="Film the graphs alone, without the molecules.")] = False,
    theme: Annotated[Theme, typer.Option(help="For a page or for a screen.")] = Theme.notes,
    force: Force = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Show no progress.")] = False,
    verbose: Verbose = False,
) -> None:
    """Film a run: the molecules in their box, and the graphs that they draw.

    The molecules are in the file if it was run with --save-molecules.
    """
    from atmosbox.cli.animate import animate as filming

    filming(
        file,
        out=out,
        format=None if format is None else format.value,
        seconds=seconds,
        fps=fps,
        graphs=graphs,
        theme=theme.value,
        force=force,
        quiet=quiet,
    )
