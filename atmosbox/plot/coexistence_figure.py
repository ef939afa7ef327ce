"""The figure of liquid and vapour at several temperatures: ln p against 1/T (Clausius and Clapeyron), both densities.

It shows a sweep over the temperature. Each run has measured by itself a vapour pressure p and the slope L/ΔZ that ln p
must have against 1/T at its temperature. The lines have these slopes: nothing is fitted.
"""

from __future__ import annotations

import math

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from atmosbox import theory
from atmosbox.plot.caption import Reading, number, stated
from atmosbox.plot.layout import page
from atmosbox.plot.run_figure import painter
from atmosbox.plot.theme import Theme
from atmosbox.scene.panels import Line, Panel
from atmosbox.theory.constants import BOLTZMANN

Floats = NDArray[np.float64]

_NEAR = 0.8
"""The critical temperature is estimated from temperatures above this share of the expected value."""
_REACH = 0.45
"""Length of the line of a run to each side of its point, in mean distances between points."""
_DENSE = ("liquid_density", "vapor_density")


def is_coexistence(dataset: xr.Dataset, names: list[str]) -> bool:
    """Tell whether a sweep over the temperature has measured a vapour pressure and its slope at two or more of them.

    Examples
    --------
    >>> is_coexistence(xr.Dataset(), [])
    False
    """
    return {"vapor_pressure", "clapeyron_slope"} <= set(names) and bool(_known(dataset).sum() > 1)


def _known(data: xr.Dataset) -> NDArray[np.bool_]:
    """Tell at which temperatures both the vapour pressure and its slope are known."""
    return np.asarray(np.isfinite(data.vapor_pressure.values) & np.isfinite(data.clapeyron_slope.values))


def draw_coexistence(dataset: xr.Dataset, members: int, look: Theme) -> Figure:
    """Draw ln p against 1/T with the slope that each run has measured, and the densities of liquid and vapour.

    Parameters
    ----------
    dataset : xarray.Dataset
        The sweep, for which `is_coexistence` is true.
    members : int
        Number of runs at each temperature.

    Returns
    -------
    matplotlib.figure.Figure
        The figure. Above the panels it gives the slope of ln p through all points beside the mean of the slopes L/ΔZ
        that the runs have measured, and, if enough temperatures are near it, the critical temperature.
    """
    data = dataset.isel(temperature=np.flatnonzero(_known(dataset)))
    parameters = stated(data, "atmosbox_parameters", dict)
    settings = parameters.get("settings", {})
    fluid = theory.SIMPLE_FLUIDS.get(str(settings.get("substance", "")))
    strength = float(settings.get("attraction", 1.0))
    readings, panels, flat = [_slopes(data)], [], _curves(data, fluid, strength)
    pressure = [
        Line("inverse", "p", "runs", error="p_se"),
        Line("inverse_ends", "slope", "slope L/ΔZ of each run", "reference"),
    ]
    if fluid is not None:
        pressure.append(Line("inverse_fine", "published", "published simulations", "theory"))
        if strength == 1.0:
            pressure.append(Line("inverse_fine", "real", f"real {fluid.name}", "environment"))
    title = "Clausius and Clapeyron: ln p against 1/T"
    panels.append(Panel("line", title, tuple(pressure), "1000 K / T", "vapour pressure", "1", "bar", y_scale="log"))
    if set(_DENSE) <= set(data):
        lines = [
            Line(name, "kelvin", label, error=f"{name}_se")
            for name, label in zip(_DENSE, ("liquid", "vapour"), strict=True)
        ]
        lines.append(Line("mean", "kelvin", "mean of both"))
        if fluid is not None:
            readings.append(_critical(data, fluid, strength))
            lines.append(Line("width", "critical", "critical temperature", "theory"))
        panels.append(Panel("profile", "Liquid and vapour become alike", tuple(lines), "density", "temperature"))
    runs = "one run" if members == 1 else f"mean of {members} runs"
    small = f"atmosbox {parameters.get('version', data.attrs.get('product_version', ''))} · {parameters['scene']}"
    small += f" · each point {runs} · bars: ± 1 standard error"
    heading = str(data.attrs.get("title", ""))
    return page(
        tuple(panels), look, flat, painter(flat, look), [each for each in readings if each is not None], small, heading
    )


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
    flat = xr.Dataset({"kelvin": ("run", kelvin, {"units": "K"}), "inverse": ("point", _parted(1e3 / kelvin))})
    for name, values in (("p", pressure), ("p_se", _error(data, "vapor_pressure"))):
        flat[name] = ("point", _parted(values), {"units": "Pa"})
    flat["inverse_ends"], flat["slope"] = ("end", 1e3 * ends.ravel()), ("end", slope.ravel(), {"units": "Pa"})
    if set(_DENSE) <= set(data):
        for name in _DENSE:
            for part, values in ((name, data[name].values), (f"{name}_se", _error(data, name))):
                flat[part] = ("run", values, {"units": "kg m-3"})
        flat["mean"] = 0.5 * (flat.liquid_density + flat.vapor_density).assign_attrs(units="kg m-3")
        flat["width"] = ("side", [0.0, 1.05 * float(np.nanmax(flat.liquid_density))], {"units": "kg m-3"})
    if fluid is not None:
        room = 0.03 * np.ptp(kelvin)
        fine = np.linspace(kelvin.min() - room, kelvin.max() + room, 100)
        unit = strength * fluid.well_depth / fluid.well_diameter**3
        model = theory.well_vapor_pressure(fine * BOLTZMANN / (strength * fluid.well_depth)) * unit
        real = np.where(
            fine < fluid.critical_temperature,
            fluid.vapor_pressure(np.minimum(fine, fluid.critical_temperature)),
            np.nan,
        )
        flat["inverse_fine"] = ("fine", 1e3 / fine)
        flat["published"], flat["real"] = (("fine", each, {"units": "Pa"}) for each in (model, real))
        flat["critical"] = ((), fluid.critical_temperature * strength, {"units": "K"})
    return flat


def _parted(values: Floats) -> Floats:
    """Return values with gaps between them, so that no line joins the points."""
    return np.column_stack([values, np.full(len(values), np.nan)]).ravel()


def _slopes(data: xr.Dataset) -> Reading | None:
    """Return the slope of ln p through all points beside the weighted mean of the slopes that the runs have measured.

    None if a standard error is not known.
    """
    kelvin, pressure, slope = (data[name].values for name in ("temperature", "vapor_pressure", "clapeyron_slope"))
    error, spread = _error(data, "vapor_pressure"), _error(data, "clapeyron_slope")
    if not (error > 0.0).all() or not (spread > 0.0).all():
        return None
    through, through_se = theory.slope_of_pressure(kelvin, pressure, error)
    weight = 1.0 / spread**2
    within, within_se = float((weight * slope).sum() / weight.sum()), float(weight.sum() ** -0.5)
    value, _, deviation = number(through, through_se).partition(" ± ")
    apart = number(through - within, math.hypot(through_se, within_se), signed=True)
    return Reading(
        "slope of ln p against 1/T through the points",
        value,
        f"± {deviation} K",
        f"L/ΔZ, measured within the runs: {number(within, within_se)} K",
        f"difference {apart} K",
    )


def _critical(data: xr.Dataset, fluid: theory.SimpleFluid, strength: float) -> Reading | None:
    """Return the critical temperature, at which the densities of liquid and vapour meet, from the warmest points.

    None for fewer than three such points, or if a standard error is not known.
    """
    expected = fluid.critical_temperature * strength
    warm = data.isel(temperature=np.flatnonzero(data.temperature.values > _NEAR * expected))
    if warm.sizes["temperature"] < 3:
        return None
    liquid, vapour = (warm[name].values for name in ("liquid_density", "vapor_density"))
    errors = [_error(warm, name) for name in ("liquid_density", "vapor_density")]
    if not all((each > 0.0).all() for each in errors):
        return None
    found = theory.critical_point(warm.temperature.values, liquid, vapour, *errors)
    value, _, deviation = number(found.temperature, found.temperature_se).partition(" ± ")
    return Reading(
        "critical temperature, where both densities meet",
        value,
        f"± {deviation} K",
        f"of this model {expected:.1f} K",
        "expected too high: the law of their difference holds only near it",
    )
