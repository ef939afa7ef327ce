"""Liquid and vapour of molecules that attract each other, at six temperatures: what follows from attraction alone."""

import numpy as np
from jobs.registry import Findings, job

from atmosbox import theory
from atmosbox.plot import sweep_figure
from atmosbox.sweep import plan, sweep
from atmosbox.theory.constants import BOLTZMANN

WORDS = ["temperature=111.4K,117.6K,123.8K,130K,136.2K,142.4K"]
SETTINGS = {"start": "slab", "density": 1.0, "duration": "4 ns"}


@job("coexistence")
def coexistence(found: Findings) -> None:
    """Measure vapour pressures of slabs, and the slope of Clausius and Clapeyron within them and between them."""
    swept = sweep(plan("attraction", WORDS, settings=SETTINGS, members=1, engine="exact"), jobs=1)
    data = swept.dataset
    found.failures.extend(f"point {point}, member {member}: {why}" for point, member, why in swept.failures)
    if not swept.ledger < 1e-10:
        found.failures.append(f"the ledger of a slab is off by {swept.ledger:.1e}")
    kelvin = data.temperature.values
    (pressure, pressure_se), (steep, steep_se) = (
        (data[name].values, data[f"{name}_se"].values) for name in ("vapor_pressure", "clapeyron_slope")
    )
    fluid = theory.SIMPLE_FLUIDS["argon"]
    unit = fluid.well_depth / fluid.well_diameter**3
    published = theory.well_vapor_pressure(kelvin * BOLTZMANN / fluid.well_depth) * unit
    if np.any(np.abs(pressure - published) > 4.0 * pressure_se):
        found.failures.append(f"the vapour pressures {pressure} +- {pressure_se} Pa are not the published {published}")
    slope, slope_se = theory.slope_of_pressure(kelvin, pressure, pressure_se)
    weight = steep_se**-2
    within = float(np.average(steep, weights=weight))
    within_se = float(1.0 / np.sqrt(weight.sum()))
    found.number("slope", f"{slope:.0f} ± {slope_se:.0f} K")
    found.number("within", f"{within:.0f} ± {within_se:.0f} K")
    if abs(slope - within) > 4.0 * np.hypot(slope_se, within_se):
        found.failures.append(f"the slope is {slope:.0f} +- {slope_se:.0f} K, L/dZ {within:.0f} +- {within_se:.0f} K")
    found.figure(sweep_figure.figure(data), "coexistence", 130)
