"""How well a lifted parcel keeps to the dry adiabat, and what a fast ascent costs."""

import math
from typing import Any

import numpy as np
from jobs.drawing import BLUE, VERMILLION, axes_of, explain, save
from jobs.registry import Findings, job
from scipy import optimize

from atmosbox import scenarios, theory
from atmosbox.simulation import runner
from atmosbox.theory.constants import BOLTZMANN

LEVELS = (700, 300)
SEEDS = {100: 24, 200: 24, 400: 24, 800: 16, 1600: 16}
"""How many seeds there are for each length of the ascent in mean free times."""
SLOW = 200
"""From which length on the law of the finite speed is fitted; in faster ascents its next order shows."""
_MEMORY: dict[tuple[int, int], dict[int, tuple[float, float, float]]] = {}


def misfits(ascent: int, seed: int) -> dict[int, tuple[float, float, float]]:
    """Return by pressure [hPa] how far a parcel is above the textbook's adiabat, with what error, and in theory [K]."""
    if (ascent, seed) not in _MEMORY:
        prepared = runner.prepare("lifting-dry", {"ascent": ascent, "seed": seed})
        found = {each.name: each for each in runner.execute(prepared).headlines}
        _MEMORY[ascent, seed] = {}
        for level in LEVELS:
            each = found[f"temperature_at_{level}_hpa"]
            adiabat = float(theory.dry_adiabat_temperature(level, 288.15, 1000.0, 5))
            _MEMORY[ascent, seed][level] = each.value - adiabat, each.standard_error, (each.theory or 0.0) - adiabat
    return _MEMORY[ascent, seed]


@job("lifting-seeds")
def lifting_seeds(found: Findings) -> None:
    """Run the scene as it comes, with the seeds 1 to 8."""
    seeds = range(1, 9)
    all_of_them = np.array([[misfits(1600, seed)[level][0] for level in LEVELS] for seed in seeds])
    rows: list[list[Any]] = [
        [seed, *(f"{value:+.2f}" for value in row)] for seed, row in zip(seeds, all_of_them, strict=True)
    ]
    error = all_of_them.std(axis=0, ddof=1) / math.sqrt(len(seeds))
    mean, largest = all_of_them.mean(axis=0), np.abs(all_of_them).max(axis=0)
    rows.append(["**mean**", *(f"**{m:+.2f} ± {e:.2f}**" for m, e in zip(mean, error, strict=True))])
    rows.append(["**largest**", *(f"**{value:.2f}**" for value in largest)])
    found.table(
        ["seed", "difference at 700 hPa [K]", "difference at 300 hPa [K]"],
        [[str(c).replace("-", "−") for c in r] for r in rows],
    )
    for level, m, e, worst in zip(LEVELS, mean, error, largest, strict=True):
        found.number(f"mean-{level}", f"{m:.2f} ± {e:.2f} K")
        found.number(f"largest-{level}", f"{worst:.2f} K")
        if worst > 0.5:
            found.failures.append(f"a parcel at {level} hPa is {worst:.2f} K off the dry adiabat")


@job("finite-speed")
def finite_speed(found: Findings) -> None:
    """Measure how much too warm the parcel is at 300 hPa, against the length of the ascent."""
    ascents = np.array(list(SEEDS), float)
    values = [np.array([misfits(n, seed)[300] for seed in range(1, seeds + 1)]) for n, seeds in SEEDS.items()]
    mean = np.array([each[:, 0].mean() for each in values])
    scatter = np.array([each[:, 0].std(ddof=1) for each in values])
    stated = np.array([each[:, 1].mean() for each in values])
    error = scatter / np.sqrt(list(SEEDS.values()))
    expected = float(theory.dry_adiabat_temperature(300.0, 288.15, 1000.0, 5))
    room = adiabat_of_spheres(30_000.0) - expected
    used = ascents >= SLOW
    c, c_error, chi_squared = fitted(1.0 / ascents[used, None], (mean - room)[used], error[used])
    scene = scenarios.load("lifting-dry")
    slow = 1e6  # so long that only the first order is left
    allowed = slow * expected * scene._ascent(scene.Settings(ascent=slow)).finite_speed(30_000.0)
    rows = [
        [f"{n:.0f}", seeds, f"{m:.3f} ± {e:.3f}", f"{n * (m - room):.0f} ± {n * e:.0f}", f"{s:.3f}", f"{t:.3f}"]
        for n, seeds, m, e, s, t in zip(ascents, SEEDS.values(), mean, error, scatter, stated, strict=True)
    ]
    found.table(
        [
            *("length n of the ascent [mean free times]", "runs", "too warm by [K]", f"n × (that + {-room:.3f} K) [K]"),
            *("scatter from run to run [K]", "standard error that a run states [K]"),
        ],
        rows,
    )
    found.number("c", f"{c[0]:.0f} ± {c_error[0]:.0f} K")
    found.number("chi-squared", f"{chi_squared:.1f} for {used.sum() - 1} degrees of freedom")
    found.number("share", f"{c[0] / expected:.2f} ± {c_error[0] / expected:.2f}")
    found.number("room", f"{-room:.3f} K")
    found.number("allowed", f"{allowed:.0f} K")
    found.number("default", f"{c[0] / 1600:.2f} K")
    for n, m, e, answer in zip(ascents, mean, error, [each[0, 2] for each in values], strict=True):
        if not abs(m - answer) <= 4.0 * e:
            found.failures.append(f"an ascent of {n:.0f} mean free times ends {m:.3f} +- {e:.3f} K too warm")
    draw_finite_speed(found, ascents, mean, error, float(c[0]), room, scatter)


def adiabat_of_spheres(pressure: float) -> float:
    """Return the temperature [K] at which spheres as wide as those of the scene arrive at a pressure [Pa].

    Lifted infinitely slowly, their excluded volume still makes them deviate from T ~ p^(2/7) to second order in their
    packing fraction.
    """
    volume = scenarios.load("lifting-dry").Settings().si.diameter ** 3

    def filled(temperature: float, pressure: float) -> float:
        wanted = pressure * volume / (BOLTZMANN * temperature)
        reduced = optimize.brentq(lambda n: float(theory.gas_pressure(n, 1.0, 1.0)) - wanted, 0.1 * wanted, wanted)
        return float(theory.packing_fraction(reduced, 1.0))

    start = filled(288.15, 1e5)

    def surplus(temperature: float) -> float:
        return temperature / 288.15 - float(theory.hard_sphere_isentrope(filled(temperature, pressure), start, 5))

    return float(optimize.brentq(surplus, 100.0, 400.0))


def fitted(terms: np.ndarray, values: np.ndarray, error: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Return the coefficients of terms that fit the values best, their standard errors, and chi squared."""
    weighted = terms / error[:, None]
    covariance = np.linalg.inv(weighted.T @ weighted)
    best = covariance @ weighted.T @ (values / error)
    return best, np.sqrt(np.diag(covariance)), float(np.sum(((values - terms @ best) / error) ** 2))


def draw_finite_speed(
    found: Findings,
    ascents: np.ndarray,
    mean: np.ndarray,
    error: np.ndarray,
    c: float,
    room: float,
    scatter: np.ndarray,
) -> None:
    """Draw the misfit against the length of the ascent."""
    line = np.geomspace(80.0, 2000.0, 50)
    with axes_of(1, (6.8, 4.4)) as (drawing, (axes,)):
        axes.plot(line, c / line + room, "--", color="#1a1a1a", label=f"{c:.0f} K / n − {-room:.2f} K")
        axes.errorbar(ascents, mean, error, fmt="o", capsize=3, color=BLUE, label="mean of the runs")
        axes.plot(ascents, scatter, "s", mfc="none", color=VERMILLION, label="scatter from run to run")
        axes.set(
            xscale="log",
            yscale="log",
            title="A fast ascent ends too warm",
            xlabel="length n of the ascent in mean free times",
            ylabel="parcel minus adiabat at 300 hPa (K)",
        )
        axes.set_xticks(ascents, [f"{n:.0f}" for n in ascents], minor=False)
        axes.set_xticks([], minor=True)
        axes.set_yticks([0.05, 0.1, 0.2, 0.5, 1.0, 2.0], ["0.05", "0.1", "0.2", "0.5", "1", "2"])
        axes.legend()
        explain(drawing)
        save(found, drawing, "finite-speed")


@job("rotation")
def rotation(found: Findings) -> None:
    """Lift molecules that rotate, and such that do not."""
    runs = {on: runner.execute(runner.prepare("lifting-dry", {"rotation": on})) for on in (True, False)}
    with axes_of(1, (6.8, 4.8)) as (drawing, (axes,)):
        for on, freedom, colour, marker in ((True, 5, BLUE, "o"), (False, 3, VERMILLION, "s")):
            data = runs[on].dataset
            hpa = np.linspace(300.0, 1000.0, 100)
            answer = theory.dry_adiabat_temperature(hpa, 288.15, 1000.0, freedom)
            label = "rotating, as air does" if on else "not rotating"
            axes.plot(
                data.parcel_temperature - 273.15,
                data.parcel_pressure / 100.0,
                marker,
                color=colour,
                markevery=2,
                label=f"molecules {label}",
            )
            power = "2/7" if on else "2/5"
            axes.plot(answer - 273.15, hpa, "--" if on else ":", color="#1a1a1a", label=f"$T \\sim p^{{\\,{power}}}$")
            level = next(each for each in runs[on].headlines if each.name == "temperature_at_300_hpa")
            found.number("on" if on else "off", f"{level.value - 273.15:.1f} °C".replace("-", "−"))
            if not level.agrees:
                found.failures.append(f"rotation {on}: {level.value} K at 300 hPa, but theory says {level.theory}")
        axes.set(
            yscale="log",
            title="Without rotation, air would cool by another 26 K",
            xlabel="temperature (°C)",
            ylabel="pressure (hPa)",
        )
        axes.set_yticks([300, 400, 500, 700, 850, 1000], ["300", "400", "500", "700", "850", "1000"])
        axes.set_yticks([], minor=True)
        axes.invert_yaxis()
        axes.legend()
        save(found, drawing, "rotation")
    difference = runs[True].dataset.parcel_temperature[-1] - runs[False].dataset.parcel_temperature[-1]
    found.number("difference", f"{float(difference):.1f} K")
