"""The text formats of soundings: each says where its columns are named, and which cells a level has.

A format is a function that returns the first sounding of a text as a table, or None if the text is of another format.
What all have in common is in `_table`; -9999 and the like are missing values in all of them.
"""

from __future__ import annotations

import csv
import html
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding.column import QUANTITIES, Table, number, stated_columns

_UNITS: Mapping[str, str | None] = {"pressure": "hPa", "temperature": "degC", "dewpoint": "degC"}


class Text(NamedTuple):
    """The lines of a file, its name in messages, and the name of the ascent if the text has none."""

    lines: Sequence[str]
    file: str
    name: str

    def place(self, index: int) -> str:
        """Return where a line is."""
        return f"{self.file}, line {index + 1}"

    def error(self, index: int, problem: str) -> SoundingError:
        """Return the refusal of a line, which gives its place and says what to do."""
        return SoundingError(f"{self.place(index)}: {problem}.")


def _table(
    text: Text, kind: str, head: int, names: Sequence[str], rows: Iterable[tuple[int, Sequence[str]]], *,
    units: Mapping[str, str | None] = _UNITS, title: str = "", soundings: int = 1, whole: bool = True,
) -> Table:  # fmt: skip
    """Return a table of rows; each is the index of its line and its cells."""
    columns = stated_columns(names, text.place(head))
    least = len(names) if whole else max(at for at, _ in columns.values()) + 1
    values, places = [], []
    for i, cells in rows:
        if len(cells) < least:
            raise text.error(i, f"there are {len(cells)} of {len(names)} columns: write NaN for the others")
        if any(cells[len(names) :]):
            raise text.error(i, f"there are {len(cells)} columns, but {len(names)} names: write decimal points")
        values.append([number(cells[at], name, text.place(i)) for name, (at, _) in columns.items()])
        places.append(f"line {i + 1}")
    by_column = dict(zip(columns, np.array(values, dtype=np.float64).reshape(-1, len(columns)).T, strict=True))
    found = {name: unit or units.get(name) for name, (_, unit) in columns.items()}
    remarks = (f"The first of {soundings} soundings in the file taken.",) if soundings > 1 else ()
    return Table(text.file, kind, title or text.name, by_column, found, tuple(places), text.place(head), remarks)


_IGRA = re.compile(r"#([A-Z]{2}[A-Z0-9]{9}) (\d{4} \d\d \d\d) ([\d ]{2}) .{4}  *(\d+) .*")
_IGRA_FIELDS = {"pressure": (9, 15), "temperature": (22, 27), "dewpoint": (34, 39)}


def igra(text: Text) -> Table | None:
    """Return the first ascent of a file of the Integrated Global Radiosonde Archive, version 2.

    The columns have fixed widths (``igra2-data-format.txt``, doi:10.7289/V5X63K0Q): pressure [Pa], temperature and
    dewpoint depression [0.1 K]; -8888 marks a value that failed a quality check.
    """
    header = _IGRA.fullmatch(text.lines[0].rstrip())
    if header is None:
        return None
    station, date, hour, announced = (part.strip() for part in header.groups())
    rows = []
    for i in range(1, int(announced) + 1):
        line = text.lines[i].rstrip() if i < len(text.lines) else ""
        if len(line) < 39 or line.startswith("#"):
            raise text.error(i, f"the header announces {announced} levels, and {i - 1} are whole: save it again")
        found = [number(line[a:b], name, text.place(i)) for name, (a, b) in _IGRA_FIELDS.items()]
        pressure, temperature, depression = (each if each > -8888.0 else float("nan") for each in found)
        rows.append((i, [f"{pressure}", f"{temperature / 10.0:.1f}", f"{(temperature - depression) / 10.0:.1f}"]))
    title = f"{station} {date.replace(' ', '-')} {hour} UTC"
    soundings = sum(line.startswith("#") for line in text.lines)
    units = {**_UNITS, "pressure": "Pa"}
    return _table(text, "IGRA version 2", 0, list(units), rows, units=units, title=title, soundings=soundings)


_SNPARM = re.compile(r"\s*SNPARM\s*=\s*(\S+?);?\s*")
_STATION = re.compile(r"\s*STID\s*=\s*(\S*?)\s*STNM\s*=\s*(\S*)\s+TIME\s*=\s*(\S+).*")


def bufkit(text: Text) -> Table | None:
    """Return the first hour of a forecast of BUFKIT, of which ``SNPARM`` names the columns.

    The values of a level may fill several lines: they are told apart by their number, not by their position (GEMPAK's
    ``namsnd``).
    """
    named = [(i, found) for i, line in enumerate(text.lines[:20]) if (found := _SNPARM.fullmatch(line))]
    if not named:
        return None
    head, names = named[0][0], named[0][1][1].split(";")
    stations = [(i, found) for i, line in enumerate(text.lines) if (found := _STATION.fullmatch(line))]
    start, station = stations[0] if stations else (0, None)
    # forecasts of some models name their stations by the number alone
    title = f"{station[1] or station[2]} {station[3]}" if station else ""
    words = [(i, word) for i in range(start, len(text.lines)) for word in text.lines[i].split()]
    places = (k for k, (_, word) in enumerate(words) if word == names[0])
    at = next((k for k in places if [word for _, word in words[k : k + len(names)]] == names), None)
    if at is None:
        raise text.error(head, f"no table has the columns {' '.join(names)} that SNPARM names: save it again")
    cells: list[tuple[int, str]] = []
    for i in range(words[at + len(names) - 1][0] + 1, len(text.lines)):
        if not text.lines[i].strip() or re.match(r"\s*[A-Z]", text.lines[i]):
            break
        cells += [(i, word) for word in text.lines[i].split()]
    width, held = len(names), len(cells) % len(names)
    if not cells or held:
        cut = f"{held} of {width} values of a level are there, so the sounding is cut off: save it again"
        raise text.error(cells[-1][0] if cells else start, cut)
    rows = [(cells[k][0], [word for _, word in cells[k : k + width]]) for k in range(0, len(cells), width)]
    return _table(text, "BUFKIT", head, names, rows, title=title, soundings=len(stations))


def sharppy(text: Text) -> Table | None:
    """Return the table of SHARPpy's text between %RAW% and %END%, below the names of the columns and a title."""
    marks = [line.strip().upper() for line in text.lines]
    if "%RAW%" not in marks:
        return None
    raw = marks.index("%RAW%")
    if "%END%" not in marks[raw:]:
        raise text.error(len(marks) - 1, "there is no %END%, so the file is cut off: save it again")
    end = raw + marks[raw:].index("%END%")
    rows = [(i, text.lines[i].split(",")) for i in range(raw + 1, end) if marks[i] and not marks[i].startswith("#")]
    above = text.lines[marks.index("%TITLE%") + 1 : raw] if "%TITLE%" in marks[:raw] else ()
    title = next((line.strip() for line in above if line.strip()), "")[:150]
    return _table(text, "SHARPpy text", raw, ["LEVEL", "HGHT", "TEMP", "DWPT", "WDIR", "WSPD"], rows, title=title)


_WYOMING = re.compile(r"\s*PRES\s+HGHT\s+TEMP\s+DWPT\b.*")
_TITLE = re.compile(r"(?i)<h[1-6]>(.{1,200}?)</h[1-6]>|^\s*(\S.{1,150}\bObservations at\b.{1,60})$", re.MULTILINE)
_END = re.compile(r"\s*(?:$|<|Station\b|[A-Za-z][^:]{2,60}:)")


def wyoming(text: Text) -> Table | None:
    """Return the first table of the University of Wyoming in a text, or in the web page from which it was saved.

    Columns are seven characters wide and may be blank: below the ground, and above the last report of humidity or wind.
    The indices after the table are not read.
    """
    heads = [i for i, line in enumerate(text.lines) if _WYOMING.fullmatch(line)]
    if not heads:
        return None
    head = heads[0]
    names = list(re.finditer(r"\S+", text.lines[head].expandtabs()))
    units = text.lines[head + 1].split() if head + 1 < len(text.lines) else []
    if len(units) != len(names):
        raise text.error(head, "no line of units follows the names of the columns: save the whole page again")
    rows = []
    for i in range(head + 2, len(text.lines)):
        if _END.match(text.lines[i]):
            break
        if not re.fullmatch(r"\s*-{5,}\s*", text.lines[i]):
            rows.append((i, _cells_below(text.lines[i], [name.end() for name in names], text.place(i))))
    title = _TITLE.search("\n".join(line[:300] for line in text.lines[max(0, head - 40) : head]))
    said = html.unescape(re.sub(r"<[^>]*>", "", title[1] or title[2])) if title else ""
    columns = [f"{name.group()} [{unit}]" for name, unit in zip(names, units, strict=True)]
    return _table(text, "table of the University of Wyoming", head, columns, rows, title=said, soundings=len(heads))


def _cells_below(line: str, ends: Sequence[int], where: str) -> list[str]:
    """Return the cells of a line: its words if none is missing, else the text below the name of each column."""
    words = line.split()
    if len(words) == len(ends):
        return words
    line = line.expandtabs().rstrip()
    cells = [line[start:end].strip() for start, end in zip([0, *ends], ends, strict=False)]
    if [cell for cell in cells if cell] != words:
        raise SoundingError(f"{where}: the numbers do not stand below the names of the columns: save the page again.")
    return cells


def delimited(text: Text) -> Table | None:
    """Return the table below a line that names at least two columns: CSV, or with semicolons, tabs or blanks.

    The units are written with the names. Lines that start with # are comments.

    >>> delimited(Text(["T_K,p/hPa,Td_K", "298,1000,290"], "a.csv", "a")).values["pressure"]
    array([1000.])
    """
    header = _header(text)
    if header is None:
        return None
    head, separator, names = header
    lines = [(i, line) for i, line in enumerate(text.lines) if i > head and not line.lstrip().startswith("#")]
    rows = [(i, _split(line, separator)) for i, line in lines if line.strip(" \t;,")]
    return _table(text, "CSV", head, names, rows, units={}, whole=separator is None)


def _header(text: Text) -> tuple[int, str | None, list[str]] | None:
    """Return the line that names the columns, its separator and the names; a comment only if no other line does."""
    claims = []
    for i, line in enumerate(text.lines[:60]):
        comment = line.lstrip().startswith("#")
        for separator in (";", "\t", ",", None):
            cells = _split(line.lstrip("# \t") if comment else line, separator)
            try:
                count = len(stated_columns(cells, ""))
            except SoundingError:  # two cells name the same one
                count = len(QUANTITIES)
            if len(cells) > 1 and count > 1:
                claims.append((count, not comment, i, separator, cells))
    return max(claims, key=lambda claim: claim[:2])[2:] if claims else None


def _split(line: str, separator: str | None) -> list[str]:
    """Return the cells of a line; if there is no separator, they are separated by blanks."""
    if separator is None:
        return line.split()
    return next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])


FORMATS = (igra, bufkit, sharppy, wyoming, delimited)
"""The formats in the order in which they are tried."""
