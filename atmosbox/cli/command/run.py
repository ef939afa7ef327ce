"""The command ``run``."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from atmosbox.cli.application import WORDS, app, examples
from atmosbox.cli.option import Force, Json, SceneName, Verbose
from atmosbox.cli.terminal import guarded


@app.command(
    epilog=examples(
        "atmosbox run lifting-dry",
        "atmosbox run lifting-dry --set temperature=25degC --set molecules=2000 --seed 7 --out warm.nc",
        "atmosbox run --from warm.nc --set temperature=5degC --out cold.nc",
        "atmosbox run --config lift.toml --dry-run",
        "atmosbox run temperature --accuracy sketch",
    )
)
@guarded
def run(
    ctx: typer.Context,
    scene: Annotated[str | None, SceneName] = None,
    values: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="NAME=VALUE",
            help="A setting, with its unit: temperature=25degC; any number of them.",
        ),
    ] = None,
    config: Annotated[
        str | None, typer.Option(metavar="FILE", help="Settings, and perhaps the scene, from a TOML file.")
    ] = None,
    source: Annotated[
        str | None,
        typer.Option("--from", metavar="FILE", help="Scene and settings of an earlier run."),
    ] = None,
    seed: Annotated[
        str | None, typer.Option(metavar="N", help="Seed of the random numbers: the same seed, the same run.")
    ] = None,
    engine: Annotated[
        str | None,
        typer.Option(
            metavar="NAME[:OPTION=VALUE,...]",
            help="What lets time pass: exact, or an approximation such as stepped:delta=0.02.  [default: exact]",
        ),
    ] = None,
    accuracy: Annotated[
        str | None,
        typer.Option(
            metavar="WISH",
            help="Picks engine and settings from what was measured: sketch, lecture, reference, or the largest "
            "error of a run, such as 0.5K or 2%.",
        ),
    ] = None,
    out: Annotated[
        str | None, typer.Option(metavar="FILE", help="The netCDF file.  [default: SCENE.nc in this folder]")
    ] = None,
    force: Force = False,
    save_molecules: Annotated[
        bool, typer.Option("--save-molecules", help="Save where every molecule is, in every frame.")
    ] = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Show what would run, compute nothing and write nothing.")
    ] = False,
    as_json: Json = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Print the path of the file, no more.")] = False,
    verbose: Verbose = False,
) -> None:
    """Run a scene, and lay what comes out beside what theory says.

    Where a setting is given more than once, --seed counts before --set, --set before --config, and --config
    before --from. Ctrl-C stops a run and keeps what is complete in NAME.part.nc.
    """
    from atmosbox.cli import run as running
    from atmosbox.cli.request import Request

    request = Request(scene, values or (), config, source, seed, save_molecules, engine, accuracy)
    running.run(
        request,
        words=["atmosbox", *ctx.meta.get(WORDS, sys.argv[1:])],
        out=out,
        force=force,
        quiet=quiet,
        verbose=verbose,
        as_json=as_json,
        dry_run=dry_run,
    )
