"""A sheet as Markdown, for a wiki, a notebook or a printer of your own."""

from __future__ import annotations

from collections.abc import Iterator

from atmosbox.sheet.block import Answer, Axes, Blank, Block, Choices, Commands, Heading, Kept, Measurements, Text
from atmosbox.sheet.markup import as_markdown
from atmosbox.sheet.worksheet import Worksheet

__all__ = ["markdown"]

RULE = "_" * 72
WIDTH, HEIGHT = 56, 9
"""Size of empty axes in characters."""


def markdown(sheet: Worksheet) -> str:
    """Return a sheet as Markdown.

    Parameters
    ----------
    sheet
        From `worksheet`.

    Returns
    -------
    str
        Its text, which ends with a line's end.

    Examples
    --------
    >>> from atmosbox.sheet import worksheet
    >>> print(markdown(worksheet("lifting-dry")).splitlines()[0])
    # Lifting dry air
    """
    head = [f"# {sheet.title}" + (": answers" if sheet.answers else ""), f"`{sheet.scene}` · {sheet.about}"]
    head += [] if sheet.answers else ["Name: ____________________________ Date: ______________"]
    parts = [*head, *(part for block in sheet.blocks for part in _parts(block))]
    return "\n\n".join(parts) + "\n"


def _parts(block: Block) -> Iterator[str]:
    """Yield the paragraphs of a block."""
    match block:
        case Kept(blocks):
            for each in blocks:
                yield from _parts(each)
        case Heading(text):
            yield f"## {text}"
        case Text(text):
            yield as_markdown(text)
        case Answer(text):
            yield f"> {as_markdown(text)}"
        case Commands(letter, title, lines):
            yield f"**{letter}**, {as_markdown(title)}:"
            yield "\n".join(["```sh", *lines, "```"])
        case Choices(items):
            yield "\n".join(f"- [ ] {as_markdown(item)}" for item in items)
        case Axes(x, y):
            rows = [f"  {y}", "  ^", *["  |"] * HEIGHT, f"  +{'-' * WIDTH}> {x}"]
            yield "\n".join(["```text", *rows, "```"])
        case Blank(lines):
            yield "\n\n".join([RULE] * lines)
        case Measurements():
            yield "\n".join(_table(block))


def _table(block: Measurements) -> Iterator[str]:
    """Yield the lines of the table."""
    yield "| quantity | theory, formula | run | measured ± standard error | theory | misfit / error |"
    yield "| --- | --- | --- | --- | --- | --- |"
    for label, formula, lines in block.rows:
        for number, line in enumerate(lines):
            name = (label, formula) if number == 0 else ("", "")
            blank = line.measured or "±"
            cells = (*name, line.run, blank, line.theory, line.misfit)
            yield "| " + " | ".join(as_markdown(cell, cell=True) or " " for cell in cells) + " |"
