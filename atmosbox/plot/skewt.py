"""A parcel in its environment on the diagram that forecasters use: the skew-T of MetPy."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec
from numpy.typing import NDArray

from atmosbox.errors import FileError
from atmosbox.plot.curve import read
from atmosbox.plot.draw import Entry, draw_lines
from atmosbox.plot.energy import shade_energy
from atmosbox.plot.theme import PALE, Theme
from atmosbox.plot.tilt import ROTATION, put_levels
from atmosbox.plot.unit import convert
from atmosbox.scene.panels import Line, Panel

BACKGROUND = "grey: dry adiabats (solid), moist adiabats (dashed), mixing ratios (dotted)"

_ABBREVIATIONS = {"lcl": "LCL", "cloud_base": "LCL", "lfc": "LFC", "el": "EL"}
SHADE_ORDER = 0.8
"""Drawing order (``zorder``) of the shaded areas: above the background lines, below all curves."""

_SLENDER = 0.75  # width of the curves in units of the theme's width
# Distance of the curves from the lower and the upper end, as a share of their height; least ratio of the pressures.
_END, _LEAST_RATIO = 0.02, 2.0
# Background lines: temperatures of the adiabats at 1000 hPa [degC], and mixing ratios [g kg-1].
_DRY = np.arange(-80.0, 321.0, 20.0)
_MOIST = np.arange(-30.0, 41.0, 10.0)
_MIXING = np.array([0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0])
_MIXING_TOP = 400.0  # upper end of the lines of mixing ratio [hPa]
_HIGHEST_MOIST = 50.0  # upper end of the moist adiabats [hPa]

Floats = NDArray[np.float64]


def levels(dataset: xr.Dataset, panel: Panel) -> dict[str, float]:
    """Return the pressures of the levels that a panel marks.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run.
    panel : Panel
        The panel; its ``marks`` are names of single numbers in the file.

    Returns
    -------
    dict of str to float
        Pressure of each level by its name [hPa]; levels that the run has not found are left out.

    Raises
    ------
    FileError
        If a mark is not a single number, or not a pressure.

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.scene.panels import Line
    >>> parcel = Line("parcel_temperature", "parcel_pressure", "parcel")
    >>> panel = Panel("skewt", "Air", (parcel,), marks=("lcl", "lfc", "el"))
    >>> held = {"lcl": ((), 9e4, {"units": "Pa"}), "lfc": ((), float("nan"), {"units": "Pa"})}
    >>> levels(xr.Dataset(held), panel)
    {'LCL': 900.0}
    """
    found: dict[str, float] = {}
    for name in panel.marks:
        if name not in dataset.variables or not dataset[name].attrs.get("resolved", True):
            continue
        variable = read(dataset, name)
        if variable.ndim:
            raise FileError(f"The variable {name!r} of the file is a list, and a mark is a single number.")
        unit = str(variable.attrs.get("units", "1"))
        pressure = float(convert(variable.values, unit, panel.y_unit, name=name))
        if math.isfinite(pressure) and pressure > 0.0:
            found.setdefault(_ABBREVIATIONS.get(name, name.replace("_", " ")), pressure)
    return found


def draw_skewt(
    figure: Figure,
    spot: SubplotSpec,
    panel: Panel,
    dataset: xr.Dataset,
    theme: Theme,
    only: tuple[Line, ...] | None = None,
) -> tuple[Axes, list[Entry]]:
    """Draw a parcel and its environment as a skew-T, with CAPE and CIN shaded.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        Where to draw.
    spot : matplotlib.gridspec.SubplotSpec
        The place of the panel in it.
    panel : Panel
        A panel of the kind ``skewt``.
    dataset : xarray.Dataset
        The run.
    theme : Theme
        The theme: sizes of type, lines and markers.
    only : tuple of Line, optional
        The lines to draw; by default all.

    Returns
    -------
    matplotlib.axes.Axes
        The axes. `tilt.fit_skewt` sets their range of temperatures later.
    list of tuple
        The entries of the legend.

    Raises
    ------
    FileError
        If the file lacks a variable of the panel.

    Notes
    -----
    The shaded areas lie between the curves of temperature that are drawn. On MetPy's diagram an area is nearly, but
    not exactly, proportional to an energy, and CAPE and CIN are computed from virtual temperatures. The areas show
    where these energies come from; the headline numbers give their values.

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> from atmosbox.scene.panels import Line
    >>> from atmosbox.plot.theme import THEMES
    >>> held = {
    ...     "t": ("level", np.array([300.0, 280.0, 250.0]), {"units": "K"}),
    ...     "p": ("level", np.array([1000e2, 700e2, 400e2]), {"units": "Pa"}),
    ... }
    >>> figure = Figure()
    >>> spot = figure.add_gridspec(1, 1)[0, 0]
    >>> panel = Panel("skewt", "Air", (Line("t", "p", "air"),))
    >>> axes, entries = draw_skewt(figure, spot, panel, xr.Dataset(held), THEMES["notes"])
    >>> axes.get_yscale(), [label for _, label in entries]
    ('log', ['air'])
    """
    marks = levels(dataset, panel)
    skewed, axes = skewed_axes(figure, spot)
    entries, _ = draw_lines(axes, panel, dataset, slender(theme), only)
    put_background(skewed, axes, theme)
    put_levels(axes, marks, theme)
    return axes, entries + shade_energy(skewed, panel, dataset, marks, SHADE_ORDER)


def skewed_axes(figure: Figure, spot: SubplotSpec) -> tuple[Any, Axes]:
    """Return an empty skew-T and its axes.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        Where to draw.
    spot : matplotlib.gridspec.SubplotSpec
        The place in it.

    Returns
    -------
    metpy.plots.SkewT
        The diagram.
    matplotlib.axes.Axes
        Its axes.

    Examples
    --------
    >>> figure = Figure()
    >>> skewed_axes(figure, figure.add_gridspec(1, 1)[0, 0])[1].get_yscale()
    'log'
    """
    with warnings.catch_warnings(action="ignore"):  # a user can do nothing about warnings of MetPy in a new Python
        from metpy.plots import SkewT

        skewed = SkewT(figure, rotation=ROTATION, subplot=spot, aspect="auto")
    axes: Axes = skewed.ax
    _mend_ticks(axes)
    axes.grid(visible=True)
    axes.spines[:].set_visible(True)
    axes.tick_params(top=False)
    return skewed, axes


def put_background(skewed: Any, axes: Axes, theme: Theme) -> None:
    """Set the range of pressures of a skew-T from its curves, and draw the background lines.

    Parameters
    ----------
    skewed : metpy.plots.SkewT
        The diagram, with its curves.
    axes : matplotlib.axes.Axes
        Its axes.
    theme : Theme
        The theme: sizes of type, lines and markers.

    Examples
    --------
    >>> from atmosbox.plot.theme import THEMES
    >>> figure = Figure()
    >>> skewed, axes = skewed_axes(figure, figure.add_gridspec(1, 1)[0, 0])
    >>> _ = axes.plot([20.0, -60.0], [1000.0, 250.0])
    >>> put_background(skewed, axes, THEMES["notes"])
    >>> [round(float(limit)) for limit in axes.get_ylim()]
    [1028, 243]
    """
    bottom, top = _pressures(axes)
    axes.set_ylim(bottom, top)
    _draw_background(skewed, bottom, top, theme)


def slender(theme: Theme) -> Theme:
    """Return a theme with thinner curves for a skew-T, where the curves run close together near the ground.

    Examples
    --------
    >>> from atmosbox.plot.theme import THEMES
    >>> slender(THEMES["notes"]).line < THEMES["notes"].line
    True
    """
    return replace(theme, line=_SLENDER * theme.line)


def _mend_ticks(axes: Any) -> None:
    """Replace the ticks of MetPy, which find the ends of the axes by a function that matplotlib has deprecated.

    MetPy 1.7 calls that function whenever it draws a tick, and each call would cause a warning.
    """
    from metpy.plots.skewt import SkewXTick

    class Tick(SkewXTick):  # type: ignore[misc]
        lower_in_bounds = property(lambda self: _holds(self.axes.lower_xlim, self.get_loc()))
        upper_in_bounds = property(lambda self: _holds(self.axes.upper_xlim, self.get_loc()))
        grid_in_bounds = property(lambda self: _holds(self.axes.xaxis.get_view_interval(), self.get_loc()))

    axes.xaxis._get_tick = lambda major: Tick(axes, None, major=major)
    axes.xaxis.reset_ticks()


def _holds(interval: tuple[float, float], value: float) -> bool:
    """Tell whether a value lies in an interval whose ends may be in either order."""
    return bool(min(interval) <= value <= max(interval))


def _pressures(axes: Axes) -> tuple[float, float]:
    """Return the pressures at the bottom and at the top of the diagram [hPa]."""
    seen = np.concatenate([np.zeros(0), *(line.get_xydata()[:, 1] for line in axes.lines)])  # type: ignore[index]
    seen = seen[np.isfinite(seen)]
    ground, highest = (float(seen.max()), float(seen.min())) if seen.size else (1000.0, 500.0)
    if ground > 930.0:
        ground = max(ground, 1000.0)
    highest = min(highest, ground / _LEAST_RATIO)
    return ground * (ground / highest) ** _END, highest * (highest / ground) ** _END


def _draw_background(skewed: Any, bottom: float, top: float, theme: Theme) -> None:
    """Draw dry adiabats, moist adiabats and lines of mixing ratio, paler than any curve."""
    with warnings.catch_warnings(action="ignore"):
        from metpy.units import units

        def between(upper: float) -> Any:
            return units.Quantity(np.geomspace(bottom, upper, 60), "hPa")

        look = {"colors": PALE, "alpha": 1.0, "linewidths": theme.line / 2.4, "zorder": 0.5}
        skewed.plot_dry_adiabats(units.Quantity(_DRY + 273.15, "K"), between(top), linestyles="solid", **look)
        if bottom > _HIGHEST_MOIST:
            dashes = (0.0, (6.0, 3.0))
            start = units.Quantity(_MOIST, "degC")
            skewed.plot_moist_adiabats(start, between(max(top, _HIGHEST_MOIST)), linestyles=[dashes], **look)
        if bottom > _MIXING_TOP:
            dots = (0.0, (1.0, 2.5))
            skewed.plot_mixing_lines(_MIXING / 1e3, between(max(top, _MIXING_TOP)), linestyles=[dots], **look)
