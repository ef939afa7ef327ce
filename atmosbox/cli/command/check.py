"""The command ``check``."""

from __future__ import annotations

from typing import Annotated

import typer

from atmosbox.cli.application import app, examples
from atmosbox.cli.option import Json, Verbose
from atmosbox.cli.terminal import guarded


@app.command(
    epilog=examples(
        "atmosbox check lifting-dry.nc",
        "atmosbox check lifting-dry.nc --json",
        "atmosbox check --extremes",
        "atmosbox check --extremes --engine exact --only cradle",
    )
)
@guarded
def check(
    file: Annotated[
        str | None, typer.Argument(metavar="FILE", help="A file that `atmosbox run` has written.", show_default=False)
    ] = None,
    extremes: Annotated[
        bool, typer.Option("--extremes", help="Put the engines through boxes that break simulations.")
    ] = False,
    engine: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="With --extremes: an engine, with its options; any number of them."),
    ] = None,
    only: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="With --extremes: one of them; any number.")
    ] = None,
    every: Annotated[bool, typer.Option("--all", help="With --extremes: also those that take minutes.")] = False,
    as_json: Json = False,
    verbose: Verbose = False,
) -> None:
    """Verify the physics in a file, or the engines in extremes.

    Of a file: does the energy ledger close, does the run agree with theory, does the file keep to the CF
    conventions? With --extremes: what becomes of each engine where others hang, leak or lie? The exit status
    is 3 if anything fails.
    """
    from atmosbox.cli import check as checking

    if extremes:
        checking.check_extremes(file, engine, only, every=every, as_json=as_json)
    else:
        checking.check(file, as_json=as_json, misplaced=(("--engine", engine), ("--only", only), ("--all", every)))
