"""A piston that recedes slowly: the adiabat of discs, of spheres, and of molecules that rotate."""

import math

import numpy as np
from jobs.registry import Findings, job

from atmosbox import theory
from atmosbox.engine import ParcelSet, Periodic, Piston, Specular, maxwell_velocities, random_positions

N = 1000
SEEDS = range(1, 9)
LENGTH_IN_FREE_TIMES = 400.0
DISSIPATION = {2: 1.022, 3: 4.0 / 3.0 * 1.016 * 1.25, 5: theory.DISSIPATION}
"""Entropy that a gas which expands at the rate e gains per molecule and time, over e^2 and its mean free time.

By kinetic theory, see `theory.DISSIPATION`; for discs in a plane it is the viscosity, 1.022 n k T and mean free times.
"""


def expansion(freedom: int, seed: int) -> float:
    """Return the adiabatic index of a gas that a piston lets expand to twice its volume.

    It is read from the temperatures before and after, and from what the room that the molecules take does to the
    volume that counts: dT / T = -(gamma - 1) Z dV / V.
    """
    planar = freedom == 2
    rng = np.random.default_rng(seed)
    packing = 0.01
    share = math.pi / 4.0 if planar else math.pi / 6.0
    side = (N * share / packing) ** (0.5 if planar else 1.0 / 3.0)
    length = (side, 2.0 if planar else side, side)
    kT = 1.0
    turning = 2.0 if freedom == 5 else 0.0
    density = packing / share
    rate = float(
        theory.collision_rate_discs(density, 1.0, kT, 1.0) if planar else theory.collision_rate(density, 1.0, kT, 1.0)
    )
    duration = LENGTH_IN_FREE_TIMES / rate
    gas = ParcelSet(
        random_positions(
            length, np.ones(N), rng, planar=planar, periodic=(True, False, False) if planar else (True, True, False)
        ),
        maxwell_velocities(kT, np.ones(N), rng, planar=planar, exact=True),
        length=length,
        walls=(Periodic(),) * 2 + (Specular() if planar else Periodic(),) * 2 + (Specular(), Piston(side / duration)),
        rotation=turning,
        rotational_energy=np.full(N, 0.5 * turning * kT),
        planar=planar,
        seed=seed,
    )
    before, energy = gas.open_density / N, gas.internal_energy()
    gas.advance(duration)
    after = gas.open_density / N
    ratio = math.log(energy / gas.internal_energy())
    steps = np.exp(np.linspace(math.log(after), math.log(before), 201))
    filled = steps * N * share
    z = theory.compressibility_factor_discs(filled) if planar else theory.compressibility_factor(filled)
    return 1.0 + ratio / float(np.trapezoid(z, np.log(steps)))


def measured(freedom: int) -> float:
    r"""Return the index that theory expects to be read from an expansion to twice the volume at this speed.

    The entropy :math:`\int D e^2 \tau dt` warms the gas at its volume by :math:`2/f` of that; with x = V / V_0 and
    times in mean free times at the start, of which n pass, e = 1 / n x and :math:`\tau = x^{(\gamma + 1) / 2}`.
    """
    index = float(theory.adiabatic_index(freedom))
    power = 0.5 * (index - 1.0)
    gained = DISSIPATION[freedom] / LENGTH_IN_FREE_TIMES * (2.0**power - 1.0) / power
    return index - 2.0 / freedom * gained / math.log(2.0)


@job("slow-piston")
def slow_piston(found: Findings) -> None:
    """Let three gases expand to twice their volume in four hundred mean free times."""
    for freedom, what in ((2, "discs in a plane"), (3, "spheres"), (5, "spheres that rotate")):
        values = np.array([expansion(freedom, seed) for seed in SEEDS])
        error = float(values.std(ddof=1) / math.sqrt(values.size))
        found.agree(f"γ of {what}", float(values.mean()), error, measured(freedom))
