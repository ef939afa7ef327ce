"""The table of contents: the pages that the index names, under the headings under which it names them.

A page on a code host cannot hold a list that only Sphinx understands, and two lists would disagree one day. So the
lists are read off the page itself: each of its sections is a part of the contents.
"""

import re
from pathlib import PurePosixPath

from extension.source import PAGES
from sphinx.application import Sphinx

LISTS = ("index", "api/index", "notebooks/index")
"""Pages whose links are a table of contents."""

HEADING = re.compile(r"^## (.+)$", re.MULTILINE)
PAGE = re.compile(r"\]\(([\w./-]+\.(?:md|rst|ipynb))\)")


def sections(text: str) -> dict[str, list[str]]:
    """Return the pages that each section of a page links to, in order, each page once."""
    parts = HEADING.split(text)
    seen: set[str] = set()
    found: dict[str, list[str]] = {}
    for heading, part in zip(["", *parts[1::2]], parts[::2], strict=True):
        pages = [page for page in dict.fromkeys(PAGE.findall(part)) if page not in seen]
        seen.update(pages)
        if pages:
            found[heading] = pages
    return found


def name_of(link: str) -> str | None:
    """Return what Sphinx calls the page of a link; None for a page that another list has."""
    if link.startswith("../"):
        return PAGES.get(link.removeprefix("../"))
    return PurePosixPath(link).with_suffix("").as_posix()


def add_contents(app: Sphinx, docname: str, source: list[str]) -> None:
    """Append the table of contents to the text of a page that lists others."""
    if docname not in LISTS:
        return
    for heading, pages in sections(source[0]).items():
        inside = [name for name in map(name_of, pages) if name]
        caption = [f":caption: {heading}"] if heading and docname == "index" else []
        source[0] += "\n".join(["\n", "```{toctree}", ":hidden:", *caption, "", *inside, "```", ""])


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx."""
    app.connect("source-read", add_contents)
    return {"parallel_read_safe": True}
