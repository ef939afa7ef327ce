"""The command ``view``."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from atmosbox.cli.application import app, examples
from atmosbox.cli.option import Force, Verbose
from atmosbox.cli.terminal import guarded


class Colours(StrEnum):
    """The colours of a page."""

    auto = "auto"
    light = "light"
    dark = "dark"


@app.command(
    epilog=examples(
        "atmosbox run temperature --save-molecules",
        "atmosbox view temperature.nc",
        "atmosbox view cold.nc warm.nc --out compared.html --theme dark",
    )
)
@guarded
def view(
    files: Annotated[
        list[str], typer.Argument(metavar="FILE [FILE]", help="One run or two, made with --save-molecules.")
    ],
    out: Annotated[
        str | None,
        typer.Option("--out", "-o", metavar="FILE", help="The page.  [default: beside FILE, by its name]"),
    ] = None,
    theme: Annotated[
        Colours, typer.Option(help="Light or dark; auto takes what the reader's computer prefers.")
    ] = Colours.auto,
    force: Force = False,
    verbose: Verbose = False,
) -> None:
    """Show the molecules of a run in three dimensions, with its graphs on the same clock.

    The page is one HTML file, which opens in a browser without a network. Two runs stand side by side and share
    the clock.
    """
    from atmosbox.cli.view import view as viewing

    viewing(files, out, theme=theme.value, force=force)
