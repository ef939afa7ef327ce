"""Clouds: how well lifted moist air keeps to its adiabat, which adiabat that is, and what rain makes of a mountain."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from jobs.drawing import BLUE, VERMILLION, axes_of, explain, save, sheet
from jobs.registry import Findings, job

from atmosbox import scenarios, theory
from atmosbox.plot.theme import DARK, ENVIRONMENT_COLOURS, FAINT, REFERENCE_COLOURS
from atmosbox.scene.headline import Headline
from atmosbox.scene.statistics import running_mean
from atmosbox.simulation import runner

LEVELS = (850, 700, 500, 300)
SEEDS = range(1, 5)
LENGTHS = (50, 100, 200, 400, 1000)
NUMBERS = (3000, 6000, 12_000)
TICKS = (300, 400, 500, 700, 850, 1000)
RAIN: Mapping[str, Any] = {"rain": True}
_MEMORY: dict[tuple[Any, ...], runner.Outcome] = {}


def lifted(scene: str = "lifting-moist", **settings: Any) -> runner.Outcome:
    """Run a scene, once for the same settings."""
    key = (scene, *sorted(settings.items()))
    if key not in _MEMORY:
        _MEMORY[key] = runner.execute(runner.prepare(scene, settings))
    return _MEMORY[key]


def ascent_of(**settings: Any) -> Any:
    """Return the ascent of lifting-moist according to theory, which knows the textbook's values."""
    return scenarios.load("lifting-moist")._ascent(runner.prepare("lifting-moist", settings).settings)


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
    digits = (1, *(2 for _ in LEVELS))
    lines = [[seed, *(signed(v, d) for v, d in zip(row, digits, strict=True))] for seed, row in enumerate(misfit, 1)]
    together = list(zip(mean, error, digits, strict=True))
    lines.append(["**mean**", *(f"**{signed(m, d)} ± {e:.{d}f}**" for m, e, d in together)])
    found.table(["seed", "cloud base [hPa]", *(f"at {level} hPa [K]" for level in LEVELS)], lines)
    found.number("base", f"{signed(mean[0], 1)} ± {error[0]:.1f} hPa")
    level = ascent_of().base
    found.number("level", f"{level / 100.0:.1f} hPa")
    found.number("known", f"{abs((stated['cloud_base'].theory or 0.0) - level) / 100.0:.1f} hPa")
    found.number("stated", f"{stated['cloud_base'].standard_error / 100.0:.1f} hPa")
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
    """Lift moist air that keeps its droplets, and such that lets all of them rain out; MetPy's adiabat beside both."""
    keeps, rains = ([lifted(seed=seed, **more) for seed in (1, 2)] for more in ({}, RAIN))
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
    found.number("metpy", signed(known["metpy"][-1] - known["reversible"][-1], 2) + " K")
    found.number("pseudo", signed(known["pseudo"][-1] - known["reversible"][-1], 2) + " K")
    found.number("metpy-pseudo", signed(known["metpy"][-1] - known["pseudo"][-1], 2) + " K")
    draw_adiabats(found, keeps, rains, settings)


def draw_adiabats(found: Findings, keeps: list[Any], rains: list[Any], settings: Any) -> None:
    """Draw both parcels on their adiabats, and what is between the adiabats."""
    line = np.geomspace(100_000.0, 30_000.0, 300)
    known = adiabats(line, settings)
    styles = (
        (keeps, "droplets stay", BLUE, "o", (5.0, 2.0), DARK),
        (rains, "droplets rain out", VERMILLION, "s", (1.2, 1.2), FAINT),
    )
    with axes_of(2, (10.4, 5.2)) as (drawing, (left, right)):
        dry = keeps[0].dataset
        left.plot(
            dry.dry_air_adiabat_temperature - 273.15,
            dry.parcel_pressure / 100.0,
            color=REFERENCE_COLOURS[0],
            linewidth=4.0,
            label="nothing condenses",
        )
        right.plot(
            known["metpy"] - known["reversible"], line / 100.0, color=REFERENCE_COLOURS[1], lw=5.0, label="MetPy"
        )
        for runs, label, colour, marker, dashes, dark in styles:
            data = [run.dataset for run in runs]
            hpa = np.mean([each.parcel_pressure for each in data], axis=0) / 100.0
            own = np.mean([each.adiabat_temperature for each in data], axis=0)
            error = np.hypot(*(each.parcel_temperature_se for each in data)) / 2.0
            reversible = adiabats(100.0 * hpa, settings)["reversible"]
            misfit = np.mean([each.parcel_temperature - each.adiabat_temperature for each in data], axis=0)
            left.plot(own + misfit - 273.15, hpa, marker, color=colour, markevery=4, label=label)
            left.plot(own - 273.15, hpa, dashes=dashes, color=dark, linestyle="--", zorder=5, label=f"theory, {label}")
            shown = running_mean(own + misfit - reversible, 5)
            right.fill_betweenx(hpa, shown - error, shown + error, color=colour, alpha=0.2, linewidth=0)
            right.plot(shown, hpa, color=colour, marker=marker, markevery=6, label=label)
            right.plot(
                own - reversible, hpa, dashes=dashes, color=dark, linestyle="--", zorder=5, label=f"theory, {label}"
            )
        pseudo = known["pseudo"] - known["reversible"]
        right.plot(pseudo, line / 100.0, "-.", color=ENVIRONMENT_COLOURS[1], label="pseudo-adiabat")
        for axes in (left, right):
            axes.set(yscale="log", ylabel="pressure (hPa)", ylim=(1010.0, 295.0))
            axes.set_yticks(TICKS, [str(tick) for tick in TICKS])
            axes.set_yticks([], minor=True)
        left.set(title="In a cloud, air cools half as fast", xlabel="temperature (°C)")
        right.set(title="Which adiabat is it?", xlabel="difference from the reversible adiabat (K)", xlim=(-1.75, 0.75))
        left.legend(loc="lower left")
        right.legend(loc="center left", bbox_to_anchor=(0.0, 0.42))
        explain(
            drawing,
            "right: curves with marks are means of 5 frames of two runs; bands: ± 1 standard error of one frame",
        )
        save(found, drawing, "moist-adiabats")


@job("moist-price")
def moist_price(found: Findings) -> None:
    """Measure what a fast ascent costs, and how well few molecules tell the cloud base."""
    rows, fast, few = [], [], []
    for length in LENGTHS:
        runs = [lifted(molecules=10_000, ascent=length, seed=seed) for seed in SEEDS]
        top = [headlines(run)["temperature_at_500_hpa"] for run in runs]
        adiabat = float(ascent_of(molecules=10_000, ascent=length).planned_at(50_000.0).temperature[0])
        warmer, known = np.mean([each.value for each in top]) - adiabat, (top[0].theory or 0.0) - adiabat
        error = math.hypot(*(each.standard_error for each in top)) / len(SEEDS)
        fast.append((length, warmer, error, known))
        if not abs(warmer - known) <= 4.0 * error:
            found.failures.append(f"an ascent of {length} mean free times is {warmer:.2f} K off")
        rows.append([str(length), f"{signed(warmer, 2)} ± {error:.2f}", signed(known, 2)])
    head = [
        "length of the ascent [mean free times]",
        "measured minus adiabat at 500 hPa [K]",
        "theory minus adiabat [K]",
    ]
    found.table(head, rows, "length")
    rows = []
    for molecules in NUMBERS:
        runs = [lifted(molecules=molecules, seed=seed) for seed in SEEDS]
        base = [headlines(run)["cloud_base"] for run in runs]
        level = ascent_of(molecules=molecules).base
        misfit = np.array([0.01 * (each.value - level) for each in base])
        known = 0.01 * ((base[0].theory or 0.0) - level)
        scatter = math.sqrt(
            float(np.mean([(run.dataset.parcel_temperature - run.dataset.adiabat_temperature) ** 2 for run in runs]))
        )
        error = 0.01 * math.hypot(*(each.standard_error for each in base)) / len(SEEDS)
        few.append((molecules, misfit.mean(), error, known))
        water = int(runs[0].dataset.vapor_molecule_count[0] + runs[0].dataset.liquid_molecule_count[0])
        stated = f"{0.01 * base[0].standard_error:.0f}"
        rows.append([f"{molecules:,}", water, f"{signed(misfit.mean(), 0)} ± {error:.0f}", stated, f"{scatter:.1f}"])
        if not abs(misfit.mean() - known) <= 4.0 * error:
            found.failures.append(f"the cloud base of {molecules} molecules is off by {misfit.mean():.1f} hPa")
    found.table(
        [
            *("molecules", "of them water", "cloud base minus LCL [hPa]", "standard error of one run [hPa]"),
            "scatter of the temperature [K]",
        ],
        rows,
        "number",
    )
    draw_price(found, np.array(fast), np.array(few))


def draw_price(found: Findings, fast: np.ndarray, few: np.ndarray) -> None:
    """Draw how far the parcel is from its adiabat against length, and the cloud base against number."""
    with axes_of(2, (10.4, 4.4)) as (drawing, (left, right)):
        length, number = "length of the ascent (mean free times)", "molecules"
        panels = (
            (left, fast, length, "parcel minus adiabat at 500 hPa (K)", "A fast ascent is off"),
            (right, few, number, "cloud base minus LCL (hPa)", "The cloud base, by the molecules"),
        )
        for axes, rows, x_label, y_label, title in panels:
            x, mean, error, known = rows.T
            axes.axhline(0.0, color=FAINT, linewidth=0.8)
            axes.plot(x, known, "--", color=DARK, label="theory")
            axes.errorbar(x, mean, error, fmt="o", capsize=3, color=BLUE, label="mean of four runs")
            axes.set(xscale="log", xlabel=x_label, ylabel=y_label, title=title)
            axes.set_xticks(x, [f"{each:,.0f}" for each in x])
            axes.set_xticks([], minor=True)
            axes.legend(loc="lower right")
        explain(drawing)
        save(found, drawing, "moist-price")


@job("mountains-rain")
def mountains_rain(found: Findings) -> None:
    """Send a parcel over the mountains, with and without rain."""
    runs = {rain: lifted("mountains", rain=rain) for rain in (True, False)}
    for rain, outcome in runs.items():
        arrival = headlines(outcome)["arrival_temperature"]
        found.number("rain" if rain else "dry", f"{arrival.value - 273.15:.1f} ± {arrival.standard_error:.1f} °C")
        found.number("rain-theory" if rain else "dry-theory", f"{(arrival.theory or 0.0) - 273.15:.1f} °C")
        if not arrival.agrees:
            found.failures.append(f"the parcel arrives with {arrival.value:.2f} K, theory says {arrival.theory:.2f} K")
    found.number("fallen", f"{1000.0 * headlines(runs[True])['rain'].value:.1f} g/kg")
    draw_mountains(found, runs)


def draw_mountains(found: Findings, runs: dict[bool, Any]) -> None:
    """Draw the mountains with the clouds on them, the temperature on the way, and temperature against height."""
    with sheet((10.8, 6.6)) as drawing:
        grid = drawing.add_gridspec(2, 2, width_ratios=(1.35, 1.0), height_ratios=(1.0, 1.15))
        land = drawing.add_subplot(grid[0, 0])
        warm = drawing.add_subplot(grid[1, 0], sharex=land)
        tall = drawing.add_subplot(grid[:, 1])
        wet = runs[True].dataset
        way = 100.0 * wet.elapsed_time.values / float(wet.elapsed_time[-1])
        ground = wet.parcel_height.values / 1000.0
        land.fill_between(way, 0.0, ground, color="#b8a88a", lw=0)
        land.plot(way, ground, color=DARK, linewidth=1.4)
        cloud = running_mean(wet.cloud_liquid_water_mixing_ratio.values * 1000.0, 3)
        low, high = ground + 0.1, ground + 0.1 + 0.45 * cloud
        land.fill_between(
            way, low, high, where=cloud > 0.15, color="#8ec5ea", lw=0, label="cloud water, 1 km for 2.2 g/kg"
        )
        fallen = np.gradient(running_mean(wet.rain_mixing_ratio.values * 1000.0, 5))
        falls = fallen > 0.2 * fallen.max()
        land.plot(way[falls][::2], ground[falls][::2] + 0.05, "|", color=BLUE, markersize=9, label="rain falls")
        land.set(ylabel="height (km)", title="Over two mountains, with rain", ylim=(0.0, 4.4))
        land.legend(loc="upper left", ncols=2)
        land.tick_params(labelbottom=False)
        styles = {True: ("it rains", VERMILLION, "s", (1.2, 1.2)), False: ("no rain", BLUE, "o", (5.0, 2.0))}
        for rain, (label, colour, marker, dashes) in styles.items():
            data = runs[rain].dataset
            t, own = data.parcel_temperature - 273.15, data.adiabat_temperature - 273.15
            warm.plot(way, t, color=colour, marker=marker, markevery=6, markersize=5, label=label)
            tall.plot(running_mean(t, 3), ground, color=colour, marker=marker, markevery=6, markersize=5, label=label)
            warm.plot(
                way, own, dashes=dashes, color=DARK, linestyle="--", linewidth=1.3, zorder=5, label=f"theory, {label}"
            )
            tall.plot(
                own,
                ground,
                dashes=dashes,
                color=DARK,
                linestyle="--",
                linewidth=1.3,
                zorder=5,
                label=f"theory, {label}",
            )
        tall.plot(wet.environment_temperature - 273.15, ground, "-.", color=ENVIRONMENT_COLOURS[0], label="environment")
        warm.set(xlabel="share of the way (%)", ylabel="temperature (°C)", title="It arrives warmer than it left")
        tall.set(xlabel="temperature (°C)", ylabel="height (km)", title="5 K per kilometre up, 10 K down")
        warm.legend(loc="upper center")
        tall.legend(loc="upper right")
        save(found, drawing, "mountains-rain")
