"""The energy of a parcel on the skew-T: areas between it and its environment, CAPE and CIN."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.patches import Patch
from numpy.typing import NDArray

from atmosbox.plot.curve import Curve, curve
from atmosbox.plot.draw import Entry
from atmosbox.plot.theme import AREA_COLOURS, AREA_HATCHES, FAINT
from atmosbox.scene.panels import Panel

_ROUNDING = 1.0 + 1e-12  # allows for the rounding error of a pressure computed as exp(log(p))

Floats = NDArray[np.float64]


def shade_energy(
    skewed: Any, panel: Panel, dataset: xr.Dataset, marks: Mapping[str, float], order: float
) -> list[Entry]:
    """Shade CAPE and CIN, and return their legend entries; without a level of free convection there are none.

    Parameters
    ----------
    skewed : metpy.plots.SkewT
        The diagram.
    panel : Panel
        The panel: its first line of role ``data`` is the parcel, its first line of role ``environment`` is the
        environment.
    dataset : xarray.Dataset
        The run.
    marks : mapping of str to float
        Pressures of the levels LFC and EL [hPa].
    order : float
        The drawing order of the areas (matplotlib's ``zorder``).

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.scene.panels import Line, Panel
    >>> panel = Panel("skewt", "A parcel", (Line("temperature", "pressure", "parcel"),), y_unit="hPa", y_scale="log")
    >>> shade_energy(None, panel, xr.Dataset(), {}, 1.0)
    []
    """
    measured, environment = (
        next((line for line in panel.lines if line.role == role), None) for role in ("data", "environment")
    )
    if "LFC" not in marks or measured is None or environment is None:
        return []
    lfc, el = marks["LFC"], marks.get("EL", 0.0)
    curves = [curve(dataset, panel, line) for line in (measured, environment)]
    pressure, parcel, around = _together(curves, [lfc, el] if el else [lfc])
    free, below = (pressure <= lfc * _ROUNDING) & (pressure * _ROUNDING >= el), pressure * _ROUNDING >= lfc
    warmer = parcel - around
    entries: list[Entry] = []
    for name, part, sign, shade in (
        ("CAPE", free, 1.0, skewed.shade_cape),
        ("CIN", below, -1.0, skewed.shade_cin),
    ):
        if not (sign * warmer[part] > 0.0).any():
            continue
        look: dict[str, Any] = {"facecolor": AREA_COLOURS[name], "hatch": AREA_HATCHES[name]}
        look |= {"edgecolor": FAINT, "linewidth": 0.0, "alpha": 0.7}
        shade(pressure[part], around[part], parcel[part], zorder=order, **look)
        entries.append(((Patch(**look),), name))
    return entries


def _together(curves: list[Curve], ends: list[float]) -> tuple[Floats, Floats, Floats]:
    """Return pressures from the ground up, which include the ends of the areas, and both curves' temperatures there."""
    columns = []
    for temperature, pressure, _ in curves:
        known = np.isfinite(temperature) & np.isfinite(pressure)
        order = np.argsort(-pressure[known], kind="stable")
        columns.append((-np.log(pressure[known][order]), temperature[known][order]))
    if not all(height.size for height, _ in columns):
        return np.zeros(0), np.zeros(0), np.zeros(0)
    low, high = max(height[0] for height, _ in columns), min(height[-1] for height, _ in columns)
    heights = np.unique(np.concatenate([*(height for height, _ in columns), -np.log(ends)]))
    heights = heights[(heights >= low) & (heights <= high)]
    temperatures = [np.interp(heights, *each) for each in columns]
    return np.exp(-heights), temperatures[0], temperatures[1]
