"""The commands of atmosbox and their options."""

from __future__ import annotations

import sys
import warnings
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from atmosbox.cli.terminal import guarded, say, say_json, width

_WORDS = "atmosbox.words"


class Format(StrEnum):
    """The formats of a figure."""

    png = "png"
    svg = "svg"
    pdf = "pdf"


class Theme(StrEnum):
    """What a figure is for: a page, or a screen."""

    notes = "notes"
    slides = "slides"


class _Group(TyperGroup):
    """A group that remembers what was typed, for the history of a file."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        ctx.meta[_WORDS] = list(args)
        return super().parse_args(ctx, args)


def _examples(*lines: str) -> str:
    """Return examples that stand below a help, one in a line."""
    return "\b\nExamples:\n" + "\n".join(f"  {line}" for line in lines)


def _completed(incomplete: str) -> list[str]:
    """Return the scenes whose names begin like what is typed."""
    from atmosbox import scenarios

    return [name for name in scenarios.names() if name.startswith(incomplete.replace("_", "-"))]


def _version(wanted: bool) -> None:
    """Say the version and end."""
    if wanted:
        from atmosbox import __version__

        say(f"atmosbox {__version__}")
        raise typer.Exit


app = typer.Typer(
    name="atmosbox",
    cls=_Group,
    help="An atmosphere in a box: textbook meteorology that emerges from colliding molecules.",
    epilog=_examples(
        "atmosbox list                    the scenes",
        "atmosbox info lifting-dry        what a scene shows, and what may be set",
        "atmosbox run lifting-dry         run it",
        "atmosbox plot lifting-dry.nc     draw it",
    ),
    no_args_is_help=True,
    rich_markup_mode=None,  # plain help is there at once, fits every terminal and can be searched
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

SceneName = typer.Argument(
    metavar="SCENE", help="A name that `atmosbox list` shows, or the path of your own: ./my_scene.py.",
    autocompletion=_completed, show_default=False,
)  # fmt: skip
RunFile = Annotated[str, typer.Argument(metavar="FILE", help="A file that `atmosbox run` has written.")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
Verbose = Annotated[bool, typer.Option("--verbose", help="Say more, with the traceback of a bug.")]
Force = Annotated[bool, typer.Option("--force", help="Replace the file if there is one.")]


@app.callback()
def _atmosbox(
    version: Annotated[
        bool, typer.Option("--version", help="Show the version and exit.", callback=_version, is_eager=True)
    ] = False,
) -> None:
    """Take the options that stand before a command."""


@app.command(
    "list", epilog=_examples("atmosbox list", "atmosbox list --names", "atmosbox list --json")
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


@app.command(epilog=_examples("atmosbox info lifting-dry", "atmosbox info ./my_scene.py --json"))
@guarded
def info(scene: Annotated[str, SceneName], as_json: Json = False, verbose: Verbose = False) -> None:
    """Show what a scene is about and what may be set."""
    from atmosbox.cli.scene import describe

    describe(scene, as_json=as_json)


@app.command(
    epilog=_examples(
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
        words=["atmosbox", *ctx.meta.get(_WORDS, sys.argv[1:])],
        out=out,
        force=force,
        quiet=quiet,
        verbose=verbose,
        as_json=as_json,
        dry_run=dry_run,
    )


@app.command(
    epilog=_examples(
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
        words=["atmosbox", *ctx.meta.get(_WORDS, sys.argv[1:])],
    )


@app.command(
    epilog=_examples(
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
    epilog=_examples(
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
