"""Liquid and vapour of molecules that attract each other: six temperatures, and a drop that is heated."""

import numpy as np
from jobs.drawing import axes_of, explain, save
from jobs.registry import Findings, job

from atmosbox import scenarios, theory
from atmosbox.file.provenance import parameters
from atmosbox.plot import sweep_figure
from atmosbox.simulation import runner
from atmosbox.sweep import plan, sweep
from atmosbox.theory.constants import AVOGADRO, BOLTZMANN

WORDS = ["temperature=111.4K,117.6K,123.8K,130K,136.2K,142.4K"]
SETTINGS = {"start": "slab", "density": 1.0, "duration": "4 ns"}


@job("coexistence")
def coexistence(found: Findings) -> None:
    """Measure vapour pressures of slabs, and the slope of Clausius and Clapeyron within them and between them."""
    data = sweep(plan("attraction", WORDS, settings=SETTINGS, members=1, engine="exact"), jobs=1)
    ledger = float(data.member_ledger.max())
    if data.member_status.values.any() or not ledger < 1e-10:
        found.failures.append(f"a slab has failed, or its ledger is off by {ledger:.1e}")
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


PACES = {27: "27 K/ns", 54: "twice as fast"}
"""Paces at which a drop is heated [K/ns], with their labels; both end at 166 K."""
DROPS = 6
"""Number of drops for each pace."""


def taken_by_both(run: "runner.Outcome") -> float:
    """Return the heat that drop and vapour take together for each kelvin, while the drop evaporates [J/mol/K]."""
    data = run.dataset
    molecules = parameters(data)["settings"]["molecules"]
    share = data.vapor_molecule_count.values / molecules
    part = slice(*(int(np.argmax(share >= least)) for least in scenarios.load("attraction").EVAPORATING))
    slope = np.polyfit(data.air_temperature_theory.values[part], data.heat_from_bath.values[part], 1)[0]
    return float(slope) * AVOGADRO / molecules


@job("heating")
def heating(found: Findings) -> None:
    """Heat drops at two paces; draw their temperature against the heat supplied, averaged over the drops."""
    latent = {}
    with axes_of(1, (7.2, 4.2)) as (drawing, (axes,)):
        for pace, label in PACES.items():
            runs = [
                runner.execute(
                    runner.prepare("attraction", {"heating": pace, "duration": f"{81 / pace:g} ns", "seed": seed})
                )
                for seed in range(1, DROPS + 1)
            ]
            heat, kelvin = (
                np.mean([run.dataset[name].values for run in runs], axis=0)
                for name in ("heat_from_bath", "air_temperature")
            )
            axes.plot(1e21 * heat, kelvin, label=label)
            stated = [{each.name: each for each in run.headlines} for run in runs]
            if label == PACES[27]:
                both = [taken_by_both(run) for run in runs]
                error = float(np.std(both, ddof=1) / np.sqrt(DROPS))
                found.number("both", f"{np.mean(both):.0f} ± {error:.0f} J/mol/K")
            for name in ("latent_heat", "liquid_heat_capacity", "vapor_heat_capacity"):
                values = np.array([each[name].value for each in stated])
                mean, error = float(values.mean()), float(values.std(ddof=1) / np.sqrt(DROPS))
                theory = stated[0][name].theory
                if name == "latent_heat":
                    latent[pace] = mean, error
                    found.number(f"latent-{pace}", f"{mean / 1000.0:.2f} ± {error / 1000.0:.2f} kJ/mol")
                elif label == PACES[27]:
                    found.number(name.partition("_")[0], f"{mean:.1f} ± {error:.1f} J/mol/K")
                if theory is None:
                    continue
                if label == PACES[27]:
                    found.number("theory", f"{theory:.1f} J/mol/K")
                chance = stated[0][name].standard_error / np.sqrt(DROPS)
                if abs(mean - theory) > 4.0 * chance + stated[0][name].tolerance:
                    found.failures.append(f"{name} at {pace} K/ns is {mean:.2f} +- {error:.2f}, not {theory:.2f}")
        axes.set_xlabel("heat supplied (zJ)")
        axes.set_ylabel("temperature (K)")
        axes.legend()
        axes.set_title("Heat warms the drop, evaporates it, warms the vapour")
        explain(drawing, f"means of {DROPS} drops of 400 molecules for each pace")
        save(found, drawing, "heating")
    (slow, slow_se), (fast, fast_se) = latent.values()
    if abs(slow - fast) > 4.0 * np.hypot(slow_se, fast_se):
        found.failures.append(f"latent heats {slow:.0f} +- {slow_se:.0f} and {fast:.0f} +- {fast_se:.0f} J/mol differ")
    flat = runner.execute(runner.prepare("attraction", {**SETTINGS, "temperature": "111.4 K"}))
    slab = {each.name: each for each in flat.headlines}["latent_heat"]
    found.number("flat", f"{slab.value / 1000.0:.2f} ± {slab.standard_error / 1000.0:.2f} kJ/mol")
