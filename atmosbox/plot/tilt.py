"""The range of temperatures of a skew-T, which depends on its size on the page, and the level names beside it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.text import Annotation
from matplotlib.ticker import FixedFormatter, FixedLocator

from atmosbox.plot.theme import DARK, FAINT, Theme

ROTATION = 30.0  # angle of the isotherms from the vertical [degree], as in MetPy

# On the page, a decade of pressure is at least as long as this many kelvin: otherwise the adiabats are too flat where
# the axes are wide.
_KELVINS_PER_DECADE = 60.0
# Least distance of the curves from the sides, in widths of the axes; least and greatest width of a diagram [K].
_MARGIN = 0.06
_LEAST_WIDTH, _MOST_WIDTH = 40.0, 400.0
_LEVEL = "level"  # marks the names of levels among the texts of the axes


def fit_skewt(axes: Axes, width: float, height: float, size: float) -> None:
    """Choose the range of temperatures of a skew-T for its size, and move the names of its levels apart.

    Isotherms are inclined on the page. How far a curve reaches to the left and to the right therefore depends on the
    height and the width of the axes.

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
    Because isotherms are inclined, a curve that cools by 80 K needs less than 80 K of the width of the page:

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
    """Return the lowest temperature at the bottom of the axes [degC], and the range of temperatures there [K].

    ``slope`` is the height of the axes divided by their width. Each point of a curve is moved to the right by its
    height times the tangent of the rotation. Measured in kelvin, that shift grows with the range of temperatures.
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
    """Draw a horizontal line across a skew-T for each level, with its name to the right of the diagram.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        The axes, with their pressures set.
    levels : dict of str to float
        Pressure of each level by its name [hPa]; levels outside the diagram are left out.
    theme : Theme
        The theme: sizes of type, lines and markers.

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
    """Return ascending positions, moved until they are at least a gap apart and none is above the height."""
    moved = list(places)
    for i in range(1, len(moved)):
        moved[i] = max(moved[i], moved[i - 1] + gap)
    ceiling = height
    for i in reversed(range(len(moved))):
        moved[i] = min(moved[i], ceiling)
        ceiling = moved[i] - gap
    return moved
