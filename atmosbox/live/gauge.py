"""Thermometer, barometer and hygrometer of a running box: the latest measurements as numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.scene import SceneSettings

__all__ = ["FEW", "GAUGES", "gauges_of", "readings"]

_FRAMES = 20
FEW = 50
"""Smallest number of molecules of saturated vapour for a hygrometer; with fewer it scatters by more than a seventh."""
GAUGES = (
    ("thermometer", ("air_temperature", "parcel_temperature", "gas_temperature"), "°C", 1.0, -273.15),
    ("barometer", ("air_pressure", "parcel_pressure"), "hPa", 0.01, 0.0),
    ("hygrometer", ("relative_humidity",), "%", 100.0, 0.0),
)
"""For each gauge its name, the variables that it can show, and their unit, factor and offset from SI."""


def gauges_of(settings: SceneSettings) -> tuple[tuple[str, tuple[str, ...], str, float, float], ...]:
    """Return `GAUGES`; the thermometer reads kelvin in a scene whose temperature is set in kelvin.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import prepare
    >>> gauges_of(prepare("attraction", {}).settings)[0][2]
    'K'
    """
    if ("temperature", "K") not in {(each.name, each.unit) for each in type(settings).describe()}:
        return GAUGES
    name, variables, *_ = GAUGES[0]
    return ((name, variables, "K", 1.0, 0.0), *GAUGES[1:])


def readings(
    found: xr.Dataset, *, moving: bool, gauges: tuple[tuple[str, tuple[str, ...], str, float, float], ...] = GAUGES
) -> list[dict[str, Any]]:
    """Return the readings of the gauges of a box.

    Parameters
    ----------
    found
        The measurements since the last change.
    moving
        Whether the box changes on a planned ascent, so that only the last frame is used; otherwise up to 20 frames are
        averaged, to reduce the scatter of few molecules.
    gauges
        The gauges of the scene: see `gauges_of`.

    Returns
    -------
    list of dict
        The ``name``, ``value`` and ``unit`` of each gauge that the box has. Discs on a table have no gauges.

    Examples
    --------
    >>> import xarray as xr
    >>> found = xr.Dataset({"air_temperature": ("elapsed_time", [300.0, 296.3])})
    >>> readings(found, moving=False)
    [{'name': 'thermometer', 'value': 25.0, 'unit': '°C'}]

    In cold air so few molecules are enough for saturation that it gets no hygrometer:

    >>> share, number = ("elapsed_time", [3.7]), ("elapsed_time", [2])
    >>> readings(xr.Dataset({"relative_humidity": share, "vapor_molecule_count": number}), moving=True)
    []
    """
    if "disc_mass" in found:  # discs on a table: their energy is not shown as a temperature
        return []
    made = []
    for name, variables, unit, factor, offset in gauges:
        known = next((each for each in variables if each in found and found[each].dims == ("elapsed_time",)), None)
        if known is None:
            continue
        last = found[known].values[-1 if moving else -_FRAMES :]
        if name == "hygrometer" and "vapor_molecule_count" in found:
            vapour = found["vapor_molecule_count"].values[-last.size :]
            last = last[vapour >= FEW * last]
        last = last[np.isfinite(last)]
        if last.size:
            value = float(last.mean()) * factor + offset
            made.append({"name": name, "value": float(f"{value:.4g}"), "unit": unit})
    return made
