"""The planned ascent of a parcel on the graphs of a page: what their axes include, and curves drawn from the start."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["show_plan"]

_PLACES = 60
_TIME = "elapsed_time"
_KNOWN = ("environment", "reference")
"""Roles of the curves that are drawn from the start: the air around the parcel, and what it is compared with."""

Array = NDArray[np.float64]


def show_plan(panels: Sequence[dict[str, Any]], tables: Sequence[Mapping[str, Any]], unit: float) -> None:
    """Add to the graphs of a page what is known of an ascent beforehand.

    Parameters
    ----------
    panels
        The graphs, as data for the page. Each gets ``planned``, the points that its axes must include; a curve against
        height or pressure that is known beforehand gets all its points, and a picture of the parcel its path, as
        heights at moments of the ascent.
    tables
        The curves of theory, see `atmosbox.lab.theory_table.tables`.
    unit
        Unit of the moments of the ascent, in that of the elapsed time.
    """
    way = _ascent(tables, unit)
    for panel in panels:
        panel["planned"] = {"x": [], "y": []}
        for line in panel["lines"]:
            points = {axis: _points(line[axis], way) for axis in ("x", "y")}
            if not (points["x"] and points["y"]):
                continue
            for axis, values in points.items():
                panel["planned"][axis] += values
            if panel["kind"] == "atmosphere":
                line["planned"] = {"moment": [float(f"{each:.5g}") for each in way["moment"]], "y": points["y"]}
            elif panel["across"] and line["role"] in _KNOWN:
                line["planned"] = points


def _ascent(tables: Sequence[Mapping[str, Any]], unit: float) -> dict[str, Array]:
    """Return the curves of theory along the planned ascent by their names [SI]; empty for another box."""
    around = next((table for table in tables if "environment_pressure" in table["curves"]), None)
    if around is None:
        return {}
    moments = np.linspace(0.0, around["grid"][-1], _PLACES)
    pressure = _between(around, "environment_pressure", moments)
    along = {"moment": moments, "parcel_pressure": pressure}
    found = {
        name: _between(table, name, along[table["along"]])
        for table in tables
        if table["along"] in along and "times" not in table
        for name in table["curves"]
    }
    way = {**along, **found, _TIME: moments * unit}
    return {name: values for name, values in way.items() if np.isfinite(values).all()}


def _between(table: Mapping[str, Any], name: str, places: Array) -> Array:
    """Return values of a curve of a table, as the page interpolates them."""
    found: Array = np.interp(places, np.array(table["grid"], float), np.array(table["curves"][name], float))
    return found


def _points(axis: Mapping[str, Any], way: Mapping[str, Array]) -> list[float]:
    """Return the values of a variable along the ascent, in the unit of its axis."""
    values = way.get(axis["name"], np.zeros(0)) * axis["factor"] + axis["offset"]
    return [float(f"{value:.5g}") for value in values]
