"""The command ``live``."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from atmosbox.cli.application import WORDS, app, examples
from atmosbox.cli.option import SceneName, Verbose
from atmosbox.cli.terminal import guarded


@app.command(
    epilog=examples(
        "atmosbox live temperature",
        "atmosbox live lifting-dry --set molecules=2000 --no-browser",
        "atmosbox live atmosphere --port 9000 --out column.nc",
    )
)
@guarded
def live(
    ctx: typer.Context,
    scene: Annotated[str | None, SceneName] = None,
    values: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="A setting, with its unit: temperature=25degC."),
    ] = None,
    config: Annotated[
        str | None, typer.Option(metavar="FILE", help="Settings, and perhaps the scene, from a TOML file.")
    ] = None,
    source: Annotated[
        str | None, typer.Option("--from", metavar="FILE", help="Scene and settings of an earlier run.")
    ] = None,
    seed: Annotated[str | None, typer.Option(metavar="N", help="Seed of the random numbers.")] = None,
    engine: Annotated[
        str | None,
        typer.Option(metavar="NAME[:OPTION=VALUE,...]", help="What lets time pass.  [default: exact]"),
    ] = None,
    accuracy: Annotated[
        str | None, typer.Option(metavar="WISH", help="Picks engine and settings: sketch, lecture, reference.")
    ] = None,
    out: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="Where the record button writes.  [default: SCENE-live.nc in this folder]"),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Recordings may replace files.")] = False,
    save_molecules: Annotated[
        bool, typer.Option("--save-molecules", help="Recordings say where every molecule is, for atmosbox view.")
    ] = False,
    host: Annotated[
        str, typer.Option(metavar="ADDRESS", help="Who can reach the page; by default this computer alone.")
    ] = "127.0.0.1",
    port: Annotated[
        str | None, typer.Option(metavar="N", help="Port of the page.  [default: the first free one from 8642 on]")
    ] = None,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Only say where the page is.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Print the address, no more.")] = False,
    verbose: Verbose = False,
) -> None:
    """Play with a scene on a local page: change one thing at a time, and see what follows.

    The page shows molecules and graphs while the engine runs. Its record button writes the same netCDF file as
    run. While no browser looks, the box rests, unless it is being recorded.
    """
    from atmosbox.cli import live as living
    from atmosbox.cli.request import Request

    living.live(
        Request(scene, values or (), config, source, seed, save_molecules, engine, accuracy),
        words=["atmosbox", *ctx.meta.get(WORDS, sys.argv[1:])],
        out=out,
        force=force,
        host=host,
        port=port,
        browser=not no_browser,
        quiet=quiet,
    )
