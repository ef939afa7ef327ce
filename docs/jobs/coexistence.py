"""Liquid and vapour of molecules that attract each other, at six temperatures: what follows from attraction alone."""

import numpy as np
from jobs.drawing import BLUE, VERMILLION, axes_of, save
from jobs.registry import Findings, job

from atmosbox import theory
from atmosbox.plot.theme import DARK, REFERENCE_COLOURS
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
    _draw(found, kelvin, value, error)


def _draw(found: Findings, kelvin: np.ndarray, value: dict[str, np.ndarray], error: dict[str, np.ndarray]) -> None:
    """Draw ln p against 1/T with the slope that each run measured, and both densities."""
    fluid = theory.SIMPLE_FLUIDS["argon"]
    fine = np.linspace(kelvin.min() - 3.0, kelvin.max() + 3.0, 100)
    warmth = fine * BOLTZMANN / fluid.well_depth
    with axes_of(2, (9.6, 4.2)) as (drawing, (left, right)):
        pressure, bars = value["vapor_pressure"] / 1e5, error["vapor_pressure"] / 1e5
        left.errorbar(1e3 / kelvin, pressure, bars, fmt="o", color=BLUE, label="runs", zorder=3)
        for k, each in enumerate(kelvin):
            ends = 1.0 / each + np.array([-1.0, 1.0]) * 1.6e-4
            line = pressure[k] * np.exp(-value["clapeyron_slope"][k] * (ends - 1.0 / each))
            left.plot(1e3 * ends, line, color=VERMILLION, label="slope L/ΔZ of each run" if k == 0 else None)
        unit = fluid.well_depth / fluid.well_diameter**3
        left.plot(1e3 / fine, theory.well_vapor_pressure(warmth) * unit / 1e5, color=DARK, ls="--", lw=1.2,
                  label="published simulations")  # fmt: skip
        left.plot(1e3 / fine, fluid.vapor_pressure(fine) / 1e5, color=REFERENCE_COLOURS[0], ls=":", label="argon")
        left.set(title="Vapour pressure", xlabel="1000 K / T", ylabel="pressure (bar)", yscale="log")
        left.yaxis.set_major_formatter("{x:g}")
        left.yaxis.set_minor_formatter("{x:g}")
        left.legend(frameon=False)
        for name, label in (("liquid_density", "liquid"), ("vapor_density", "vapour")):
            right.errorbar(value[name], kelvin, xerr=error[name], fmt="o", label=label)
        mean = 0.5 * (value["liquid_density"] + value["vapor_density"])
        right.plot(mean, kelvin, "x", color=DARK, label="mean of both")
        right.set_ylim(top=fluid.critical_temperature + 10.0)
        right.axhline(fluid.critical_temperature, color=DARK, ls="--", lw=1.2, label="critical temperature")
        right.set(title="Both densities", xlabel="density (kg m⁻³)", ylabel="temperature (K)")
        right.legend(frameon=False, loc="upper center", ncols=2)
        save(found, drawing, "coexistence")
