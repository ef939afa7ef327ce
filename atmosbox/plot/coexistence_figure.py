"""The figure of liquid and vapour at several temperatures: ln p against 1/T (Clausius and Clapeyron), both densities.

It shows a sweep over the temperature. Each run has measured by itself a vapour pressure p and the slope L/ΔZ that ln p
must have against 1/T at its temperature. The lines have these slopes: nothing is fitted.
"""

from __future__ import annotations

import json
import math

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from atmosbox import theory
from atmosbox.plot.caption import Reading, number
from atmosbox.plot.number_card import put_numbers
from atmosbox.plot.pen import Pen
from atmosbox.plot.place import blank, put_footer, put_heading
from atmosbox.plot.theme import DARK, DATA_COLOURS, REFERENCE_COLOURS, THEORY_COLOURS, Theme, style
from atmosbox.plot.varied import Varied
from atmosbox.theory.constants import BOLTZMANN

__all__ = ["draw_coexistence", "is_coexistence"]

Floats = NDArray[np.float64]

_BAR = 1e5
_NEAR = 0.8
"""The critical temperature is estimated from temperatures above this share of the expected value."""
_REACH = 0.45
"""Length of the line of a run to each side of its point, in mean distances between points."""


def is_coexistence(swept: Varied) -> bool:
    """Tell whether a sweep has measured a vapour pressure and its slope at two or more temperatures.

    Examples
    --------
    >>> import xarray as xr
    >>> is_coexistence(Varied(xr.Dataset(), "height", None, (), 1))
    False
    """
    named = swept.across == "temperature" and swept.other is None and swept.numeric(swept.across)
    return named and {"vapor_pressure", "clapeyron_slope"} <= set(swept.names) and bool(_known(swept).sum() > 1)


def _known(swept: Varied) -> NDArray[np.bool_]:
    """Tell at which temperatures both the vapour pressure and its slope are known."""
    data = swept.dataset
    return np.asarray(np.isfinite(data.vapor_pressure.values) & np.isfinite(data.clapeyron_slope.values))


def draw_coexistence(swept: Varied, look: Theme) -> Figure:
    """Draw ln p against 1/T with the slope that each run has measured, and the densities of liquid and vapour.

    Parameters
    ----------
    swept : Varied
        The sweep, for which `is_coexistence` is true.
    look : Theme
        The theme: sizes of type, lines and markers.

    Returns
    -------
    matplotlib.figure.Figure
        The figure. Above the panels it gives the slope of ln p through all points beside the mean of the slopes L/ΔZ
        that the runs have measured, and, if enough temperatures are near it, the critical temperature.
    """
    data = swept.dataset.isel(temperature=np.flatnonzero(_known(swept)))
    parameters = json.loads(data.attrs["atmosbox_parameters"])
    settings = parameters.get("settings", {})
    fluid = theory.SIMPLE_FLUIDS.get(str(settings.get("substance", "")))
    strength = float(settings.get("attraction", 1.0))
    dense = {"liquid_density", "vapor_density"} <= set(swept.names)
    with style(look):
        drawing = blank(look.wide, look)
        pen = Pen(drawing)
        top = put_heading(pen, str(data.attrs.get("title", "")) if look.heading else "", look)
        readings = [_slopes(data), *([_critical(data, fluid, strength)] if dense and fluid is not None else [])]
        top += put_numbers(pen, [each for each in readings if each is not None], look, top)
        if look.grows:
            drawing.set_figheight(drawing.get_figheight() + top / 72)
        axes = drawing.subplots(1, 2 if dense else 1, squeeze=False)[0]
        _draw_pressure(axes[0], data, fluid, strength, look)
        if dense:
            _draw_densities(axes[1], data, fluid, strength, look)
        runs = "one run" if swept.members == 1 else f"mean of {swept.members} runs"
        small = f"atmosbox {parameters.get('version', data.attrs.get('product_version', ''))} · {parameters['scene']}"
        put_footer(pen, f"{small} · each point {runs} · bars: ± 1 standard error", look)
        engine = drawing.get_layout_engine()
        assert engine is not None
        engine.set(rect=(0.0, 0.0, 1.0, 1.0 - top / 72 / drawing.get_figheight()))  # type: ignore[call-arg]
    return drawing


def _error(data: xr.Dataset, name: str) -> Floats:
    """Return the standard errors of a headline, 0 where they are not known."""
    values = data[f"{name}_se"].values if f"{name}_se" in data else np.zeros(data.sizes["temperature"])
    return np.nan_to_num(np.asarray(values, np.float64))


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


def _draw_pressure(
    axes: Axes, data: xr.Dataset, fluid: theory.SimpleFluid | None, strength: float, look: Theme
) -> None:
    """Draw the vapour pressures with the slope of each run, published simulations, and the real substance."""
    kelvin, pressure = data.temperature.values, data.vapor_pressure.values / _BAR
    axes.errorbar(
        1e3 / kelvin, pressure, _error(data, "vapor_pressure") / _BAR, fmt="o", color=DATA_COLOURS[0],
        label="runs", zorder=4,
    )  # fmt: skip
    half = _REACH * float(np.ptp(1.0 / kelvin)) / (len(kelvin) - 1)
    for k, each in enumerate(kelvin):
        ends = 1.0 / each + np.array([-half, half])
        line = pressure[k] * np.exp(-data.clapeyron_slope.values[k] * (ends - 1.0 / each))
        axes.plot(
            1e3 * ends, line, color=DATA_COLOURS[1], lw=1.6 * look.line, zorder=3,
            label="slope L/ΔZ of each run" if k == 0 else None,
        )  # fmt: skip
    if fluid is not None:
        room = 0.03 * np.ptp(kelvin)
        fine = np.linspace(kelvin.min() - room, kelvin.max() + room, 100)
        unit = strength * fluid.well_depth / fluid.well_diameter**3 / _BAR
        model = theory.well_vapor_pressure(fine * BOLTZMANN / (strength * fluid.well_depth)) * unit
        axes.plot(1e3 / fine, model, color=THEORY_COLOURS[0], ls="--", label="published simulations", zorder=2)
        if strength == 1.0:
            real = fluid.vapor_pressure(fine[fine < fluid.critical_temperature]) / _BAR
            below = fine[fine < fluid.critical_temperature]
            axes.plot(1e3 / below, real, color=REFERENCE_COLOURS[0], ls=":", label=f"real {fluid.name}", zorder=1)
    axes.set_yscale("log")
    axes.set_title("Clausius and Clapeyron: ln p against 1/T", loc="left", fontsize=look.title, weight="bold")
    axes.set_xlabel("1000 K / T")
    axes.set_ylabel("vapour pressure (bar)")
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_formatter("{x:g}")
    axes.tick_params(axis="y", which="minor", labelsize=look.small)
    axes.grid(visible=True, which="both")
    axes.legend(loc="lower left")


def _draw_densities(
    axes: Axes, data: xr.Dataset, fluid: theory.SimpleFluid | None, strength: float, look: Theme
) -> None:
    """Draw the densities of liquid and vapour, which approach each other towards the critical temperature."""
    kelvin = data.temperature.values
    for place, (name, label) in enumerate((("vapor_density", "vapour"), ("liquid_density", "liquid"))):
        axes.errorbar(
            data[name].values, kelvin, xerr=_error(data, name), fmt="os"[place], color=DATA_COLOURS[place], label=label
        )
    mean = 0.5 * (data.liquid_density.values + data.vapor_density.values)
    axes.plot(mean, kelvin, "x", color=DARK, label="mean of both")
    if fluid is not None:
        critical = fluid.critical_temperature * strength
        axes.axhline(critical, color=THEORY_COLOURS[0], ls="--", label="critical temperature")
        axes.set_ylim(top=critical + 0.25 * max(critical - kelvin.min(), 1.0))
    axes.set_title("Liquid and vapour become alike", loc="left", fontsize=look.title, weight="bold")
    axes.set_xlabel("density (kg m⁻³)")
    axes.set_ylabel("temperature (K)")
    axes.grid(visible=True)
    axes.legend(loc="upper center", ncols=2)
