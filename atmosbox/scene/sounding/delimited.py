"""Tables with one level per line: CSV with commas, semicolons, tabs or blanks between the columns."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence

import numpy as np

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding.column import REQUIRED, number, stated_columns
from atmosbox.scene.sounding.tabulated import Table

__all__ = ["parse", "recognised"]

_SEPARATORS = (";", "\t", ",", None)
_LONGEST_HEADER = 10_000  # characters
_DEEPEST_HEADER = 60  # lines above the table, such as a station's description


def _split(line: str, separator: str | None) -> list[str]:
    """Return the cells of a line; if there is no separator, they are separated by blanks."""
    if separator is None:
        return line.split()
    try:
        return next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])
    except csv.Error:  # a cell of more than 128 kB
        return line.split(separator)


def _found(cells: Sequence[str]) -> int:
    """Return how many of the required columns these cells name."""
    try:
        return len(set(stated_columns(cells, "")) & set(REQUIRED))
    except SoundingError:  # two cells name the same one
        return len(REQUIRED)


def _header(lines: Sequence[str]) -> tuple[int, str | None, list[str]] | None:
    """Return the line that names the columns, its separator and the names; a comment only if no other line does."""
    claims: list[tuple[int, bool, int, str | None, list[str]]] = []
    for i, line in enumerate(lines[:_DEEPEST_HEADER]):
        if len(line) > _LONGEST_HEADER:
            continue
        comment = line.lstrip().startswith("#")
        text = line.strip().lstrip("#").strip() if comment else line
        for separator in _SEPARATORS:
            cells = _split(text, separator)
            if len(cells) > 1 and (count := _found(cells)) > 1:
                claims.append((count, not comment, i, separator, cells))
    return max(claims, key=lambda claim: claim[:2])[2:] if claims else None


def recognised(lines: Sequence[str]) -> bool:
    """Return whether a line of a text names at least two of the columns of a sounding.

    Parameters
    ----------
    lines
        The lines of the file.

    Examples
    --------
    >>> recognised(["# made by hand", "p [hPa];T [degC];Td [degC]"]), recognised(["a,b,c"])
    (True, False)
    """
    return _header(lines) is not None


def parse(lines: Sequence[str], file: str, name: str) -> Table:
    """Return the columns below the line that names them.

    The units are written with the names, or alone in the next line. Lines that start with # are comments.

    Parameters
    ----------
    lines
        The lines of the file.
    file
        The name of the file in messages.
    name
        The name of the ascent.

    Raises
    ------
    SoundingError
        If there is no line that names the columns, or a line below it cannot be understood.

    Examples
    --------
    >>> parse(["T_K,p/hPa,Td_K", "298,1000,290"], "a.csv", "a").values["pressure"]
    array([1000.])
    """
    header = _header(lines)
    if header is None:
        raise SoundingError(f"{file}: no line names the columns: write pressure [hPa],temperature [degC],... first.")
    at, separator, cells = header
    head = f"{file}, line {at + 1}"
    found = stated_columns(cells, head)
    units = {quantity: unit for quantity, (_, unit) in found.items()}
    rows: list[list[float]] = []
    places: list[str] = []
    for i in range(at + 1, len(lines)):
        if not lines[i].strip(" \t;,") or lines[i].lstrip().startswith("#"):
            continue
        row = _split(lines[i], separator)
        where = f"{file}, line {i + 1}"
        here = {quantity: row[j] for quantity, (j, _) in found.items() if j < len(row)}
        if not rows and _is_units(here):
            units = {quantity: unit or here.get(quantity, "").strip("[]() ") for quantity, unit in units.items()}
            continue
        if len(row) < len(cells) and (separator is None or len(here) < len(found)):
            raise SoundingError(f"{where}: there are {len(row)} of {len(cells)} columns: write NaN for the others.")
        if len(row) > len(cells) and any(row[len(cells) :]):
            raise SoundingError(f"{where}: there are {len(row)} columns, but {len(cells)} names: write decimal points.")
        rows.append([number(row[j], quantity, where) for quantity, (j, _) in found.items()])
        places.append(f"line {i + 1}")
    columns = np.array(rows, dtype=np.float64).reshape(-1, len(found)).T
    return Table(file, "CSV", name, dict(zip(found, columns, strict=True)), units, tuple(places), head)


def _is_units(row: Mapping[str, str]) -> bool:
    """Return whether a row holds units: words that are neither numbers nor marks of a missing value."""
    words = 0
    for quantity, cell in row.items():
        try:
            if not np.isnan(number(cell, quantity, "")):
                return False
        except SoundingError:
            words += not any(c.isdigit() for c in cell)
    return words > 0
