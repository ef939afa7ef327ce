"""The commands of atmosbox and their options."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from typing import Annotated

import typer

from atmosbox.cli.application import WORDS, app, examples
from atmosbox.cli.option import Force, Format, Json, RunFile, SceneName, Theme, Verbose
from atmosbox.cli.terminal import guarded, say, say_json, width


@app.command(
    "list", epilog=examples("atmosbox list", "atmosbox list --names", "atmosbox list --json")
)  # fmt: skip
@guarded
def list_scenes(
    names: Annotated[bool, typer.Option("--names", help="Print the names alone, one in a line.")] = False,
    as_json: Json = False,
    verbose: Verbose = False,
) -> None:
    """List the scenes that come with atmosbox."""
    from atmosbox.cli.scene import summaries
    from atmosbox.cli.table import table

    found = summaries()
    if as_json:
        say_json({"scenes": [{"name": name, "summary": summary} for name, summary in found.items()]})
    elif names:
        say("\n".join(found))
    else:
        lines = table(["", ""], list(found.items()), width())
        say("\n".join([*lines, "", "next: atmosbox info SCENE, or atmosbox run SCENE"]))


@app.command(epilog=examples("atmosbox info lifting-dry", "atmosbox info ./my_scene.py --json"))
@guarded
def info(scene: Annotated[str, SceneName], as_json: Json = False, verbose: Verbose = False) -> None:
    """Show what a scene is about and what may be set."""
    from atmosbox.cli.scene import describe

    describe(scene, as_json=as_json)


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


@app.command(
    epilog=examples(
        "atmosbox plot lifting-dry.nc",
        "atmosbox plot lifting-dry.nc --format pdf --theme slides",
        "atmosbox plot lifting-dry.nc --out figures/lift.svg --force",
    )
)
@guarded
def plot(
    file: RunFile,
    out: Annotated[
        str | None, typer.Option(metavar="FILE", help="The figure.  [default: beside FILE, by its name]")
    ] = None,
    format: Annotated[
        Format | None, typer.Option(help="The format, where the name of the figure does not say it.")
    ] = None,
    theme: Annotated[Theme, typer.Option(help="For a page or for a screen.")] = Theme.notes,
    force: Force = False,
    verbose: Verbose = False,
) -> None:
    """Draw the figure of a run."""
    from atmosbox.output import read

    dataset = read(file)
    kind = None if format is None else format.value
    path = Path(file).with_suffix(f".{kind or 'png'}") if out is None else Path(out)

    from atmosbox.plot import save

    say(str(save(dataset, path, kind, theme=theme.value, force=force)))


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


def main() -> None:
    """Run the command line; this is what the program atmosbox calls.

    Raises
    ------
    SystemExit
        With the status of the command.
    """
    warnings.formatwarning = lambda message, *rest, **named: f"warning: {message}\n"
    try:
        app(prog_name="atmosbox")
    except KeyboardInterrupt:
        sys.exit(130)
