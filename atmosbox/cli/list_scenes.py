"""The command ``list``: which scenes there are."""

from __future__ import annotations

import ast
import importlib.util
from importlib.abc import InspectLoader
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
    found = summaries()
    if as_json:
        say_json({"scenes": [{"name": name, "summary": summary} for name, summary in found.items()]})
    elif names:
        say("\n".join(found))
    else:
        lines = table(["", ""], list(found.items()), width())
        say("\n".join([*lines, "", "next: atmosbox info SCENE, or atmosbox run SCENE"]))


def summaries() -> dict[str, str]:
    """Return the first line of each scene's story by its name; no scene is imported for it.

    Examples
    --------
    >>> summaries()["lifting-dry"]
    'A parcel of dry air rises and cools.'
    """
    from atmosbox import scenarios

    found = {}
    for name in scenarios.names():
        spec = importlib.util.find_spec(f"{scenarios.__name__}.{name.replace('-', '_')}")
        source = None
        if spec is not None and isinstance(spec.loader, InspectLoader):
            source = spec.loader.get_source(spec.name)
        text = ast.get_docstring(ast.parse(source or "")) or ""
        found[name] = text.partition("\n\n")[0].replace("\n", " ")
    return found
