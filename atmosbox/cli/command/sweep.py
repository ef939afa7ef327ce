"""The command ``sweep``."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from atmosbox.cli.application import WORDS, app, examples
from atmosbox.cli.option import Force, Json, SceneName, Verbose
from atmosbox.cli.terminal import guarded


@app.command(
    epilog=examples(
        "atmosbox sweep condensation --vary temperature=-10degC:40degC:6 --members 8",
        "atmosbox sweep temperature --vary molecules=50:5000:5log --vary start=equal,maxwell",
        "atmosbox sweep lifting-dry --vary ascent=50,100,200,400 --scheduler tcp://10.0.0.1:8786",
    )
)
@guarded
def sweep(
    ctx: typer.Context,
    scene: Annotated[str, SceneName],
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=A:B:N",
            help="A setting that varies: N values from A to B, with Nlog at even ratios, or the values X,Y,Z; any "
            "number of them make a grid.",
        ),
    ] = None,
    members: Annotated[str, typer.Option(metavar="N", help="Number of runs at each point.")] = "1",
    values: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="A setting for all runs; any number of them."),
    ] = None,
    seed: Annotated[
        str | None, typer.Option(metavar="N", help="Seed, from which that of each run is made.  [default: 1]")
    ] = None,
    engine: Annotated[
        str | None,
        typer.Option(metavar="NAME[:OPTION=VALUE,...]", help="What lets time pass, as for run.  [default: exact]"),
    ] = None,
    accuracy: Annotated[
        str | None, typer.Option(metavar="WISH", help="Picks engine and settings at each point, as for run.")
    ] = None,
    jobs: Annotated[
        str | None, typer.Option(metavar="N", help="Number of processes.  [default: one for each core]")
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Run on the workers of this Dask scheduler: tcp://host:8786."),
    ] = None,
    out: Annotated[
        str | None, typer.Option(metavar="FILE", help="The netCDF file.  [default: SCENE-sweep.nc in this folder]")
    ] = None,
    force: Force = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Show the points, compute nothing and write nothing.")
    ] = False,
    as_json: Json = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Print the path of the file, no more.")] = False,
    verbose: Verbose = False,
) -> None:
    """Run a scene with many settings: how its numbers depend on them.

    Every run is saved as it ends. What was stopped, by Ctrl-C or by anything else, goes on where it was when the
    same is typed again. The file has the settings that vary as dimensions; `atmosbox plot` draws it.
    """
    from atmosbox.cli.sweep import sweep as sweeping

    sweeping(
        scene,
        vary=vary or (),
        members=members,
        values=values or (),
        seed=seed,
        engine=engine,
        accuracy=accuracy,
        jobs=jobs,
        scheduler=scheduler,
        out=out,
        force=force,
        dry_run=dry_run,
        as_json=as_json,
        quiet=quiet,
        words=["atmosbox", *ctx.meta.get(WORDS, sys.argv[1:])],
    )
