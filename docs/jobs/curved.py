"""What the laws of Kelvin and of Koehler need of a drop and of a grain."""

import math

from jobs.registry import Findings, job
from jobs.registry import rounded as printed

from atmosbox import theory
from atmosbox.theory.constants import BOLTZMANN

WARM = 293.15
WATER = {
    "tension": float(theory.water_surface_tension(WARM)),
    "volume": theory.WATER_VOLUME,
    "kT": BOLTZMANN * WARM,
}
GRAINS = (1.288, 20.0, 100.0, 1000.0)
"""Diameters of dry grains [nm]; the first is that of the scene."""


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
    found.number("kelvin", f"{1e9 * theory.kelvin_radius(**WATER) / math.log(2.5):.2f} nm")
