"""What a lifted parcel of moist air shows: its curves, its numbers, its figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.ascent import finite_size
from atmosbox.scene.ascent.way import MoistAscent
from atmosbox.scene.headline import Headline
from atmosbox.scene.panels import Line, Panel
from atmosbox.scene.statistics import successive_error

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["atmosphere_panel", "lifted_headlines", "lifted_panels", "lifted_theory"]

Array = NDArray[np.float64]
BLOCK = 5
"""Over how many frames a temperature is averaged that is compared with the adiabat."""


def lifted_panels(ascent: MoistAscent, adiabat: str) -> tuple[Panel, ...]:
    """Return temperature against pressure with its kink, vapour and liquid, beside the parcel on its way.

    Parameters
    ----------
    ascent
        The way up.
    adiabat
        What the adiabat is called.
    """
    cloud = ascent.base > 1.02 * ascent.top_pressure
    base = (Line("adiabat_temperature", "cloud_base_theory", "condensation level", "reference"),) if cloud else ()
    return (
        atmosphere_panel("The parcel and its cloud" if cloud else "The parcel on its way"),
        Panel(
            "profile",
            "A kink at the cloud base" if cloud else "Too dry for a cloud",
            (
                Line("parcel_temperature", "parcel_pressure", "parcel", error="parcel_temperature_se"),
                Line("adiabat_temperature", "parcel_pressure", adiabat, "theory"),
                Line("dry_air_adiabat_temperature", "parcel_pressure", "without condensation", "reference"),
                Line("environment_temperature", "environment_pressure", "environment", "environment"),
                *base,
            ),
            x_label="temperature",
            x_unit="degC",
            headlines=(
                *(("cloud_base",) if cloud else ()),
                *(f"temperature_at_{level / 100.0:.0f}_hpa" for level in ascent.levels[1::2]),
            ),
            y_label="pressure",
            y_unit="hPa",
            y_scale="log",
            y_invert=True,
        ),
        Panel(
            "profile",
            "Vapour becomes liquid",
            (
                Line("cloud_liquid_water_mixing_ratio", "parcel_pressure", "liquid"),
                Line("cloud_liquid_water_mixing_ratio_theory", "parcel_pressure", "liquid, theory", "theory"),
                Line("humidity_mixing_ratio", "parcel_pressure", "vapour"),
                Line("humidity_mixing_ratio_theory", "parcel_pressure", "vapour, theory", "theory"),
            ),
            x_label="mixing ratio",
            x_unit="g kg-1",
            y_label="pressure",
            y_unit="hPa",
            y_scale="log",
            y_invert=True,
        ),
    )


def atmosphere_panel(title: str, headlines: tuple[str, ...] = (), way: str = "") -> Panel:
    """Return the picture of the parcel on its way, with ground, cloud and rain.

    Parameters
    ----------
    title
        What is seen.
    headlines
        Names of the numbers that go with it.
    way
        What is written along the way across; nothing for a parcel that rises where it is.
    """
    line = Line("elapsed_time", "parcel_height", "parcel")
    return Panel("atmosphere", title, (line,), x_label=way, y_label="height", y_unit="km", headlines=headlines)


def lifted_theory(dataset: xr.Dataset, ascent: MoistAscent, frames: int) -> dict[str, Array]:
    """Return what theory expects on the way: water, humidity, and the adiabat if nothing condensed."""
    pressure = dataset.parcel_pressure.values
    if ascent.rains:
        shares, along = ascent.planned
        middle = (np.arange(len(pressure)) + 0.5) / frames
        planned = np.exp(np.interp(middle, shares, np.log(ascent.route)))
        if np.allclose(planned, dataset.environment_pressure.values, rtol=1e-6):
            path = law.ParcelPath(*(np.interp(middle, shares, each) for each in along))
        else:  # its altitude was set by a knob
            path = ascent.path(pressure, middle)
    else:
        path = ascent.path(pressure, pressure)
    exponent = float(law.moist_air_poisson_exponent(ascent.total_water, ascent.nuclei_heat))
    vapour_pressure = law.vapor_pressure(pressure, path.vapor)
    found = {
        "dry_air_adiabat_temperature": ascent.temperature * (pressure / ascent.pressure) ** exponent,
        "cloud_liquid_water_mixing_ratio_theory": path.liquid,
        "humidity_mixing_ratio_theory": path.vapor,
        "relative_humidity_theory": vapour_pressure / law.saturation_vapor_pressure(path.temperature),
    }
    return found | ({"rain_mixing_ratio_theory": path.rain} if "rain_mixing_ratio" in dataset else {})


def lifted_headlines(dataset: xr.Dataset, ascent: MoistAscent, *, ideal: bool) -> tuple[Headline, ...]:
    """Return the cloud base, and the temperature at some levels of a way up."""
    pressure, temperature = dataset.parcel_pressure.values, dataset.parcel_temperature.values
    stated, misfit = dataset.parcel_temperature_se.values, temperature - dataset.adiabat_temperature.values
    found = []
    base = law.fitted_cloud_base(
        pressure, temperature, stated, ascent.pressure, ascent.temperature, ascent.total_water,
        nuclei_heat=ascent.nuclei_heat,
    )  # fmt: skip
    if base is not None:
        found.append(
            Headline(
                "cloud_base",
                base.pressure,
                base.standard_error,
                ascent.base,
                finite_size.blur(ascent),
                "molecules cluster already below the base, and vapour must find liquid: it is blurred",
                "Pa",
                "hPa",
                "cloud base",
            )
        )
    scatter = successive_error(misfit, block=BLOCK)
    for level in ascent.levels:
        middle = int(np.argmin(np.abs(np.log(pressure / level))))
        # the error is that of so many frames: at the top the last of them, not fewer
        first = min(max(middle - BLOCK // 2, 0), max(len(pressure) - BLOCK, 0))
        near = slice(first, first + BLOCK)
        if dataset.environment_pressure.values.min() > 1.02 * level:  # the parcel's own pressure scatters
            continue
        expected = float(ascent.planned_at(level).temperature[0])
        found.append(
            Headline(
                f"temperature_at_{level / 100.0:.0f}_hpa",
                expected + float(misfit[near].mean()),
                float(np.hypot(scatter[middle], expected * finite_size.walk(ascent, np.array([level]))[0])),
                expected if finite_size.comparable(ascent) else None,
                finite_size.tolerance(ascent, level, ideal=ideal),
                "the ascent is not infinitely slow, spheres have volume, and vapour must find liquid",
                "K",
                "degC",
                f"temperature at {level / 100.0:.0f} hPa",
            )
        )
    return tuple(found)
