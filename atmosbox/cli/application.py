"""The application that all commands belong to."""

from __future__ import annotations

from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from atmosbox.cli.terminal import say

__all__ = ["WORDS", "app", "examples"]

WORDS = "atmosbox.words"
"""Where the words are remembered that were typed."""


class _Group(TyperGroup):
    """A group that remembers what was typed, for the history of a file."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        ctx.meta[WORDS] = list(args)
        return super().parse_args(ctx, args)


def examples(*lines: str) -> str:
    """Return examples that stand below a help, one in a line."""
    return "\b\nExamples:\n" + "\n".join(f"  {line}" for line in lines)


def _version(wanted: bool) -> None:
    """Say the version and end."""
    if wanted:
        from atmosbox.version import __version__

        say(f"atmosbox {__version__}")
        raise typer.Exit


app = typer.Typer(
    name="atmosbox",
    cls=_Group,
    help="An atmosphere in a box: textbook meteorology that emerges from colliding molecules.",
    epilog=examples(
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


@app.callback()
def _atmosbox(
    version: Annotated[
        bool, typer.Option("--version", help="Show the version and exit.", callback=_version, is_eager=True)
    ] = False,
) -> None:
    """Take the options that stand before a command."""
