"""The room that a skew-T has: its temperatures, whose isotherms lean, and the names of levels beside it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.text import Annotation
from matplotlib.ticker import FixedFormatter, FixedLocator

from atmosbox.plot.theme import DARK, FAINT, Theme

ROTATION = 30.0  # of isotherms from the upright [degree], as MetPy has it

# As long as a decade of pressure are at least so many kelvin, where the axes are wide: else the adiabats lie flat.
_KELVINS_PER_DECADE = 60.0
# The curves keep so far from the sides, in widths of the axes; and no diagram is narrower or wider [K].
_MARGIN = 0.06
_LEAST_WIDTH, _MOST_WIDTH = 40.0, 400.0
_LEVEL = "level"  # by which the names of levels are found among the texts


def fit_skewt(axes: Axes, width: float, height: float, size: float) -> None:
    """Choose the range of temperatures for the room that a skew-T has, and move the names of its levels apart.

    Isotherms are inclined on the page, and so the room that a curve needs to the left and to the right depends on
    how high and how wide the page is.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        The axes, from `skewt.draw_skewt`.
    width, height : float
        Size of the axes [pt].
    size : float
        Size of the type [pt].

    Examples
    --------
    Because isotherms lean, a curve that cools by 80 K needs less than 80 K of the page:

    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot(yscale="log", ylim=(1000.0, 100.0))
    >>> _ = axes.plot([20.0, -60.0], [1000.0, 100.0])
    >>> fit_skewt(axes, 200.0, 200.0, 8.0)
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
    names = [text for text in axes.texts if isinstance(text, Annotation) and text.get_gid() == _LEVEL]
    wanted = [height * math.log(bottom / text.xy[1]) / math.log(bottom / top) for text in names]
    for text, place, moved in zip(names, wanted, _apart(wanted, 1.15 * size, height), strict=True):
        text.set_position((0.8 * size, moved - place))


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


def put_levels(axes: Axes, levels: dict[str, float], theme: Theme) -> None:
    """Mark levels across a skew-T, with their names to the right of it.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        The axes, with their pressures set.
    levels : dict of str to float
        Pressures, by what they are called [hPa]; those outside the diagram are left out.
    theme : Theme
        How large.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from atmosbox.plot.theme import THEMES
    >>> axes = Figure().add_subplot(yscale="log", ylim=(1000.0, 100.0))
    >>> put_levels(axes, {"EL": 200.0, "LCL": 900.0, "LFC": 50.0}, THEMES["notes"])
    >>> [text.get_text() for text in axes.texts]
    ['LCL', 'EL']
    """
    bottom, top = axes.get_ylim()
    line: dict[str, Any] = {"color": FAINT, "linewidth": 0.06 * theme.text}
    for name, pressure in sorted(levels.items(), key=lambda level: -level[1]):
        if top <= pressure <= bottom:
            axes.hlines(pressure, 0.0, 1.0, transform=axes.get_yaxis_transform(), zorder=0.9, **line)
            axes.annotate(
                name, (1.0, pressure), (0.8 * theme.text, 0.0), xycoords=("axes fraction", "data"),
                textcoords="offset points", va="center", size=theme.text, color=DARK, annotation_clip=False, gid=_LEVEL,
                arrowprops={"arrowstyle": "-", "shrinkA": 0.0, "shrinkB": 0.0, "relpos": (0.0, 0.5), **line},
            )  # fmt: skip


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
