"""Error against processor time: the figure of a measured trade of speed against accuracy.

By default it is one graph, readable from the last row of a lecture hall: the error of a single run against its
processor time, and the recommended run. With all panels it shows up to four quantities, and for each of them bias,
noise and their laws.
"""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from numpy.typing import NDArray

from atmosbox.plot.direct_label import Label, put_labels
from atmosbox.plot.pen import Pen
from atmosbox.plot.theme import DARK, DATA_COLOURS, FAINT, Theme, find, style
from atmosbox.plot.tradeoff_choice import (
    SEEN,
    WANTED,
    foremost,
    in_words,
    limit,
    recommended,
    series_of,
    telling,
    total,
)

__all__ = ["figure"]

CLEAR = 6.0
"""Where possible, the law of a bias is drawn through one that is more than this many standard errors."""

_MARKERS = ("o", "s", "^", "D", "v", "P", "X", "<")


def figure(dataset: xr.Dataset, theme: str = "notes", *, all_panels: bool = False) -> Figure:
    """Draw errors against processor time: one quantity, or a panel for each of up to four.

    Parameters
    ----------
    dataset : xarray.Dataset
        What `atmosbox.trade.tradeoff.measured_trade` returns.
    theme : {"notes", "slides"}
        A figure for a page, or one for a screen.
    all_panels : bool
        Whether up to four quantities are drawn, each with bias, noise and laws, and not only the error of a single
        run in the quantity that best shows how the ways of running differ.

    Returns
    -------
    matplotlib.figure.Figure
        The figure. In one panel a mark is the expected error of a single run, filled where most of it is bias and
        hollow where most of it is chance; the ring is the recommended run. In all panels a filled mark is the bias,
        the mean error of many runs; a hollow one with an arrow is an upper limit, twice the standard error, where no
        larger bias was seen; a pale ring is the noise, the scatter of a single run; the grey line runs along the best
        totals; thin lines are laws.

    Raises
    ------
    SettingError
        If there is no such theme.
    """
    look = find(theme)
    with style(look):
        return _all_panels(dataset, look) if all_panels else _one_panel(dataset, look)


def _one_panel(dataset: xr.Dataset, look: Theme) -> Figure:
    """Draw the error of a single run in one quantity against its processor time."""
    name = telling(dataset)
    one = dataset.sel(quantity=name)
    share, unit = _unit(one)
    place = [str(each) for each in dataset.quantity.values].index(name)
    error = share * total(dataset)[:, place]
    seconds = dataset.engine_seconds.values
    chance = np.hypot(one.noise.values, one.bias_se.values) > np.abs(one.bias.values)
    drawing = Figure(figsize=look.wide, layout="constrained")
    FigureCanvasAgg(drawing)
    axes = drawing.subplots()
    axes.set_xscale("log")
    axes.set_yscale("log")
    labels = []
    for row in sorted({int(k) for k in dataset.series.values}):
        here = (dataset.series.values == row) & np.isfinite(seconds) & np.isfinite(error)
        if not here.any():
            continue
        colour, marker = _colour(dataset, row), _MARKERS[row % len(_MARKERS)]
        along = np.flatnonzero(here)[np.argsort(seconds[here])]
        axes.plot(seconds[along], error[along], color=colour, lw=0.7 * look.line, alpha=0.6, zorder=2)
        for face, those in ((colour, ~chance), ("white", chance)):
            axes.plot(
                seconds[here & those], error[here & those], marker, mfc=face, mec=colour, mew=0.8 * look.line,
                ms=1.7 * look.marker, zorder=3,
            )  # fmt: skip
        engine, what, fixed = _series(dataset, row, here)
        words = f"{engine}\n{what}" + (f"\n{fixed}" if fixed else "")
        labels.append(Label(words, seconds[along], error[along], colour))
    allowed = share * limit(str(one.unit.item()))
    best = recommended(dataset)
    if best is not None:
        k, enough = best
        axes.plot(
            seconds[k], error[k], "o", mfc="none", mec=DARK, mew=1.2 * look.line, ms=4.2 * look.marker, zorder=4
        )  # fmt: skip
        head = "recommended" if enough else "the most accurate"
        words = f"{head}: {error[k]:.2g} {unit} in {seconds[k]:.2g} s\n{_way(dataset, k)}"
        labels.insert(0, Label(words, seconds[[k]], error[[k]], DARK, bold=True, clear=2.1 * look.marker))
    low, high = axes.get_ylim()
    axes.set_ylim(0.7 * min(low, allowed), 1.4 * max(high, allowed))
    axes.axhspan(axes.get_ylim()[0], allowed, color="#009e73", alpha=0.10, lw=0.0, zorder=0)
    axes.margins(x=0.12)
    _ticks(axes)
    axes.set_xlabel("processor time of a run (s)")
    axes.set_ylabel(f"error of a run ({unit})")
    axes.grid(visible=True)
    drawing.suptitle(str(dataset.attrs.get("title", "")), fontsize=look.title, weight="bold", x=0.01, ha="left")
    axes.set_title(f"{_sentence(str(one.label.item()))}: what a single run is off by", loc="left", fontsize=look.text)
    small = (
        "filled: mostly the error of the method · hollow: mostly chance, which more molecules or runs average out\n"
        f"green: within {allowed:g} {unit} · recommended: the cheapest run within {WANTED.limits} in all its numbers "
        f"(--accuracy {WANTED.text})"
    )
    pen = Pen(drawing)
    width = 72.0 * drawing.get_figwidth() - look.text
    small = "\n".join(pen.wrap(line, 0.98 * width, look.small) for line in small.split("\n"))
    drawing.supxlabel(small, x=0.01, ha="left", fontsize=look.small, color=FAINT)
    drawing.draw_without_rendering()
    put_labels(axes, labels, pen, look.text)
    return drawing


def _all_panels(dataset: xr.Dataset, look: Theme) -> Figure:
    """Draw bias and noise of up to four quantities against the processor time of a run."""
    chosen = foremost(dataset)
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


def _unit(one: xr.Dataset) -> tuple[float, str]:
    """Return the factor from the error of a quantity in the file to the one shown, and the unit that is shown."""
    return (1.0, "K") if str(one.unit.values) == "K" else (100.0, "%")


def _ticks(axes: Axes) -> None:
    """Write plain numbers on both logarithmic axes."""
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < 60.0 * low else (1.0,), numticks=12))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())


def _draw(axes: Axes, dataset: xr.Dataset, name: str, look: Theme) -> None:
    """Draw the panel of one quantity."""
    one = dataset.sel(quantity=name)
    scale, unit = _unit(one)
    seconds = dataset.engine_seconds.values
    bias, se, noise = (scale * np.abs(one[key].values) for key in ("bias", "bias_se", "noise"))
    rows = series_of(dataset)
    axes.set_xscale("log")
    axes.set_yscale("log")
    _front(axes, seconds, np.sqrt(np.maximum(bias**2 - se**2, 0.0) + noise**2), look)
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
    _ticks(axes)
    axes.grid(visible=True)


def _front(axes: Axes, seconds: NDArray[np.float64], total: NDArray[np.float64], look: Theme) -> None:
    """Draw the line along the runs of which no cheaper run is more accurate (the Pareto front)."""
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
    """Draw a known law of bias through the smallest bias that was clearly seen: laws hold where errors are small."""
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
    """Draw the law of chance, noise proportional to 1/√time, through the noise of the reference."""
    reference = json.loads(dataset.attrs["atmosbox_parameters"])["tradeoff"].get("reference")
    finite = seconds[np.isfinite(seconds)]
    if reference is None or not finite.size or not math.isfinite(noise[reference]):
        return
    x = np.geomspace(finite.min(), finite.max(), 16)
    y = noise[reference] * np.sqrt(seconds[reference] / x)
    axes.plot(x, y, color=DARK, ls=(0, (2, 2)), lw=0.6 * look.line, zorder=1.5)


def _engine(dataset: xr.Dataset, row: int) -> str:
    """Return the name of the engine of a series."""
    return str(dataset.engine.values[dataset.series.values == row][0]).partition(":")[0]


def _colour(dataset: xr.Dataset, row: int) -> str:
    """Return the colour of a series, which is that of its engine."""
    known = list(dict.fromkeys(str(text).partition(":")[0] for text in dataset.engine.values))
    return to_hex(DATA_COLOURS[known.index(_engine(dataset, row)) % len(DATA_COLOURS)])


def _series(dataset: xr.Dataset, row: int, shown: NDArray[np.bool_]) -> tuple[str, str, str]:
    """Return the engine of a series, its varied setting with the range of the points ``shown``, and its own settings.

    Its own settings are those of all its runs.
    """
    rows = series_of(dataset)
    values = dataset.value.values[shown]
    vary = rows[row]["vary"] if row < len(rows) else "settings"
    ends = " to ".join(dict.fromkeys(f"{value:g}" for value in (values[0], values[-1]) if np.isfinite(value)))
    own = rows[row]["settings"] if row < len(rows) else {}
    return (
        _engine(dataset, row),
        f"{vary} {ends}",
        ", ".join(f"{name} {in_words(value)}" for name, value in own.items()),
    )


def _way(dataset: xr.Dataset, k: int) -> str:
    """Return a way of running as text: the engine, its options, and the settings."""
    settings = json.loads(str(dataset.settings.values[k]))
    engine = str(dataset.engine.values[k]).replace(":", ", ").replace("=", " ")
    return ", ".join([engine, *(f"{name} {in_words(value)}" for name, value in settings.items())])


def _legend(dataset: xr.Dataset, look: Theme) -> list[Line2D]:
    """Return the entries of the legend: the series, then bias, noise, Pareto front and laws."""
    made = np.isfinite(dataset.engine_seconds.values)
    entries = []
    for row in sorted({int(k) for k in dataset.series.values[made]}):
        engine, what, fixed = _series(dataset, row, made & (dataset.series.values == row))
        words = f"{engine}: {what}" + (f", {fixed}" if fixed else "")
        entries.append(
            Line2D([], [], ls="", marker=_MARKERS[row % len(_MARKERS)], color=_colour(dataset, row), label=words)
        )
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


def _sentence(text: str) -> str:
    """Return a text with a capital as its first letter."""
    return text[:1].upper() + text[1:]
