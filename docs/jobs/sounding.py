"""What theory says of the analytic sounding: three kinds of CAPE, and what half a degree does to it."""

import math

import numpy as np
from jobs.registry import Findings, job, rounded

from atmosbox import theory
from atmosbox.scene import sounding

MOISTURE = 0.014


def cape(most_liquid: float, warmer: float = 0.0, *, weight: bool = False) -> float:
    """Return the CAPE of a parcel from the ground [J/kg], with the weight of the droplets or without it."""
    air = sounding.weisman_klemp(MOISTURE)
    levels = np.unique(np.append(air.pressure, np.geomspace(air.pressure[0], air.pressure[-1], 400)))[::-1]
    x, known = -np.log(levels), -np.log(air.pressure)
    temperature, dewpoint = np.interp(x, known, air.temperature), np.interp(x, known, air.dewpoint)
    vapour = theory.mixing_ratio(theory.saturation_vapor_pressure(dewpoint), levels)
    water = float(theory.mixing_ratio(theory.saturation_vapor_pressure(air.dewpoint[0]), air.pressure[0]))
    path = theory.parcel_path(levels, air.pressure[0], air.temperature[0], water, most_liquid)
    base = float(theory.lcl(air.pressure[0], air.temperature[0], air.dewpoint[0])[0])
    parcel = theory.density_temperature(path.temperature + warmer, path.vapor, path.liquid if weight else 0.0)
    return theory.cape_cin(levels, theory.virtual_temperature(temperature, vapour), parcel, base).cape


@job("sounding", quick=True)
def analytic(found: Findings) -> None:
    """Tell the CAPE of a parcel that loses its water, keeps it, and carries its weight."""
    loaded = cape(math.inf, weight=True)
    found.number("pseudo", f"{cape(0.0):.0f} J/kg")
    found.number("reversible", f"{cape(math.inf):.0f} J/kg")
    found.number("loaded", f"{loaded:.0f} J/kg")
    found.number("half-degree", f"{rounded(cape(math.inf, 0.5, weight=True) - loaded)} J/kg")
