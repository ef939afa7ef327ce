"""Drops that feel their curvature: the laws of Kelvin and of Koehler, measured, and what they need of a grain."""

import math

from jobs.registry import Findings, job
from jobs.registry import rounded as printed

from atmosbox import theory
from atmosbox.simulation import runner
from atmosbox.theory.constants import BOLTZMANN

WARM = 293.15
WATER = {
    "tension": float(theory.water_surface_tension(WARM)),
    "volume": theory.WATER_VOLUME,
    "kT": BOLTZMANN * WARM,
}
PAIRS = 25
NUMBERS = ((0, 150), (0, 400), (0, 1000), (PAIRS, 70), (PAIRS, 160), (PAIRS, 500))
"""Pairs of ions in the drop, and molecules of water in it."""
GRAINS = (1.288, 5.0, 20.0, 100.0, 1000.0)
"""Diameters of dry grains [nm]; the first is that of the scene."""


def over(number: float, pairs: int) -> float:
    """Return the humidity over a drop by theory."""
    core = 2 * pairs * theory.SALT_VOLUME if pairs else theory.WATER_VOLUME
    return float(theory.humidity_over_drop(number, **WATER, particles=2.0 * pairs, core=core))


@job("koehler")
def koehler(found: Findings) -> None:
    """Watch one drop in a closed box where it is stable, of six sizes."""
    for pairs, number in NUMBERS:
        expected = over(number, pairs)
        vapour = number if pairs == 0 else min(number, 300)
        settings = {
            "salted": int(pairs > 0),
            "pure": int(pairs == 0),
            "water": number,
            "humidity": 100.0 * expected,
            "molecules": round(vapour / (expected * 0.23348)),
            "duration": 600.0,
        }
        outcome = runner.execute(runner.prepare("nuclei", settings))
        (stated,) = [each for each in outcome.headlines if each.name == "humidity_over_drops"]
        late = outcome.dataset.isel(elapsed_time=slice(120, None))
        name = "salted" if pairs else "pure"
        radius = 1e9 * float(late[f"{name}_drop_radius"].mean())
        what = f"{2 * pairs} ions" if pairs else "pure water"
        where = f"humidity over a drop of {radius:.2f} nm, {what}"
        found.agree(where, stated.value, stated.standard_error, float(stated.theory or 0.0))
    found.number("kelvin", f"{1e9 * theory.kelvin_radius(**WATER) / math.log(2.5):.2f} nm")


@job("koehler-grains", quick=True)
def grains(found: Findings) -> None:
    """Say which humidity grains of salt need, from those of the scene to those of the sea."""
    rows = []
    for wide in GRAINS:
        core = math.pi / 6.0 * (wide * 1e-9) ** 3
        drop = theory.critical_drop(**WATER, particles=core / theory.SALT_VOLUME, core=core)
        rows.append(
            [
                f"{wide:.2g} nm" if wide < 100.0 else f"{wide / 1000.0:g} µm",
                printed(core / theory.SALT_VOLUME),
                f"{1e9 * drop.radius:.2g} nm" if drop.radius < 1e-7 else f"{1e6 * drop.radius:.2g} µm",
                f"{100.0 * drop.humidity:.{4 if drop.humidity < 1.0005 else 2 if drop.humidity < 1.1 else 0}f} %",
            ]
        )
    found.table(["dry grain", "ions", "radius of the drop at the maximum", "humidity at the maximum"], rows)
