"""Liquid and vapour of molecules that attract each other, at six temperatures: what follows from attraction alone."""

import numpy as np
from jobs.registry import Findings, job

from atmosbox import theory
from atmosbox.plot import sweep_figure
from atmosbox.sweep import plan, sweep
from atmosbox.theory.constants import BOLTZMANN

WORDS = ["temperature=111.4K,117.6K,123.8K,130K,136.2K,142.4K"]
SETTINGS = {"start": "slab", "density": 1.0, "duration": "4 ns"}
NAMES = ("vapor_pressure", "gas_law", "clapeyron_slope", "liquid_density", "vapor_density", "latent_heat",
         "mean_surface_tension")  # fmt: skip


@job("coexistence")
def coexistence(found: Findings) -> None:
    """Measure vapour pressure, densities, latent heat and surface tension of slabs."""
    swept = sweep(plan("attraction", WORDS, settings=SETTINGS, members=1, engine="exact"), jobs=1)
    data = swept.dataset
    found.failures.extend(f"point {point}, member {member}: {why}" for point, member, why in swept.failures)
    if not swept.ledger < 1e-10:
        found.failures.append(f"the ledger of a slab is off by {swept.ledger:.1e}")
    kelvin = data.temperature.values
    value = {name: data[name].values for name in NAMES}
    error = {name: data[f"{name}_se"].values for name in NAMES}
    fluid = theory.SIMPLE_FLUIDS["argon"]
    warmth = kelvin * BOLTZMANN / fluid.well_depth
    unit = fluid.well_depth / fluid.well_diameter**3
    published = theory.well_vapor_pressure(warmth) * unit

    def shown(name: str, k: int, factor: float, digits: int) -> str:
        return f"{value[name][k] * factor:.{digits}f} ± {error[name][k] * factor:.{digits}f}"

    header = ("T [K]", "T*", "p [bar]", "published", "by density, $B_2$, $B_3$", "liquid [kg/m³]", "vapour [kg/m³]",
              "L [kJ/mol]", "L/ΔZ [K]", "γ [mN/m]")  # fmt: skip
    rows = [
        (f"{kelvin[k]:.1f}", f"{warmth[k]:.3f}", shown("vapor_pressure", k, 1e-5, 1), f"{published[k] / 1e5:.1f}",
         f"{data['gas_law_theory'].values[k] / 1e5:.1f}", shown("liquid_density", k, 1.0, 0),
         shown("vapor_density", k, 1.0, 1), shown("latent_heat", k, 1e-3, 2), shown("clapeyron_slope", k, 1.0, 0),
         shown("mean_surface_tension", k, 1e3, 1))
        for k in range(len(kelvin))
    ]  # fmt: skip
    found.table(header, rows)
    slope, slope_se = theory.slope_of_pressure(kelvin, value["vapor_pressure"], error["vapor_pressure"])
    weight = 1.0 / error["clapeyron_slope"] ** 2
    within = float(np.sum(weight * value["clapeyron_slope"]) / weight.sum())
    within_se = float(1.0 / np.sqrt(weight.sum()))
    found.number("slope", f"{slope:.0f} ± {slope_se:.0f} K")
    found.number("within", f"{within:.0f} ± {within_se:.0f} K")
    if abs(slope - within) > 4.0 * np.hypot(slope_se, within_se):
        found.failures.append(f"the slope is {slope:.0f} +- {slope_se:.0f} K, L/dZ {within:.0f} +- {within_se:.0f} K")
    warm = kelvin > 120.0
    point = theory.critical_point(
        kelvin[warm], *(values[name][warm] for values in (value, error) for name in ("liquid_density", "vapor_density"))
    )
    found.number("critical-temperature", f"{point.temperature:.1f} ± {point.temperature_se:.1f} K")
    found.number("critical-density", f"{point.density:.0f} ± {point.density_se:.0f} kg/m³")
    found.figure(sweep_figure.figure(data), "coexistence", 130)
