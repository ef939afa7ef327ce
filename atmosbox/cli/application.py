"""The Typer application that all commands belong to, and the layout of its help."""

import copy
import functools
import inspect
import shlex
import sys
from collections.abc import Callable
from typing import Annotated, Any, get_type_hints

import typer
from typer.core import TyperGroup

from atmosbox.cli.option import Output, Result, Sought, Verbose
from atmosbox.cli.terminal import guarded, say
from atmosbox.cli.usage import Command, OneSentence, UsageError, command_refusal

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


def command(*examples: str, name: str | None = None, **helps: str) -> Callable[[Callable[..., None]], Any]:
    """Return a decorator that makes a function a command whose errors end it as `guarded` says.

    A parameter of the type `Sought`, `Output` or `Result` stands for the options of that group; `helps` has the help
    of those that mean something else in each command. Every command has ``--verbose``.
    """

    def added(function: Callable[..., None]) -> Any:
        return app.command(name, cls=Command, epilog=_examples(*examples))(guarded(_ungrouped(function, helps)))

    return added


def _ungrouped(function: Callable[..., None], helps: dict[str, str]) -> Callable[..., None]:
    """Return a function that takes the options of a group one by one."""
    own = inspect.signature(function, eval_str=True).parameters
    groups: dict[str, Any] = {name: p.annotation for name, p in own.items() if p.annotation in (Sought, Output, Result)}
    flat: dict[str, tuple[Any, Any]] = {}
    for name, each in sorted(own.items(), key=lambda item: item[1].annotation in (Output, Result)):  # they come last
        group = groups.get(name)
        told = {name: each.annotation} if group is None else get_type_hints(group, include_extras=True)
        flat |= {field: (kind, getattr(group, field, each.default)) for field, kind in told.items()}
    flat["verbose"] = flat.pop("verbose", (Verbose, False))
    for name, help in helps.items():
        kind, default = flat[name]
        option = copy.copy(kind.__metadata__[0])
        option.help = help
        flat[name] = Annotated[kind.__origin__, option], default

    @functools.wraps(function)
    def called(**given: Any) -> None:
        grouped = {
            name: group(**{field: given.pop(field) for field in group.__dataclass_fields__})
            for name, group in groups.items()
        }
        function(**grouped, **{name: value for name, value in given.items() if name in own})

    parameters = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=kind)
        for name, (kind, default) in flat.items()
    ]
    called.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    return called
