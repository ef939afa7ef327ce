"""The command ``compare``."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from atmosbox.cli.application import app, examples
from atmosbox.cli.option import Force, Json, Theme, Verbose
from atmosbox.cli.terminal import guarded


class Comparison(StrEnum):
    """The formats of a comparison."""

    png = "png"
    svg = "svg"
    pdf = "pdf"
    html = "html"


@app.command(
    epilog=examples(
        "atmosbox compare cold.nc warm.nc",
        "atmosbox compare cold.nc mild.nc warm.nc --format pdf --theme slides",
        "atmosbox compare dry.nc moist.nc --out both.html",
    )
)
@guarded
def compare(
    files: Annotated[list[str], typer.Argument(metavar="FILE FILE...", help="Two to six runs.")],
    out: Annotated[
        str | None, typer.Option(metavar="FILE", help="The figure.  [default: beside FILE, named after all files]")
    ] = None,
    format: Annotated[
        Comparison | None,
        typer.Option(
            help="The format, where the name of the figure does not say it; html is a page of two boxes with one clock."
        ),
    ] = None,
    theme: Annotated[Theme, typer.Option(help="For a page or for a screen.")] = Theme.notes,
    force: Force = False,
    as_json: Json = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Print the path of the figure, no more.")] = False,
    verbose: Verbose = False,
) -> None:
    """Lay runs over each other: one figure, and by how much their numbers differ.

    What is not the same in all of them is named, and nothing else.
    """
    from atmosbox.cli.compare import compare as comparing

    comparing(
        files,
        out=out,
        format=None if format is None else format.value,
        theme=theme.value,
        force=force,
        as_json=as_json,
        quiet=quiet,
    )
