"""Convection: wind, heat and lapse rate for several gravities and seeds; onset and growth of rolls beside theory."""

import numpy as np
from jobs.registry import Findings, job, results, rounded
from scipy import stats

from atmosbox.scene.headline import Headline
from atmosbox.simulation import runner
from atmosbox.text.table import measurement
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR

GRAVITIES = (0.0, 5.0, 9.80665, 15.0, 20.0, 25.0, 30.0)
SEEDS = range(1, 7)
STRONG = 6.0
"""How many times as strong as its noise at rest a roll must be, so that the air counts as turned over."""
LINEAR = 0.3
"""Share of its largest speed up to which the growth of a roll is measured; it is slower by the square of this share."""
CERTAIN = 3.29
"""Number of standard errors that a difference exceeds by chance in one of a thousand cases."""
DISCS = (
    *((molecules, 1000.0, 1) for molecules in (2000, 4000, 14_000)),
    *((7300, 4000.0, seed) for seed in (1, 2)),
)
"""Numbers of discs, durations [s] and seeds."""
SPHERES = ((25_000, 2000.0), (50_000, 1500.0), (100_000, 1200.0))
"""Numbers of spheres, and the time after which they turn over steadily [s]."""
STEEPER = 16.36, 50_000
"""Gravity of which the adiabat is .6 times as steep as the imposed gradient [m/s2], and the box looked at closely."""
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


SHOWN = [
    "wind [m/s]",
    "lapse rate of the core [K/km]",
    "heat / heat at rest",
    "marked molecules in the upper half [%]",
]


@job("convection-gravity")
def gravities(found: Findings) -> None:
    """Turn the air over under more and more gravity."""
    rows = []
    for gravity in GRAVITIES:
        each, _ = measured(gravity=gravity)
        rows.append([f"{gravity:.3g}", *row(each)])
        heat = each["nusselt_number"]
        if gravity == 0.0 and not abs(heat.value - 1.0) <= heat.chance + 0.05:
            found.failures.append(f"without gravity {heat.value:.3g} times the heat passes that discs conduct at rest")
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


@job("convection-growth", quick=True)
def growth(found: Findings) -> None:
    """Compare the growth of the strongest roll of each run with linear theory, as the benchmark has measured it."""
    grown = [each for each in results("convection")["growth"] if each["rate"] is not None]
    rate, error, known = (np.array([each[name] for each in grown]) for name in ("rate", "standard_error", "theory"))
    square = float(np.sum(((rate - known) / error) ** 2))
    if not stats.chi2.ppf(0.0005, len(grown)) < square < stats.chi2.ppf(0.9995, len(grown)):
        found.failures.append(f"the sum of {len(grown)} squared differences from theory, in errors, is {square:.4g}")
    ratio = float(np.mean(rate / known))
    chance = float(stats.sem(rate / known))
    if not -(LINEAR**2) - CERTAIN * chance < ratio - 1.0 < CERTAIN * chance:  # grown rolls are slower
        found.failures.append(f"rolls grow {ratio:.3g} +- {chance:.2g} times as fast as theory says")
    found.number("seeds", len(grown))
    found.number("ratio", measurement(ratio, chance))
    found.number("scatter", f"{(square / len(grown)) ** 0.5:.2f}")


@job("convection-onset", quick=True)
def onset(found: Findings) -> None:
    """Count how many boxes of an ideal gas turn over, for gravities on either side of the onset of linear theory."""
    measured_by = results("convection")
    rows, shares = [], []
    for known in measured_by["theory"]["gravities"]:
        runs = [each for each in measured_by["onset"] if each["gravity"] == known["gravity"]]
        turned, heat = sum(each["roll"] > STRONG for each in runs), [each["nusselt_number"] for each in runs]
        low, high = stats.binomtest(turned, len(runs)).proportion_ci(0.95)
        shares.append(turned / len(runs))
        rows.append(
            [
                f"{known['gravity']:.3g}",
                f"{known['rayleigh_number']:.0f}",
                rounded(known["growth_rate"]),
                f"{turned} of {len(runs)}",
                f"{100.0 * low:.0f} to {100.0 * high:.0f}",
                measurement(float(np.mean(heat)), float(stats.sem(heat))),
            ]
        )
    if not (shares[0] > 0.5 and shares[-2:] == [0.0, 0.0]):
        found.failures.append(f"air turns over where theory says that it rests, or the other way round: {shares}")
    found.number("seeds", len(measured_by["onset"]) // len(rows))
    found.number("gravity", f"{measured_by['theory']['onset']:.1f}")
    head = ["gravity [m/s²]", "Rayleigh number", "growth by theory [1/s]", "turned over", "share, 95 % interval [%]"]
    found.table([*head, "heat / heat at rest"], rows)


@job("convection-size")
def size(found: Findings) -> None:
    """Turn over boxes with fewer and with more discs, and watch some boxes for four times as long."""
    rows = []
    for molecules, duration, seed in DISCS:
        each, _ = measured(molecules=molecules, duration=duration, seed=seed)
        rows.append([f"{molecules:,}", f"{duration:g}", str(seed), *row(each)[:3]])
    found.table(["discs", "duration [s]", "seed", *SHOWN[:3]], rows)


@job("convection-adiabat")
def adiabat(found: Findings) -> None:
    """Turn ideal gases over in boxes of three heights, and compare the lapse rates of their cores with the adiabat."""
    rows = []
    for gravity in (9.80665, STEEPER[0]):
        dry = gravity / (2.5 * BOLTZMANN / DRY_AIR.molecule_mass)
        steep = []
        for molecules, duration in SPHERES:
            settings = {"molecules": molecules, "width": 1.0, "gravity": gravity, "duration": duration}
            each, outcome = measured("dsmc", **settings)
            core, rest = each["mean_core_lapse_rate"], conducted(outcome) / 1000.0
            steep.append(core.value / dry)
            rows.append(
                [
                    f"{gravity:.3g}",
                    f"{molecules:,}",
                    f"{(molecules / 8.0) ** 0.5:.0f}",
                    f"{rest / dry:.2f}",
                    measurement(core.value / dry, core.standard_error / dry),
                    cell(each, "nusselt_number"),
                ]
            )
            if (gravity, molecules) == STEEPER:  # without the uppermost of the rows of the core
                late = outcome.dataset.isel(height=slice(5, 10))
                lower = -float(np.polyfit(late.height.values, late.layer_temperature.values, 1)[0])
                found.number("lower", f"{lower / dry:.2f}")
                found.number("core", measurement(steep[-1], core.standard_error / dry))
        if not steep[-1] < steep[0]:
            found.failures.append(f"in a higher box the core is not nearer to the adiabat: {steep}")
    found.table(
        [
            "gravity [m/s²]",
            "molecules",
            "height [mean free paths]",
            "at rest / adiabat",
            "core / adiabat",
            "heat / heat at rest",
        ],
        rows,
    )


@job("convection-stable")
def stable(found: Findings) -> None:
    """Watch stable air with several seeds: it has no wind beyond noise, and carries the heat that is conducted."""
    outcomes = [measured(case="stable", molecules=15_000, duration=800.0, seed=seed) for seed in STILL]
    for name, what, unit in (
        ("mean_square_wind", "mean square of the wind", "m²/s²"),
        ("nusselt_number", "heat / heat at rest", ""),
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
