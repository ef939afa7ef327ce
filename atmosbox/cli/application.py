"""The Typer application that all commands belong to, and the layout of its help."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable
from typing import Annotated, Any, ParamSpec, TypeVar

import typer
from typer.core import TyperGroup

from atmosbox.cli.terminal import guarded, say
from atmosbox.cli.usage import Command, OneSentence, UsageError, command_refusal

P = ParamSpec("P")
R = TypeVar("R")

_WORDS = "atmosbox.words"
_WIDEST_HELP = 120  # columns: longer lines are hard to read


class _Group(TyperGroup):
    """A group that remembers what was typed; its help lists each command with its full summary."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        ctx.meta[_WORDS] = list(args)
        try:
            return super().parse_args(ctx, args)
        except UsageError as error:
            if not ctx.meta[_WORDS]:  # the help is shown
                raise
            said = str(error.format_message()).rstrip(".")
            raise OneSentence(f"{said}: type atmosbox --help to see what may be given.") from error

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        if self.get_command(ctx, args[0]) is None and not ctx.resilient_parsing:
            raise command_refusal(args, self.list_commands(ctx))
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        with formatter.section("Commands"):
            named = [(name, self.get_command(ctx, name)) for name in self.list_commands(ctx)]
            formatter.write_dl([(name, each.get_short_help_str(1000)) for name, each in named if each is not None])


def typed(ctx: typer.Context) -> str:
    """Return the command as typed, for the history of a file; bytes that are not text are escaped."""
    words = ["atmosbox", *ctx.meta.get(_WORDS, sys.argv[1:])]
    return shlex.join(words).encode("utf-8", "backslashreplace").decode("utf-8")


def _examples(*lines: str) -> str:
    """Return the examples to print below a help text, one in each line."""
    return "\b\nExamples:\n" + "\n".join(f"  {line}" for line in lines)


def _version(wanted: bool) -> None:
    """Print the version and exit."""
    if wanted:
        from atmosbox.version import __version__

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
    rich_markup_mode=None,  # plain help appears without delay, fits every terminal and can be searched
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": _WIDEST_HELP},
)


@app.callback()
def _atmosbox(
    version: Annotated[
        bool, typer.Option("--version", help="Show the version and exit.", callback=_version, is_eager=True)
    ] = False,
) -> None:
    """Take the options that stand before a command."""


def command(*examples: str, name: str | None = None) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Return a decorator that makes a function a command whose errors end it as `guarded` says."""

    def added(function: Callable[P, R]) -> Callable[P, R]:
        return app.command(name, cls=Command, epilog=_examples(*examples))(guarded(function))

    return added
