"""The figure of liquid and vapour at several temperatures: ln p against 1/T (Clausius and Clapeyron), both densities.

It shows a sweep over the temperature. Each run has measured by itself a vapour pressure p and the slope L/RΔZ that ln p
must have against 1/T at its temperature. The lines have these slopes: nothing is fitted.
"""

import json
import math
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from atmosbox import theory
from atmosbox.plot.caption import stated
from atmosbox.scene.panels import Line, Panel, to_json
from atmosbox.theory.constants import BOLTZMANN

Floats = NDArray[np.float64]

_NEAR = 0.8
"""The critical temperature is estimated from temperatures above this share of the expected value."""
_REACH = 0.45
"""Length of the line of a run to each side of its point, in mean distances between points."""
_DENSE = {"liquid_density": "liquid", "vapor_density": "vapour"}
_TOO_HIGH = "The critical temperature comes out too high: the law of the densities' difference holds only close to it."


def is_coexistence(dataset: xr.Dataset, names: list[str]) -> bool:
    """Tell whether a sweep over the temperature has measured a vapour pressure and its slope at two or more of them."""
    return {"vapor_pressure", "clapeyron_slope"} <= set(names) and bool(_known(dataset).sum() > 1)


def _known(data: xr.Dataset) -> NDArray[np.bool_]:
    """Tell at which temperatures both the vapour pressure and its slope are known."""
    return np.asarray(np.isfinite(data.vapor_pressure.values) & np.isfinite(data.clapeyron_slope.values))


def coexistence(dataset: xr.Dataset, runs: str) -> xr.Dataset:
    """Return a sweep with the panels of ln p against 1/T and of the densities of liquid and vapour.

    Its headlines are the slope of ln p through all points, with the mean of the slopes L/RΔZ that the runs have
    measured as its theory, and, if enough temperatures are near it, the critical temperature. ``runs`` says what a
    point is.
    """
    data = dataset.isel(temperature=np.flatnonzero(_known(dataset)))
    settings = stated(data, "atmosbox_parameters", dict).get("settings", {})
    fluid = theory.SIMPLE_FLUIDS.get(str(settings.get("substance", "")))
    strength = float(settings.get("attraction", 1.0))
    flat = _curves(data, fluid, strength).assign(_slopes(data))
    lines = [
        Line("inverse", "p", runs, error="p_se"),
        Line("inverse_ends", "slope", "slope −L/RΔZ of each run", "reference"),
    ]
    if fluid is not None:
        lines.append(Line("inverse_fine", "published", "published simulations", "theory"))
        if strength == 1.0:
            lines.append(Line("inverse_fine", "real", f"real {fluid.name}", "environment"))
    title, label = "Clausius and Clapeyron: ln p against 1/T", "vapour pressure"
    panels = [Panel("line", title, tuple(lines), "1000 K / T", label, "1", "hPa", y_scale="log")]
    if set(_DENSE) <= set(data):
        lines = [Line(name, "kelvin", label, error=f"{name}_se") for name, label in _DENSE.items()]
        lines.append(Line("mean", "kelvin", "mean of both"))
        if fluid is not None:
            flat = flat.assign(_critical(data, fluid.critical_temperature * strength))
            lines.append(Line("width", "critical", "critical temperature", "theory"))
        title, note = "Liquid and vapour become alike", _TOO_HIGH if "meeting" in flat else ""
        panels.append(Panel("profile", title, tuple(lines), "density", "temperature", note=note))
    headlines = json.dumps(["steepness", "meeting"])
    return flat.assign_attrs(data.attrs, atmosbox_panels=to_json(panels), atmosbox_headlines=headlines)


def _error(data: xr.Dataset, name: str) -> Floats:
    """Return the standard errors of a headline, 0 where they are not known."""
    values = data[f"{name}_se"].values if f"{name}_se" in data else np.zeros(data.sizes["temperature"])
    return np.nan_to_num(np.asarray(values, np.float64))


def _curves(data: xr.Dataset, fluid: theory.SimpleFluid | None, strength: float) -> xr.Dataset:
    """Return the curves of both panels; the lines of the runs are parted by gaps."""
    kelvin, pressure = data.temperature.values, data.vapor_pressure.values
    half = _REACH * float(np.ptp(1.0 / kelvin)) / (len(kelvin) - 1)
    ends = 1.0 / kelvin[:, None] + np.array([-half, half, np.nan])
    slope = pressure[:, None] * np.exp(-data.clapeyron_slope.values[:, None] * (ends - 1.0 / kelvin[:, None]))
    density, pascal = {"units": "kg m-3"}, {"units": "Pa"}
    flat = xr.Dataset({"kelvin": ("run", kelvin, {"units": "K"}), "inverse": ("point", _parted(1e3 / kelvin))})
    flat["p"] = ("point", _parted(pressure), pascal)
    flat["p_se"] = ("point", _parted(_error(data, "vapor_pressure")), pascal)
    flat["inverse_ends"], flat["slope"] = ("end", 1e3 * ends.ravel()), ("end", slope.ravel(), pascal)
    if set(_DENSE) <= set(data):
        for name in _DENSE:
            flat[name] = ("run", data[name].values, density)
            flat[f"{name}_se"] = ("run", _error(data, name), density)
        flat["mean"] = 0.5 * (flat.liquid_density + flat.vapor_density).assign_attrs(density)
        flat["width"] = ("side", [0.0, 1.05 * float(np.nanmax(flat.liquid_density))], density)
    if fluid is not None:
        room = 0.03 * np.ptp(kelvin)
        fine = np.linspace(kelvin.min() - room, kelvin.max() + room, 100)
        unit = strength * fluid.well_depth / fluid.well_diameter**3
        model = theory.well_vapor_pressure(fine * BOLTZMANN / (strength * fluid.well_depth)) * unit
        flat["inverse_fine"], flat["published"] = ("fine", 1e3 / fine), ("fine", model, pascal)
        flat["real"] = ("fine", fluid.vapor_pressure(fine), pascal)
        flat["critical"] = ((), fluid.critical_temperature * strength, {"units": "K"})
    return flat


def _parted(values: Floats) -> Floats:
    """Return values with gaps between them, so that no line joins the points."""
    return np.column_stack([values, np.full(len(values), np.nan)]).ravel()


def _headline(name: str, found: tuple[float, float], told: tuple[float, float], *labels: str) -> dict[str, Any]:
    """Return a headline number in kelvin with its error and its theory, whose error is known, too."""
    chance = 4.0 * math.hypot(found[1], told[1]) if told[1] else 0.0
    attrs = [{"units": "K", "display_name": label, "misfit_allowed_by_chance": chance} for label in labels]
    return {name: ((), found[0], attrs[0]), f"{name}_se": found[1], f"{name}_theory": ((), told[0], attrs[1])}


def _slopes(data: xr.Dataset) -> dict[str, Any]:
    """Return the slope of ln p through all points beside the weighted mean of the slopes that the runs have measured.

    Empty if a standard error is not known.
    """
    kelvin, pressure, slope = (data[name].values for name in ("temperature", "vapor_pressure", "clapeyron_slope"))
    error, spread = _error(data, "vapor_pressure"), _error(data, "clapeyron_slope")
    if not (error > 0.0).all() or not (spread > 0.0).all():
        return {}
    weight = 1.0 / spread**2
    within = float((weight * slope).sum() / weight.sum()), float(weight.sum() ** -0.5)
    labels = "slope of ln p against −1/T through the points", "L/RΔZ, measured within the runs"
    return _headline("steepness", theory.slope_of_pressure(kelvin, pressure, error), within, *labels)


def _critical(data: xr.Dataset, expected: float) -> dict[str, Any]:
    """Return the critical temperature, at which the densities of liquid and vapour meet, from the warmest points.

    Empty for fewer than three such points, or if a standard error is not known.
    """
    warm = data.isel(temperature=np.flatnonzero(data.temperature.values > _NEAR * expected))
    errors = [_error(warm, name) for name in _DENSE]
    if warm.sizes["temperature"] < 3 or not all((each > 0.0).all() for each in errors):
        return {}
    found = theory.critical_point(warm.temperature.values, *(warm[name].values for name in _DENSE), *errors)
    labels = "critical temperature, where both densities meet", "of this model"
    return _headline("meeting", (found.temperature, found.temperature_se), (expected, 0.0), *labels)
