"""The command ``plot``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from atmosbox.cli.application import app, examples
from atmosbox.cli.option import Force, Format, RunFile, Theme, Verbose
from atmosbox.cli.terminal import guarded, say


@app.command(
    epilog=examples(
        "atmosbox plot lifting-dry.nc",
        "atmosbox plot lifting-dry.nc --format pdf --theme slides",
        "atmosbox plot lifting-dry.nc --out figures/lift.svg --force",
    )
)
@guarded
def plot(
    file: RunFile,
    out: Annotated[
        str | None, typer.Option(metavar="FILE", help="The figure.  [default: beside FILE, by its name]")
    ] = None,
    format: Annotated[
        Format | None, typer.Option(help="The format, where the name of the figure does not say it.")
    ] = None,
    theme: Annotated[Theme, typer.Option(help="For a page or for a screen.")] = Theme.notes,
    force: Force = False,
    verbose: Verbose = False,
) -> None:
    """Draw the figure of a run."""
    from atmosbox.file.netcdf import read

    dataset = read(file)
    kind = None if format is None else format.value
    path = Path(file).with_suffix(f".{kind or 'png'}") if out is None else Path(out)

    from atmosbox.plot import save

    say(str(save(dataset, path, kind, theme=theme.value, force=force)))
