"""The command ``list``: list the scenes."""

from __future__ import annotations

from typing import Annotated

import typer

from atmosbox.cli.application import app, examples
from atmosbox.cli.option import Json, Verbose
from atmosbox.cli.terminal import guarded, say, say_json, width
from atmosbox.text.table import table


@app.command("list", epilog=examples("atmosbox list", "atmosbox list --names", "atmosbox list --json"))
@guarded
def list_scenes(
    names: Annotated[bool, typer.Option("--names", help="Print the names alone, one in a line.")] = False,
    as_json: Json = False,
    verbose: Verbose = False,
) -> None:
    """List the scenes that come with atmosbox."""
    from atmosbox import scenarios

    found = scenarios.summaries()
    if as_json:
        say_json({"scenes": [{"name": name, "summary": summary} for name, summary in found.items()]})
    elif names:
        say("\n".join(found))
    else:
        lines = table(["", ""], list(found.items()), width())
        say("\n".join([*lines, "", "next: atmosbox info SCENE, or atmosbox run SCENE"]))
