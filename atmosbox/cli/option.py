"""The options and arguments that several commands share."""

from enum import StrEnum
from typing import Annotated

import typer

__all__ = ["Force", "Format", "Json", "RunFile", "SceneName", "Theme", "Verbose"]


class Format(StrEnum):
    """The formats of a figure."""

    png = "png"
    svg = "svg"
    pdf = "pdf"


class Theme(StrEnum):
    """What a figure is for: a page, or a screen."""

    notes = "notes"
    slides = "slides"


def _completed(incomplete: str) -> list[str]:
    """Return the scenes whose names begin like what is typed."""
    from atmosbox import scenarios

    return [name for name in scenarios.names() if name.startswith(incomplete.replace("_", "-"))]


SceneName = typer.Argument(
    metavar="SCENE", help="A name that `atmosbox list` shows, or the path of your own: ./my_scene.py.",
    autocompletion=_completed, show_default=False,
)  # fmt: skip
RunFile = Annotated[str, typer.Argument(metavar="FILE", help="A file that `atmosbox run` has written.")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
Verbose = Annotated[bool, typer.Option("--verbose", help="Say more, with the traceback of a bug.")]
Force = Annotated[bool, typer.Option("--force", help="Replace the file if there is one.")]
