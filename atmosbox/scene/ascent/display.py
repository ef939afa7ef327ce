"""The output of a lifted parcel of moist air: its theory curves, its headline numbers, its panels."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.ascent.drawn_parcels import Parcels, comparable, draw, planned_cloud
from atmosbox.scene.ascent.near_equilibrium import Cloud
from atmosbox.scene.ascent.way import MoistAscent
from atmosbox.scene.headline import Headline
from atmosbox.scene.panels import Line, Panel, over_height

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]
BLOCK = 7
"""Number of frames over which a temperature is averaged before it is compared with the adiabat."""
LEAST, CLUSTERED = 0.1, 3.0
"""Least liquid that counts as a cloud: as a share of all water, and in standard deviations of the liquid."""
THEORY = "theory is the adiabat of a large parcel, with the known errors of so fast an ascent of so few molecules"


def lifted_panels(ascent: MoistAscent, adiabat: str) -> tuple[Panel, ...]:
    """Return the panels of temperature against pressure, of vapour and liquid, and of the parcel on its ascent."""
    cloud = ascent.base > 1.02 * ascent.top_pressure
    low, base = ascent.pressure / 100.0, ascent.base / 100.0
    start = ascent.temperature - 273.15, low
    cools = (
        Line("parcel_temperature", "parcel_pressure", "parcel", error="parcel_temperature_se"),
        Line("adiabat_temperature", "parcel_pressure", adiabat, "theory"),
        Line("dry_air_adiabat_temperature", "parcel_pressure", "without condensation", "reference"),
        Line("environment_temperature", "environment_pressure", "environment", "environment"),
    )
    liquid, vapour = "cloud_liquid_water_mixing_ratio", "humidity_mixing_ratio"
    water = (
        Line(liquid, "parcel_pressure", "liquid"),
        Line(f"{liquid}_theory", "parcel_pressure", "theory", "theory"),
        Line(vapour, "parcel_pressure", "vapour"),
        Line(f"{vapour}_theory", "parcel_pressure", "theory", "theory"),
    )
    shown = [f"temperature_at_{level / 100.0:.0f}_hpa" for level in ascent.levels[1:2]]
    both: dict[str, Any] = {"pressure": True}
    if cloud:
        # so that the kink is seen, a fifth of the axis lies below it
        both["y_limits"] = low, max(ascent.top_pressure / 100.0, low * (base / low) ** 5)
        shown.insert(0, "cloud_base")
    title = "In its cloud it cools less" if cloud else "Too dry for a cloud"
    marked = [(("y", base, words),) if cloud else () for words in ("cloud base", "")]
    return (
        replace(atmosphere_panel("The parcel and its cloud" if cloud else "The parcel on its way"), start=start),
        over_height(title, cools, "temperature", "degC", *shown, start=start, guides=marked[0], **both),
        over_height("Vapour becomes liquid", water, "mixing ratio", "g kg-1", guides=marked[1], **both),
    )


def atmosphere_panel(title: str, headlines: tuple[str, ...] = (), way: str = "") -> Panel:
    """Return the picture of the parcel on its ascent; ``way`` is the label of the horizontal axis, if there is one."""
    line = Line("elapsed_time", "parcel_height", "parcel")
    return Panel("atmosphere", title, (line,), x_label=way, y_label="height", y_unit="km", headlines=headlines)


def lifted_theory(dataset: xr.Dataset, ascent: MoistAscent, frames: int) -> dict[str, Array]:
    """Return what theory expects along the ascent: water, humidity, and the adiabat if nothing condensed; (frame,).

    Liquid above ``largest_haze_mixing_ratio`` is a cloud.
    """
    pressure = dataset.parcel_pressure.values
    middle = (np.arange(len(pressure)) + 0.5) / frames
    if ascent.rains:
        shares, along = ascent.planned
        planned = np.exp(np.interp(middle, shares, np.log(ascent.route)))
        if np.allclose(planned, dataset.environment_pressure.values, rtol=1e-6):
            path = law.ParcelPath(*(np.interp(middle, shares, each) for each in along))
        else:  # a knob has set its altitude
            path = ascent.path(pressure, middle)
    else:
        path = ascent.path(pressure, pressure)
    exponent = float(law.moist_air_poisson_exponent(ascent.total_water, ascent.nuclei_heat))
    vapour_pressure = law.vapor_pressure(pressure, path.vapor)
    cloud = Cloud(ascent, pressure, middle, path=path)
    found = {
        "dry_air_adiabat_temperature": ascent.temperature * (pressure / ascent.pressure) ** exponent,
        "cloud_liquid_water_mixing_ratio_theory": path.liquid,
        "humidity_mixing_ratio_theory": path.vapor,
        "largest_haze_mixing_ratio": law.WATER_MASS_RATIO * cloud.haze / cloud.air,
        "relative_humidity_theory": vapour_pressure / law.saturation_vapor_pressure(path.temperature),
    }
    return found | ({"rain_mixing_ratio_theory": path.rain} if "rain_mixing_ratio" in dataset else {})


def lifted_headlines(
    dataset: xr.Dataset, ascent: MoistAscent, frames: int, samples: int, *, ideal: bool
) -> tuple[Headline, ...]:
    """Return the cloud base, and the temperature at some pressure levels of an ascent."""
    pressure, outside = dataset.parcel_pressure.values, dataset.environment_pressure.values
    if len(pressure) < BLOCK:
        return ()
    drawn = draw(ascent, outside, frames, samples, ideal=ideal)
    misfit = (dataset.parcel_temperature - dataset.adiabat_temperature).values
    found = _cloud_base(dataset, ascent, drawn)
    for level in ascent.levels:
        if outside.min() > 1.02 * level:  # the parcel's own pressure fluctuates
            continue
        first = int(np.argmin(np.abs(np.log(outside / level)))) - BLOCK // 2
        first = min(max(first, 0), len(pressure) - BLOCK)
        near = slice(first, first + BLOCK)
        adiabat = float(ascent.planned_at(level).temperature[0])
        warmer = drawn.warmth[:, near].mean(axis=1) * adiabat
        name, label = f"temperature_at_{level / 100.0:.0f}_hpa", f"temperature at {level / 100.0:.0f} hPa"
        value, error = adiabat + float(misfit[near].mean()), float(warmer.std())
        answer = adiabat + float(warmer.mean()) if comparable(ascent) else None
        found.append(Headline(name, value, error, answer, 0.0, THEORY, "K", "degC", label))
    return tuple(found)


def _cloud_base(dataset: xr.Dataset, ascent: MoistAscent, drawn: Parcels) -> list[Headline]:
    """Return the pressure at which the liquid of the parcel begins.

    Noise shifts that level by an amount that depends on the slope of the curve, and the measured slope is noisy itself:
    so error and theory are those of the drawn parcels, measured in the same way.
    """
    if not ascent.base > ascent.top_pressure:
        return []
    vapour, liquid = (dataset[name].values for name in ("humidity_mixing_ratio", "cloud_liquid_water_mixing_ratio"))
    condensed = liquid + (dataset.rain_mixing_ratio.values if "rain_mixing_ratio" in dataset else 0.0)
    water, unit = ascent.total_water, ascent.total_water / ascent.vapour
    noise = np.cov(drawn.vapour.T) * unit**2
    least = max(LEAST, CLUSTERED * float(planned_cloud(ascent).liquid_scatter.max()) / ascent.vapour)
    base = law.measured_cloud_base(dataset.parcel_pressure.values, vapour, condensed, noise, least)
    if base is None or base.pressure > ascent.pressure:  # noise can put it below the ground
        return []
    frames = dataset.environment_pressure.values
    seen = np.clip((drawn.theory + drawn.vapour) * unit, 0.0, water)
    found = [law.measured_cloud_base(frames, each, water - each, noise, least) for each in seen]
    levels = [each.pressure for each in found if each is not None]
    if len(levels) <= 0.5 * len(seen):
        return []
    error, expected = float(np.std(levels, ddof=1)), float(np.mean(levels))
    aside = f"{(expected - ascent.base) / 100.0:+.1f} hPa"
    note = f"theory is {aside} from the condensation level: extrapolation, few molecules, noise, late condensation"
    sizes, low, high = (base.pressure, error, expected, 0.0), ascent.top_pressure, ascent.pressure
    return [Headline("cloud_base", *sizes, note, "Pa", "hPa", "cloud base", low=low, high=high)]
