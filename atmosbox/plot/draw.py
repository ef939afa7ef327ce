"""The curves of a panel: measurements, theory, and the curves with which they are compared."""

from __future__ import annotations

from collections import Counter

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import StepPatch

from atmosbox.plot.atmosphere_picture import draw_atmosphere
from atmosbox.plot.curve import curve
from atmosbox.plot.disc_marker import draw_discs
from atmosbox.plot.stroke import MOST_POINTS, draw_line, draw_steps
from atmosbox.plot.theme import Theme
from atmosbox.scene.panels import Line, Panel

Entry = tuple[tuple[Artist, ...], str]

# If the highest pressure is between this and 1000 hPa, the axis still begins at 1000 hPa.
_NEAR_THE_GROUND = 930.0
# A single value is drawn in the middle of a logarithmic axis, from the value divided by this to the value times this.
_ONE_LEVEL = 1.3
# The axis of a histogram ends where data and theory are below this share of the peak.
_NEGLIGIBLE = 1e-3


def draw(
    axes: Axes, panel: Panel, dataset: xr.Dataset, theme: Theme, only: tuple[Line, ...] | None = None
) -> list[Entry]:
    """Draw a panel, and set the scales and the limits of its axes.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    panel : Panel
        What to draw.
    dataset : xarray.Dataset
        The run.
    theme : Theme
        The theme: sizes of type, lines and markers.
    only : tuple of Line, optional
        The lines to draw; by default all.

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
    if panel.kind == "atmosphere":
        return draw_atmosphere(axes, dataset, theme)
    axes.set_xscale(panel.x_scale)
    axes.set_yscale(panel.y_scale)
    axes.grid(visible=True)
    entries, most = draw_lines(axes, panel, dataset, theme, only)
    set_limits(axes, panel, most)
    return entries


def draw_lines(
    axes: Axes, panel: Panel, dataset: xr.Dataset, theme: Theme, only: tuple[Line, ...] | None = None
) -> tuple[list[Entry], int]:
    """Draw the curves of a panel into axes whose scales are set.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    panel : Panel
        What to draw.
    dataset : xarray.Dataset
        The run.
    theme : Theme
        The theme: sizes of type, lines and markers.
    only : tuple of Line, optional
        The lines to draw; by default all.

    Returns
    -------
    list of tuple
        The entries of the legend: the artists of a curve, and its label.
    int
        Number of values of the longest curve.

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
        if only is not None and line not in only:
            continue
        if panel.kind == "histogram" and line.role == "data":
            artists = draw_steps(axes, panel, line, dataset, theme, index)
        else:
            values = curve(dataset, panel, line)
            artists = draw_line(axes, panel, line, values, theme, index)
            most = max(most, values.x.size)
        entries.append((artists, line.label))
    return entries, most


def set_limits(axes: Axes, panel: Panel, values: int) -> None:
    """Set the limits of axes: no empty margin beside a graph of many values, and heights that begin at zero.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        The axes, with all curves drawn.
    panel : Panel
        The panel.
    values : int
        Number of values of the longest curve.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> _ = axes.plot([280.0, 290.0], [50.0, 950.0])
    >>> set_limits(axes, Panel("profile", "Air", (Line("t", "z", "air"),)), 2)
    >>> float(axes.get_ylim()[0])
    0.0
    """
    across = {"profile": 0.07, "histogram": 0.0}.get(panel.kind, 0.03 if values <= MOST_POINTS else 0.0)
    axes.margins(x=across, y=0.07 if panel.kind == "line" else 0.02)
    low, high = axes.dataLim.intervaly
    if panel.kind == "profile" and panel.y_scale == "log" and low >= high * (1.0 - 1e-9):
        axes.set_autoscaley_on(False)
        axes.set_ylim(low / _ONE_LEVEL, high * _ONE_LEVEL)
    axes.autoscale_view()
    if panel.x_scale == "log" and axes.get_xlim()[1] <= axes.get_xlim()[0] * (1.0 + 1e-9):
        axes.set_xlim(axes.get_xlim()[0] / _ONE_LEVEL, axes.get_xlim()[1] * _ONE_LEVEL)
    if panel.kind == "line" and panel.x_scale == "linear" and 0.0 < axes.get_xlim()[0] < 0.1 * axes.get_xlim()[1]:
        axes.set_xlim(left=0.0)
    if panel.kind == "histogram":
        axes.set_ylim(bottom=0.0, top=axes.get_ylim()[1] * 1.05)
        axes.set_xlim(right=_end_of_histogram(axes))
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


def _end_of_histogram(axes: Axes) -> float:
    """Return the abscissa beyond which neither a histogram nor a curve beside it is seen."""
    steps = [each.get_data() for each in axes.patches if isinstance(each, StepPatch)]
    curves = [(edges[1:], values) for values, edges, _ in steps]
    curves += [(np.asarray(line.get_xdata()), np.asarray(line.get_ydata())) for line in axes.lines]
    seen = _NEGLIGIBLE * max((np.nanmax(y, initial=0.0) for _, y in curves), default=0.0)
    return max((float(x[y > seen].max()) for x, y in curves if (y > seen).any()), default=axes.get_xlim()[1])
