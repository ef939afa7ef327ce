"""The columns of a sounding: their names, their units, and their plausible values."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import SoundingError, shown
from atmosbox.scene.conversion import SIGNS, Unit, known_unit

_HIGHEST_GROUND = 450e2  # Pa; the highest stations, in Tibet, report some 550 hPa

Floats = NDArray[np.float64]
Place = Callable[[int], str]
"""Returns the place of a level in a file, for messages."""


class Measure(NamedTuple):
    """A measured quantity: its SI unit, the usual names, best first, the units to try, and its limits [SI]."""

    si: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    low: float
    high: float


class Table(NamedTuple):
    """The columns of a file as they are written in it, with its name in messages, its format, and the ascent's name.

    Of each quantity there is its column : (level,), NaN where a value is missing, and its unit, None if none is
    written; ``places`` are those of the levels in the file, ``head`` is where the columns are named.
    """

    file: str
    kind: str
    name: str
    values: Mapping[str, Floats]
    units: Mapping[str, str | None]
    places: tuple[str, ...]
    head: str
    remarks: tuple[str, ...] = ()
    """What reading has left out so far, one sentence each."""


QUANTITIES: dict[str, Measure] = {
    "pressure": Measure(
        "Pa", ("air_pressure", "pressure", "pres", "press", "prs", "p", "P", "plev", "isobaric", "level", "lev"),
        ("hPa", "Pa", "kPa", "inHg"), 0.1, 110e3,
    ),
    "temperature": Measure(
        "K", ("air_temperature", "temperature", "temp", "tmp", "tmpc", "tair", "tdry", "T", "t"),
        ("degC", "K", "degF"), 160.0, 335.0,
    ),
    "dewpoint": Measure(
        "K", ("dew_point_temperature", "dewpoint_temperature", "dewpoint", "dew_point", "dwpt", "dwpc", "dewpt", "dewp",
              "td", "dp"),
        ("degC", "K", "degF"), 130.0, 320.0,
    ),
}  # fmt: skip
"""The three columns of a sounding; other columns of a file are not read."""

_BRACKETS = re.compile(r"(.+?)\s*[\[({]\s*([^\[\](){}]*?)\s*[\])}]")
_SUFFIX = re.compile(r"(.+?)(?:\s*[/_,:]\s*|\s+)([^\s_/,:]+)")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_MISSING = re.compile(r"(?i)|nan|na|n/a|none|null|missing|m|-+|/+|\*+|\.|#n/a")


def _plain(name: str) -> str:
    """Return a column's name in the form for comparison; case counts in single letters, because t may be the time."""
    name = re.sub(r"[\s.\-]+", "_", name.strip().strip("\"'").strip())
    return name if len(name) == 1 else name.casefold()


def _unit(text: str) -> Unit | None:
    """Return a unit from any of its spellings, or None."""
    text = text.strip()[:40]
    return known_unit(text) or known_unit(text.casefold()) if text else None


def _split(cell: str) -> tuple[str, str | None]:
    """Return the name and the unit in a header cell, such as "pressure [hPa]", "T_K" or "Td"."""
    cell = cell.strip()[:200]
    known = {name for measure in QUANTITIES.values() for name in measure.names}
    if bracketed := _BRACKETS.fullmatch(cell):
        return _plain(bracketed[1]), bracketed[2]
    suffixed = _SUFFIX.fullmatch(cell)
    if _plain(cell) not in known and suffixed and _plain(suffixed[1]) in known and _unit(suffixed[2]):
        return _plain(suffixed[1]), suffixed[2]
    return _plain(cell), None


def stated_columns(header: Sequence[str], where: str) -> dict[str, tuple[int, str | None]]:
    """Return the column of each quantity in a table and its unit, or None; ``where`` is the place of the header."""
    cells = [_split(cell) for cell in header]
    found: dict[str, tuple[int, str | None]] = {}
    for quantity, measure in QUANTITIES.items():
        claims = [(measure.names.index(name), i) for i, (name, _) in enumerate(cells) if name in measure.names]
        units = {i: _unit(cells[i][1] or "") for _, i in claims}
        claims = sorted([claim for claim in claims if (units[claim[1]] or measure).si == measure.si] or claims)
        if len(claims) > 1 and claims[0][0] == claims[1][0]:
            twice = shown(header[claims[1][1]].strip())
            raise SoundingError(f"{where}: {twice} is a second column of {quantity}: delete one of the two.")
        if claims:
            found[quantity] = claims[0][1], cells[claims[0][1]][1]
    return found


def unit_of(quantity: str, text: str | None, where: str) -> Unit:
    """Return the unit of a column from its text, which may be empty; refuse one of another quantity.

    >>> unit_of("pressure", "millibars", "a.csv, line 1").up
    100.0
    """
    measure, unit = QUANTITIES[quantity], _unit(text or "")
    if unit is not None and unit.si == measure.si:
        return unit
    problem = f"{shown(text or '')} is not a unit of {quantity}"
    if unit is None:
        known = f"unit {shown(text)} of the {quantity} is not known" if text and text.strip() else ""
        problem = f"the {known or f'{quantity} has no unit'}"
    raise SoundingError(f'{where}: {problem}: name it, as in "{quantity} [{measure.units[0]}]".')


def in_si(values: Floats, unit: Unit) -> Floats:
    """Return values of a unit in SI units; NaN stays NaN."""
    return np.asarray(values * (unit.up / unit.down) + unit.offset, dtype=np.float64)


def number(token: str, quantity: str, where: str) -> float:
    """Return the number in a cell, NaN if the cell marks a missing value: empty, NaN, NA, M, dashes, slashes, stars.

    >>> number(" −12.5 ", "temperature", "a.csv, line 3"), number("////", "temperature", "a.csv, line 4")
    (-12.5, nan)
    """
    text = token.strip().strip("\"'").strip().translate(SIGNS)
    if _MISSING.fullmatch(text):
        return float("nan")
    if _NUMBER.fullmatch(text[:60]) and len(text) <= 60 and abs(value := float(text)) < 1e30:
        return value
    problem = "is not a number: correct it, or write NaN"
    if re.fullmatch(r"[+-]?[0-9]+,[0-9]+", text):
        problem = "is written with a comma: write a decimal point"
    raise SoundingError(f"{where}: the {quantity} {shown(text)} {problem}.")


def _first_implausible(quantity: str, values: Floats, unit: Unit) -> int | None:
    """Return the first level whose value is outside the limits if its unit is this one; None if there is none."""
    measure, si = QUANTITIES[quantity], in_si(values, unit)
    wrong = np.flatnonzero((si < measure.low) | (si > measure.high))
    if not wrong.size and quantity == "pressure" and not np.nanmax(si) >= _HIGHEST_GROUND:
        return int(np.nanargmax(si))
    return int(wrong[0]) if wrong.size else None


def check_plausible(quantity: str, values: Floats, unit: str, place: Place) -> None:
    """Refuse values : (level,) in a unit that do not occur in the atmosphere, and name the unit that they look like."""
    measure = QUANTITIES[quantity]
    known = known_unit(unit) or Unit(measure.si)
    wrong = _first_implausible(quantity, values, known)
    if wrong is None:
        return
    high_up = quantity == "pressure" and measure.low <= in_si(values, known)[wrong] < _HIGHEST_GROUND
    low, ground = (_HIGHEST_GROUND, " at the ground") if high_up else (measure.low, "")
    what = (
        f"{place(wrong)}: a {quantity} of {values[wrong]:.10g} {shown(unit)}{ground} does not occur in the atmosphere"
    )
    for other in measure.units:
        candidate = known_unit(other)
        if candidate and candidate != known and _first_implausible(quantity, values, candidate) is None:
            raise SoundingError(f'{what} and looks like {other}: name its unit, as in "{quantity} [{other}]".')
    ends = " to ".join(f"{(limit - known.offset) * known.down / known.up:.6g}" for limit in (low, measure.high))
    raise SoundingError(f"{what} ({ends} {shown(unit)}): correct it, or write -9999 where it is missing.")
