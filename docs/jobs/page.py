"""The pages: where a number or a table stands between two marks, and what stands there now.

A number stands in a sentence, a table on lines of its own, each between a mark that names it and ``<!-- end -->``.
"""

import re
from collections.abc import Mapping
from pathlib import Path

from jobs.registry import DOCS, ROOT

MARK = re.compile(r"<!-- (number|table):([\w.-]+) -->(.*?)<!-- end -->", re.DOTALL)
FIGURE = re.compile(r"!\[[^\]]*\]\(([^)]+\.png)\)")
COST = re.compile(r"collisions in \S+ s, [\d,]+ a second")
"""What a run took: it is never twice the same, and no reason to call a page stale."""


def pages() -> list[Path]:
    """Return all pages."""
    return [ROOT / "README.md", *sorted(DOCS.glob("**/*.md"))]


def filled(text: str, numbers: Mapping[str, str], tables: Mapping[str, str], wanted: set[str]) -> str:
    """Return a page with its numbers and tables put in; names that nobody has computed go into ``wanted``."""

    def put(match: re.Match[str]) -> str:
        kind, name, old = match.groups()
        known = numbers if kind == "number" else tables
        if name not in known:
            wanted.add(f"{kind}:{name}")
            return match.group()
        new = known[name] if kind == "number" else f"\n{known[name]}\n"
        if COST.sub("", new) == COST.sub("", old):
            new = old
        return f"<!-- {kind}:{name} -->{new}<!-- end -->"

    return MARK.sub(put, text)


def used(text: str) -> set[str]:
    """Return the names of the numbers, tables and figures that a page shows."""
    marks = {f"{kind}:{name}" for kind, name, _ in MARK.findall(text)}
    return marks | {f"figure:{Path(target).name}" for target in FIGURE.findall(text)}
