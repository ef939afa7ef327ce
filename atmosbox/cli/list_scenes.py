"""The command ``list``: list the scenes."""

from typing import Annotated

from atmosbox.cli.application import command
from atmosbox.cli.option import Json, switch
from atmosbox.cli.terminal import say, say_json, width
from atmosbox.text.report import scene_lines


@command("atmosbox list", "atmosbox list --names", "atmosbox list --json", name="list")
def list_scenes(
    names: Annotated[bool, switch("--names", "Print only the names, one per line.")] = False,
    as_json: Json = False,
) -> None:
    """List the scenes that come with atmosbox, in the order of teaching."""
    from atmosbox import scenarios

    found = scenarios.summaries()
    if as_json:
        parts = ("name", "summary", "level", "minutes")
        say_json({"scenes": [dict(zip(parts, (name, *each), strict=True)) for name, each in found.items()]})
    elif names:
        say("\n".join(found))
    else:
        lines = scene_lines(found, width())
        say("\n".join([*lines, "", "next: atmosbox info SCENE, or atmosbox run SCENE"]))
