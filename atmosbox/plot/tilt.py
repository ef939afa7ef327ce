"""The room that a skew-T has: its temperatures, whose isotherms lean, and the names of levels beside it."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.ticker import FixedFormatter, FixedLocator

from atmosbox.plot.theme import DARK, FAINT

ROTATION = 30.0  # of isotherms from the upright [degree], as MetPy has it

# As long as a decade of pressure are at least so many kelvin, where the axes are wide: else the adiabats lie flat.
_KELVINS_PER_DECADE = 60.0
# The curves keep so far from the sides, in widths of the axes; and no diagram is narrower or wider [K].
_MARGIN = 0.06
_LEAST_WIDTH, _MOST_WIDTH = 40.0, 400.0


def fit_skewt(axes: Axes, marks: dict[str, float], width: float, height: float, size: float) -> list[Artist]:
    """Choose the range of temperatures for the room that a skew-T has, and write its numbers and levels.

    Isotherms are inclined on the page, and so the room that a curve needs to the left and to the right depends on
    how high and how wide the page is.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        The axes, from `skewt.draw_skewt`.
    marks : dict of str to float
        The levels, by what they are called [hPa].
    width, height : float
        Size of the axes [pt].
    size : float
        Size of the type [pt].

    Returns
    -------
    list of matplotlib.artist.Artist
        The marks, to be removed before the axes are fitted again.

    Examples
    --------
    Because isotherms lean, a curve that cools by 80 K needs less than 80 K of the page:

    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot(yscale="log", ylim=(1000.0, 100.0))
    >>> _ = axes.plot([20.0, -60.0], [1000.0, 100.0])
    >>> fit_skewt(axes, {}, 200.0, 200.0, 8.0)
    []
    >>> [round(float(limit)) for limit in axes.get_xlim()]
    [-33, 27]
    """
    bottom, top = axes.get_ylim()
    left, across = _temperatures(axes, bottom, top, height / width)
    axes.set_xlim(left, left + across)
    step = next(step for step in (5.0, 10.0, 20.0, 50.0, 100.0) if step * width / across >= 3.2 * size)
    coldest = left - across * math.tan(math.radians(ROTATION)) * height / width
    isotherms = step * np.arange(math.floor(coldest / step), math.ceil((left + across) / step) + 1)
    numbers = [f"{t:.0f}".replace("-", "−") if left <= t <= left + across else "" for t in isotherms]
    axes.xaxis.set_major_locator(FixedLocator(list(isotherms)))
    axes.xaxis.set_major_formatter(FixedFormatter(numbers))
    return _write_marks(axes, {name: p for name, p in marks.items() if top <= p <= bottom}, height, size)


def _temperatures(axes: Axes, bottom: float, top: float, slope: float) -> tuple[float, float]:
    """Return the left end and the width of the temperatures at the bottom of axes of a height per width [degC, K].

    A curve leans to the right by the tangent of the rotation; in a wider range of temperatures it leans less.
    """
    points = np.concatenate([np.zeros((0, 2)), *(np.asarray(line.get_xydata()) for line in axes.lines)])
    points = points[np.isfinite(points).all(axis=1)]
    temperature, up = points[:, 0], np.log(bottom / points[:, 1]) / math.log(bottom / top)
    lean = math.tan(math.radians(ROTATION)) * slope
    least = min(max(_LEAST_WIDTH, _KELVINS_PER_DECADE * math.log10(bottom / top) / slope), _MOST_WIDTH)
    if not points.size:
        return -least / 2, least
    widths = np.arange(least, _MOST_WIDTH + 1.0)
    fitting = (each for each in widths if np.ptp(temperature / each + lean * up) <= 1.0 - 2 * _MARGIN)
    across = float(next(fitting, widths[-1]))
    place = temperature + across * lean * up
    return float(place.min() + place.max() - across) / 2, across


def _write_marks(axes: Axes, marks: dict[str, float], height: float, size: float) -> list[Artist]:
    """Mark levels across the diagram, and write their names to the right of it, apart from each other."""
    if not marks:
        return []
    bottom, top = axes.get_ylim()
    order = sorted(marks, key=lambda name: -marks[name])
    places = [height * math.log(bottom / marks[name]) / math.log(bottom / top) for name in order]
    lines = axes.hlines(
        [marks[name] for name in order], 0.0, 1.0, transform=axes.get_yaxis_transform(), colors=FAINT,
        linewidths=0.06 * size, zorder=0.9,
    )  # fmt: skip
    written: list[Artist] = [lines]
    for name, place, wanted in zip(order, _apart(places, 1.15 * size, height), places, strict=True):
        label = axes.annotate(
            name, (1.0, wanted / height), (0.8 * size, place - wanted), xycoords="axes fraction",
            textcoords="offset points", ha="left", va="center", size=size, color=DARK, annotation_clip=False,
            arrowprops={"arrowstyle": "-", "color": FAINT, "linewidth": 0.06 * size, "shrinkA": 0.0, "shrinkB": 0.0,
                        "relpos": (0.0, 0.5)},
        )  # fmt: skip
        written.append(label)
    return written


def _apart(places: list[float], gap: float, height: float) -> list[float]:
    """Return ascending places, moved until they are a gap apart and within the height."""
    moved = list(places)
    for i in range(1, len(moved)):
        moved[i] = max(moved[i], moved[i - 1] + gap)
    ceiling = height
    for i in reversed(range(len(moved))):
        moved[i] = min(moved[i], ceiling)
        ceiling = moved[i] - gap
    return moved
