"""The curves of a panel: lines with bands, points with error bars, steps of a histogram; and the limits of its axes."""

from collections.abc import Callable, Sequence
from typing import Any, cast

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import StepPatch
from numpy.typing import NDArray

from atmosbox.plot.atmosphere_picture import draw_atmosphere
from atmosbox.plot.curve import Curve, curve, edges
from atmosbox.plot.discs import draw_discs
from atmosbox.plot.theme import AREAS, CURVES, DARK, DATA_MARKERS, FAINT, Theme
from atmosbox.scene.panels import Line, Panel

# A measured curve of at most this many values is drawn as points with error bars, a longer one as a line with a band.
MOST_POINTS = 40
# A curve that crosses its whole range more often than this is drawn thinner, so that its scatter does not become a
# solid area; at the thinnest, this share of the usual width.
_MOST_CROSSINGS, _THINNEST = 25.0, 0.4
_ORDER = {"band": 1.0, "tint": 1.1, "reference": 1.5, "environment": 2.0, "data": 3.1, "hollow": 3.5, "theory": 4.0}
MEASURED = (_ORDER["tint"], _ORDER["data"], _ORDER["hollow"])
"""Drawing orders (``zorder``) of all that shows a measured curve; nothing else has them."""


def draw_line(
    axes: Axes, panel: Panel, line: Line, values: Curve, theme: Theme, index: int, **look: Any
) -> tuple[Artist, ...]:
    """Draw one curve in the style of its role, changed by ``look``; return the artists that stand for it in the legend.

    ``index`` is the number of lines of the same role before this one in the panel. NaN is not drawn.
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
        style["marker"] = DATA_MARKERS[index % len(DATA_MARKERS)]
        style["markevery"] = every // 2 + index * every // 4, every
    if measured:
        style["linewidth"] *= min(1.0, max(_THINNEST, _MOST_CROSSINGS / _crossings(x if along_x else y)))
    artists: list[Artist] = []
    if error is not None:
        order, alpha = ("tint", 0.3) if measured else ("band", 0.15)
        fill = {"color": style["color"], "alpha": alpha, "linewidth": 0.0, "zorder": _ORDER[order]}
        along, value, band = (y, x, axes.fill_betweenx) if along_x else (x, y, axes.fill_between)
        artists.append(band(along, value - error, value + error, **fill))
    artists.extend(axes.plot(x, y, **style))
    return tuple(artists)


def _points(axes: Axes, panel: Panel, values: Curve, style: dict[str, Any], index: int) -> tuple[Artist, ...]:
    """Draw points with bars of one standard error; points whose error is not known are hollow."""
    x, y, error = values
    look = {"linestyle": "none", "marker": DATA_MARKERS[index % len(DATA_MARKERS)], "color": style["color"]}
    bars = {"xerr" if panel.measured_across else "yerr": error, "elinewidth": style["linewidth"]}
    drawn = axes.errorbar(x, y, zorder=style["zorder"], **look, **bars)
    if (unsure := hollow_points(values)).any():
        axes.plot(x[unsure], y[unsure], markerfacecolor="white", zorder=_ORDER["hollow"], **look)
    return (cast(Artist, drawn),)


def hollow_points(values: Curve) -> NDArray[np.bool_]:
    """Tell which points of a curve with error bars have none, as in a layer that was seldom visited.

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
    axes: Axes, panel: Panel, line: Line, dataset: xr.Dataset, theme: Theme, index: int, **look: Any
) -> tuple[Artist, ...]:
    """Draw a histogram, between the bounds of its bins, with the area below tinted unless ``look`` is given."""
    x, y, error = curve(dataset, panel, line)
    style = line_style("data", theme, index) | {"linewidth": theme.line, "zorder": _ORDER["data"]} | look
    bounds = edges(dataset, panel, line)
    tint = {"color": style["color"], "alpha": 0.25, "linewidth": 0.0, "zorder": _ORDER["tint"]}
    area = () if look else (axes.stairs(y, bounds, fill=True, **tint),)
    steps = axes.stairs(y, bounds, baseline=None, **style)
    if error is not None:
        axes.errorbar(x, y, error, linestyle="none", color=style["color"], zorder=style["zorder"])
    return *area, steps


def line_style(role: str, theme: Theme, index: int) -> dict[str, Any]:
    """Return colour, dashes and width of a curve; ``index`` is the number of curves of its role before it."""
    colours, dashes, width = CURVES[role]
    look = {"color": colours[index % len(colours)], "linestyle": dashes[index % len(dashes)]}
    return look | {"linewidth": theme.line * width}


Entry = tuple[tuple[Artist, ...], str]
Curves = Callable[[Axes, Panel, Theme], list[Entry]]
"""Draws the curves of a panel and returns the legend entries."""

# The axis of a histogram ends where data and theory are below this share of the peak.
_NEGLIGIBLE = 1e-3


def draw(axes: Axes, panel: Panel, runs: Sequence[xr.Dataset], theme: Theme, curves: Curves) -> list[Entry]:
    """Draw a panel of one or several runs, and set the scales and the limits of its axes; return its legend entries."""
    if panel.kind == "discs":
        return draw_discs(axes, panel, runs[0], theme)
    if panel.kind == "atmosphere":
        return draw_atmosphere(axes, runs[0], theme, panel.start)
    axes.set(xscale=panel.x_scale, yscale=panel.y_scale)
    axes.grid(visible=True)
    entries = curves(axes, panel, theme)
    if panel.areas and len(runs) == 1:
        x, y, _ = curve(runs[0], panel, panel.lines[0])
        # above the highest level where it rises by itself, a parcel is not inhibited: it has passed the EL
        below = np.arange(x.size) <= np.flatnonzero(x > 0.0).max(initial=-1)
        for name, shown in (("CAPE", x > 0.0), ("CIN", (x < 0.0) & below)):
            area = axes.fill_betweenx(y, np.where(shown, x, 0.0), zorder=0.8, **AREAS[name])
            entries.append(((area,), name))
    set_limits(axes, panel)
    if len(runs) == 1:
        draw_guides(axes, panel, theme)
    return entries


def draw_guides(axes: Axes, panel: Panel, theme: Theme) -> None:
    """Draw the guides of a panel, their texts away from its first curve, and mark where its curves begin."""
    look: dict[str, Any] = {"size": theme.text, "color": FAINT, "textcoords": "offset points", "zorder": 5.0}
    thin: dict[str, Any] = {"color": FAINT, "linewidth": 0.7 * theme.line, "zorder": 1.4}
    drawn = [line for line in axes.lines if line.get_zorder() == _ORDER["data"]]
    curves = [points for points in (np.asarray(line.get_xydata()) for line in drawn) if points.size]
    gap = 0.25 * theme.text
    for axis, value, words in panel.guides:
        low, high = sorted(axes.get_xlim() if axis == "x" else axes.get_ylim())
        if not low <= value <= high:
            continue
        if axis == "x":
            axes.axvline(value, **thin)
            axes.annotate(words, (value, 0.0), (gap, gap), xycoords=("data", "axes fraction"), **look)
            continue
        axes.axhline(value, **thin)
        near = curves[0][np.nanargmin(np.abs(curves[0][:, 1] - value))] if curves else (low, value)
        right = axes.transLimits.transform(axes.transScale.transform(near))[0] < 0.7
        place, side = ((1.0, -gap), "right") if right else ((0.0, gap), "left")
        axes.annotate(words, (place[0], value), (place[1], gap), xycoords=("axes fraction", "data"), ha=side, **look)
    if panel.start and curves:
        begins = panel.start[0] or min(float(points[0, 0]) for points in curves), panel.start[1]
        ring: dict[str, Any] = {"markersize": 1.6 * theme.marker, "markerfacecolor": "white", "markeredgecolor": DARK}
        axes.add_artist(Line2D(begins[:1], begins[1:], marker="o", zorder=4.5, clip_on=False, **ring))
        # above the point and to the right; a little lower where the curve would cross the word
        right, wide = 1.8 * theme.marker, 2.5 * theme.text
        along, rise = np.diff(axes.transData.transform(curves[0][:2]), axis=0).sum(axis=0)
        crosses = rise * (right + wide) > along * gap and rise * right < along * (gap + theme.text)
        up = -0.4 * theme.text if panel.kind == "line" and crosses else gap
        axes.annotate("start", begins, (right, up), **look | {"color": DARK})


def from_start(panel: Panel, line: Line, values: Curve) -> Curve:
    """Return a curve that begins where the panel says; half a frame from the first on a logarithmic axis."""
    begins = line.role == "data" or (panel.kind == "profile" and line.role in ("theory", "environment"))
    if not (panel.start and begins and values.x.size):
        return values
    x = panel.start[0] or (0.5 * float(np.nanmin(values.x)) if panel.x_scale == "log" else 0.0)
    error = None if values.error is None else np.append(0.0, values.error)
    return Curve(np.append(x, values.x), np.append(panel.start[1], values.y), error)


def draw_lines(dataset: xr.Dataset, axes: Axes, panel: Panel, theme: Theme) -> list[Entry]:
    """Draw the curves of one run, and return the legend entries."""
    artists: dict[str, tuple[Artist, ...]] = {}
    for place, line in enumerate(panel.lines):
        # curves of one label look alike
        index = len({each.label for each in panel.lines[:place] if each.role == line.role} - {line.label})
        if panel.kind == "histogram" and line.role == "data":
            drawn = draw_steps(axes, panel, line, dataset, theme, index)
        else:
            values = from_start(panel, line, curve(dataset, panel, line))
            drawn = draw_line(axes, panel, line, values, theme, index)
        artists.setdefault(line.label, drawn)
    first = {line.label: line.role != "data" for line in reversed(panel.lines)}
    return [(artists[label], label) for label in sorted(artists, key=first.__getitem__)]


def set_limits(axes: Axes, panel: Panel) -> None:
    """Set the limits of axes: no margin beside a curve of many values, and heights that begin at zero."""
    values = max((np.size(line.get_xdata()) for line in axes.lines), default=0)
    across = {"profile": 0.07, "histogram": 0.0}.get(
        panel.kind, 0.03 if panel.averages or values <= MOST_POINTS else 0.0
    )
    up = 0.02 if panel.kind != "line" else 0.15 if panel.start else 0.07
    axes.margins(x=across, y=up)
    if panel.y_limits:
        axes.update_datalim([(0.0, value) for value in panel.y_limits], updatex=False)
    axes.autoscale_view()
    if panel.kind == "line" and panel.x_scale == "linear" and 0.0 < axes.get_xlim()[0] < 0.1 * axes.get_xlim()[1]:
        axes.set_xlim(left=0.0)
    if panel.kind == "histogram":
        axes.set_ylim(bottom=0.0, top=axes.get_ylim()[1] * 1.05)
        axes.set_xlim(right=_end_of_histogram(axes))
    elif panel.kind == "profile" and panel.y_scale == "linear":
        low, high = axes.dataLim.intervaly  # infinite without a value
        if 0.0 <= low < 0.2 * high:
            axes.set_ylim(bottom=0.0)
    axes.set_xlim(*panel.x_limits)  # without limits, those of the curves stay
    axes.set_ylim(*panel.y_limits)
    axes.xaxis.set_inverted(panel.x_invert)
    axes.yaxis.set_inverted(panel.y_invert)


def _end_of_histogram(axes: Axes) -> float:
    """Return the abscissa beyond which neither a histogram nor a curve beside it is seen."""
    steps = [each.get_data() for each in axes.patches if isinstance(each, StepPatch)]
    curves = [(edges[1:], values) for values, edges, _ in steps]
    curves += [(np.asarray(line.get_xdata()), np.asarray(line.get_ydata())) for line in axes.lines]
    seen = _NEGLIGIBLE * max((np.nanmax(y, initial=0.0) for _, y in curves), default=0.0)
    return max((float(x[y > seen].max()) for x, y in curves if (y > seen).any()), default=axes.get_xlim()[1])
