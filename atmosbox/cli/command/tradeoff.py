"""The command ``tradeoff``."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from atmosbox.cli.application import WORDS, app, examples
from atmosbox.cli.option import Force, Json, SceneName, Verbose
from atmosbox.cli.terminal import guarded


@app.command(
    epilog=examples(
        "atmosbox tradeoff lifting-dry",
        "atmosbox tradeoff atmosphere --budget 5min --set height=15km --out trade.nc",
    )
)
@guarded
def tradeoff(
    ctx: typer.Context,
    scene: Annotated[str, SceneName],
    values: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="A setting for all runs; any number of them."),
    ] = None,
    budget: Annotated[str, typer.Option(metavar="TIME", help="For how long to measure.")] = "60s",
    seed: Annotated[str | None, typer.Option(metavar="N", help="The first seed.  [default: 1]")] = None,
    out: Annotated[
        str | None,
        typer.Option(
            metavar="FILE", help="The netCDF file; .csv and .png stand beside it.  [default: SCENE-tradeoff.nc]"
        ),
    ] = None,
    force: Force = False,
    as_json: Json = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Print the path of the file, no more.")] = False,
    verbose: Verbose = False,
) -> None:
    """Measure speed against accuracy: a scene through engines and settings, errors beside seconds.

    Every way of running is run again and again, with other seeds, while the budget lasts. Ctrl-C ends it
    early and keeps what was measured.
    """
    from atmosbox.cli.tradeoff import tradeoff as measuring

    measuring(
        scene,
        values=values or (),
        budget=budget,
        seed=seed,
        out=out,
        force=force,
        as_json=as_json,
        quiet=quiet,
        words=["atmosbox", *ctx.meta.get(WORDS, sys.argv[1:])],
    )
