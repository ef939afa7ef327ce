"""Checks of soundings: values in the wrong unit, levels out of order, gaps.

Every refusal is one sentence that says where the value is, what it is and what to do.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import SoundingError, shown
from atmosbox.scene.conversion import Unit, from_si, known_unit
from atmosbox.scene.sounding.column import QUANTITIES, in_si

__all__ = ["check_levels", "check_plausible", "doubts", "widest_gap"]

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
_HIGHEST_GROUND = 450e2  # Pa; the highest stations, in Tibet, report some 550 hPa

Floats = NDArray[np.float64]
Place = Callable[[int], str]


def _first_implausible(quantity: str, values: Floats, unit: Unit) -> int | None:
    """Return the first level whose value is outside the limits if its unit is this one; None if there is none."""
    measure, si = QUANTITIES[quantity], in_si(values, unit)
    wrong = np.flatnonzero((si < measure.low) | (si > measure.high))
    if not wrong.size and quantity == "pressure" and not np.nanmax(si) >= _HIGHEST_GROUND:
        return int(np.nanargmax(si))
    return int(wrong[0]) if wrong.size else None


def check_plausible(quantity: str, values: Floats, unit: str, place: Place) -> None:
    """Refuse values that do not occur in the atmosphere, and name the unit that they look like.

    Parameters
    ----------
    quantity
        One of :data:`~atmosbox.scene.sounding.column.QUANTITIES`.
    values : (level,)
        The values in `unit`, NaN where they are missing; at least one is a number.
    unit
        The unit in which they are read.
    place
        Function that returns the place of a level in the file.

    Raises
    ------
    SoundingError
        If a value is outside the limits of the quantity, or the largest pressure cannot be that of a ground.

    Examples
    --------
    >>> check_plausible("temperature", np.array([298.0, 290.0]), "degC", lambda level: f"a.csv, line {level + 2}")
    Traceback (most recent call last):
    atmosbox.errors.SoundingError: a.csv, line 2: a temperature of 298 degC does not occur in the atmosphere and looks
    like K: name its unit, as in "temperature [K]".
    """
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


def widest_gap(pressure: Floats) -> tuple[float, int]:
    """Return the widest gap between two levels of the lower and middle troposphere.

    Parameters
    ----------
    pressure : (level,)
        Pressure, decreasing [Pa].

    Returns
    -------
    tuple of float and int
        The difference in pressure [Pa], and the index of the level below the gap.

    Examples
    --------
    >>> widest_gap(np.array([1000e2, 850e2, 700e2, 500e2, 250e2, 20e2]))
    (25000.0, 3)
    """
    if pressure.size < 2:
        return 0.0, 0
    gap = np.where(pressure[:-1] > GAP_CEILING, pressure[:-1] - pressure[1:], 0.0)
    below = int(np.argmax(gap))
    return float(gap[below]), below


def doubts(pressure: Floats, temperature: Floats) -> list[str]:
    """Return what is doubtful in a possible sounding, one sentence each.

    Parameters
    ----------
    pressure, temperature : (level,)
        The levels from the ground up [Pa, K].

    Returns
    -------
    list of str
        Layers that are steeper than the dry adiabat by more than `STEEPEST`, inversions above `STRONGEST_INVERSION`, a
        gap above `DOUBTFUL_GAP`, and a top below the 300 hPa surface.

    Examples
    --------
    A level at 300 hPa with 0 degC instead of -43.5 degC:

    >>> p = np.array([1000e2, 850e2, 700e2, 500e2, 400e2, 300e2, 250e2])
    >>> for sentence in doubts(p, 273.15 + np.array([20.0, 12.0, 3.0, -17.0, -29.0, 0.0, -52.0])):
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
    """Refuse levels that do not make an ascent.

    Parameters
    ----------
    pressure, temperature, dewpoint : (level,)
        The levels from the ground up, complete [Pa, K, K].
    place
        Function that returns the place of a level in the file.

    Raises
    ------
    SoundingError
        If there are fewer than five levels, if the pressure does not decrease from each to the next, if a dewpoint is
        above its temperature, or if there is a gap of more than 250 hPa below the 300 hPa surface.

    Examples
    --------
    >>> p = np.array([1000e2, 900e2, 950e2, 700e2, 500e2])
    >>> check_levels(p, np.full(5, 280.0), np.full(5, 270.0), lambda level: f"a.csv, line {level + 2}")
    Traceback (most recent call last):
    atmosbox.errors.SoundingError: a.csv, line 4: the pressure of 950 hPa is not below the 900 hPa of the level
    before it: put the levels in order, ground first.
    """
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
