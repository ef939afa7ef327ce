"""The commands of the program, their arguments and options, as the program itself declares them."""

import re
from collections import Counter
from typing import Any

from jobs.registry import Findings, job, markdown
from typer.main import get_command

from atmosbox.cli import app

SAID = re.compile(r"\s*\[(default: )?([^\]]*)\]$")
"""What stands in brackets behind a help: the default, or that it must be given."""

OPTION = re.compile(r"(?<![\w`-])--[a-z][\w-]*")
HEAD = ["argument or option", "what it is", "if it is not given"]
COMMON = 3
"""An option that says the same in so many commands is explained once: that which most of them have."""


def commands() -> list[tuple[str, Any, Any]]:
    """Return name, command and context of each command, in the order in which ``--help`` lists them."""
    group: Any = get_command(app)
    top = group.context_class(group, info_name="atmosbox")
    named = [(name, group.get_command(top, name)) for name in group.list_commands(top)]
    return [(name, each, each.context_class(each, info_name=name, parent=top)) for name, each in named]


def shown(text: str) -> str:
    """Return a text of the program as a page shows it: its options set as what one types."""
    return OPTION.sub(r"`\g<0>`", " ".join(text.split()))


def told(command: Any) -> list[str]:
    """Return the paragraphs that a command says of itself."""
    return [shown(part) for part in (command.help or "").split("\n\n")]


def examples(command: Any) -> list[str]:
    """Return the examples that stand below a command's help."""
    return [line.strip() for line in (command.epilog or "").splitlines() if line.startswith("  ")]


def words(command: Any, context: Any) -> list[tuple[str, str, str]]:
    """Return what may stand behind a command, as rows of a table."""
    rows = []
    for parameter in command.get_params(context):
        typed, text = parameter.get_help_record(context)
        if typed == "--help":
            continue
        said = SAID.search(text)
        default = "–" if said is None else said[2] if said[1] else "must be given"
        name = typed.removesuffix(" <str>").removesuffix(" <list[str]>")
        rows.append((f"`{name}`", shown(SAID.sub("", text)), default))
    return rows


@job("commands", quick=True)
def reference(found: Findings) -> None:
    """Make the table of all commands, that of the options that many have, and the section of each command."""
    every = commands()
    found.table(
        ["command", "what it does"],
        [[f"[`atmosbox {name}`](#{name})", told(each)[0]] for name, each, _ in every],
        "list",
    )
    rows = {name: words(each, context) for name, each, context in every}
    often = Counter(row for each in rows.values() for row in each)
    most = {row[0]: row for row, times in reversed(often.most_common()) if times >= COMMON}
    common = [row for row in often if most.get(row[0]) == row]
    found.table(HEAD, common, "common")
    parts = []
    for name, each, _ in every:
        own = [row for row in rows[name] if row not in common]
        also = ", ".join(row[0] for row in rows[name] if row in common)
        parts += [f"### {name}", ""]
        parts += [line for paragraph in told(each) for line in (paragraph, "")]
        parts += [markdown(HEAD, own), ""] if own else []
        parts += [f"Also: {also}.", "", "```sh", *examples(each), "```", ""]
    found.text("\n".join(parts).rstrip(), key="reference")
