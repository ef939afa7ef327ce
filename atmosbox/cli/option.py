"""The options and arguments that several commands share."""

from typing import Annotated, Any, Literal

import typer

Format = Literal["png", "svg", "pdf"]
"""The formats of a figure."""
Theme = Annotated[Literal["notes", "slides"], typer.Option(help="For a page or for a screen.")]
"""What a figure is for."""


def _completed(incomplete: str) -> list[str]:
    """Return the scenes whose names begin with the letters typed so far."""
    from atmosbox import scenarios

    return [name for name in scenarios.names() if name.startswith(incomplete.replace("_", "-"))]


def out_option(help: str) -> Any:
    """Return the option ``--out`` of a command that writes a file."""
    return typer.Option("--out", "-o", metavar="FILE", help=help)


def quiet_option(help: str) -> Any:
    """Return the option ``--quiet``."""
    return typer.Option("--quiet", help=help)


SceneName = typer.Argument(
    metavar="SCENE", help="A name that `atmosbox list` shows, or the path of your own: ./my_scene.py.",
    autocompletion=_completed, show_default=False,
)  # fmt: skip
RunFile = Annotated[str, typer.Argument(metavar="FILE", help="A file that `atmosbox run` has written.")]
Values = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="A setting with its unit, as temperature=25degC; repeatable. --set may be left out.",
    ),
]
ValuesOfAll = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="NAME=VALUE", help="A setting for all runs; repeatable. --set may be left out."),
]
Config = Annotated[
    str | None, typer.Option("--config", metavar="FILE", help="Settings, and perhaps the scene, from a TOML file.")
]
Source = Annotated[str | None, typer.Option("--from", metavar="FILE", help="Scene and settings of an earlier run.")]
Seed = Annotated[
    str | None,
    typer.Option("--seed", metavar="N", help="Seed of the random numbers: the same seed, the same run."),
]
Engine = Annotated[
    str | None,
    typer.Option(
        "--engine",
        metavar="NAME[:OPTION=VALUE,...]",
        help="The engine: exact, or an approximate one such as stepped:delta=0.02.  [default: that of the scene]",
    ),
]
Accuracy = Annotated[
    str | None,
    typer.Option(
        "--accuracy",
        metavar="TARGET",
        help="Pick engine and settings by their measured errors: sketch, lecture, reference, or the largest error of "
        "a run, such as 0.5K or 2%.",
    ),
]
Language = Annotated[
    Literal["auto", "en", "de", "es"],
    typer.Option("--language", help="Words of the page; auto takes the reader's browser's language."),
]
PageTheme = Annotated[
    Literal["auto", "light", "dark"], typer.Option(help="Light or dark; auto takes what the reader's computer prefers.")
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
Verbose = Annotated[bool, typer.Option("--verbose", help="Say more, with the traceback of a bug.")]
Force = Annotated[bool, typer.Option("--force", help="Replace the file if there is one.")]
