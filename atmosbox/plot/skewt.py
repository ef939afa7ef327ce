"""A parcel in its environment on the skew-T of MetPy, shaded where the parcel is warmer or colder."""

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec
from matplotlib.patches import Patch
from matplotlib.text import Annotation
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray

from atmosbox.plot.curve import Curve, curve, series
from atmosbox.plot.draw import Curves, Entry
from atmosbox.plot.theme import AREAS, DARK, FAINT, PALE, Theme
from atmosbox.scene.panels import Panel

Floats = NDArray[np.float64]

ROTATION = 30.0  # angle of the isotherms from the vertical [degree], as in MetPy

# On the page, a decade of pressure is at least as long as this many kelvin: otherwise the adiabats are too flat where
# the axes are wide.
_KELVINS_PER_DECADE = 60.0
# Least distance of the curves from the sides, in widths of the axes; least and greatest width of a diagram [K].
_MARGIN = 0.06
_LEAST_WIDTH, _MOST_WIDTH = 40.0, 400.0
_LEVEL = "level"  # marks the names of levels among the texts of the axes


def fit_skewt(axes: Axes, width: float, height: float, size: float) -> None:
    """Choose the range of temperatures of a skew-T for its size [pt], and move the names of its levels apart.

    Isotherms are inclined on the page: a curve that cools by 80 K needs less than 80 K of its width.

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
    axes.xaxis.set_major_locator(MultipleLocator(step))
    names = [text for text in axes.texts if isinstance(text, Annotation) and text.get_gid() == _LEVEL]
    above = -math.inf
    for text in names:  # from the ground up
        place = height * math.log(bottom / text.xy[1]) / math.log(bottom / top)
        above = max(place, above + 1.15 * size)
        text.set_position((0.8 * size, above - place))


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
    """Draw a line across a skew-T at the pressure of each level [hPa] inside it, with its name to the right."""
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


def shade_energy(
    skewed: Any, panel: Panel, dataset: xr.Dataset, marks: Mapping[str, float], order: float
) -> list[Entry]:
    """Shade where the parcel is warmer, between LFC and EL [hPa], and colder, below; return the legend entries."""
    roles = {line.role: line for line in reversed(panel.lines)}
    if "LFC" not in marks or not {"data", "environment"} <= set(roles):
        return []
    lfc, el = marks["LFC"], marks.get("EL", 0.0)
    curves = [curve(dataset, panel, roles[role]) for role in ("data", "environment")]
    pressure = np.unique(np.concatenate([*(each.y[np.isfinite(each.y)] for each in curves), [lfc, el or lfc]]))[::-1]
    parcel, around = (_temperature(each, pressure) for each in curves)
    known = np.isfinite(parcel) & np.isfinite(around)
    entries: list[Entry] = []
    for name, label, part, sign, shade in (
        ("CAPE", "warmer", known & (pressure <= lfc) & (pressure >= el), 1.0, skewed.shade_cape),
        ("CIN", "colder", known & (pressure >= lfc), -1.0, skewed.shade_cin),
    ):
        if (sign * (parcel - around)[part] > 0.0).any():
            shade(pressure[part], around[part], parcel[part], zorder=order, **AREAS[name])
            entries.append(((Patch(**AREAS[name]),), label))
    return entries


def _temperature(one: Curve, pressure: Floats) -> Floats:
    """Return the temperature of a curve at some pressures, NaN beyond its ends."""
    known = np.isfinite(one.x) & np.isfinite(one.y)
    if not known.any():
        return np.full_like(pressure, np.nan)
    height, order = -np.log(one.y[known]), np.argsort(-one.y[known], kind="stable")
    return np.interp(-np.log(pressure), height[order], one.x[known][order], left=np.nan, right=np.nan)


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


def levels(dataset: xr.Dataset, panel: Panel) -> dict[str, float]:
    """Return the pressures of the levels that a panel marks by their names [hPa]; NaN in the file means not found."""
    found: dict[str, float] = {}
    for name in panel.marks:
        if name in dataset.variables and dataset[name].attrs.get("resolved", True):
            pressure = float(series(dataset, name, panel.y_unit))
            if pressure > 0.0:
                found.setdefault(_ABBREVIATIONS.get(name, name.replace("_", " ")), pressure)
    return found


def draw_skewt(
    figure: Figure, spot: SubplotSpec, panel: Panel, runs: Sequence[xr.Dataset], theme: Theme, curves: Curves
) -> tuple[Axes, list[Entry]]:
    """Draw parcels and their environment as a skew-T; for one run alone the areas between their curves are shaded.

    CAPE and CIN are not these areas: they are computed from density temperatures.
    """
    marks, *others = (levels(run, panel) for run in runs)
    with warnings.catch_warnings(action="ignore"):  # a user can do nothing about warnings of MetPy in a new Python
        from metpy.plots import SkewT

        skewed = SkewT(figure, rotation=ROTATION, subplot=spot, aspect="auto")
    axes: Axes = skewed.ax
    _mend_ticks(axes)
    axes.grid(visible=True)
    axes.spines[:].set_visible(True)
    axes.tick_params(top=False)
    entries = curves(axes, panel, slender(theme))
    put_background(skewed, axes, theme)
    if all(each.keys() == marks.keys() and np.allclose([*each.values()], [*marks.values()]) for each in others):
        put_levels(axes, marks, theme)
    if not others:
        entries += shade_energy(skewed, panel, runs[0], marks, SHADE_ORDER)
    return axes, entries


def put_background(skewed: Any, axes: Axes, theme: Theme) -> None:
    """Set the range of pressures of a skew-T from its curves, and draw the background lines."""
    bottom, top = _pressures(axes)
    axes.set_ylim(bottom, top)
    with warnings.catch_warnings(action="ignore"):
        from metpy.units import units

        def between(upper: float) -> Any:
            return units.Quantity(np.geomspace(bottom, max(top, upper), 60), "hPa")

        look = {"colors": PALE, "alpha": 1.0, "linewidths": theme.line / 2.4, "zorder": 0.5}
        skewed.plot_dry_adiabats(units.Quantity(_DRY + 273.15, "K"), between(top), linestyles="solid", **look)
        moist, dashes, dots = units.Quantity(_MOIST, "degC"), (0.0, (6.0, 3.0)), (0.0, (1.0, 2.5))
        skewed.plot_moist_adiabats(moist, between(_HIGHEST_MOIST), linestyles=[dashes], **look)
        skewed.plot_mixing_lines(_MIXING / 1e3, between(_MIXING_TOP), linestyles=[dots], **look)


def slender(theme: Theme) -> Theme:
    """Return a theme with thinner curves for a skew-T, where the curves run close together near the ground."""
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
