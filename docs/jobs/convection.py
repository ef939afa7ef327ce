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
HIGHER = range(1, 5)


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


def conducted(outcome: "runner.Outcome") -> float:
    """Return the lapse rate of the core of air at rest, by Fourier's law [K/km]."""
    height, rest = outcome.dataset.height.values, outcome.dataset.layer_temperature_conduction.values
    core = (height > 0.299 * height.max()) & (height < 0.701 * height.max())
    return -1000.0 * float(np.polyfit(height[core], rest[core], 1)[0])


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
        steep = conducted(outcome)
        lapse, heat = each["mean_core_lapse_rate"], each["nusselt_number"]
        if not 1000.0 * (lapse.value + lapse.chance) < steep:
            found.failures.append(f"seed {seed}: the core is as steep as at rest")
        if not heat.value - heat.chance > 1.0:
            found.failures.append(f"seed {seed}: no more heat passes than at rest")
        found.number("conducted", rounded(steep, 3))
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
    """Watch stable air with several seeds: it has no wind beyond noise, and carries the heat that is conducted."""
    outcomes = [measured(case="stable", molecules=15_000, duration=800.0, seed=seed) for seed in STILL]
    for name, what, unit in (
        ("mean_square_wind", "mean square of the wind", "m²/s²"),
        ("nusselt_number", "heat, over that at rest", ""),
    ):
        values = np.array([each[name].value for each, _ in outcomes])
        error = float(np.std(values, ddof=1)) / len(values) ** 0.5
        found.agree(what, float(values.mean()), error, outcomes[0][0][name].theory or 0.0, 0.0, unit)
    higher = [measured(case="stable", molecules=60_000, duration=1600.0, seed=seed) for seed in HIGHER]
    apart = []
    for name, runs in (("low", outcomes), ("high", higher)):
        values = 1000.0 * np.array([each["mean_core_lapse_rate"].value for each, _ in runs])
        error = float(np.std(values, ddof=1)) / len(values) ** 0.5
        known = conducted(runs[0][1])
        found.number(name, measurement(float(values.mean()), error))
        found.number(f"{name}-theory", rounded(known, 3))
        apart.append(abs(float(values.mean()) / known - 1.0))
    if not apart[1] < apart[0]:
        found.failures.append(f"in a higher box the core is not nearer to Fourier's law: {apart}")
