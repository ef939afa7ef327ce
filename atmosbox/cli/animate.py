"""The command ``animate``: film a run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from atmosbox.cli.application import command
from atmosbox.cli.option import Force, RunFile, Theme, Verbose, beside, chosen, out_option, quiet_option
from atmosbox.cli.terminal import say
from atmosbox.text.progress import progress


@command(
    "atmosbox animate temperature.nc",
    "atmosbox animate lifting-dry.nc --format mp4 --theme slides --seconds 8",
    "atmosbox animate lifting-dry.nc --graphs --out lift.gif --force",
)
def animate(
    file: RunFile,
    out: Annotated[str | None, out_option("The film.  [default: beside FILE, by its name]")] = None,
    format: Annotated[
        Literal["gif", "mp4"] | None,
        typer.Option(help="The format, where the name of the film does not say it; mp4 needs atmosbox[movie]."),
    ] = None,
    seconds: Annotated[
        float | None,
        typer.Option(metavar="S", help="Greatest length of the film, in seconds.  [default: 12]", show_default=False),
    ] = None,
    fps: Annotated[
        float | None,
        typer.Option(
            metavar="N", help="Frames per second.  [default: 10, or 20 where motion is smooth]", show_default=False
        ),
    ] = None,
    graphs: Annotated[bool, typer.Option("--graphs", help="Film only the graphs, without the molecules.")] = False,
    theme: Theme = "notes",
    force: Force = False,
    quiet: Annotated[bool, quiet_option("Show no progress.")] = False,
    verbose: Verbose = False,
) -> None:
    """Film a run: the molecules in their box, and the graphs of the scene.

    The molecules can be filmed if the run kept them: small runs do, others with --save-molecules.
    """
    from atmosbox.file.netcdf import read

    dataset = read(file)
    path = chosen(out, beside([file], format or "gif"), force=force, quiet=quiet)

    from atmosbox.film import save

    with progress(Path(file).name, quiet=quiet) as show:
        path, _ = save(
            dataset,
            path,
            format,
            theme=theme,
            seconds=seconds,
            fps=fps,
            graphs=graphs,
            force=force,
            progress=lambda done: show(done, "running"),
        )
    say(str(path))
