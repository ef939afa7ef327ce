"""The tables of the University of Wyoming, as text or as the web page from which they were saved."""

from __future__ import annotations

import html
import re
from collections.abc import Sequence

import numpy as np

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding.column import number, stated_columns
from atmosbox.scene.sounding.tabulated import Table

__all__ = ["parse", "recognised"]

_HEAD = re.compile(r"\s*PRES\s+HGHT\s+TEMP\s+DWPT\b.*")
_TITLE = re.compile(r"(?i)<h[1-6]>(.{1,200}?)</h[1-6]>|^\s*(\S.{1,150}\bObservations at\b.{1,60})$", re.MULTILINE)
_END = re.compile(r"\s*(?:$|<|Station\b|[A-Za-z][^:]{2,60}:)")
_DEEPEST_TITLE = 40  # lines between the title and the table
_RULE = re.compile(r"\s*-{5,}\s*")


def recognised(lines: Sequence[str]) -> bool:
    """Return whether a text contains such a table.

    Parameters
    ----------
    lines
        The lines of the file.

    Examples
    --------
    >>> recognised(["<PRE>", "   PRES   HGHT   TEMP   DWPT   RELH"])
    True
    """
    return any(_HEAD.fullmatch(line) for line in lines)


def parse(lines: Sequence[str], file: str, name: str) -> Table:
    """Return the first table in a text.

    Columns are seven characters wide and may be blank: below the ground, and above the last report of humidity or wind.
    The indices after the table are not read.

    Parameters
    ----------
    lines
        The lines of the file.
    file
        The name of the file in messages.
    name
        The name of the ascent if the text has none.

    Raises
    ------
    SoundingError
        If a line of the table cannot be understood.

    Examples
    --------
    >>> lines = ["   PRES   HGHT   TEMP   DWPT", "    hPa     m      C      C ", " 1000.0     -7"]
    >>> parse([*lines, "  959.0    345   22.2   19.0"], "oun.txt", "oun").values["temperature"]
    array([ nan, 22.2])
    """
    heads = [i for i, line in enumerate(lines) if _HEAD.fullmatch(line)]
    head = heads[0]
    where = f"{file}, line {head + 1}"
    words = list(re.finditer(r"\S+", lines[head].expandtabs()))
    ends = [word.end() for word in words]
    found = stated_columns([word.group() for word in words], where)
    units = re.findall(r"\S+", lines[head + 1]) if head + 1 < len(lines) else []
    if len(units) != len(words):
        raise SoundingError(f"{where}: no line of units follows the names of the columns: save the whole page again.")
    rows: list[list[float]] = []
    places = []
    for i in range(head + 2, len(lines)):
        line = lines[i]
        if _RULE.fullmatch(line):
            continue
        if _END.match(line):
            break
        cells = _cells(line, ends, f"{file}, line {i + 1}")
        rows.append([number(cells[j], quantity, f"{file}, line {i + 1}") for quantity, (j, _) in found.items()])
        places.append(f"line {i + 1}")
    columns = np.array(rows, dtype=np.float64).reshape(-1, len(found)).T
    title = _TITLE.search("\n".join(line[:300] for line in lines[max(0, head - _DEEPEST_TITLE) : head]))
    remarks = (f"The first of {len(heads)} soundings in the file taken.",) if len(heads) > 1 else ()
    return Table(
        file,
        "table of the University of Wyoming",
        html.unescape(re.sub(r"<[^>]*>", "", title[1] or title[2])) if title else name,
        dict(zip(found, columns, strict=True)),
        {quantity: units[j] for quantity, (j, _) in found.items()},
        tuple(places),
        where,
        remarks,
    )


def _cells(line: str, ends: Sequence[int], where: str) -> list[str]:
    """Return the cells of a line: its words if none is missing, else the text below the name of each column."""
    words = line.split()
    if len(words) == len(ends):
        return words
    line = line.expandtabs().rstrip()
    cells = [line[start:end].strip() for start, end in zip([0, *ends], ends, strict=False)]
    if [word for cell in cells for word in cell.split()] != words or any(len(cell.split()) > 1 for cell in cells):
        raise SoundingError(f"{where}: the numbers do not stand below the names of the columns: save the page again.")
    return cells
