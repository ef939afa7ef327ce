"""Thermometer, barometer and hygrometer of a box that runs: what was measured last, as numbers to read."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.scene import SceneSettings

__all__ = ["FEW", "GAUGES", "gauges_of", "readings"]

_FRAMES = 20
FEW = 50
"""With fewer molecules that would saturate the air, a hygrometer scatters by more than a seventh."""
GAUGES = (
    ("thermometer", ("air_temperature", "parcel_temperature", "gas_temperature"), "°C", 1.0, -273.15),
    ("barometer", ("air_pressure", "parcel_pressure"), "hPa", 0.01, 0.0),
    ("hygrometer", ("relative_humidity",), "%", 100.0, 0.0),
)
"""Of each gauge its name, the variables that it may show, and how it shows them: unit, factor and offset from SI."""


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
    """Return what the gauges of a box say.

    Parameters
    ----------
    found
        What has been measured since the last change.
    moving
        Whether the box is on a way, so that only its last frame tells how it is now; else up to 20 frames are averaged,
        because so few molecules scatter.
    gauges
        Those of the scene: see `gauges_of`.

    Returns
    -------
    list of dict
        Of each gauge that the box has: its ``name``, ``value`` and ``unit``. Discs on a table have none.

    Examples
    --------
    >>> import xarray as xr
    >>> found = xr.Dataset({"air_temperature": ("elapsed_time", [300.0, 296.3])})
    >>> readings(found, moving=False)
    [{'name': 'thermometer', 'value': 25.0, 'unit': '°C'}]

    Cold air would be saturated by a molecule or two, and has no hygrometer:

    >>> share, number = ("elapsed_time", [3.7]), ("elapsed_time", [2])
    >>> readings(xr.Dataset({"relative_humidity": share, "vapor_molecule_count": number}), moving=True)
    []
    """
    if "disc_mass" in found:  # discs of a table, whose energy no thermometer shows
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
