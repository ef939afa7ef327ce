"""Error against seconds: the figure of a measurement of speed against accuracy."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from numpy.typing import NDArray

from atmosbox.plot.theme import DARK, DATA_COLOURS, FAINT, Theme, find, style

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["MOST_PANELS", "figure", "foremost"]

MOST_PANELS = 4
SEEN = 2.0
"""A bias of fewer standard errors than this is not told from zero: its place is an upper limit."""
CLEAR = 6.0
"""From so many standard errors on, a law may be drawn through a bias."""

_MARKERS = ("o", "s", "^", "D", "v", "P", "X", "<")


def figure(dataset: xr.Dataset, theme: str = "notes") -> Figure:
    """Draw errors against seconds, a panel for each of the foremost quantities.

    Parameters
    ----------
    dataset : xarray.Dataset
        What `atmosbox.trade.tradeoff.measured_trade` returns.
    theme : {"notes", "slides"}
        A figure for a page, or one for a screen.

    Returns
    -------
    matplotlib.figure.Figure
        The figure. A filled mark is the bias, the mean error of many runs; a hollow one below an arrow says
        that no bias was seen above twice its standard error; a pale ring is the noise, by which a single run
        scatters; the grey line runs along the best totals; thin lines are laws.

    Raises
    ------
    SettingError
        If there is no such theme.
    """
    look = find(theme)
    chosen = foremost(dataset)
    with style(look):
        width, height = look.wide if len(chosen) > 1 else look.narrow
        drawing = Figure(figsize=(width, height * (1.0 if look.heading else 1.45)), layout="constrained")
        FigureCanvasAgg(drawing)
        columns = min(2, len(chosen))
        axes = drawing.subplots(math.ceil(len(chosen) / columns), columns, sharex=True, squeeze=False).ravel()
        for each in axes[len(chosen) :]:
            each.remove()
        for each, name in zip(axes, chosen, strict=False):
            _draw(each, dataset, name, look)
        for place in range(len(chosen)):
            if place + columns >= len(chosen):
                axes[place].set_xlabel("processor time of the engine in a run (s)")
                axes[place].tick_params(labelbottom=True)
        drawing.legend(
            handles=_legend(dataset, look),
            loc="outside lower center",
            ncols=3,
            fontsize=look.small if look.heading else 0.85 * look.small,
            handlelength=1.4,
            columnspacing=1.2,
            labelspacing=0.3,
        )
        drawing.suptitle(str(dataset.attrs.get("title", "")), fontsize=look.title, weight="bold")
    return drawing


def foremost(dataset: xr.Dataset) -> list[str]:
    """Return the quantities to draw: those with a law first, then numbers, then curves."""
    series = json.loads(dataset.attrs["atmosbox_parameters"]).get("series", [])
    lawful = {name for row in series for name in row["order"]}
    names = [str(name) for name in dataset.quantity.values]
    return sorted(names, key=lambda name: name not in lawful)[:MOST_PANELS]


def _draw(axes: Axes, dataset: xr.Dataset, name: str, look: Theme) -> None:
    """Draw one quantity."""
    one = dataset.sel(quantity=name)
    scale = 1.0 if str(one.unit.values) == "K" else 100.0
    unit = "K" if scale == 1.0 else "%"
    seconds = dataset.engine_seconds.values
    bias, se, noise = (scale * np.abs(one[key].values) for key in ("bias", "bias_se", "noise"))
    rows = json.loads(dataset.attrs["atmosbox_parameters"]).get("series", [])
    axes.set_xscale("log")
    axes.set_yscale("log")
    total = np.sqrt(np.maximum(bias**2 - se**2, 0.0) + noise**2)
    _front(axes, seconds, total, look)
    for row in sorted({int(k) for k in dataset.series.values}):
        here = (dataset.series.values == row) & np.isfinite(seconds) & np.isfinite(noise)
        if not here.any():
            continue
        colour, marker = _colour(dataset, row), _MARKERS[row % len(_MARKERS)]
        axes.plot(
            seconds[here], np.maximum(noise[here], 1e-300), marker, mfc="white", mec=colour, mew=0.6 * look.line,
            ms=0.8 * look.marker, alpha=0.55, ls=":", lw=0.5 * look.line, color=colour, zorder=2,
        )  # fmt: skip
        seen = here & (bias > SEEN * se)
        axes.errorbar(
            seconds[seen], bias[seen], yerr=np.minimum(se[seen], 0.99 * bias[seen]), fmt=marker, color=colour,
            ms=look.marker, elinewidth=0.6 * look.line, zorder=4,
        )  # fmt: skip
        unseen = here & ~seen
        limit = SEEN * se[unseen]
        axes.errorbar(
            seconds[unseen], limit, yerr=0.35 * limit, uplims=True, fmt=marker, mfc="white", mec=colour,
            color=colour, ms=look.marker, elinewidth=0.6 * look.line, capsize=0.6 * look.marker, zorder=3,
        )  # fmt: skip
        if row < len(rows):
            _law(axes, dataset, rows[row], name, here, seconds, np.where(seen, bias, np.nan), se, look)
    _statistics(axes, dataset, seconds, noise, look)
    axes.set_title(_sentence(str(one.label.values)), loc="left", fontsize=look.text)
    axes.set_ylabel(f"error ({unit})")
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < 60.0 * low else (1.0,), numticks=12))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())
    axes.grid(visible=True)


def _front(axes: Axes, seconds: NDArray[np.float64], total: NDArray[np.float64], look: Theme) -> None:
    """Draw the line along the runs that no cheaper run betters."""
    x, y = [], []
    best = math.inf
    for k in np.argsort(seconds):
        if math.isfinite(seconds[k]) and total[k] < best:
            best = total[k]
            x.append(seconds[k])
            y.append(best)
    axes.step(x, y, where="post", color="#bfbfbf", lw=2.5 * look.line, zorder=1, solid_capstyle="round")


def _law(
    axes: Axes,
    dataset: xr.Dataset,
    row: dict[str, Any],
    name: str,
    here: NDArray[np.bool_],
    seconds: NDArray[np.float64],
    bias: NDArray[np.float64],
    se: NDArray[np.float64],
    look: Theme,
) -> None:
    """Draw a known law through the finest run whose bias was clearly seen: laws hold where errors are small."""
    order = row["order"].get(name)
    known = here & np.isfinite(bias)
    if order is None or known.sum() < 1 or here.sum() < 2:
        return
    value = dataset.value.values
    clear = known & (bias > CLEAR * se)
    first = np.flatnonzero(clear)[np.argmin(bias[clear])] if clear.any() else np.flatnonzero(known)[0]
    along = np.argsort(seconds[here])
    y = bias[first] * (value[here] / value[first]) ** order
    axes.plot(seconds[here][along], y[along], color=DARK, lw=0.6 * look.line, zorder=1.5)


def _statistics(
    axes: Axes, dataset: xr.Dataset, seconds: NDArray[np.float64], noise: NDArray[np.float64], look: Theme
) -> None:
    """Draw the law of chance, one over the root of the time, through the reference."""
    reference = json.loads(dataset.attrs["atmosbox_parameters"])["tradeoff"].get("reference")
    finite = seconds[np.isfinite(seconds)]
    if reference is None or not finite.size or not math.isfinite(noise[reference]):
        return
    x = np.geomspace(finite.min(), finite.max(), 16)
    y = noise[reference] * np.sqrt(seconds[reference] / x)
    axes.plot(x, y, color=DARK, ls=(0, (2, 2)), lw=0.6 * look.line, zorder=1.5)


def _engine(dataset: xr.Dataset, row: int) -> str:
    """Return the name of a series' engine."""
    return str(dataset.engine.values[dataset.series.values == row][0]).partition(":")[0]


def _colour(dataset: xr.Dataset, row: int) -> str:
    """Return the colour of a series' engine."""
    known = list(dict.fromkeys(str(text).partition(":")[0] for text in dataset.engine.values))
    return to_hex(DATA_COLOURS[known.index(_engine(dataset, row)) % len(DATA_COLOURS)])


def _legend(dataset: xr.Dataset, look: Theme) -> list[Line2D]:
    """Return what the marks mean: the series, then bias, noise, front and laws."""
    rows = json.loads(dataset.attrs["atmosbox_parameters"]).get("series", [])
    made = np.isfinite(dataset.engine_seconds.values)
    entries = []
    for row in sorted({int(k) for k in dataset.series.values[made]}):
        row_is = (dataset.series.values == row) & made
        values = dataset.value.values[row_is][np.argsort(dataset.engine_seconds.values[row_is])]
        vary = rows[row]["vary"] if row < len(rows) else "settings"
        ends = " to ".join(dict.fromkeys(f"{value:g}" for value in (values[0], values[-1]) if np.isfinite(value)))
        own = rows[row]["settings"] if row < len(rows) else {}
        fixed = "".join(f", {name} {_plain(value)}" for name, value in own.items())
        entries.append(
            Line2D([], [], ls="", marker=_MARKERS[row % len(_MARKERS)], color=_colour(dataset, row),
                   label=f"{_engine(dataset, row)}: {vary} {ends}{fixed}")
        )  # fmt: skip
    plain: dict[str, Any] = {"ls": "", "marker": "o", "color": FAINT}
    entries += [
        Line2D([], [], **plain, label="bias: mean error of many runs"),
        Line2D([], [], **plain | {"mfc": "white"}, label="with an arrow: bias less than this"),
        Line2D([], [], **plain | {"mfc": "white", "alpha": 0.55, "ls": ":"}, label="noise: scatter of a single run"),
        Line2D([], [], color="#bfbfbf", lw=2.5 * look.line, label="the best totals (Pareto front)"),
        Line2D([], [], color=DARK, lw=0.6 * look.line, label="law of the bias"),
        Line2D([], [], color=DARK, ls=(0, (2, 2)), lw=0.6 * look.line, label="law of chance, 1/√time"),
    ]
    return entries


def _plain(value: object) -> str:
    """Return a setting as a legend says it."""
    if isinstance(value, bool):
        return "on" if value else "off"
    return f"{value:g}" if isinstance(value, int | float) else str(value)


def _sentence(text: str) -> str:
    """Return a text that begins with a capital."""
    return text[:1].upper() + text[1:]
