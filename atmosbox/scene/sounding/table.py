"""From the columns of a file to a sounding: units, missing values, order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import SoundingError, shown
from atmosbox.scene.sounding.column import QUANTITIES, in_si, unit_of
from atmosbox.scene.sounding.plausibility import check_plausible, widest_gap
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


def sounding_of(table: Table) -> Sounding:
    """Return the sounding in the columns of a file, after every check.

    A level without pressure or temperature is left out, and so is a level without dewpoint below another that has one,
    as in MetPy. Above the highest dewpoint, where radiosondes cease to report it, the dewpoint is set 30 K below the
    temperature. Of a level that is given twice, one is left out. The remarks list all this.

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
    columns = {quantity: _known(table, quantity) for quantity in QUANTITIES}
    whole = ~np.isnan(columns["pressure"]) & ~np.isnan(columns["temperature"])
    if not whole.any():
        raise SoundingError(f"{table.file}: no level has both pressure and temperature: give a sounding with values.")
    for quantity, column in columns.items():
        used = np.where(whole, column, np.nan)
        if not np.isnan(used).all():
            unit = str(table.units[quantity]).strip()
            check_plausible(quantity, used, unit, lambda level: f"{table.file}, {table.places[level]}")
    rows = np.stack([in_si(each, unit_of(q, table.units[q], table.head)) for q, each in columns.items()])
    places = np.array([f"{table.file}, {place}" for place in table.places])
    remarks = [*table.remarks]

    def keep(which: NDArray[np.bool_], left_out: str) -> None:
        nonlocal rows, places
        if count := int(np.count_nonzero(~which)):
            remarks.append(f"{count} level{'s' if count > 1 else ''} {left_out}.")
        rows, places = rows[:, which], places[which]

    keep(whole, "without pressure or temperature left out")
    if rows[0, 0] < rows[0, -1]:
        rows, places = rows[:, ::-1], places[::-1]
    moist = ~np.isnan(rows[2])
    if not moist.any():
        raise SoundingError(
            f"{table.file}: no level has pressure, temperature and dewpoint: give a sounding with all three."
        )
    above = np.arange(moist.size) > np.flatnonzero(moist)[-1]
    keep(moist | above, "without dewpoint below one that has it left out")
    same = np.all((rows[:, 1:] == rows[:, :-1]) | np.isnan(rows[:, 1:] + rows[:, :-1]), axis=0)
    keep(~np.r_[False, same], "given twice taken once")
    pressure, temperature, dewpoint = rows
    dry = np.isnan(dewpoint)
    if dry.any():
        highest = pressure[~dry][-1] / 100
        remarks.append(f"Above {highest:.6g} hPa no dewpoint: taken {DRY_DEPRESSION:.0f} K below the temperature.")
    gap, below = widest_gap(pressure)
    if gap > _REMARKABLE_GAP:
        ends = " to ".join(f"{each / 100:.6g}" for each in pressure[below : below + 2])
        remarks.append(f"The widest gap below 300 hPa, {gap / 100:.6g} hPa, is from {ends} hPa.")
    name = shown(" ".join(table.name.split())) or table.file
    dewpoint = np.where(dry, temperature - DRY_DEPRESSION, dewpoint)
    source = f"{table.file}, {table.kind}"
    return Sounding(pressure, temperature, dewpoint, name, source, tuple(remarks), tuple(map(str, places)))


def _known(table: Table, quantity: str) -> Floats:
    """Return a column with NaN in place of marks of missing values, after a check that it has a unit."""
    if quantity not in table.values:
        lacking = "name its column " + quantity
        lacking += ", or make it of the relative humidity by MetPy" if quantity == "dewpoint" else ""
        raise SoundingError(f"{table.head}: there is no {quantity}: {lacking}.")
    unit_of(quantity, table.units.get(quantity), table.head)
    column = np.array(table.values[quantity], dtype=np.float64)
    missing = column <= _LOW_MARK
    if quantity != "pressure":
        missing |= np.isin(column, _HIGH_MARKS)
    return np.where(missing, np.nan, column)
