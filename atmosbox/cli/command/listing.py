"""The commands ``list`` and ``info``."""

from __future__ import annotations

from typing import Annotated

import typer

from atmosbox.cli.application import app, examples
from atmosbox.cli.option import Json, SceneName, Verbose
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
