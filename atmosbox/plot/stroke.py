"""One curve of a panel, drawn as a line with a band, as points with error bars, or as the steps of a histogram."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from numpy.typing import NDArray

from atmosbox.plot.curve import Curve, curve, edges
from atmosbox.plot.theme import CURVES, DATA_COLOURS, DATA_MARKERS, Theme
from atmosbox.scene.panels import Line, Panel

# A measured curve of at most this many values is drawn as points with error bars, a longer one as a line with a band.
MOST_POINTS = 40
# A curve that crosses its whole range more often than this is drawn thinner, so that its scatter does not become a
# solid area; at the thinnest, this share of the usual width.
_MOST_CROSSINGS, _THINNEST = 25.0, 0.5
_ORDER = {"band": 1.0, "reference": 1.5, "environment": 2.0, "data": 3.0, "theory": 4.0}


def draw_line(
    axes: Axes, panel: Panel, line: Line, values: Curve, theme: Theme, index: int, **look: Any
) -> tuple[Artist, ...]:
    """Draw one curve of a panel.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    panel : Panel
        The panel.
    line : Line
        One of its lines.
    values : Curve
        Its numbers; values that are not finite are not drawn.
    theme : Theme
        The theme: sizes of type, lines and markers.
    index : int
        Number of lines of the same role before this one in the panel.
    **look
        Overrides of the style of its role: ``color``, ``linestyle``, ``linewidth``.

    Returns
    -------
    tuple of Artist
        The artists that stand for it in the legend.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from atmosbox.plot.theme import THEMES
    >>> line = Line("z", "p", "air", "theory")
    >>> values = Curve(np.array([0.0, 1.0]), np.array([1e3, 9e2]), None)
    >>> (drawn,) = draw_line(Figure().add_subplot(), Panel("line", "Air", (line,)), line, values, THEMES["notes"], 0)
    >>> drawn.get_color()
    '#1a1a1a'
    """
    x, y, error = values
    style = line_style(line.role, theme, index) | {"zorder": _ORDER[line.role]} | look
    along_x = panel.measured_across
    measured = line.role == "data"
    if x.size == 1 or (measured and x.size <= MOST_POINTS):
        if measured and not along_x:
            axes.plot(x, y, alpha=0.4, **style)
        return _points(axes, panel, values, style, index)
    if measured and sum(other.role == "data" for other in panel.lines) > 1:
        every = max(1, x.size // 8)
        style |= {
            "marker": DATA_MARKERS[index % len(DATA_MARKERS)],
            "markevery": (every // 2 + index * every // 4, every),
        }
    if measured:
        style["linewidth"] *= min(1.0, max(_THINNEST, _MOST_CROSSINGS / _crossings(x if along_x else y)))
    artists: list[Artist] = []
    if error is not None:
        alpha = 0.3 if measured else 0.15
        fill = {"color": style["color"], "alpha": alpha, "linewidth": 0.0, "zorder": _ORDER["band"]}
        if along_x:
            artists.append(axes.fill_betweenx(y, x - error, x + error, **fill))
        else:
            artists.append(axes.fill_between(x, y - error, y + error, **fill))
    artists.extend(axes.plot(x, y, **style))
    return tuple(artists)


def _points(axes: Axes, panel: Panel, values: Curve, style: dict[str, Any], index: int) -> tuple[Artist, ...]:
    """Draw points with bars of one standard error; points whose error is not known are hollow."""
    along_x = panel.measured_across
    marker = DATA_MARKERS[index % len(DATA_MARKERS)]
    bars = axes.errorbar(
        values.x,
        values.y,
        xerr=values.error if along_x else None,
        yerr=None if along_x else values.error,
        linestyle="none",
        marker=marker,
        capsize=0.0,
        elinewidth=style["linewidth"],
        color=style["color"],
        zorder=style["zorder"],
    )
    unsure = hollow_points(values)
    if unsure.any():
        axes.plot(
            values.x[unsure],
            values.y[unsure],
            linestyle="none",
            marker=marker,
            color=style["color"],
            markerfacecolor="white",
            zorder=style["zorder"] + 0.5,
        )
    return (cast(Artist, bars),)


def hollow_points(values: Curve) -> NDArray[np.bool_]:
    """Tell which points of a curve with errors have none, a layer that was seldom visited for instance.

    Parameters
    ----------
    values : Curve
        A curve.

    Returns
    -------
    ndarray of bool
        True at points whose value is known and whose error is not; False everywhere if the curve is drawn as a line.

    Examples
    --------
    >>> one = np.ones(3)
    >>> hollow_points(Curve(one, one, np.array([0.1, np.nan, 0.2]))).tolist()
    [False, True, False]
    """
    known = np.isfinite(values.x) & np.isfinite(values.y)
    if values.error is None or values.x.size > MOST_POINTS:
        return np.zeros_like(known)
    return known & ~np.isfinite(values.error)


def _crossings(values: NDArray[np.float64]) -> float:
    """Return how often a curve crosses its whole range: the sum of all steps over the range, at least 1."""
    seen = values[np.isfinite(values)]
    extent = np.ptp(seen) if seen.size else 0.0
    return max(1.0, float(np.abs(np.diff(seen)).sum() / extent)) if extent else 1.0


def draw_steps(
    axes: Axes,
    panel: Panel,
    line: Line,
    dataset: xr.Dataset,
    theme: Theme,
    index: int,
    *,
    colour: Any = None,
    style: Any = "solid",
    filled: bool = True,
) -> tuple[Artist, ...]:
    """Draw a histogram, between the bounds of its bins.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    panel : Panel
        The panel.
    line : Line
        One of its measured lines.
    dataset : xarray.Dataset
        The run.
    theme : Theme
        The theme: sizes of type, lines and markers.
    index : int
        Number of measured lines before this one in the panel.
    colour, style
        Colour and dashes, if they are not those of its role.
    filled : bool
        Whether the area below is tinted.

    Returns
    -------
    tuple of Artist
        The artists that stand for it in the legend.

    Examples
    --------
    >>> import xarray as xr
    >>> from matplotlib.figure import Figure
    >>> from atmosbox.plot.theme import THEMES
    >>> dataset = xr.Dataset({"f": ("speed", [1.0, 3.0])}, coords={"speed": [50.0, 150.0]})
    >>> line = Line("speed", "f", "molecules")
    >>> panel = Panel("histogram", "Speeds", (line,))
    >>> _, steps = draw_steps(Figure().add_subplot(), panel, line, dataset, THEMES["notes"], 0)
    >>> steps.get_data().edges.tolist()
    [0.0, 100.0, 200.0]
    """
    x, y, error = curve(dataset, panel, line)
    colour = colour or DATA_COLOURS[index % len(DATA_COLOURS)]
    bounds = edges(dataset, panel, line)
    look = {"color": colour, "alpha": 0.25, "linewidth": 0.0, "zorder": _ORDER["band"]}
    area = (axes.stairs(y, bounds, fill=True, **look),) if filled else ()
    steps = axes.stairs(
        y, bounds, color=colour, linewidth=theme.line, linestyle=style, baseline=None, zorder=_ORDER["data"]
    )
    if error is not None:
        axes.errorbar(x, y, error, linestyle="none", color=colour, capsize=0.0, zorder=_ORDER["data"])
    return *area, steps


def line_style(role: str, theme: Theme, index: int) -> dict[str, Any]:
    """Return colour, dashes and width of a curve.

    Parameters
    ----------
    role : str
        Role of the curve, one of `panels.ROLES`.
    theme : Theme
        The theme: sizes of type, lines and markers.
    index : int
        Number of curves of this role before it.

    Examples
    --------
    >>> from atmosbox.plot.theme import THEMES
    >>> line_style("data", THEMES["notes"], 0)["linestyle"]
    'solid'
    """
    colours, dashes, width = CURVES[role]
    return {
        "color": colours[index % len(colours)],
        "linestyle": dashes[index % len(dashes)],
        "linewidth": theme.line * width,
    }
