"""Numbers on the axes: few enough to read, plain, and with a common power of ten in the label."""

from __future__ import annotations

import math
from itertools import pairwise

from matplotlib.axis import Axis, XAxis
from matplotlib.ticker import FixedFormatter, FixedLocator, FuncFormatter, MaxNLocator, NullLocator

from atmosbox.plot.unit import power_of_ten

# The levels that a meteorologist looks for, the most telling first.
_PRESSURE_LEVELS = (1000.0, 500.0, 300.0, 700.0, 850.0, 400.0, 200.0, 100.0, 250.0, 600.0, 150.0)
# The digits that are written between two powers of ten, each group wholly or not at all.
_DIGITS = ((1.0,), (2.0, 5.0), (3.0, 7.0), (1.5, 4.0, 6.0, 8.0))


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
    room = size * (3.6 if isinstance(axis, XAxis) else 1.9)
    if log:
        return _put_log_ticks(axis, low, high, length, room, pressure=pressure)
    power = _power(low, high)
    axis.set_major_locator(MaxNLocator(nbins=max(2, min(7, int(length / room))), steps=[1, 2, 2.5, 5, 10]))
    if power:
        axis.set_major_formatter(FuncFormatter(lambda value, _: _plain(value / 10.0**power)))
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
    if pressure and 90.0 < low < high < 1100.0:
        classes = [[level] for level in _PRESSURE_LEVELS]
    elif high / low < 3.0:
        classes = []
    else:
        decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
        digits = _DIGITS if _is_plain(low, high) or high / low < 1e3 else _DIGITS[:1]
        classes = [[digit * 10.0**decade for decade in decades for digit in each] for each in digits]
    kept: list[float] = []
    for candidates in classes:
        fitting = [value for value in candidates if low * (1 - 1e-9) <= value <= high * (1 + 1e-9)]
        if not kept and _closest(fitting) < least:
            fitting = fitting[:: math.ceil(least)]
        if _closest(kept + fitting) >= least:
            kept += fitting
    if len(kept) < 2:
        values = MaxNLocator(nbins=max(2, int(0.6 / room)), steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
        kept = [float(value) for value in values if low <= value <= high]
    return sorted(kept)


def _put_log_ticks(axis: Axis, low: float, high: float, length: float, room: float, *, pressure: bool) -> int:
    ticks = log_ticks(low, high, room / length, pressure=pressure)
    power = 0 if _is_plain(low, high) or high / low >= 1e3 else math.floor(math.log10(low))
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_major_formatter(FixedFormatter([_plain(tick / 10.0**power) for tick in ticks]))
    axis.set_minor_locator(NullLocator())
    return power


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
