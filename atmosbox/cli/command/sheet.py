"""The command ``sheet``."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from atmosbox.cli.application import app, examples
from atmosbox.cli.option import Force, SceneName, Verbose
from atmosbox.cli.terminal import guarded


class SheetFormat(StrEnum):
    """The formats of a sheet."""

    pdf = "pdf"
    md = "md"


class Paper(StrEnum):
    """The papers of a sheet."""

    a4 = "a4"
    letter = "letter"


@app.command(
    epilog=examples(
        "atmosbox sheet lifting-dry",
        "atmosbox sheet lifting-dry --seed 7 --answers",
        "atmosbox sheet temperature --set temperature=20degC --paper letter --out class.pdf",
        "atmosbox sheet ./my_scene.py --format md",
    )
)
@guarded
def sheet(
    scene: Annotated[str, SceneName],
    answers: Annotated[
        bool, typer.Option("--answers", help="Make its runs, fill in the table and answer the questions.")
    ] = False,
    values: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="A setting for all runs of the sheet; any number of them."),
    ] = None,
    seed: Annotated[
        str | None, typer.Option(metavar="N", help="Seed of the runs: all students get the same numbers.")
    ] = None,
    engine: Annotated[
        str | None,
        typer.Option(metavar="NAME[:OPTION=VALUE,...]", help="What lets time pass in the runs.  [default: exact]"),
    ] = None,
    paper: Annotated[Paper, typer.Option(help="The size of the pages.")] = Paper.a4,
    format: Annotated[
        SheetFormat | None, typer.Option(help="The format, where the name of the file does not say it.")
    ] = None,
    out: Annotated[
        str | None,
        typer.Option(
            metavar="FILE", help="The sheet.  [default: SCENE-sheet.pdf, or SCENE-answers.pdf, in this folder]"
        ),
    ] = None,
    force: Force = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Show no progress and no remarks.")] = False,
    verbose: Verbose = False,
) -> None:
    """Make a worksheet to hand out: predict, run, measure, ask why.

    The words of a sheet stand beside its scene, in SCENE.sheet.toml; a scene of your own without such a file gets a
    sheet from what a run of it reports.
    """
    from atmosbox.cli.sheet import sheet as making

    making(
        scene,
        values=values or (),
        seed=seed,
        engine=engine,
        answers=answers,
        paper=paper.value,
        format=None if format is None else format.value,
        out=out,
        force=force,
        quiet=quiet,
    )
