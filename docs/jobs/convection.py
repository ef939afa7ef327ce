"""Convection: wind, heat and lapse rate for several gravities and seeds, and growth of rolls beside theory."""

import numpy as np
from jobs.registry import Findings, job, rounded

from atmosbox.scene.headline import Headline
from atmosbox.simulation import runner
from atmosbox.text.table import measurement

GRAVITIES = (0.0, 5.0, 9.80665, 15.0, 20.0, 25.0, 30.0)
SEEDS = range(1, 7)
GROWN = range(1, 13)
STILL = range(1, 9)


def measured(engine: str | None = None, **settings: object) -> tuple[dict[str, Headline], "runner.Outcome"]:
    """Run a box; return its headlines by name, and the run."""
    outcome = runner.execute(runner.prepare("convection", settings, engine=engine))
    return {each.name: each for each in outcome.headlines}, outcome


def cell(found: dict[str, Headline], name: str, factor: float = 1.0) -> str:
    """Return a headline with its error as it stands in a table; a dash if the run has none."""
    if name not in found:
        return "–"
    return measurement(factor * found[name].value, factor * found[name].standard_error).replace("-", "−")


def row(found: dict[str, Headline]) -> list[str]:
    """Return the numbers of a box in which the air may turn over."""
    return [
        cell(found, "mean_wind_speed"),
        cell(found, "mean_core_lapse_rate", 1000.0),
        cell(found, "nusselt_number"),
        cell(found, "share_from_the_floor", 100.0),
    ]


SHOWN = ["wind [m/s]", "lapse rate of the core [K/km]", "heat, over that at rest", "from the floor aloft [%]"]


@job("convection-gravity")
def gravities(found: Findings) -> None:
    """Turn the air over under more and more gravity."""
    rows = []
    for gravity in GRAVITIES:
        each, _ = measured(gravity=gravity)
        rows.append([f"{gravity:.3g}", *row(each)])
        if gravity == 0.0:
            heat = each["nusselt_number"]
            found.agree("heat without gravity", heat.value, heat.standard_error, 1.0, 0.05)
    found.table(["gravity [m/s²]", *SHOWN], rows, "rows")


@job("convection-seeds")
def seeds(found: Findings) -> None:
    """Turn the air over with several seeds; the core must be less steep than at rest, and carry more heat."""
    rows = []
    for seed in SEEDS:
        each, outcome = measured(seed=seed)
        rows.append([str(seed), *row(each)])
        height, rest = outcome.dataset.height.values, outcome.dataset.layer_temperature_conduction.values
        core = (height > 0.3 * height.max()) & (height < 0.7 * height.max())
        conducted = -float(np.polyfit(height[core], rest[core], 1)[0])
        lapse, heat = each["mean_core_lapse_rate"], each["nusselt_number"]
        if not lapse.value + lapse.chance < conducted:
            found.failures.append(f"seed {seed}: the core is as steep as at rest")
        if not heat.value - heat.chance > 1.0:
            found.failures.append(f"seed {seed}: no more heat passes than at rest")
        found.number("conducted", rounded(1000.0 * conducted, 3))
    found.table(["seed", *SHOWN], rows)


@job("convection-growth")
def growth(found: Findings) -> None:
    """Let rolls grow in an ideal gas, and compare the strongest of each run with linear theory."""
    rows, ratios = [], []
    for seed in GROWN:
        each, _ = measured("dsmc", molecules=100_000, duration=500.0, seed=seed)
        if "growth_rate" not in each:
            continue
        grown = each["growth_rate"]
        if not grown.agrees:
            found.failures.append(f"seed {seed}: rolls grow by {grown.value:.3g}, theory says {grown.theory:.3g}")
        rows.append([str(seed), grown.label.split()[-3], cell(each, "growth_rate"), rounded(grown.theory or 0.0, 3)])
        ratios.append(grown.value / (grown.theory or 1.0))
    error = float(np.std(ratios, ddof=1)) / len(ratios) ** 0.5
    found.number("ratio", measurement(float(np.mean(ratios)), error))
    found.table(["seed", "half waves of the roll", "growth [1/s]", "linear theory [1/s]"], rows)


@job("convection-stable")
def stable(found: Findings) -> None:
    """Watch stable air with several seeds: it has no wind beyond noise."""
    each = [measured(case="stable", molecules=15_000, duration=800.0, seed=seed)[0] for seed in STILL]
    for name, what, unit, factor in (
        ("mean_square_wind", "mean square of the wind", "m²/s²", 1.0),
        ("mean_core_lapse_rate", "lapse rate of the core", "K/km", 1000.0),
        ("nusselt_number", "heat, over that at rest", "", 1.0),
    ):
        values = factor * np.array([found_in[name].value for found_in in each])
        error = float(np.std(values, ddof=1)) / len(values) ** 0.5
        theory, known = factor * (each[0][name].theory or 0.0), factor * each[0][name].tolerance
        found.agree(what, float(values.mean()), error, theory, known, unit)
