"""The curves of a panel: what was measured, what was calculated, and what they are compared with."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from numpy.typing import NDArray

from atmosbox.panels import Line, Panel
from atmosbox.plot.curve import Curve, curve, edges
from atmosbox.plot.disc import draw_discs
from atmosbox.plot.theme import (
    DATA_COLOURS,
    DATA_MARKERS,
    ENVIRONMENT_COLOURS,
    ENVIRONMENT_DASHES,
    REFERENCE_COLOURS,
    REFERENCE_WIDTH,
    THEORY_COLOURS,
    THEORY_DASHES,
    Theme,
)

if TYPE_CHECKING:
    import xarray as xr

Entry = tuple[tuple[Artist, ...], str]

# Up to so many values, a measured curve is drawn as points with bars; beyond, as a line with a band.
_MOST_POINTS = 40
# A curve that crosses its own range more often than this becomes thinner, lest its scatter be a blot; down to
# this share of its width.
_MOST_CROSSINGS, _THINNEST = 25.0, 0.5
# Where the ground is missing by so little, the axis of pressure still begins at 1000 hPa.
_NEAR_THE_GROUND = 930.0
# One level alone stands in the middle of a logarithmic axis that reaches to so many times it.
_ONE_LEVEL = 1.3
_ORDER = {"band": 1.0, "reference": 1.5, "environment": 2.0, "data": 3.0, "theory": 4.0}


def draw(axes: Axes, panel: Panel, dataset: xr.Dataset, theme: Theme) -> list[Entry]:
    """Draw a panel, and set scales and limits of its axes.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    panel : Panel
        What to draw.
    dataset : xarray.Dataset
        The run.
    theme : Theme
        How large.

    Returns
    -------
    list of tuple
        The entries of the legend: the artists of a curve, and its label.

    Raises
    ------
    FileError
        If the file lacks a variable of the panel.

    Examples
    --------
    >>> import xarray as xr
    >>> from matplotlib.figure import Figure
    >>> from atmosbox.plot.theme import THEMES
    >>> dataset = xr.Dataset({"p": ("z", [1e5, 9e4], {"units": "Pa"})}, coords={"z": [0.0, 900.0]})
    >>> panel = Panel("profile", "Pressure", (Line("p", "z", "air"),), x_unit="hPa")
    >>> [label for _, label in draw(Figure().add_subplot(), panel, dataset, THEMES["notes"])]
    ['air']
    """
    if panel.kind == "discs":
        return draw_discs(axes, panel, dataset, theme)
    axes.set_xscale(panel.x_scale)
    axes.set_yscale(panel.y_scale)
    axes.grid(visible=True)
    entries, most = draw_lines(axes, panel, dataset, theme)
    _set_limits(axes, panel, most)
    return entries


def draw_lines(axes: Axes, panel: Panel, dataset: xr.Dataset, theme: Theme) -> tuple[list[Entry], int]:
    """Draw the curves of a panel into axes that have their scales.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    panel : Panel
        What to draw.
    dataset : xarray.Dataset
        The run.
    theme : Theme
        How large.

    Returns
    -------
    list of tuple
        The entries of the legend.
    int
        How many values the longest curve has.

    Raises
    ------
    FileError
        If the file lacks a variable of the panel.

    Examples
    --------
    >>> import xarray as xr
    >>> from matplotlib.figure import Figure
    >>> from atmosbox.plot.theme import THEMES
    >>> dataset = xr.Dataset({"p": ("z", [1e5, 9e4], {"units": "Pa"})}, coords={"z": [0.0, 900.0]})
    >>> panel = Panel("profile", "Pressure", (Line("p", "z", "air"),), x_unit="hPa")
    >>> draw_lines(Figure().add_subplot(), panel, dataset, THEMES["notes"])[1]
    2
    """
    seen: Counter[str] = Counter()
    entries: list[Entry] = []
    most = 0
    for line in panel.lines:
        index = seen[line.role]
        seen[line.role] += 1
        if panel.kind == "histogram" and line.role == "data":
            artists = _steps(axes, panel, line, dataset, theme, index)
        else:
            values = curve(dataset, panel, line)
            artists = _line(axes, panel, line, values, theme, index)
            most = max(most, values.x.size)
        entries.append((artists, line.label))
    return entries, most


def _line(axes: Axes, panel: Panel, line: Line, values: Curve, theme: Theme, index: int) -> tuple[Artist, ...]:
    x, y, error = values
    style = _style(line.role, theme, index) | {"zorder": _ORDER[line.role]}
    along_x = panel.measured_across
    measured = line.role == "data"
    if x.size == 1 or (measured and x.size <= _MOST_POINTS):
        if measured and not along_x:
            axes.plot(x, y, alpha=0.4, **style)
        return _points(axes, panel, values, style, index)
    if measured and sum(other.role == "data" for other in panel.lines) > 1:
        every = max(1, x.size // 8)
        style |= {"marker": DATA_MARKERS[index % 4], "markevery": (every // 2 + index * every // 4, every)}
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
    """Draw values with bars of one standard error, and hollow where the error is not known."""
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
    """Tell which points have no error although the others have: a layer that was seldom visited, for instance.

    Parameters
    ----------
    values : Curve
        A curve.

    Returns
    -------
    ndarray of bool
        True at the points that are known and whose error is not; nowhere if the curve is no points but a line.

    Examples
    --------
    >>> one = np.ones(3)
    >>> hollow_points(Curve(one, one, np.array([0.1, np.nan, 0.2]))).tolist()
    [False, True, False]
    """
    known = np.isfinite(values.x) & np.isfinite(values.y)
    if values.error is None or values.x.size > _MOST_POINTS:
        return np.zeros_like(known)
    return known & ~np.isfinite(values.error)


def _crossings(values: NDArray[np.float64]) -> float:
    """Return how often a curve goes over its whole range, up or down; at least once."""
    seen = values[np.isfinite(values)]
    extent = np.ptp(seen) if seen.size else 0.0
    return max(1.0, float(np.abs(np.diff(seen)).sum() / extent)) if extent else 1.0


def _steps(axes: Axes, panel: Panel, line: Line, dataset: xr.Dataset, theme: Theme, index: int) -> tuple[Artist, ...]:
    """Draw a histogram, between the bounds of its bins."""
    x, y, error = curve(dataset, panel, line)
    colour = DATA_COLOURS[index % len(DATA_COLOURS)]
    bounds = edges(dataset, panel, line)
    area = axes.stairs(y, bounds, color=colour, alpha=0.25, fill=True, linewidth=0.0, zorder=_ORDER["band"])
    steps = axes.stairs(y, bounds, color=colour, linewidth=theme.line, baseline=None, zorder=_ORDER["data"])
    if error is not None:
        axes.errorbar(x, y, error, linestyle="none", color=colour, capsize=0.0, zorder=_ORDER["data"])
    return area, steps


def _style(role: str, theme: Theme, index: int) -> dict[str, Any]:
    """Return colour and dashes of the index-th curve of its role."""
    if role == "theory":
        return {
            "color": THEORY_COLOURS[index % len(THEORY_COLOURS)],
            "linestyle": (0.0, THEORY_DASHES[index % len(THEORY_DASHES)]),
            "linewidth": theme.line * 1.1,
        }
    if role == "environment":
        colour = ENVIRONMENT_COLOURS[index % len(ENVIRONMENT_COLOURS)]
        dashes = ENVIRONMENT_DASHES[index % len(ENVIRONMENT_DASHES)]
        return {"color": colour, "linestyle": (0.0, dashes), "linewidth": theme.line}
    if role == "reference":
        colour = REFERENCE_COLOURS[index % len(REFERENCE_COLOURS)]
        return {"color": colour, "linestyle": "solid", "linewidth": theme.line * REFERENCE_WIDTH}
    return {"color": DATA_COLOURS[index % len(DATA_COLOURS)], "linestyle": "solid", "linewidth": theme.line}


def _set_limits(axes: Axes, panel: Panel, values: int) -> None:
    """Leave no idle room where a curve of many values runs from end to end, and let heights begin at zero."""
    across = {"profile": 0.07, "histogram": 0.0}.get(panel.kind, 0.03 if values <= _MOST_POINTS else 0.0)
    axes.margins(x=across, y=0.07 if panel.kind == "line" else 0.02)
    low, high = axes.dataLim.intervaly
    if panel.kind == "profile" and panel.y_scale == "log" and low >= high * (1.0 - 1e-9):
        axes.set_autoscaley_on(False)
        axes.set_ylim(low / _ONE_LEVEL, high * _ONE_LEVEL)
    axes.autoscale_view()
    if panel.kind == "line" and panel.x_scale == "linear" and 0.0 < axes.get_xlim()[0] < 0.1 * axes.get_xlim()[1]:
        axes.set_xlim(left=0.0)
    if panel.kind == "histogram":
        axes.set_ylim(bottom=0.0, top=axes.get_ylim()[1] * 1.05)
    elif panel.kind == "profile" and panel.y_scale == "linear":
        low, high = axes.dataLim.intervaly
        if np.isfinite([low, high]).all() and 0.0 <= low < 0.2 * high:
            axes.set_ylim(bottom=0.0)
    elif panel.kind == "profile" and panel.y_unit == "hPa":
        top, bottom = axes.dataLim.intervaly
        if _NEAR_THE_GROUND < bottom < 1000.0:
            axes.set_ylim(top=1000.0 * (1000.0 / top) ** 0.02)
    axes.xaxis.set_inverted(panel.x_invert)
    axes.yaxis.set_inverted(panel.y_invert)
