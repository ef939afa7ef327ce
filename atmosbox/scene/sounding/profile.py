"""The sounding itself: the state of the air above a place, and what no ascent can be, or is doubtful in one.

Every refusal is one sentence that says where the value is, what it is and what to do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.errors import SoundingError, shown
from atmosbox.scene.conversion import from_si
from atmosbox.scene.sounding.column import QUANTITIES, Place, check_plausible

FEWEST_LEVELS = 5
"""Smallest number of levels of a sounding."""
LARGEST_GAP = 250e2
"""Largest difference in pressure between two levels: the mandatory levels are up to 200 hPa apart [Pa]."""
GAP_CEILING = 300e2
"""Gaps between levels above this pressure surface do not matter [Pa]."""
ROUNDING = 0.05
"""How far rounding may put the dewpoint above the temperature [K]."""
STEEPEST = 2.0
"""How much colder a level may be than the dry adiabat from the level below [K]; steeper layers mix at once."""
STEEPEST_AT_GROUND = 6.0
"""The same within 50 hPa of the ground, where the sun heats the air faster than it can mix [K]."""
STRONGEST_INVERSION = 15.0
"""How much warmer a level may be than the one below it, above the lowest 150 hPa and below the 100 hPa surface [K]."""
DOUBTFUL_GAP = 200e2
"""Difference in pressure between two levels, below the 300 hPa surface, above which the sounding is doubtful [Pa]."""
LOWEST_TOP = 300e2
"""Highest pressure at which a sounding should end; storms reach higher [Pa]."""
_GROUND_LAYER = 50e2
_LOWEST_LAYER = 150e2
_STRATOSPHERE = 100e2

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class Sounding:
    """Pressure, temperature and dewpoint from the ground up.

    Parameters
    ----------
    pressure, temperature : (level,)
        Pressure, decreasing from each level to the next [Pa], and temperature [K].
    dewpoint : (level,)
        Dewpoint with respect to liquid water, not above the temperature; if rounding has put it up to 0.05 K above the
        temperature, it is set to the temperature [K].
    name, source
        The name of the ascent, and where it comes from: the file and its format, or the paper.
    remarks
        What reading has left out or filled in, one sentence each.
    places
        The place of each level in its file, for messages; its number if there is none.

    Raises
    ------
    SoundingError
        If the columns differ in length, if a value is not finite or does not occur in the atmosphere, or if the levels
        do not make an ascent (see :func:`check_levels`).

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
        return tuple(_doubts(self.pressure, self.temperature))

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


def widest_gap(pressure: Floats) -> tuple[float, int]:
    """Return the widest gap between two levels below the 300 hPa surface [Pa], and the index of the level below it.

    >>> widest_gap(np.array([1000e2, 850e2, 700e2, 500e2, 250e2, 20e2]))
    (25000.0, 3)
    """
    gap = np.where(pressure[:-1] > GAP_CEILING, pressure[:-1] - pressure[1:], 0.0)
    below = int(np.argmax(gap))
    return float(gap[below]), below


def _doubts(pressure: Floats, temperature: Floats) -> list[str]:
    """Return what is doubtful in a possible sounding, one sentence each.

    A level at 300 hPa with 0 degC instead of -43.5 degC:

    >>> p = np.array([1000e2, 850e2, 700e2, 500e2, 400e2, 300e2, 250e2])
    >>> for sentence in _doubts(p, 273.15 + np.array([20.0, 12.0, 3.0, -17.0, -29.0, 0.0, -52.0])):
    ...     print(sentence)
    From 400 to 300 hPa the temperature rises by 29 K, more than 15 K.
    From 300 to 250 hPa the air is 38.1 K colder than along the dry adiabat, more than 2 K.
    """
    found = []
    lifted = temperature[:-1] * (pressure[1:] / pressure[:-1]) ** (2.0 / 7.0)
    for i, steep in enumerate(lifted - temperature[1:]):
        ends = f"From {pressure[i] / 100:.6g} to {pressure[i + 1] / 100:.6g} hPa"
        limit = STEEPEST_AT_GROUND if pressure[i + 1] >= pressure[0] - _GROUND_LAYER else STEEPEST
        if steep > limit:
            found.append(f"{ends} the air is {steep:.3g} K colder than along the dry adiabat, more than {limit:.3g} K.")
        aloft = _STRATOSPHERE <= pressure[i + 1] < pressure[0] - _LOWEST_LAYER
        warmer = temperature[i + 1] - temperature[i]
        if aloft and warmer > STRONGEST_INVERSION:
            found.append(f"{ends} the temperature rises by {warmer:.3g} K, more than {STRONGEST_INVERSION:.3g} K.")
    gap, below = widest_gap(pressure)
    if gap > DOUBTFUL_GAP:
        ends = f"{pressure[below] / 100:.6g} and {pressure[below + 1] / 100:.6g} hPa"
        found.append(f"Between {ends} there is no level: {gap / 100:.4g} hPa, more than {DOUBTFUL_GAP / 100:.3g} hPa.")
    if (top := pressure[-1]) > LOWEST_TOP:
        found.append(f"The sounding ends at {top / 100:.6g} hPa, below the {LOWEST_TOP / 100:.3g} hPa surface.")
    return found


def check_levels(pressure: Floats, temperature: Floats, dewpoint: Floats, place: Place) -> None:
    """Refuse levels that do not make an ascent: too few, not in order, a dewpoint above its temperature, a wide gap."""
    count, hpa = pressure.size, pressure / 100
    if count < FEWEST_LEVELS:
        where = place(count - 1)
        raise SoundingError(f"{where}: the sounding ends after {count} of at least {FEWEST_LEVELS} levels: add more.")
    for i in np.flatnonzero(np.diff(pressure) >= 0.0)[:1] + 1:
        order = f"is not below the {hpa[i - 1]:.10g} hPa of the level before it: put the levels in order, ground first"
        if pressure[i] == pressure[i - 1]:
            order = "is that of the level before it, whose temperature or dewpoint is another: delete one of the two"
        raise SoundingError(f"{place(i)}: the pressure of {hpa[i]:.10g} hPa {order}.")
    for i in np.flatnonzero(dewpoint > temperature + ROUNDING + 1e-6)[:1]:
        t, td = (round(from_si(float(x[i]), "degC"), 2) for x in (temperature, dewpoint))
        what = f"{place(i)}: the dewpoint of {td:g} degC is above the temperature of {t:g} degC"
        raise SoundingError(f"{what}: correct one, or write -9999 for it.")
    gap, i = widest_gap(pressure)
    if gap > LARGEST_GAP:
        what = f"below the pressure of {hpa[i + 1]:.6g} hPa there is a gap of {gap / 100:.6g} hPa"
        most = f"at most {LARGEST_GAP / 100:.0f} hPa may lie between two levels"
        raise SoundingError(f"{place(i + 1)}: {what}, but {most}: add levels.")
