"""The sounding itself: the state of the air above a place, from a balloon or from a formula."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.errors import SoundingError, shown
from atmosbox.scene.conversion import from_si
from atmosbox.scene.sounding.column import QUANTITIES
from atmosbox.scene.sounding.plausibility import check_levels, check_plausible, doubts

__all__ = ["Sounding"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class Sounding:
    """Pressure, temperature and dewpoint from the ground up.

    Parameters
    ----------
    pressure : (level,)
        Pressure, decreasing from each level to the next [Pa].
    temperature : (level,)
        Temperature [K].
    dewpoint : (level,)
        Dewpoint with respect to liquid water, not above the temperature; if rounding has put it up to 0.05 K above the
        temperature, it is set to the temperature [K].
    name
        The name of the ascent.
    source
        Where it comes from: the file and its format, or the paper.
    remarks
        What reading has left out or filled in, one sentence each.
    places
        The place of each level in its file, for messages; its number if there is none.

    Raises
    ------
    SoundingError
        If the columns differ in length, if a value is not finite or does not occur in the atmosphere, or if the levels
        do not make an ascent (see :func:`atmosbox.scene.sounding.plausibility.check_levels`).

    Notes
    -----
    The arrays are read-only copies.

    Examples
    --------
    >>> pressure = [1000e2, 850e2, 700e2, 500e2, 300e2]
    >>> Sounding(pressure, [298, 290, 280, 263, 233], [290, 284, 270, 250, 210], name="Oslo")
    <Sounding Oslo: 5 levels from 1000 hPa, 24.85 degC to 300 hPa, -40.15 degC>
    """

    pressure: Floats
    temperature: Floats
    dewpoint: Floats
    name: str = "sounding"
    source: str = ""
    remarks: tuple[str, ...] = ()
    places: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        columns = {name: self._column(name, getattr(self, name)) for name in QUANTITIES}
        for name, column in columns.items():
            if column.size != columns["pressure"].size:
                raise SoundingError(
                    f"{shown(self.name)}: there are {column.size} values of {name}, but {columns['pressure'].size} of "
                    "pressure: give one of each for every level."
                )
            check_plausible(name, column, QUANTITIES[name].si, self._place)
        pressure, temperature, dewpoint = columns.values()
        check_levels(pressure, temperature, dewpoint, self._place)
        columns["dewpoint"] = np.minimum(columns["dewpoint"], columns["temperature"])
        for name, column in columns.items():
            column.setflags(write=False)
            object.__setattr__(self, name, column)

    @property
    def doubts(self) -> tuple[str, ...]:
        """What is doubtful in the ascent though it is possible, one sentence each."""
        return tuple(doubts(self.pressure, self.temperature))

    def _place(self, level: int) -> str:
        return self.places[level] if self.places else f"{shown(self.name)}, level {level + 1}"

    def _column(self, name: str, values: ArrayLike) -> Floats:
        """Return a copy of a column, or raise SoundingError if it is not a row of finite numbers."""
        try:
            column = np.array(values, dtype=np.float64)
        except (TypeError, ValueError, OverflowError):
            column = np.zeros(0)
        if column.ndim != 1 or not column.size:
            raise SoundingError(f"{shown(self.name)}: the {name} is not a row of numbers: give a list.")
        if (odd := np.flatnonzero(~np.isfinite(column))).size:
            where = self._place(int(odd[0]))
            raise SoundingError(f"{where}: the {name} {column[odd[0]]} is not finite: leave the level out.")
        return column

    def __len__(self) -> int:
        return int(self.pressure.size)

    def __repr__(self) -> str:
        ends = (
            f"{self.pressure[i] / 100:.6g} hPa, {from_si(float(self.temperature[i]), 'degC'):.2f} degC" for i in (0, -1)
        )
        return f"<Sounding {shown(self.name)}: {len(self)} levels from {' to '.join(ends)}>"
