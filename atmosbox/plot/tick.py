"""Numbers on the axes: few enough to read, plain, and with a common power of ten in the label."""

from __future__ import annotations

import math
from itertools import pairwise

from matplotlib.axis import Axis, XAxis
from matplotlib.ticker import FixedFormatter, FixedLocator, FuncFormatter, MaxNLocator, NullFormatter

from atmosbox.plot.unit import power_of_ten

# The levels that a meteorologist looks for, the most telling first.
_PRESSURE_LEVELS = (1000.0, 500.0, 300.0, 700.0, 850.0, 400.0, 200.0, 100.0, 50.0, 20.0, 10.0, 250.0, 600.0, 150.0)
# The digits that are written between two powers of ten, each group wholly or not at all.
_DIGITS = ((1.0,), (2.0, 5.0), (3.0,), (7.0,), (1.5, 4.0, 6.0, 8.0))
# An axis over so many times its low end shows powers of ten; just below 1000, lest rounding decide.
_MANY = 999.0
# On a longer logarithmic axis the small ticks between the powers of ten would run together.
_MOST_DECADES = 6.0
# Numbers beside each other: the width of a digit and the gap between two numbers, in sizes of the type.
_DIGIT_WIDTH, _GAP = 0.64, 0.7


def put_ticks(axis: Axis, *, log: bool, length: float, size: float, pressure: bool = False) -> int:
    """Put as many numbers on an axis as can be read, and return the power of ten that they are in units of.

    Parameters
    ----------
    axis : matplotlib.axis.Axis
        The axis, with its limits set.
    log : bool
        Whether it is logarithmic.
    length, size : float
        Length of the axis and size of its type [pt].
    pressure : bool
        Whether it shows a pressure in hPa, and so the standard levels if it is logarithmic.

    Returns
    -------
    int
        A power of ten that belongs into the label of the axis; 0 for none.

    Examples
    --------
    Numbers of the order of 1e-15 are read as such:

    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot(ylim=(-3e-15, 2e-15))
    >>> put_ticks(axes.yaxis, log=False, length=100.0, size=8.0)
    -15
    """
    low, high = sorted(axis.get_view_interval())
    if log:
        return _put_log_ticks(axis, low, high, length, size, pressure=pressure)
    power = _power(low, high)
    upright = not isinstance(axis, XAxis)
    for intervals in range(max(2, min(7, int(length / (1.5 * size)))), 1, -1):
        locator = MaxNLocator(nbins=intervals, steps=[1, 2, 2.5, 5, 10])
        axis.set_major_locator(locator)
        ticks = [float(value) for value in locator.tick_values(low, high) if low <= value <= high]
        if power:
            axis.set_major_formatter(_alike(ticks, power))
        places = [(value - low) / (high - low) * length for value in ticks]
        if upright or _fit(places, axis.get_major_formatter().format_ticks(ticks), size):
            break
    return power


def log_ticks(low: float, high: float, room: float, *, pressure: bool = False) -> list[float]:
    """Return the numbers to write on a logarithmic axis.

    Parameters
    ----------
    low, high : float
        Its ends, both above zero.
    room : float
        The least distance between two numbers, as a part of the length of the axis.
    pressure : bool
        Whether the standard levels of the atmosphere are preferred.

    Returns
    -------
    list of float
        Numbers in ascending order, round ones preferred.

    Examples
    --------
    >>> log_ticks(290.0, 1030.0, room=0.05, pressure=True)
    [300.0, 400.0, 500.0, 600.0, 700.0, 850.0, 1000.0]
    >>> log_ticks(0.8, 120.0, room=0.1)
    [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]
    """
    least = room * math.log10(high / low)
    if pressure and 9.0 < low < high < 1100.0:
        classes = [[level] for level in _PRESSURE_LEVELS]
    elif high / low < 3.0:
        classes = []
    else:
        decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
        digits = _DIGITS if _is_plain(low, high) or high / low < _MANY else _DIGITS[:1]
        classes = [[digit * 10.0**decade for decade in decades for digit in each] for each in digits]
    kept: list[float] = []
    for candidates in classes:
        fitting = [value for value in candidates if low * (1 - 1e-9) <= value <= high * (1 + 1e-9)]
        if not kept and _closest(fitting) < least:
            fitting = fitting[:: math.ceil(least)]
        if _closest(kept + fitting) >= least:
            kept += fitting
    if len(kept) < 2:
        values = MaxNLocator(nbins=max(2, int(0.8 / room)), steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
        kept = [float(value) for value in values if low <= value <= high]
    return sorted(kept)


def small_ticks(low: float, high: float) -> list[float]:
    """Return the ticks without a number that show that an axis is logarithmic.

    Parameters
    ----------
    low, high : float
        Its ends, both above zero.

    Returns
    -------
    list of float
        One to nine times the powers of ten; none where they would be one or none, or too many.

    Examples
    --------
    >>> small_ticks(70.0, 300.0)
    [70.0, 80.0, 90.0, 100.0, 200.0, 300.0]
    >>> small_ticks(1.0, 1e20)
    []
    """
    if math.log10(high / low) > _MOST_DECADES:
        return []
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    every = (digit * 10.0**decade for decade in decades for digit in range(1, 10))
    ticks = [value for value in every if low * (1 - 1e-9) <= value <= high * (1 + 1e-9)]
    return ticks if len(ticks) > 1 else []


def _put_log_ticks(axis: Axis, low: float, high: float, length: float, size: float, *, pressure: bool) -> int:
    power = 0 if high / low >= _MANY or _is_plain(low, high) else math.floor(math.log10(low))
    room = 1.9 * size
    while True:
        ticks = log_ticks(low, high, room / length, pressure=pressure)
        numbers = _written(ticks, power)
        places = [math.log10(tick / low) / math.log10(high / low) * length for tick in ticks]
        if not isinstance(axis, XAxis) or room > length / 2 or _fit(places, numbers, size):
            break
        room += 0.2 * size
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_major_formatter(FixedFormatter(numbers))
    axis.set_minor_locator(FixedLocator(small_ticks(low, high)))
    axis.set_minor_formatter(NullFormatter())
    return power


def _written(ticks: list[float], power: int) -> list[str]:
    """Return the numbers at ticks, all as powers of ten where one of them would be too long otherwise."""
    exponents = [math.log10(tick) for tick in ticks]
    decades = all(abs(exponent - round(exponent)) < 1e-9 for exponent in exponents)
    if decades and not power and not _is_plain(1.001 * ticks[0], ticks[-1]):
        return [power_of_ten(round(exponent)) for exponent in exponents]
    return [_plain(tick / 10.0**power) for tick in ticks]


def _alike(ticks: list[float], power: int) -> FuncFormatter:
    """Return what writes ticks at even distances with equally many decimals, in units of a power of ten."""
    step = min((b - a for a, b in pairwise(ticks)), default=1.0) / 10.0**power
    decimals = next((places for places in range(9) if abs(step * 10**places % 1.0 - 0.5) > 0.4999), 9)
    return FuncFormatter(lambda value, _: f"{value / 10.0**power:.{decimals}f}".replace("-", "−"))


def _fit(places: list[float], numbers: list[str], size: float) -> bool:
    """Tell whether numbers that stand beside each other at these places [pt] keep apart."""
    return all(
        right - left >= size * (_DIGIT_WIDTH * (len(first) + len(second)) / 2 + _GAP)
        for (left, first), (right, second) in pairwise(zip(places, numbers, strict=True))
    )


def _closest(values: list[float]) -> float:
    """Return the least distance of two values on a logarithmic axis, in decades."""
    ascending = sorted(values)
    return min((math.log10(b / a) for a, b in pairwise(ascending)), default=math.inf)


def _is_plain(low: float, high: float) -> bool:
    """Tell whether both ends of a logarithmic axis can be written without an exponent."""
    return low >= 1e-3 and high < 1e5


def _power(low: float, high: float) -> int:
    """Return the power of ten of a linear axis whose numbers would otherwise be long."""
    largest = max(abs(low), abs(high))
    return 0 if largest == 0 or 1e-2 <= largest < 1e5 else math.floor(math.log10(largest))


def _plain(value: float) -> str:
    """Return a number without exponent, or as a bare power of ten where it is one."""
    if value and not 1e-4 <= abs(value) < 1e6:
        exponent = math.log10(abs(value))
        if abs(exponent - round(exponent)) < 1e-9:
            return ("−" if value < 0 else "") + power_of_ten(round(exponent))
    return f"{value:.6g}".replace("-", "−")
