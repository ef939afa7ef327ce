"""What ``atmosbox list`` and ``atmosbox info`` do: say which scenes there are, and what one is about."""

from __future__ import annotations

import ast
import contextlib
import importlib.util
import shlex
import sys
from importlib.abc import InspectLoader

from atmosbox.cli.report import card_json, parameter_lines
from atmosbox.cli.table import story, table
from atmosbox.cli.terminal import say, say_json, width


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


def describe(scene: str, *, as_json: bool) -> None:
    """Say what a scene is about: its story, its facts and its settings.

    Parameters
    ----------
    scene
        Its name, or the path of its file.
    as_json
        Whether to say it as JSON.

    Raises
    ------
    AtmosboxError
        If there is no such scene, or its file cannot be run.
    """
    from atmosbox.simulation import runner

    with contextlib.redirect_stdout(sys.stderr):  # what a scene of one's own prints is no result
        card = runner.card(runner.prepare(scene, {}))
    if as_json:
        say_json(card_json(card))
        return
    columns = width()
    lines = [
        f"{card.scene}: {card.title}",
        "",
        *story(card.story, columns),
        "",
        *table(["", ""], card.facts, columns),
        "",
        *parameter_lines(card.parameters, columns),
        "",
        f"next: atmosbox run {shlex.quote(card.scene)}",
    ]
    say("\n".join(lines))
