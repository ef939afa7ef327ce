"""Clouds: how well lifted moist air keeps to its adiabat, which adiabat that is, and mountains without rain."""

import math
from typing import Any

import numpy as np
from jobs.registry import Findings, job

from atmosbox import scenarios, theory
from atmosbox.scene.headline import Headline
from atmosbox.simulation import runner

LEVELS = (850, 700, 500, 300)
SEEDS = range(1, 5)
_MEMORY: dict[tuple[Any, ...], runner.Outcome] = {}


def lifted(scene: str = "lifting-moist", **settings: Any) -> runner.Outcome:
    """Run a scene, once for the same settings."""
    key = (scene, *sorted(settings.items()))
    if key not in _MEMORY:
        _MEMORY[key] = runner.execute(runner.prepare(scene, settings))
    return _MEMORY[key]


def headlines(outcome: runner.Outcome) -> dict[str, Headline]:
    """Return the headlines of a run by name."""
    return {each.name: each for each in outcome.headlines}


def signed(value: float, digits: int) -> str:
    """Return a number with its sign, as it stands in a table."""
    return f"{value:+.{digits}f}".replace("-", "−")


@job("moist-seeds")
def moist_seeds(found: Findings) -> None:
    """Lift moist air with four seeds, and compare cloud base and temperatures with theory."""
    names = ["cloud_base", *(f"temperature_at_{level}_hpa" for level in LEVELS)]
    units = np.array([0.01, *(1.0 for _ in LEVELS)])
    rows, errors = [], []
    for seed in SEEDS:
        stated = headlines(lifted(seed=seed))
        rows.append([stated[name].misfit or 0.0 for name in names] * units)
        errors.append([stated[name].standard_error for name in names] * units)
        for each in stated.values():
            if not each.agrees:
                found.failures.append(f"seed {seed}: {each.label} is off by {each.misfit:.3g} {each.unit}")
    misfit = np.array(rows)
    # the scatter of four runs tells little; the errors that the runs state are tested over many
    mean, error = misfit.mean(axis=0), np.sqrt(np.sum(np.square(errors), axis=0)) / len(SEEDS)
    found.number("base", f"{signed(mean[0], 1)} ± {error[0]:.1f} hPa")
    ascent = scenarios.load("lifting-moist")._ascent(runner.prepare("lifting-moist", {}).settings)
    found.number("level", f"{ascent.base / 100.0:.1f} hPa")
    found.number("largest", f"{np.abs(misfit[:, 1:]).max():.1f} K")
    found.number("mean", f"{signed(misfit[:, 1:].mean(), 2)} K")


def adiabats(pressure: np.ndarray, settings: Any) -> dict[str, np.ndarray]:
    """Return temperatures [K] along three adiabats from the start of the scene, at pressures [Pa]."""
    from metpy.calc import moist_lapse
    from metpy.units import units

    si = settings.si
    water = float(theory.saturation_mixing_ratio(si.pressure, si.dewpoint))
    start = si.pressure, si.temperature, water
    base = float(theory.lcl(si.pressure, si.temperature, si.dewpoint)[0])
    kink = float(theory.parcel_path([base], *start).temperature[0])
    rising = np.sort(pressure[pressure < base])[::-1]
    levels = units.Quantity(np.concatenate([[base], rising]), "Pa")
    metpy = moist_lapse(levels, units.Quantity(kink, "K")).m_as("K")[1:]
    reversible = theory.parcel_path(pressure, *start).temperature
    other = reversible.copy()
    other[pressure < base] = np.interp(-np.log(pressure[pressure < base]), -np.log(rising), metpy)
    return {
        "reversible": reversible,
        "pseudo": theory.parcel_path(pressure, *start, 0.0).temperature,
        "metpy": other,
    }


@job("moist-adiabats")
def moist_adiabats(found: Findings) -> None:
    """Lift moist air that keeps its droplets, and such that lets them rain out; MetPy's adiabat beside both."""
    keeps, rains = ([lifted(seed=seed, rain=rain) for seed in (1, 2)] for rain in (False, True))
    for outcome in (*keeps, *rains):
        for each in outcome.headlines:
            if not each.agrees:
                found.failures.append(f"{each.label} is off by {each.misfit:.3g} {each.unit}")
    settings = runner.prepare("lifting-moist", {}).settings
    levels = np.array(LEVELS) * 100.0
    known = adiabats(levels, settings)
    rows = []
    for k, level in enumerate(LEVELS):
        name = f"temperature_at_{level}_hpa"
        cells = [str(level)]
        for runs in (keeps, rains):
            each = [headlines(run)[name] for run in runs]
            measured = float(np.mean([one.value for one in each]))
            error = math.hypot(*(one.standard_error for one in each)) / len(each)
            cells += [f"{measured - 273.15:.1f} ± {error:.1f}", f"{(each[0].theory or 0.0) - 273.15:.1f}"]
        cells += [f"{known[what][k] - 273.15:.1f}" for what in ("pseudo", "metpy")]
        rows.append([cell.replace("-", "−") for cell in cells])
    found.table(
        ["hPa", "droplets stay", "reversible", "rain", "rain, theory", "pseudo-adiabat", "MetPy's `moist_lapse`"], rows
    )


@job("mountains-rain")
def mountains_rain(found: Findings) -> None:
    """Send a parcel over the mountains without rain; with rain is how the scene comes."""
    arrival = headlines(lifted("mountains", rain=False))["arrival_temperature"]
    found.number("dry", f"{arrival.value - 273.15:.1f} ± {arrival.standard_error:.1f} °C")
    found.number("dry-theory", f"{(arrival.theory or 0.0) - 273.15:.1f} °C")
    if not arrival.agrees:
        found.failures.append(f"the parcel arrives with {arrival.value:.2f} K, theory says {arrival.theory:.2f} K")
