"""A thin gas of molecules that attract each other, as in `attraction`.

Its second and third virial coefficient, each by itself.
"""

import math

import numpy as np
from jobs.registry import Findings, job

from atmosbox import theory
from atmosbox.engine import AttractingParcelSet, Periodic, RandomBath, SquareWell, random_positions
from atmosbox.scene.statistics import block_average
from tests.oracle.mayer import fourth_virial

MOLECULES = 500
BLOCKS = 100
RANGE = 1.5
CASES = ((1.0, 0.01, 1e4), (1.0, 0.02, 2.5e4), (1.5, 0.01, 1.2e4), (2.0, 0.01, 8e3), (3.0, 0.01, 1.2e4))
"""Temperature T*, packing fraction, and for how long [time]: B3 is known to some 15 %, except in the first case."""


def pressure(warmth: float, density: float, lasting: float, seed: int) -> tuple[float, float]:
    """Return Z - 1 of a gas with a random thermostat, and its standard error."""
    n = MOLECULES
    side = (n / density) ** (1.0 / 3.0)
    random = np.random.default_rng(seed)
    # a rate of some 1.5 lets the energy of the whole, and so the number of pairs, forget itself soonest
    gas = AttractingParcelSet(
        random_positions((side,) * 3, np.ones(n), random, periodic=(True,) * 3),
        random.normal(size=(n, 3)) * math.sqrt(warmth), length=(side,) * 3, walls=(Periodic(),) * 6,
        well=SquareWell(RANGE, 1.0), bath=RandomBath(warmth, 1.5), seed=seed,
    )  # fmt: skip
    gas.advance(50.0)
    sums = [float(gas.virial.sum())]
    for block in range(BLOCKS):
        gas.advance(50.0 + lasting * (block + 1) / BLOCKS)
        sums.append(float(gas.virial.sum()))
    mean = block_average(np.diff(sums) * BLOCKS / (3.0 * n * warmth * lasting), BLOCKS)
    return float(mean.mean), float(mean.standard_error)


@job("virial")
def virial(found: Findings) -> None:
    r"""Measure the pressure of thin gases, and from it B2, with B3 of theory, and B3, with B2 of theory.

    In a box of N molecules no more come and none go: Z is smaller there by
    :math:`\tfrac{1}{2N}\,\partial \ln \chi^{-1} / \partial \ln \rho` with
    :math:`\chi^{-1} = 1 + 2 B_2 \rho + 3 B_3 \rho^2`.
    """
    for seed, (warmth, packing, lasting) in enumerate(CASES):
        density = 6.0 / math.pi * packing
        measured, error = pressure(warmth, density, lasting, 1 + seed)
        second, third = (
            float(of(warmth, RANGE)) for of in (theory.square_well_second_virial, theory.square_well_third_virial)
        )
        fourth, unsure = fourth_virial(warmth, 20_000_000 if warmth == 1.0 else 5_000_000)
        stiffness = 1.0 + 2.0 * second * density + 3.0 * third * density**2
        few = density * (second + 3.0 * third * density) / stiffness / MOLECULES
        rest = (measured + few) / density - fourth * density**2
        where = f"at T* = {warmth:g}, φ = {packing:g}"
        found.agree(f"B₂ {where}", rest - third * density, error / density, second, limit=3.0 * error / density)
        error = math.hypot(error / density**2, unsure * density)
        found.agree(f"B₃ {where}", (rest - second) / density, error, third, limit=3.0 * error)
