"""Liquid and vapour without a surface: when they are in balance, by thermodynamics, to lay beside slabs."""

import math
from typing import NamedTuple

import numpy as np
from jobs.registry import Findings, job
from scipy.integrate import quad
from scipy.optimize import newton

from atmosbox import theory
from atmosbox.engine import AttractingParcelSet, Periodic, RandomBath, SquareWell, lattice_positions
from atmosbox.scene.statistics import block_average
from atmosbox.theory.constants import AVOGADRO, BOLTZMANN

POINTS = (
    (0.9, 0.692, 0.0146),
    (0.95, 0.671, 0.0215),
    (1.0, 0.6455, 0.0314),
    (1.05, 0.619, 0.0449),
    (1.1, 0.586, 0.0655),
    (1.15, 0.546, 0.0995),
)
"""Temperatures T*, and densities near those of liquid and vapour: within some percent, see `balance`."""
NODES = 8
MOLECULES = 500
BLOCKS = 25


class Phase(NamedTuple):
    """A box of one phase: pressure over n kT and its standard error, energy of a molecule [depth] and its error."""

    factor: float
    factor_se: float
    energy: float
    energy_se: float


class Balance(NamedTuple):
    """Liquid and vapour that are in balance at one temperature, in diameters and depths, each with its error."""

    pressure: tuple[float, float]
    liquid: tuple[float, float]
    vapor: tuple[float, float]
    latent_heat: tuple[float, float]


class Side(NamedTuple):
    """One of the phases near where it is in balance: density, chemical potential less p / density, and error [kT].

    ``pressure`` over kT, with its error, and how it rises with density; ``energy`` of a molecule [depth].
    """

    density: float
    free: float
    free_se: float
    pressure: float
    pressure_se: float
    rise: float
    energy: float
    energy_se: float

    def potential(self, pressure: float) -> float:
        """Return the chemical potential at a pressure over kT, to second order [kT]."""
        return self.free + pressure / self.density - 0.5 * (pressure - self.pressure) ** 2 / self.density**2 / self.rise

    def density_at(self, pressure: float, pressure_se: float) -> tuple[float, float]:
        """Return the density at a pressure over kT, and its standard error."""
        away = (pressure - self.pressure) / self.rise
        return self.density + away, math.hypot(self.pressure_se, pressure_se) / self.rise


def phase(density: float, strength: float, lasting: float, seed: int) -> Phase:
    """Let molecules of kT = 1, whose wells are so deep, be in a periodic cube, and measure what they press."""
    n = MOLECULES
    side = (n / density) ** (1.0 / 3.0)
    rng = np.random.default_rng(seed)
    box = AttractingParcelSet(
        lattice_positions((side,) * 3, np.ones(n), periodic=(True,) * 3), rng.normal(size=(n, 3)), length=(side,) * 3,
        walls=(Periodic(),) * 6, well=SquareWell(1.5, 1.0), strength=strength, bath=RandomBath(1.0, 1.0), seed=seed,
    )  # fmt: skip
    box.advance(20.0)
    looks = 100 * BLOCKS
    virial, wells = np.zeros(looks + 1), np.zeros(looks)
    virial[0] = box.virial.sum()
    for k in range(looks):
        box.advance(20.0 + lasting * (k + 1) / looks)
        virial[k + 1], wells[k] = box.virial.sum(), box.number_of_wells
    factor = block_average(1.0 + np.diff(virial) * looks / (3.0 * n * lasting), BLOCKS)
    energy = block_average(-wells / n, BLOCKS)
    return Phase(*(float(each) for each in (*factor, *energy)))


def free_energy(density: float, strength: float, lasting: float, seed: int) -> tuple[float, float]:
    r"""Return the free energy of a molecule beyond that of an ideal gas [kT], and its standard error.

    That of hard spheres, and what the wells add as they are made deeper: :math:`\int_0^{\beta} u\,d\beta`.
    """
    packing = math.pi / 6.0 * density
    hard, _ = quad(lambda y: (float(theory.compressibility_factor(y)) - 1.0) / y, 1e-9, packing)
    place, weight = np.polynomial.legendre.leggauss(NODES)
    found = [phase(density, 0.5 * strength * (1.0 + x), lasting, seed + k) for k, x in enumerate(place)]
    part = 0.5 * strength * weight
    return (
        hard + float(part @ [each.energy for each in found]),
        float(np.linalg.norm(part * [each.energy_se for each in found])),
    )


def near(density: float, strength: float, lasting: float, seed: int) -> Side:
    """Measure a phase at a density, and how its pressure rises where it is 4 % denser."""
    free, free_se = free_energy(density, strength, lasting, seed)
    here, denser = (phase(more * density, strength, 4.0 * lasting, seed + 50 + k) for k, more in enumerate((1.0, 1.04)))
    pressure, more = here.factor * density, denser.factor * 1.04 * density
    rise = (more - pressure) / (0.04 * density)
    potential = math.log(density) + free
    return Side(density, potential, free_se, pressure, here.factor_se * density, rise, here.energy, here.energy_se)


def balance(warmth: float, liquid: float, vapor: float, lasting: float = 60.0, seed: int = 1) -> Balance:
    r"""Return where liquid and vapour have the same pressure and the same chemical potential.

    From a density near it, :math:`d\mu = dp / n`. What the liquid's own pressure is off counts to second order only,
    and so the balance is known far better than that pressure.

    Parameters
    ----------
    warmth
        T*.
    liquid, vapor
        Densities near those of the two.
    lasting
        For how long each box is measured [time], those of the vapour three times as long.
    seed
        Of the random numbers.
    """
    dense = near(liquid, 1.0 / warmth, lasting, seed)
    thin = near(vapor, 1.0 / warmth, 3.0 * lasting, seed + 100)
    p = float(newton(lambda p: dense.potential(p) - thin.potential(p), thin.pressure))
    error = math.hypot(dense.free_se, thin.free_se) / (1.0 / thin.density - 1.0 / dense.density)
    (here, here_se), (there, there_se) = (side.density_at(p, error) for side in (dense, thin))
    # as many neighbours as the density says, from the density at which they were counted to that of balance
    below, above = (side.energy * place / side.density for side, place in ((dense, here), (thin, there)))
    heat = above - below + p * warmth * (1.0 / there - 1.0 / here)
    slope = above / there - p * warmth / there**2
    heat_se = math.hypot(dense.energy_se, thin.energy_se, below / here * here_se, slope * there_se)
    return Balance((p * warmth, error * warmth), (here, here_se), (there, there_se), (heat, heat_se))


@job("bulk")
def bulk(found: Findings) -> None:
    """Tell pressure, densities and latent heat of liquid and vapour in balance, beside what is published."""
    fluid = theory.SIMPLE_FLUIDS["argon"]
    bar = 1e-5 * fluid.well_depth / fluid.well_diameter**3
    mass = fluid.molecule_mass / fluid.well_diameter**3
    molar = 1e-3 * fluid.well_depth * AVOGADRO
    rows = []
    for k, (warmth, liquid, vapor) in enumerate(POINTS):
        still = balance(warmth, liquid, vapor, seed=1000 * k + 1)
        published = float(theory.well_vapor_pressure(warmth))
        off = still.pressure[0] / published - 1.0
        if abs(off) > 0.05:
            found.failures.append(f"at T* = {warmth:g} the pressure is {off:.1%} off the published one")
        for near, (value, _) in ((liquid, still.liquid), (vapor, still.vapor)):
            if abs(value / near - 1.0) > 0.05:
                found.failures.append(f"at T* = {warmth:g} a density is {value:.4g}, too far from {near:g}")
        cells = (
            (still.pressure, bar, 2), (still.liquid, mass, 1), (still.vapor, mass, 2), (still.latent_heat, molar, 3)
        )  # fmt: skip
        rows.append(
            [f"{warmth:.2f}", f"{warmth * fluid.well_depth / BOLTZMANN:.1f}", f"{published * bar:.2f}"]
            + [f"{value * unit:.{digits}f} ± {error * unit:.{digits}f}" for (value, error), unit, digits in cells]
            + [f"{100.0 * off:+.1f} %".replace("-", "−")]
        )
    header = [
        "T*",
        "T [K]",
        "p published [bar]",
        "p [bar]",
        "liquid [kg/m³]",
        "vapour [kg/m³]",
        "L [kJ/mol]",
        "p off the published",
    ]
    found.table(header, rows)
