"""What the figure of a measured trade shows first: the recommended way of running, and the quantity to plot."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from atmosbox.scene.target import TARGETS

__all__ = [
    "MOST_PANELS",
    "SEEN",
    "WANTED",
    "foremost",
    "in_words",
    "limit",
    "recommended",
    "series_of",
    "telling",
    "total",
]

MOST_PANELS = 4
SEEN = 2.0
"""A bias of fewer standard errors than this is not told from zero: an upper limit is drawn in its place."""
WANTED = TARGETS["lecture"]
"""The accuracy of a recommended run, the one that ``atmosbox run SCENE --accuracy lecture`` asks for."""


def series_of(dataset: xr.Dataset) -> list[dict[str, Any]]:
    """Return the series of a trade as its file describes them: engine, varied setting, other settings, laws of bias."""
    rows: list[dict[str, Any]] = json.loads(dataset.attrs["atmosbox_parameters"]).get("series", [])
    return rows


def foremost(dataset: xr.Dataset) -> list[str]:
    """Return the quantities to show, at most four: those with a law first, otherwise in the order of the file."""
    lawful = {name for row in series_of(dataset) for name in row["order"]}
    names = [str(name) for name in dataset.quantity.values]
    return sorted(names, key=lambda name: name not in lawful)[:MOST_PANELS]


def telling(dataset: xr.Dataset) -> str:
    """Return the quantity that best shows how the ways of running differ: the one in which most of them have a bias.

    Numbers come before curves, and then quantities with a law of bias before those without.
    """
    lawful = {name for row in series_of(dataset) for name in row["order"]}

    def rank(name: str) -> tuple[bool, bool, int]:
        one = dataset.sel(quantity=name)
        seen = int((np.abs(one.bias.values) > SEEN * one.bias_se.values).sum())
        return not _is_curve(one), name in lawful, seen

    return max((str(name) for name in dataset.quantity.values), key=rank)


def _is_curve(one: xr.Dataset) -> bool:
    """Tell whether a quantity is a curve; its error is a mean along the curve."""
    return str(one.label.item()).startswith("profile of ")


def total(dataset: xr.Dataset) -> NDArray[np.float64]:
    """Return the expected error of a single run, ``(rung, quantity)`` [K, or a share].

    It is the root of the sum of squares of bias, standard error of the bias, and noise.
    """
    square = sum(dataset[name].transpose("rung", "quantity").values ** 2 for name in ("bias", "bias_se", "noise"))
    return np.sqrt(np.asarray(square, dtype=np.float64))


def limit(unit: str) -> float:
    """Return the largest error of a recommended run [K, or a share].

    Examples
    --------
    >>> limit("K"), limit("1")
    (0.5, 0.01)
    """
    return WANTED.kelvin if unit == "K" else WANTED.share


def recommended(dataset: xr.Dataset) -> tuple[int, bool] | None:
    """Return the index of the recommended way of running, and whether all its numbers are accurate enough.

    It is the cheapest way whose numbers are all accurate enough or, if there is none, the most accurate way. Only ways
    of running the same experiment count: a series with a switch of its own, such as discs in a plane, is another
    experiment. None if no way has known errors and a known cost.
    """
    numbers = np.array([not _is_curve(dataset.sel(quantity=name)) for name in dataset.quantity.values])
    allowed = np.array([limit(str(unit)) for unit in dataset.unit.values])
    worst = (total(dataset) / allowed)[:, numbers].max(axis=1, initial=0.0)
    own = [row["settings"].values() for row in series_of(dataset)]
    other = [k for k, values in enumerate(own) if any(isinstance(value, bool | str) for value in values)]
    cost = dataset.engine_seconds.values
    fit = np.isfinite(worst) & np.isfinite(cost) & ~np.isin(dataset.series.values, other)
    if not fit.any() or not numbers.any():
        return None
    good = fit & (worst <= 1.0)
    if good.any():
        return int(np.argmin(np.where(good, cost, math.inf))), True
    return int(np.argmin(np.where(fit, worst, math.inf))), False


def in_words(value: object) -> str:
    """Return the value of a setting as text for a figure.

    Examples
    --------
    >>> in_words(True), in_words(400.0)
    ('on', '400')
    """
    if isinstance(value, bool):
        return "on" if value else "off"
    return f"{value:g}" if isinstance(value, int | float) else str(value)
