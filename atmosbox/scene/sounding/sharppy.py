"""The text format of SHARPpy and its predecessors: %TITLE%, %RAW%, lines of numbers, %END%."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding.column import number, stated_columns
from atmosbox.scene.sounding.tabulated import Table

__all__ = ["parse", "recognised"]

_COLUMNS = ("LEVEL", "HGHT", "TEMP", "DWPT", "WDIR", "WSPD")
_UNITS = {"pressure": "hPa", "temperature": "degC", "dewpoint": "degC", "height": "m"}


def _line_of(mark: str, lines: Sequence[str]) -> int | None:
    """Return the index of the line that consists of a mark, or None."""
    return next((i for i, line in enumerate(lines) if line.strip().upper() == mark), None)


def recognised(lines: Sequence[str]) -> bool:
    """Return whether a text has this format.

    Parameters
    ----------
    lines
        The lines of the file.

    Examples
    --------
    >>> recognised(["%TITLE%", " BNA 140728/0000", "%RAW%"])
    True
    """
    return _line_of("%RAW%", lines) is not None


def parse(lines: Sequence[str], file: str, name: str) -> Table:
    """Return the columns between %RAW% and %END%; -9999 means a missing value.

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
        If %END% is missing, or a line cannot be understood.

    Examples
    --------
    >>> parse(["%RAW%", " 989.00, 210.00, 32.60, 23.60, 265.00, 10.00", "%END%"], "bna.txt", "bna").values["height"]
    array([210.])
    """
    raw = _line_of("%RAW%", lines)
    start = 0 if raw is None else raw
    title, end = _line_of("%TITLE%", lines[:start]), _line_of("%END%", lines[start:])
    if end is None:
        raise SoundingError(f"{file}, line {len(lines)}: there is no %END%, so the file is cut off: save it again.")
    above = lines[title + 1 : start] if title is not None else []
    named = [line.split() for line in above if re.match(r"\s*LEVEL\s", line)]
    header = named[0] if named else list(_COLUMNS)
    head = f"{file}, line {start + 1}"
    found = stated_columns(header, head)
    rows, places = [], []
    for i in range(start + 1, start + end):
        if not lines[i].strip() or lines[i].lstrip().startswith("#"):
            continue
        where = f"{file}, line {i + 1}"
        cells = lines[i].split(",")
        if len(cells) < len(header):
            raise SoundingError(f"{where}: there are {len(cells)} of {len(header)} columns: write -9999 for others.")
        rows.append([number(cells[j], quantity, where) for quantity, (j, _) in found.items()])
        places.append(f"line {i + 1}")
    columns = np.array(rows, dtype=np.float64).reshape(-1, len(found)).T
    titles = [line.strip() for line in above if line.strip() and not re.match(r"\s*(?:LEVEL\s|-{5})", line)]
    return Table(
        file,
        "SHARPpy text",
        titles[0][:150] if titles else name,
        dict(zip(found, columns, strict=True)),
        _UNITS,
        tuple(places),
        head,
    )
