"""What a sounding says by MetPy, by theory with our own constants, and by molecules that are lifted through it."""

import math

import numpy as np
from jobs.registry import Findings, job, rounded

from atmosbox import theory
from atmosbox.scene import sounding
from atmosbox.simulation import runner


def own(moisture: float, most_liquid: float, warmer: float = 0.0, *, weight: bool = False) -> theory.Convection:
    """Return what theory says of the analytic sounding, with the weight of the droplets or without it."""
    air = sounding.weisman_klemp(moisture)
    levels = np.unique(np.append(air.pressure, np.geomspace(air.pressure[0], air.pressure[-1], 400)))[::-1]
    x, known = -np.log(levels), -np.log(air.pressure)
    temperature, dewpoint = np.interp(x, known, air.temperature), np.interp(x, known, air.dewpoint)
    vapour = theory.mixing_ratio(theory.saturation_vapor_pressure(dewpoint), levels)
    water = float(theory.mixing_ratio(theory.saturation_vapor_pressure(air.dewpoint[0]), air.pressure[0]))
    path = theory.parcel_path(levels, air.pressure[0], air.temperature[0], water, most_liquid)
    base = float(theory.lcl(air.pressure[0], air.temperature[0], air.dewpoint[0])[0])
    parcel = theory.density_temperature(path.temperature + warmer, path.vapor, path.liquid if weight else 0.0)
    return theory.cape_cin(levels, theory.virtual_temperature(temperature, vapour), parcel, base)


@job("sounding")
def analytic(found: Findings) -> None:
    """Compare MetPy's indices of the analytic sounding with ours, and both with lifted molecules."""
    rows = []
    for moisture in (0.011, 0.012, 0.013, 0.014, 0.015, 0.016):
        air = sounding.weisman_klemp(moisture)
        metpy, ours = sounding.indices(air), own(moisture, 0.0)
        base = float(theory.lcl(air.pressure[0], air.temperature[0], air.dewpoint[0])[0])
        found.bound(f"LCL at {1000 * moisture:.0f} g/kg [Pa]", abs(base - metpy.lcl.pressure), 200.0)
        found.bound(f"CAPE at {1000 * moisture:.0f} g/kg, relative", abs(ours.cape / metpy.cape - 1.0), 0.05)
        assert metpy.el is not None
        assert ours.el is not None
        found.bound(f"EL at {1000 * moisture:.0f} g/kg [Pa]", abs(ours.el - metpy.el.pressure), 1000.0)
        rows.append(
            [
                f"{1000 * moisture:.0f}",
                f"{metpy.lcl.pressure / 100:.1f} / {base / 100:.1f}",
                f"{metpy.el.pressure / 100:.0f} / {ours.el / 100:.0f}",
                f"{metpy.cape:.0f} / {ours.cape:.0f}",
                f"{metpy.cin:.0f} / {ours.cin:.0f}".replace("-", "−"),
            ]
        )
    found.table(
        ["vapour [g/kg]", "LCL [hPa], MetPy / ours", "EL [hPa]", "CAPE [J/kg]", "CIN [J/kg]"], rows, key="indices"
    )
    pseudo, reversible = own(0.014, 0.0).cape, own(0.014, math.inf).cape
    found.number("pseudo", f"{pseudo:.0f} J/kg")
    found.number("reversible", f"{reversible:.0f} J/kg")
    loaded = own(0.014, math.inf, weight=True)
    found.number("loaded", f"{loaded.cape:.0f} J/kg")
    warmer = own(0.014, math.inf, 0.5, weight=True).cape
    found.number("half-degree", f"{rounded(warmer - loaded.cape)} J/kg")
    runs = []
    for seed in (1, 2, 3):
        outcome = runner.execute(runner.prepare("lifting-sounding", {"seed": seed}))
        by_name = {each.name: each for each in outcome.headlines}
        for each in outcome.headlines:
            if each.agrees is False:
                found.failures.append(f"seed {seed}: {each.label} is {each.value:.6g}, theory says {each.theory:.6g}")
        shown = [("cape", 1.0, 0), ("cin", 1.0, 0), ("lfc", 100.0, 0), ("el", 100.0, 1)]
        runs.append(
            [
                seed,
                *(
                    f"{by_name[n].value / u:.{d}f} ± {by_name[n].standard_error / u:.{d}f}".replace("-", "−")
                    for n, u, d in shown
                ),
            ]
        )
    expected = [f"**{by_name[name].theory / unit:.{digits}f}**".replace("-", "−") for name, unit, digits in shown]
    runs.append(["**theory**", *expected])
    found.table(["seed", "CAPE [J/kg]", "CIN [J/kg]", "LFC [hPa]", "EL [hPa]"], runs, key="seeds")
