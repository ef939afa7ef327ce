"""The command ``info``: the description and the settings of a scene."""

import shlex
from typing import Annotated

from atmosbox.cli.application import command
from atmosbox.cli.option import Json, SceneName
from atmosbox.cli.terminal import prints_to_stderr, say, say_json, width
from atmosbox.text.table import story, table, wrapped


@command("atmosbox info lifting-dry", "atmosbox info ./my_scene.py --json")
def info(scene: Annotated[str, SceneName], as_json: Json = False) -> None:
    """Show what a scene is about and what may be set."""
    from atmosbox.simulation import runner
    from atmosbox.simulation.expected_time import expected_time, in_words
    from atmosbox.text.report import parameter_lines

    with prints_to_stderr():
        prepared = runner.prepare(scene, {})
        card = runner.card(prepared)
    expected = expected_time(prepared)
    if as_json:
        parts = ("name", "unit", "default", "low", "high", "choices", "kind", "help")
        parameters = [{part: getattr(each, part) for part in parts} for each in card.parameters]
        record = card._asdict() | {"facts": dict(card.facts), "parameters": parameters}
        say_json(record | {"expected_seconds": expected})
        return
    columns = width()
    lines = [
        *wrapped(f"{card.scene}: {card.title}", columns),
        "",
        *story(card.story, columns),
        "",
        *table(["", ""], [*card.facts, *([] if expected is None else [("a run takes", in_words(expected))])], columns),
        "",
        *parameter_lines(card.parameters, columns),
        "",
        f"next: atmosbox run {shlex.quote(card.scene)}",
    ]
    say("\n".join(lines))
