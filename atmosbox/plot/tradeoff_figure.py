"""Error against processor time: the figure of a measured trade of speed against accuracy, and the recommended run.

One graph, readable from the last row of a lecture hall: the error of a single run against its processor time.
"""

import json
import math
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from atmosbox.plot.draw import Entry
from atmosbox.plot.layout import page
from atmosbox.plot.theme import AGREES, DARK, DATA_COLOURS, Theme, find
from atmosbox.scene.panels import Line, Panel
from atmosbox.scene.target import TARGETS

SEEN = 2.0
"""A bias of fewer standard errors than this is not told from zero."""
WANTED = TARGETS["lecture"]
"""The accuracy of a recommended run, the one that ``atmosbox run SCENE --accuracy lecture`` asks for."""
_MARKERS = ("o", "s", "^", "D", "v", "P", "X", "<")


def figure(dataset: xr.Dataset, theme: str = "notes") -> Figure:
    """Draw the error of a single run against its processor time, in the quantity that best shows how engines differ.

    A mark is the expected error of a single run, filled where most of it is bias and hollow where most of it is chance;
    the ring is the recommended run.
    """
    look = find(theme)
    look = replace(look, narrow=look.wide)
    place = _telling(dataset)
    one = dataset.isel(quantity=place)
    said, share, unit = str(one.label.item()), *((1.0, "K") if str(one.unit.item()) == "K" else (100.0, "%"))
    allowed, error = share * limit(str(one.unit.item())), share * _total(dataset)[:, place]
    panel = Panel(
        "line",
        f"{said[:1].upper()}{said[1:]}: what a single run is off by",
        (Line("engine_seconds", "engine_seconds", "runs", "theory"),),
        *("processor time of a run", "error of a run", "s", unit, "log", "log"),
    )

    def draw(drawing: Figure, spot: SubplotSpec, panel: Panel, above: Axes | None) -> tuple[Axes, list[Entry]]:
        axes = drawing.add_subplot(spot, sharex=above, xscale=panel.x_scale, yscale=panel.y_scale)
        entries = _draw_runs(axes, dataset, error, np.hypot(one.noise, one.bias_se) > np.abs(one.bias), look)
        if best := recommended(dataset):
            k, enough = best
            seconds, head = float(dataset.engine_seconds[k]), "recommended" if enough else "the most accurate"
            ring: dict[str, Any] = {"mfc": "none", "mec": DARK, "mew": 1.2 * look.line, "ms": 2.8 * look.marker}
            label = f"{head}: {error[k]:.2g} {unit} in {seconds:.2g} s by {_way(dataset, k)}"
            entries.insert(0, ((axes.plot(seconds, error[k], "o", zorder=4, **ring)[0],), label))
        low, high = axes.get_ylim()
        axes.set_ylim(0.7 * min(low, allowed), 1.4 * max(high, allowed))
        axes.axhspan(axes.get_ylim()[0], allowed, color=AGREES, alpha=0.10, lw=0.0, zorder=0)
        axes.grid(visible=True)
        return axes, entries

    small = (
        "filled: mostly the error of the method · hollow: mostly chance, which more molecules or runs average out · "
        f"green: within {allowed:g} {unit} · recommended: the cheapest run within {WANTED.limits} in all its numbers "
        f"(--accuracy {WANTED.text})"
    )
    return page((panel,), look, dataset, draw, [], small)


def _draw_runs(
    axes: Axes, dataset: xr.Dataset, error: NDArray[np.float64], chance: xr.DataArray, look: Theme
) -> list[Entry]:
    """Draw the errors of each series of runs, hollow where most of them is chance; return the legend entries."""
    seconds, values, hollow = dataset.engine_seconds.values, dataset.value.values, np.asarray(chance)
    known = np.isfinite(seconds) & np.isfinite(error)
    engines = [str(text).partition(":")[0] for text in dataset.engine.values]
    entries: list[Entry] = []
    for row in sorted({int(k) for k in dataset.series.values[known]}):
        along = np.flatnonzero((dataset.series.values == row) & known)
        along = along[np.argsort(seconds[along])]
        engine, about = engines[along[0]], _rows(dataset)[row]
        colour = DATA_COLOURS[list(dict.fromkeys(engines)).index(engine) % len(DATA_COLOURS)]
        looks: dict[str, Any] = {"mec": colour, "mew": 0.8 * look.line, "ms": 1.7 * look.marker, "zorder": 3}
        looks["marker"] = _MARKERS[row % len(_MARKERS)]
        axes.plot(seconds[along], error[along], lw=0.7 * look.line, alpha=0.6, zorder=2, color=colour)
        for face, those in ((colour, along[~hollow[along]]), ("white", along[hollow[along]])):
            axes.plot(seconds[those], error[those], ls="none", mfc=face, **looks)
        shown = Line2D([], [], color=colour, mfc="white" if hollow[along].all() else colour, **looks)
        # the varied setting with its range in these runs, and the settings of all of them
        ends = " to ".join(dict.fromkeys(f"{value:g}" for value in values[along[[0, -1]]] if np.isfinite(value)))
        words = [f"{engine}: {about['vary']} {ends}", *_in_words(about["settings"])]
        entries.append(((shown,), ", ".join(words)))
    return entries


def _way(dataset: xr.Dataset, k: int) -> str:
    """Return a way of running as text: the engine, its options, and the settings."""
    engine = str(dataset.engine.values[k]).replace(":", ", ").replace("=", " ")
    return ", ".join([engine, *_in_words(json.loads(str(dataset.settings.values[k])))])


def _in_words(settings: dict[str, Any]) -> list[str]:
    """Return settings with their values as text."""
    words = {True: "on", False: "off"}
    return [
        f"{name} {words[value] if isinstance(value, bool) else value if isinstance(value, str) else f'{value:g}'}"
        for name, value in settings.items()
    ]


def _rows(dataset: xr.Dataset) -> list[dict[str, Any]]:
    """Return the series of a trade as its file describes them: engine, varied setting, other settings, laws of bias."""
    rows: list[dict[str, Any]] = json.loads(dataset.attrs["atmosbox_parameters"]).get("series", [])
    return rows


def _lawful(dataset: xr.Dataset) -> list[bool]:
    """Tell which quantities have a law of bias."""
    lawful = {name for row in _rows(dataset) for name in row["order"]}
    return [str(name) in lawful for name in dataset.quantity.values]


def foremost(dataset: xr.Dataset) -> list[str]:
    """Return the quantities to show, at most four: those with a law first, otherwise in the order of the file."""
    order = np.argsort(np.logical_not(_lawful(dataset)), kind="stable")
    return [str(name) for name in dataset.quantity.values[order][:4]]


def _telling(dataset: xr.Dataset) -> int:
    """Return the place of the quantity that best shows how the ways differ: the one in which most of them have a bias.

    Numbers come before curves, and then quantities with a law of bias before those without.
    """
    biased = (np.abs(dataset.bias) > SEEN * dataset.bias_se).sum("configuration").values
    ranks = list(zip(~_are_curves(dataset), _lawful(dataset), biased, strict=True))
    return ranks.index(max(ranks))


def _are_curves(dataset: xr.Dataset) -> NDArray[np.bool_]:
    """Tell which quantities are curves; the error of such a one is a mean along the curve."""
    return np.array([str(label).startswith("profile of ") for label in dataset.label.values])


def _total(dataset: xr.Dataset) -> NDArray[np.float64]:
    """Return the expected error of a single run, ``(configuration, quantity)`` [K, or a share].

    It is the root of the sum of squares of bias, standard error of the bias, and noise.
    """
    parts = (dataset[name].transpose("configuration", "quantity").values for name in ("bias", "bias_se", "noise"))
    return np.sqrt(np.asarray(sum(part**2 for part in parts), dtype=np.float64))


def limit(unit: str) -> float:
    """Return the largest error of a recommended run [K, or a share]."""
    return WANTED.kelvin if unit == "K" else WANTED.share


def recommended(dataset: xr.Dataset) -> tuple[int, bool] | None:
    """Return the index of the recommended way of running, and whether all its numbers are accurate enough.

    It is the cheapest way whose numbers are all accurate enough or, if there is none, the most accurate way. Only ways
    of running the same experiment count: a series with a switch of its own, such as discs in a plane, is another
    experiment. None if no way has known errors and a known cost.
    """
    # the curve of a parcel counts, as for `--accuracy`: beside the adiabat it tells what a fast ascent costs
    numbers = ~_are_curves(dataset) | (dataset.quantity.values == "parcel_temperature")
    allowed = np.array([limit(str(unit)) for unit in dataset.unit.values])
    worst = (_total(dataset) / allowed)[:, numbers].max(axis=1, initial=0.0)
    own = [row["settings"].values() for row in _rows(dataset)]
    other = [k for k, values in enumerate(own) if any(isinstance(value, bool | str) for value in values)]
    cost = dataset.engine_seconds.values
    fit = np.isfinite(worst) & np.isfinite(cost) & ~np.isin(dataset.series.values, other)
    if not fit.any() or not numbers.any():
        return None
    good = fit & (worst <= 1.0)
    if good.any():
        return int(np.argmin(np.where(good, cost, math.inf))), True
    return int(np.argmin(np.where(fit, worst, math.inf))), False
