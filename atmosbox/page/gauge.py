"""Thermometer, barometer and hygrometer beside a box that runs: which variable each shows, and in which unit."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from atmosbox.scene import SceneSettings

__all__ = ["gauges"]

_FEW = 50
"""Smallest number of molecules of saturated vapour for a hygrometer; with fewer it scatters by more than a seventh."""
_GAUGES = (
    ("thermometer", ("parcel_temperature", "air_temperature", "gas_temperature"), "°C", 1.0, -273.15),
    ("barometer", ("parcel_pressure", "air_pressure"), "hPa", 0.01, 0.0),
    ("hygrometer", ("relative_humidity",), "%", 100.0, 0.0),
)
"""For each gauge its name, the variables that it can show, best first, and their unit, factor and offset from SI."""


def gauges(settings: SceneSettings, measured: Collection[str]) -> list[dict[str, Any]]:
    """Return the gauges of a box, as data for the page.

    Parameters
    ----------
    settings
        The settings; a scene whose temperature is set in kelvin gets a thermometer in kelvin.
    measured
        Names of the variables that are measured.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import prepare
    >>> [gauge["unit"] for gauge in gauges(prepare("attraction", {}).settings, ["air_temperature"])]
    ['K']
    """
    kelvin = ("temperature", "K") in {(each.name, each.unit) for each in type(settings).describe()}
    found = []
    for name, variables, unit, factor, offset in _GAUGES:
        if (shown := next((each for each in variables if each in measured), None)) is None:
            continue
        gauge: dict[str, Any] = {"name": name, "variable": shown, "unit": unit, "factor": factor, "offset": offset}
        if name == "thermometer" and kelvin:
            gauge |= {"unit": "K", "offset": 0.0}
        if name == "hygrometer":
            gauge["few"] = ["vapor_molecule_count", _FEW]
        found.append(gauge)
    return found
