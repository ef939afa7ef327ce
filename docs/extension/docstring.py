"""What a docstring says to a reader of the source, said to a reader of the site."""

import re
from itertools import pairwise
from typing import Any

from sphinx.application import Sphinx

ENTRY = re.compile(r"^`(\w+)`\s+(\S.*)$")
MARK = re.compile(r"\s*\[(\d+)\]_")
REFERENCE = re.compile(r"^\.\. \[(\d+)\] ")
PLAIN = "* \\"
"""Begins a reference without a number; the backslash keeps the initial of an author from being taken for one."""


def as_list(lines: list[str]) -> list[str]:
    """Return lines in which a list in columns, a name and what it is, has become a list."""
    entries = [ENTRY.match(line) for line in lines]
    beside = {i for pair in pairwise(enumerate(entries)) if all(each for _, each in pair) for i, _ in pair}
    return [
        f"- ``{entry[1]}``: {entry[2]}" if entry and i in beside else line
        for i, (line, entry) in enumerate(zip(lines, entries, strict=True))
    ]


def with_references(what: str, lines: list[str]) -> list[str]:
    """Return lines in which nothing refers to what is not there, and nothing is there that is not referred to.

    A constant cannot have references of its own: its mark means those of its module, which need no number there.
    """
    if what in {"data", "attribute"}:
        return [MARK.sub("", line) for line in lines]
    cited = set(MARK.findall("\n".join(lines)))
    return [
        line if (found := REFERENCE.match(line)) is None or found[1] in cited else f"{PLAIN}{line[found.end() :]}"
        for line in lines
    ]


def rewrite(app: Sphinx, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Rewrite a docstring, before numpydoc reads it."""
    lines[:] = with_references(what, as_list(lines))


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx."""
    app.connect("autodoc-process-docstring", rewrite, priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
