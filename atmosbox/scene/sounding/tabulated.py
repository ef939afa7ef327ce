"""From the columns of a file to a sounding: units, missing values, order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import SoundingError, shown
from atmosbox.scene.sounding.column import QUANTITIES, REQUIRED, unit_of
from atmosbox.scene.sounding.plausibility import check_levels, check_plausible, in_si, widest_gap
from atmosbox.scene.sounding.profile import Sounding

__all__ = ["DRY_DEPRESSION", "Table", "sounding_of"]

DRY_DEPRESSION = 30.0
"""Dewpoint depression of air above the highest level with a dewpoint, as weather services coded dry air [K]."""
_REMARKABLE_GAP = 150e2  # Pa
_LOW_MARK = -999.0  # at or below it a number marks a missing value
_HIGH_MARKS = (999.0, 999.9, 999.99, 9999.0, 9999.9, 99999.0, 99999.9)  # of temperature and dewpoint

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Table:
    """The columns of a file as they are written in it.

    Parameters
    ----------
    file
        The name of the file in messages.
    kind
        The format.
    name
        The name of the ascent.
    values
        For each quantity its column (level,) in the file's unit, NaN where a value is missing.
    units
        For each quantity its unit as written, None if there is none.
    places
        The place of each level in the file.
    head
        The place where the columns are named.
    remarks
        Remarks on what reading has left out so far, one sentence each.
    """

    file: str
    kind: str
    name: str
    values: Mapping[str, Floats]
    units: Mapping[str, str | None]
    places: tuple[str, ...]
    head: str
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True)
class _Levels:
    """Levels in SI units, and the place of each in the file."""

    columns: dict[str, Floats]
    places: NDArray[np.str_]

    def kept(self, which: NDArray[np.bool_] | slice) -> _Levels:
        return _Levels({name: column[which] for name, column in self.columns.items()}, self.places[which])


def _known_columns(table: Table) -> tuple[dict[str, Floats], dict[str, str]]:
    """Return the columns in their units, with NaN in place of marks of missing values, and the units."""
    columns, units = {}, {}
    for quantity in QUANTITIES:
        if quantity not in table.values:
            if quantity in REQUIRED:
                raise SoundingError(f"{table.head}: there is no {quantity}: {_lacking(quantity)}.")
            continue
        unit_of(quantity, table.units.get(quantity), table.head)
        column = np.array(table.values[quantity], dtype=np.float64)
        missing = column <= _LOW_MARK
        if quantity in ("temperature", "dewpoint"):
            missing |= np.isin(column, _HIGH_MARKS)
        columns[quantity] = np.where(missing, np.nan, column)
        units[quantity] = str(table.units[quantity]).strip()
    return columns, units


def _lacking(quantity: str) -> str:
    """Return what a user can do about a missing column."""
    if quantity == "dewpoint":
        return "name its column dewpoint, or make it of the relative humidity by MetPy"
    return f"name its column {quantity}"


def _complete(levels: _Levels, file: str) -> tuple[_Levels, list[str]]:
    """Return the levels from the ground up, without incomplete ones, and the remarks on what was left out."""
    remarks = []
    whole = ~np.isnan(levels.columns["pressure"]) & ~np.isnan(levels.columns["temperature"])
    if left_out := int(np.count_nonzero(~whole)):
        remarks.append(f"{_counted(left_out)} without pressure or temperature left out.")
    levels = levels.kept(whole)
    pressure = levels.columns["pressure"]
    if pressure[0] < pressure[-1]:
        levels = levels.kept(slice(None, None, -1))
    moist = ~np.isnan(levels.columns["dewpoint"])
    if not moist.any():
        raise SoundingError(f"{file}: no level has pressure, temperature and dewpoint: give a sounding with all three.")
    highest = int(np.flatnonzero(moist)[-1])
    if left_out := int(np.count_nonzero(~moist[:highest])):
        remarks.append(f"{_counted(left_out)} without dewpoint below one that has it left out.")
    levels = levels.kept(moist | (np.arange(moist.size) > highest))
    rows = np.stack([levels.columns[name] for name in REQUIRED])
    below, above = rows[:, :-1], rows[:, 1:]
    same = np.r_[False, np.all((below == above) | (np.isnan(below) & np.isnan(above)), axis=0)]
    if repeated := int(np.count_nonzero(same)):
        remarks.append(f"{_counted(repeated)} given twice taken once.")
    return levels.kept(~same), remarks


def _filled(levels: _Levels) -> tuple[_Levels, list[str]]:
    """Return the levels with dry air above the highest dewpoint, and heights for all or none; and the remarks."""
    columns, remarks = dict(levels.columns), []
    dry = np.isnan(columns["dewpoint"])
    if dry.any():
        highest = columns["pressure"][~dry][-1] / 100
        remarks.append(f"Above {highest:.6g} hPa no dewpoint: taken {DRY_DEPRESSION:.0f} K below the temperature.")
        columns["dewpoint"] = np.where(dry, columns["temperature"] - DRY_DEPRESSION, columns["dewpoint"])
    if "height" in columns and np.isnan(columns["height"]).any():
        remarks.append("Heights left out, for some levels have none.")
        del columns["height"]
    gap, below = widest_gap(columns["pressure"])
    if gap > _REMARKABLE_GAP:
        ends = [f"{pressure / 100:.6g}" for pressure in columns["pressure"][below : below + 2]]
        remarks.append(f"The widest gap below 300 hPa, {gap / 100:.6g} hPa, is from {' to '.join(ends)} hPa.")
    return _Levels(columns, levels.places), remarks


def _counted(count: int) -> str:
    return f"{count} level{'s' if count > 1 else ''}"


def sounding_of(table: Table) -> Sounding:
    """Return the sounding in the columns of a file, after every check.

    Parameters
    ----------
    table
        The columns that a reader found.

    Returns
    -------
    Sounding
        The levels from the ground up. A level without pressure or temperature is left out, and so is a level without
        dewpoint below another that has one, as in MetPy. Above the highest dewpoint, where radiosondes cease to report
        it, the dewpoint is set 30 K below the temperature. Of a level that is given twice, one is left out. The remarks
        list all this.

    Raises
    ------
    SoundingError
        If a column or its unit is missing, or if the levels do not make an ascent.

    Examples
    --------
    >>> import numpy as np
    >>> columns = {
    ...     "pressure": np.array([1000.0, 850.0, 700.0, 500.0, 300.0]),
    ...     "temperature": np.array([25.0, 15.0, 5.0, -10.0, -40.0]),
    ...     "dewpoint": np.array([17.0, 12.0, -3.0, -25.0, -9999.0]),
    ... }
    >>> units = {"pressure": "hPa", "temperature": "degC", "dewpoint": "degC"}
    >>> ascent = sounding_of(Table("a.csv", "CSV", "a", columns, units, tuple("12345"), "a.csv, line 1"))
    >>> float(ascent.dewpoint[-1]), ascent.remarks[0]
    (203.15, 'Above 500 hPa no dewpoint: taken 30 K below the temperature.')
    """
    columns, units = _known_columns(table)
    whole = ~np.isnan(columns["pressure"]) & ~np.isnan(columns["temperature"])
    if not whole.any():
        raise SoundingError(f"{table.file}: no level has both pressure and temperature: give a sounding with values.")
    for quantity, column in columns.items():
        used = np.where(whole, column, np.nan)
        if not np.isnan(used).all():
            check_plausible(quantity, used, units[quantity], lambda level: f"{table.file}, {table.places[level]}")
    si = {name: in_si(column, unit_of(name, units[name], table.head)) for name, column in columns.items()}
    levels, left_out = _complete(_Levels(si, np.array(table.places)), table.file)
    levels, filled = _filled(levels)
    pressure, temperature, dewpoint = (levels.columns[name] for name in REQUIRED)
    height = levels.columns.get("height")

    def place(level: int) -> str:
        return f"{table.file}, {levels.places[level]}"

    for quantity, column in levels.columns.items():  # another level may be the lowest one now
        check_plausible(quantity, column, QUANTITIES[quantity].si, place)
    check_levels(pressure, temperature, dewpoint, height, place)
    name = shown(" ".join(table.name.split())) or table.file
    source = f"{table.file}, {table.kind}"
    return Sounding(pressure, temperature, dewpoint, height, name, source, (*table.remarks, *left_out, *filled))
