"""The command ``plot``: the figure of a run."""

from __future__ import annotations

from typing import Annotated

import typer

from atmosbox.cli.application import command
from atmosbox.cli.option import Force, Format, RunFile, Theme, Verbose, beside, chosen, out_option, quiet_option
from atmosbox.cli.terminal import say


@command(
    "atmosbox plot lifting-dry.nc",
    "atmosbox plot lifting-dry.nc --format pdf --theme slides",
    "atmosbox plot lifting-dry.nc --out figures/lift.svg --force",
    "atmosbox plot lifting-dry.nc --with-box",
)
def plot(
    file: RunFile,
    out: Annotated[str | None, out_option("The figure.  [default: beside FILE, by its name]")] = None,
    format: Annotated[
        Format | None, typer.Option(help="The format, where the name of the figure does not say it.")
    ] = None,
    theme: Theme = "notes",
    with_box: Annotated[
        bool,
        typer.Option(
            "--with-box",
            help="Draw the molecules in their box, at the start, half-way and at the end, above the graphs.",
        ),
    ] = False,
    force: Force = False,
    quiet: Annotated[bool, quiet_option("Print only the path of the figure.")] = False,
    verbose: Verbose = False,
) -> None:
    """Draw the figure of a run.

    The box can be drawn if the run kept its molecules: small runs do, others with --save-molecules.
    """
    from atmosbox.file.netcdf import read

    dataset = read(file)
    path = chosen(out, beside([file], format or "png"), force=force, quiet=quiet)

    from atmosbox.plot import save

    say(str(save(dataset, path, format, theme=theme, force=force, with_box=with_box)))
