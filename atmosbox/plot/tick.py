"""Ticks of the axes: matplotlib's locators, plain numbers, and a common power of ten for the label."""

import math
from itertools import pairwise

from matplotlib.axis import Axis, XAxis
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, MaxNLocator, NullFormatter, ScalarFormatter

from atmosbox.plot.curve import power_of_ten

# The mandatory levels of soundings [hPa], without 925, for which there is seldom room.
_PRESSURE_LEVELS = (1000.0, 850.0, 700.0, 500.0, 400.0, 300.0, 250.0, 200.0, 150.0, 100.0, 70.0, 50.0, 30.0, 20.0, 10.0)
# The leading digits of the ticks of a logarithmic axis, and the least ratio between two such ticks; the densest first.
_DIGITS = (((1.0, 2.0, 5.0), 2.0), ((1.0, 3.0), 3.0), ((1.0,), 10.0))
_NUMBER = 3.8  # room for a number and its gap along a horizontal axis, in units of the type size
# If the upper end of a logarithmic axis is at least this many times its lower end, its numbers are written as powers of
# ten, and no common power goes into the label. Just below 1000, so that rounding does not decide.
_MANY = 999.0


def put_ticks(axis: Axis, length: float, size: float, *, pressure: bool = False) -> int:
    """Put as many numbers on an axis as there is room for, and return the power of ten by which they were divided.

    The length of the axis and the size of its type are in points. A logarithmic axis of pressure in hPa has the
    mandatory levels of soundings as its ticks where there is room for them.

    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot(ylim=(-3e-15, 2e-15))
    >>> put_ticks(axes.yaxis, 100.0, 8.0)
    -15
    """
    low, high = sorted(map(float, axis.get_view_interval()))
    across = isinstance(axis, XAxis)
    most = int(length / ((_NUMBER if across else 2.0) * size))
    steps = MaxNLocator(min(max(most, 2), 7), steps=[1, 2, 2.5, 5, 10])
    if axis.get_scale() != "log":
        formatter = ScalarFormatter(useOffset=False)
        largest = max(abs(low), abs(high))
        power = 0 if largest == 0.0 or 1e-2 <= largest < 1e5 else math.floor(math.log10(largest))
        formatter.set_powerlimits((power, power) if power else (-9, 9))
        axis.set_major_locator(steps)
        axis.set_major_formatter(formatter)
        axis.offsetText.set_visible(False)
        return power
    plain = low >= 5e-4 and high < 1e5
    power = 0 if plain or high >= _MANY * low else math.floor(math.log10(low))
    axis.set_minor_locator(LogLocator(subs=range(1, 10)))
    axis.set_minor_formatter(NullFormatter())
    axis.set_major_formatter(FuncFormatter(lambda value, _: _written(value, power, plain=plain)))
    # in decades: the room that a number takes, and the least distance between two mandatory levels
    room = (3.0 if across else 1.5) * size / length * math.log10(high / low)
    levels = [level for level in _PRESSURE_LEVELS if low <= level <= high]
    closest = min((math.log10(lower / upper) for lower, upper in pairwise(levels)), default=0.0)
    if pressure and len(levels) > 3 and high < 1100.0 and closest >= 0.8 * room:
        axis.set_major_locator(FixedLocator(levels))
    elif high > 4.0 * low:
        digits = next((each for each, ratio in _DIGITS if math.log10(ratio) >= room), (1.0,))
        axis.set_major_locator(LogLocator(subs=digits))
    else:
        axis.set_major_locator(steps)
    return power


def _written(value: float, power: int, *, plain: bool) -> str:
    """Return the text of a tick of a logarithmic axis."""
    if plain or power:
        return f"{value / 10.0**power:.6g}"
    exponent = math.log10(value)
    return power_of_ten(round(exponent)) if abs(exponent - round(exponent)) < 1e-9 else f"{value:.6g}"
