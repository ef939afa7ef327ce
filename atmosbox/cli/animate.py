"""The command ``animate``: film a run."""

from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from atmosbox.cli.application import command
from atmosbox.cli.option import Output, RunFile, Theme, beside, switch
from atmosbox.cli.terminal import say
from atmosbox.text.progress import progress


@command(
    "atmosbox animate temperature.nc",
    "atmosbox animate lifting-dry.nc --format mp4 --theme slides --seconds 8",
    "atmosbox animate lifting-dry.nc --graphs --out lift.gif --force",
    out="The film.  [default: beside FILE, named after it]",
    quiet="Show no progress.",
)
def animate(
    file: RunFile,
    to: Output,
    format: Annotated[
        Literal["gif", "mp4"] | None,
        typer.Option(help="The format, where the name of the film does not say it; mp4 needs atmosbox[movie]."),
    ] = None,
    seconds: Annotated[
        float | None, typer.Option(metavar="S", help="Greatest length of the film, in seconds.  [default: 12]")
    ] = None,
    fps: Annotated[
        float | None,
        typer.Option(metavar="N", help="Frames per second.  [default: 10, or 20 if molecules move little in a frame]"),
    ] = None,
    graphs: Annotated[bool, switch("--graphs", "Film only the graphs, without the molecules.")] = False,
    theme: Theme = "notes",
) -> None:
    """Film a run: the molecules in their box, and the graphs of the scene.

    The molecules can be filmed if the run kept them: small runs do, others with --save-molecules.
    """
    from atmosbox.file.netcdf import read

    dataset = read(file)
    path = to.path(beside([file], format or "gif"))

    from atmosbox.film import save

    with progress(Path(file).name, quiet=to.quiet) as show:
        wanted: dict[str, Any] = {"theme": theme, "seconds": seconds, "fps": fps, "graphs": graphs, "force": to.force}
        path, _ = save(dataset, path, format, **wanted, progress=lambda done: show(done, "running"))
    say(str(path))
