"""Water at rest: the curve of saturation, and the balance of a few molecules."""

import math
from dataclasses import replace

import numpy as np
from jobs.drawing import BLUE, explain, save, sheet
from jobs.registry import Findings, job

from atmosbox import theory
from atmosbox.engine import Mist, Start
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from atmosbox.plot.theme import DARK, REFERENCE_COLOURS
from atmosbox.scene.moisture import WARM, moist_air, water
from atmosbox.scene.statistics import block_average
from atmosbox.scene.units import Scale
from atmosbox.simulation import runner
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR

RUNS: dict[float, dict[str, float]] = {
    -10.0: {"pressure": 100.0, "duration": 400.0},
    0.0: {"pressure": 150.0, "duration": 260.0},
    10.0: {"pressure": 300.0, "duration": 300.0},
    20.0: {"pressure": 500.0, "duration": 140.0},
    30.0: {"duration": 95.0},
    40.0: {"duration": 75.0},
}
"""Settings by temperature [degC]. In the cold the air is thin: it plays no part, and more molecules are vapour."""
FINE = 0.01
"""Largest standard error of a vapour pressure, as a share of it."""


def measured_water(celsius: np.ndarray) -> np.ndarray:
    """Return by which share the vapour pressure of real water is above the prescribed one."""
    t = np.asarray(celsius) + 273.15
    above: np.ndarray = theory.saturation_vapor_pressure_iapws(t) / theory.saturation_vapor_pressure(t) - 1.0
    return above


def iapws(found: Findings) -> None:
    """Keep by how much the prescribed formula is off that of measured water."""
    for celsius in (-10, 20, 40, 100):
        off = 100.0 * (1.0 / (1.0 + float(measured_water(np.array(celsius)))) - 1.0)
        found.number(f"iapws{celsius}", f"{off:.2f} %".replace("-", "−"))


@job("saturation")
def saturation(found: Findings) -> None:
    """Let vapour condense at six temperatures, until both rates are equal at the prescribed vapour pressure."""
    rows = []
    for celsius, own in RUNS.items():
        settings = {"temperature": celsius, "molecules": 6000, "area": 12.0, **own}
        outcome = runner.execute(runner.prepare("condensation", settings))
        stated = next(each for each in outcome.headlines if each.name == "mean_relative_humidity")
        pressure = next(each for each in outcome.headlines if each.name == "mean_water_vapor_partial_pressure")
        rows.append((celsius, pressure.value, pressure.standard_error, stated.value, stated.standard_error))
        where = f"vapour pressure / saturation at {celsius:g} °C".replace("-", "−")
        found.agree(where, stated.value, stated.standard_error, float(stated.theory or 1.0))
        if stated.standard_error > FINE:
            found.failures.append(f"{where} is known to {100.0 * stated.standard_error:.2f} % only")
    t, e, error, share, share_error = np.array(rows).T
    chance = float(np.sqrt(np.sum(share_error**2))) / len(rows)
    found.number("mean", f"{100.0 * share.mean():.1f} ± {100.0 * chance:.1f} %")
    iapws(found)
    draw_saturation(found, t, e, error, share, share_error)


def draw_saturation(
    found: Findings, t: np.ndarray, e: np.ndarray, error: np.ndarray, share: np.ndarray, share_error: np.ndarray
) -> None:
    """Draw vapour pressure against temperature, and its share of saturation."""
    line = np.linspace(-15.0, 44.0, 200)
    formula, real = theory.saturation_vapor_pressure(line + 273.15), measured_water(line)
    with sheet((7.2, 6.6)) as drawing:
        top, low = drawing.subplots(2, 1, sharex=True, height_ratios=(2.1, 1.0))
        band = {"color": REFERENCE_COLOURS[0], "linewidth": 5.0, "alpha": 0.7}
        top.plot(line, formula * (1.0 + real) / 100.0, **band, label="measured water (IAPWS)")
        top.plot(line, formula / 100.0, "--", color=DARK, label="$e_s(T)$, prescribed")
        top.errorbar(
            t,
            e / 100.0,
            error / 100.0,
            fmt="o",
            capsize=3,
            color=BLUE,
            label="measured, where both rates are equal",
            zorder=5,
        )
        top.set(
            title="The two rates are equal at the prescribed vapour pressure",
            ylabel="vapour pressure (hPa)",
            xlim=(-15.0, 44.0),
            ylim=(0.0, 85.0),
        )
        top.legend(loc="upper left")
        low.plot(line, 100.0 * real, **band)
        low.axhline(0.0, linestyle="--", color=DARK)
        low.errorbar(t, 100.0 * (share - 1.0), 100.0 * share_error, fmt="o", capsize=3, color=BLUE)
        low.set(xlabel="temperature (°C)", ylabel="difference from $e_s$ (%)", ylim=(-3.0, 3.0))
        explain(drawing)
        save(found, drawing, "saturation")


WATERS, AIR, NUCLEI = 6, 20, 30.0


def isolated_box(seed: int) -> tuple[MoistParcelSet, Scale]:
    """Return a box without heat bath that holds a few molecules of air and water, at about 20 degC."""
    rng = np.random.default_rng(seed)
    scale = Scale(DRY_AIR.diameter, DRY_AIR.molecule_mass, BOLTZMANN * 293.15)
    small, vapour = 1e-3, WATERS // 2
    side = (vapour / float(theory.saturation_vapor_pressure(293.15) / scale.pressure)) ** (1.0 / 3.0)
    gas, substance = moist_air(AIR + vapour, vapour), replace(water(scale), diameter=small)
    start = Start(AIR + vapour, WARM).draw(rng, **gas._asdict())
    box = MoistParcelSet(
        rng.uniform(small, side - small, (AIR + vapour, 3)),
        start.velocity,
        length=(side,) * 3,
        mass=gas.mass,
        diameter=small,
        rotation=gas.rotation,
        rotational_energy=start.rotational_energy,
        liquid=Mist(
            substance, number=WATERS - vapour, kT=1.0, nuclei=NUCLEI, area=20.0 * side * side
        ),
        seed=seed,
    )  # fmt: skip
    return box, scale


@job("few-molecules")
def few_molecules(found: Findings) -> None:
    """Count how often so many of six molecules of water are vapour, in a box of which nothing leaves."""
    box, scale = isolated_box(1)
    energy = (sum(box.energy()) + box.condensed_energy) * scale.energy
    exact = theory.isolated_vapor_number(WATERS, AIR, energy, box.volume * scale.length**3, NUCLEI)
    box.advance(200.0)
    looks, step = 100_000, 4.0
    number = np.empty(looks)
    for k in range(looks):
        box.advance(200.0 + (k + 1) * step)
        number[k] = box.vapour
    for n, chance in enumerate(exact.probability):
        if chance > 0.01:
            share = block_average((number == n).astype(float), 40)
            found.agree(
                f"probability that {n} of {WATERS} are vapour",
                float(share.mean),
                float(share.standard_error),
                float(chance),
                limit=0.02,
            )
    mean = block_average(number, 40)
    found.agree("mean number of molecules of vapour", float(mean.mean), float(mean.standard_error), exact.mean)
    naive = float(theory.hertz_knudsen_flux(293.15))
    thermal = (3 * theory.LIQUID_HEAT_CAPACITY + NUCLEI) * BOLTZMANN * 293.15
    ratio = float(theory.microcanonical_flux(thermal, 3, NUCLEI)) / naive
    found.number("rate", f"{ratio:.2f}")
    capacity = 2 * theory.LIQUID_HEAT_CAPACITY + NUCLEI
    left = thermal / BOLTZMANN - theory.BINDING_TEMPERATURE
    found.number("colder", f"{293.15 - left / capacity:.0f} K")
    found.number("exchanges", f"{box.evaporated:,}")
    if not math.isfinite(ratio):
        found.failures.append("the rate of three molecules is not finite")
