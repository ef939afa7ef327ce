"""How well a lifted parcel keeps to the dry adiabat, and what a fast ascent costs."""

import math

import numpy as np
from jobs.registry import Findings, job

from atmosbox import scenarios, theory
from atmosbox.simulation import runner

LEVELS = (700, 300)
SEEDS = {100: 24, 200: 24, 400: 24, 800: 16, 1600: 16}
"""How many seeds there are for each length of the ascent in mean free times."""
SLOW = 200
"""From which length on the law of the finite speed is fitted; in faster ascents its next order shows."""
_MEMORY: dict[tuple[int, int], dict[int, tuple[float, float]]] = {}


def misfits(ascent: int, seed: int) -> dict[int, tuple[float, float]]:
    """Return by pressure [hPa] how far a parcel is above the textbook's adiabat, and how far it is in theory [K]."""
    if (ascent, seed) not in _MEMORY:
        prepared = runner.prepare("lifting-dry", {"ascent": ascent, "seed": seed})
        found = {each.name: each for each in runner.execute(prepared).headlines}
        _MEMORY[ascent, seed] = {}
        for level in LEVELS:
            each = found[f"temperature_at_{level}_hpa"]
            adiabat = float(theory.dry_adiabat_temperature(level, 288.15, 1000.0, 5))
            _MEMORY[ascent, seed][level] = each.value - adiabat, (each.theory or 0.0) - adiabat
    return _MEMORY[ascent, seed]


@job("lifting-seeds")
def lifting_seeds(found: Findings) -> None:
    """Run the scene as it comes, with the seeds 1 to 8."""
    for level in LEVELS:
        off = np.array([misfits(1600, seed)[level][0] for seed in range(1, 9)])
        found.number(f"mean-{level}", f"{off.mean():.2f} ± {off.std(ddof=1) / math.sqrt(off.size):.2f} K")
        worst = np.abs(off).max()
        found.number(f"largest-{level}", f"{worst:.2f} K")
        if worst > 0.5:
            found.failures.append(f"a parcel at {level} hPa is {worst:.2f} K off the dry adiabat")


@job("finite-speed")
def finite_speed(found: Findings) -> None:
    """Measure how much too warm the parcel is at 300 hPa, against the length of the ascent; fit c / length to it."""
    expected = float(theory.dry_adiabat_temperature(300.0, 288.15, 1000.0, 5))
    scene = scenarios.load("lifting-dry")
    # what the volume of the spheres does to the adiabat is the rest of the theory
    room = misfits(1600, 1)[300][1] - expected * scene._ascent(scene.Settings()).finite_speed(30_000.0)
    weight, total = 0.0, 0.0
    for n, seeds in SEEDS.items():
        off = np.array([misfits(n, seed)[300] for seed in range(1, seeds + 1)])
        mean, answer = off.mean(axis=0)
        error = off[:, 0].std(ddof=1) / math.sqrt(seeds)
        if not abs(mean - answer) <= 4.0 * error:
            found.failures.append(f"an ascent of {n} mean free times ends {mean:.3f} +- {error:.3f} K too warm")
        if n >= SLOW:
            weight += 1.0 / (n * error) ** 2
            total += (mean - room) / (n * error**2)
    found.number("c", f"{total / weight:.0f} ± {weight**-0.5:.0f} K")
    slow = 1e6  # so long that only the first order is left
    allowed = slow * expected * scene._ascent(scene.Settings(ascent=slow)).finite_speed(30_000.0)
    found.number("allowed", f"{allowed:.0f} K")
