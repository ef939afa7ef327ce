"""BUFKIT: hourly forecast soundings for one place, a format that weather services of the USA exchange.

``SNPARM`` names the columns, and a block that begins with ``STID`` holds one hour. The values of a level may fill
several lines: they are told apart by their number, not by their position. Pressure is in hPa, height in m, temperature
and dewpoint in degrees Celsius; -9999.00 means a missing value (GEMPAK's ``namsnd`` and its table of parameters).
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding.column import number
from atmosbox.scene.sounding.tabulated import Table

__all__ = ["parse", "recognised"]

_NAMES = {"PRES": "pressure", "HGHT": "height", "TMPC": "temperature", "DWPC": "dewpoint"}
_UNITS = {"pressure": "hPa", "height": "m", "temperature": "degC", "dewpoint": "degC"}
_STATION = re.compile(r"\s*STID\s*=\s*(?P<station>\S*?)\s*STNM\s*=\s*(?P<number>\S*)\s+TIME\s*=\s*(?P<time>\S+).*")
_PARAMETERS = re.compile(r"\s*SNPARM\s*=\s*(?P<names>\S+)\s*")


def recognised(lines: Sequence[str]) -> bool:
    """Return whether a text names the parameters of its soundings as BUFKIT does.

    Examples
    --------
    >>> recognised(["SNPARM = PRES;TMPC;TMWC;DWPC;THTE;DRCT;SKNT;OMEG;CFRL;HGHT"])
    True
    """
    return any(_PARAMETERS.fullmatch(line) for line in lines[:20])


def parse(lines: Sequence[str], file: str, name: str) -> Table:
    """Return the first sounding of a forecast.

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
        If a column is missing, or the levels are cut off.

    Examples
    --------
    >>> text = '''SNPARM = PRES;TMPC;DWPC;HGHT
    ... STID = KOUN STNM = 723570 TIME = 140910/0000
    ... PRES TMPC DWPC
    ... HGHT
    ... 965.80 22.24 18.84
    ... 357.20'''
    >>> read = parse(text.splitlines(), "oun.buf", "oun")
    >>> read.name, {quantity: float(column[0]) for quantity, column in read.values.items()}["height"]
    ('KOUN 140910/0000', 357.2)
    """
    named = next((i, found) for i, line in enumerate(lines) if (found := _PARAMETERS.fullmatch(line)))
    columns = named[1]["names"].rstrip(";").split(";")
    lacking = [code for code in ("PRES", "TMPC", "DWPC") if code not in columns]
    if lacking:
        raise SoundingError(f"{file}, line {named[0] + 1}: SNPARM has no {lacking[0]}: save it with that parameter.")
    stations = [(i, found) for i, line in enumerate(lines) if (found := _STATION.fullmatch(line))]
    start, title, head = _head(lines, columns, stations, file)
    cells: list[str] = []
    lines_of: list[int] = []
    for i in range(head, len(lines)):
        if not lines[i].strip() or re.match(r"\s*[A-Z]", lines[i]):
            break
        words = lines[i].split()
        cells += words
        lines_of += [i + 1] * len(words)
    width = len(columns)
    if not cells or len(cells) % width:
        where = f"{file}, line {lines_of[-1] if lines_of else start + 1}"
        count = len(cells) % width
        raise SoundingError(
            f"{where}: {count} of {width} values of a level are there, so the sounding is cut off: save it again."
        )
    rows = range(0, len(cells), width)
    values = {
        quantity: np.array(
            [number(cells[k + columns.index(code)], quantity, f"{file}, line {lines_of[k]}") for k in rows]
        )
        for code, quantity in _NAMES.items()
        if code in columns
    }
    return Table(
        file,
        "BUFKIT",
        title or name,
        values,
        {quantity: _UNITS[quantity] for quantity in values},
        tuple(f"line {lines_of[k]}" for k in rows),
        f"{file}, line {named[0] + 1}",
        (f"The first of {len(stations)} soundings in the file taken.",) if len(stations) > 1 else (),
    )


def _head(
    lines: Sequence[str], columns: list[str], stations: list[tuple[int, re.Match[str]]], file: str
) -> tuple[int, str, int]:
    """Return the line where the first sounding begins, its name, and the line of its first level."""
    start = stations[0][0] if stations else 0
    head = stations[0][1] if stations else None
    # forecasts of some models name their stations by the number alone
    title = f"{head['station'] or head['number']} {head['time']}" if head else ""
    for i in range(start, len(lines)):
        said: list[str] = []
        for j in range(i, min(i + len(columns), len(lines))):
            said += lines[j].split()
            if said == columns:
                return start, title, j + 1
            if said != columns[: len(said)] or not lines[j].strip():
                break
    raise SoundingError(f"{file}: no table has the columns {' '.join(columns)} that SNPARM names: save it again.")
