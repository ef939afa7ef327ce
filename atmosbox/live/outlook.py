"""The planned ascent through the environment, known in advance, so that the axes of graphs fit it from the start."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.scene.conversion import to_si
from atmosbox.scene.instruments import Environment
from atmosbox.scene.setup import Setup

__all__ = ["outlook", "planned"]

Array = NDArray[np.float64]
_PLACES = 60


def outlook(setup: Setup) -> dict[str, Array]:
    """Return the planned ascent of a parcel, as arrays by the names of variables [SI]; empty for another box.

    Parameters
    ----------
    setup
        The box.

    Returns
    -------
    dict of str to (place,)
        Height, pressure and temperature of the environment, and the dry adiabat if there is one.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import build, prepare
    >>> way = outlook(build(prepare("lifting-dry", {"molecules": 100})))
    >>> [round(float(p) / 100.0) for p in way["environment_pressure"][[0, -1]]]
    [1000, 300]
    """
    found = (getattr(instrument, "environment", None) for instrument in setup.instruments)
    environment = next((each for each in found if isinstance(each, Environment)), None)
    if not setup.ends or environment is None:
        return {}
    seconds = np.linspace(0.0, setup.duration * setup.scale.time, _PLACES)
    pressure = np.array([environment.pressure(t) for t in seconds])
    way = {
        "elapsed_time": seconds / to_si(1.0, setup.time_unit),
        "parcel_height": np.array([environment.height(t) for t in seconds]),
        "parcel_pressure": pressure,
        "environment_pressure": pressure,
        "environment_temperature": np.array([environment.temperature(t) for t in seconds]),
        "adiabat_temperature": np.array([environment.adiabat(p) for p in pressure]),
    }
    return {name: values for name, values in way.items() if np.isfinite(values).all()}


def planned(panels: Iterable[Mapping[str, Any]], way: Mapping[str, Array]) -> list[dict[str, list[float]]]:
    """Return the points that the axes of each panel must include, in the units of the panel.

    Parameters
    ----------
    panels
        Records of panels, as `atmosbox.page.page_panel.panel_record` makes them.
    way
        The planned ascent, from `outlook`.

    Examples
    --------
    >>> line = {"x": {"name": "t", "factor": 1.0, "offset": -273.0}, "y": {"name": "p", "factor": 0.01, "offset": 0.0}}
    >>> planned([{"lines": [line]}], {"t": np.array([283.0]), "p": np.array([9e4])})
    [{'x': [10.0], 'y': [900.0]}]
    """
    found = []
    for panel in panels:
        points: dict[str, list[float]] = {"x": [], "y": []}
        for line in panel["lines"]:
            if "minus" in line or not {line["x"]["name"], line["y"]["name"]} <= set(way):
                continue
            for axis in ("x", "y"):
                values = way[line[axis]["name"]] * line[axis]["factor"] + line[axis]["offset"]
                points[axis] += [float(f"{value:.5g}") for value in values if math.isfinite(value)]
        found.append(points)
    return found
