"""The commands of the program, their arguments and options, as the program itself declares them."""

import re
from typing import Any

from jobs.registry import Findings, job, markdown
from typer.main import get_command

from atmosbox.cli import app

SAID = re.compile(r"\s*\[(default: )?([^\]]*)\]$")
"""What stands in brackets behind a help: the default, or that it must be given."""

OPTION = re.compile(r"(?<![\w`-])--[a-z][\w-]*")


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


def words(command: Any, context: Any) -> str:
    """Return the table of what may stand behind a command."""
    rows = []
    for parameter in command.get_params(context):
        typed, text = parameter.get_help_record(context)
        if typed == "--help":
            continue
        said = SAID.search(text)
        default = "–" if said is None else said[2] if said[1] else "must be given"
        rows.append([f"`{typed.removesuffix(' <str>')}`", shown(SAID.sub("", text)), default])
    return markdown(["argument or option", "what it is", "if it is not given"], rows)


@job("commands", quick=True)
def reference(found: Findings) -> None:
    """Make the table of all commands, and the section of each."""
    every = commands()
    rows = [[f"[`atmosbox {name}`](#{name})", told(each)[0]] for name, each, _ in every]
    found.table(["command", "what it does"], rows, key="list")
    parts = []
    for name, each, context in every:
        usage = each.get_usage(context).removeprefix("Usage: ")
        parts += [f"### {name}", "", "```text", usage, "```", ""]
        parts += [line for paragraph in told(each) for line in (paragraph, "")]
        parts += [words(each, context), "", "```sh", *examples(each), "```", ""]
    found.text("\n".join(parts).rstrip(), key="reference")
