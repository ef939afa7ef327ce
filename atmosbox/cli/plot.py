"""The command ``plot``: the figure of a run."""

from typing import Annotated

from atmosbox.cli.application import command
from atmosbox.cli.option import FigureFormat, Output, RunFile, Theme, beside, switch
from atmosbox.cli.terminal import say


@command(
    "atmosbox plot lifting-dry.nc",
    "atmosbox plot lifting-dry.nc --format pdf --theme slides",
    "atmosbox plot lifting-dry.nc --out figures/lift.svg --force",
    "atmosbox plot lifting-dry.nc --with-box",
    out="The figure.  [default: beside FILE, named after it]",
    quiet="Print only the path of the figure.",
)
def plot(
    file: RunFile,
    to: Output,
    format: FigureFormat = None,
    theme: Theme = "notes",
    with_box: Annotated[
        bool,
        switch(
            "--with-box", "Draw the molecules in their box, at the start, half-way and at the end, above the graphs."
        ),
    ] = False,
) -> None:
    """Draw the figure of a run.

    The box can be drawn if the run kept its molecules: small runs do, others with --save-molecules.
    """
    from atmosbox.file.netcdf import read

    dataset = read(file)
    path = to.path(beside([file], format or "png"))

    from atmosbox.plot import save

    say(str(save(dataset, path, format, theme=theme, force=to.force, with_box=with_box)))
