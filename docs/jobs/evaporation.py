"""Where a pool under dry air ends: from seed to seed, and what its size and the air make of it."""

import math

import numpy as np
from jobs.registry import Findings, job

from atmosbox import theory
from atmosbox.simulation import runner
from atmosbox.theory.constants import BOLTZMANN

SEEDS = range(1, 9)
NEAR = 0.3
"""How near the mean over the seeds must come to the balance of enthalpy [K]."""
COLUMNS = {
    "mean_gas_temperature": ("air [K]", 1.0, 2),
    "mean_liquid_temperature": ("pool [K]", 1.0, 2),
    "final_humidity": ("vapour pressure / saturation [%]", 100.0, 1),
    "mean_evaporation_rate": ("evaporation [%]", None, 1),
    "energy_of_those_that_leave": ("energy of those that leave [zJ]", 1e21, 2),
}
"""What is listed of each run: its heading, what it is multiplied by (None: a percentage of theory), and digits."""


def shown(value: float, digits: int) -> str:
    """Return a misfit as it stands in a table."""
    return f"{value:+.{digits}f}".replace("-", "−")


@job("evaporation-seeds")
def evaporation_seeds(found: Findings) -> None:
    """Run the scene as it comes, with the seeds 1 to 8."""
    rows = []
    for seed in SEEDS:
        outcome = runner.execute(runner.prepare("evaporation", {"seed": seed}))
        stated = {each.name: each for each in outcome.headlines}
        rows.append(
            [
                (stated[name].misfit or 0.0) * (factor or 100.0 / (stated[name].theory or 1.0))
                for name, (_, factor, _) in COLUMNS.items()
            ]
        )
        for each in outcome.headlines:
            if not each.agrees:
                found.failures.append(f"seed {seed}: {each.label} is off by {each.misfit:.3g} {each.unit}")
    misfits = np.array(rows)
    mean, error = misfits.mean(axis=0), misfits.std(axis=0, ddof=1) / math.sqrt(len(SEEDS))
    digits = [digits for _, _, digits in COLUMNS.values()]
    lines = [
        [str(seed), *(shown(*pair) for pair in zip(row, digits, strict=True))]
        for seed, row in zip(SEEDS, misfits, strict=True)
    ]
    together = zip(mean, error, digits, strict=True)
    lines.append(["**mean**", *(f"**{shown(m, d)} ± {e:.{d}f}**" for m, e, d in together)])
    found.table(["seed", *(heading for heading, _, _ in COLUMNS.values())], lines)
    for k, name in enumerate(("air", "pool")):
        if abs(mean[k]) > NEAR:
            found.failures.append(f"the {name} ends {mean[k]:.2f} K off the balance of enthalpy")


@job("evaporation-ends", quick=True)
def evaporation_ends(found: Findings) -> None:
    """Tell where pools of other sizes under other air end, and the wet-bulb temperature of that air."""
    rows = []
    scene = runner.prepare("evaporation", {})
    defaults = scene.settings
    for humidity in (0.0, defaults.humidity, 60.0, 100.0, 120.0):
        for pool in sorted({30, 300, defaults.pool}):
            settings = runner.prepare("evaporation", {"humidity": humidity, "pool": pool}).settings
            end = scene.module._start(settings, ideal=False).end
            left = float(end.liquid)
            dewpoint = theory.dewpoint(settings.si.humidity * theory.saturation_vapor_pressure(settings.si.temperature))
            bulb = "–"
            if humidity <= 100.0:
                wet = theory.wet_bulb_temperature(
                    settings.si.pressure, settings.si.temperature, min(float(dewpoint), settings.si.temperature)
                )
                bulb = f"{float(wet) - 273.15:.1f}"
            share = 100.0 * float(end.vapor_pressure / theory.saturation_vapor_pressure(end.temperature))
            rows.append(
                [
                    f"{humidity:g} %",
                    pool,
                    f"{float(end.temperature) - 273.15:.1f}",
                    "dry" if left <= 0.0 else f"{left:.0f}",
                    f"{share:.0f} %",
                    bulb,
                ]
            )
    found.table(
        ["humidity at the start", "pool", "ends at [°C]", "pool at the end", "humidity at the end", "wet bulb [°C]"],
        rows,
    )
    start = scene.module._start(defaults, ideal=False)
    found.number("end", f"{float(start.end.temperature) - 273.15:.2f} °C")
    found.number("loss", f"{start.loss(defaults.si.duration / start.scale.time):.2f} K")
    kT = float(start.end.temperature) * BOLTZMANN * 1e21
    found.number("kT", f"{kT:.2f} zJ")
