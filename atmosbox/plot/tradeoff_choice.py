"""What a measured trade says first: which way of running to take, and in which quantity it is seen."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.scene.wish import TARGETS

if TYPE_CHECKING:
    import xarray as xr

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
"""A bias of fewer standard errors than this is not told from zero: its place is an upper limit."""
WANTED = TARGETS["lecture"]
"""How accurate a run is that is recommended: as ``atmosbox run SCENE --accuracy lecture`` picks it."""


def series_of(dataset: xr.Dataset) -> list[dict[str, Any]]:
    """Return the series of a trade, as its file describes them: engine, what varies, other settings, laws."""
    rows: list[dict[str, Any]] = json.loads(dataset.attrs["atmosbox_parameters"]).get("series", [])
    return rows


def foremost(dataset: xr.Dataset) -> list[str]:
    """Return the quantities to show: those with a law first, then numbers, then curves."""
    lawful = {name for row in series_of(dataset) for name in row["order"]}
    names = [str(name) for name in dataset.quantity.values]
    return sorted(names, key=lambda name: name not in lawful)[:MOST_PANELS]


def telling(dataset: xr.Dataset) -> str:
    """Return the quantity that tells the ways of running apart best: the one in which most of them show a bias.

    A quantity with a law goes before one without, and a number before a curve.
    """
    lawful = {name for row in series_of(dataset) for name in row["order"]}

    def rank(name: str) -> tuple[bool, bool, int]:
        one = dataset.sel(quantity=name)
        seen = int((np.abs(one.bias.values) > SEEN * one.bias_se.values).sum())
        return not _is_curve(one), name in lawful, seen

    return max((str(name) for name in dataset.quantity.values), key=rank)


def _is_curve(one: xr.Dataset) -> bool:
    """Tell whether a quantity is a curve, whose error is the mean along it."""
    return str(one.label.item()).startswith("profile of ")


def total(dataset: xr.Dataset) -> NDArray[np.float64]:
    """Return the error to expect of a single run, ``(rung, quantity)``: bias and noise together [K, or a share].

    What is not known of the bias counts in full.
    """
    square = sum(dataset[name].transpose("rung", "quantity").values ** 2 for name in ("bias", "bias_se", "noise"))
    return np.sqrt(np.asarray(square, dtype=np.float64))


def limit(unit: str) -> float:
    """Return the largest error of a run that is recommended, in kelvin, or as a share.

    Examples
    --------
    >>> limit("K"), limit("1")
    (0.5, 0.01)
    """
    return WANTED.kelvin if unit == "K" else WANTED.share


def recommended(dataset: xr.Dataset) -> tuple[int, bool] | None:
    """Return the cheapest way of running whose numbers are all accurate enough, and whether there is one.

    Where there is none, it is the most accurate way. Only ways of running the same experiment count: a series with a
    switch of its own, such as discs in a plane, is another one. None where nothing fits.
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
    """Return a setting as a figure says it.

    Examples
    --------
    >>> in_words(True), in_words(400.0)
    ('on', '400')
    """
    if isinstance(value, bool):
        return "on" if value else "off"
    return f"{value:g}" if isinstance(value, int | float) else str(value)
