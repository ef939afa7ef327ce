"""How dense: at the brink of freezing, as a crystal, at random close packing, and more than space can hold."""

import math
from collections.abc import Callable

import numpy as np

from atmosbox import theory
from atmosbox.engine import Parcel, Periodic, lattice_positions, maxwell_velocities
from atmosbox.engine.core.marching import MarchingParcel
from atmosbox.scene.statistics import block_average
from atmosbox.trade.extremes.extreme import extreme
from atmosbox.trade.extremes.guarded_run import Trial
from atmosbox.trade.extremes.law import by_chance, step_of
from atmosbox.trade.extremes.verdict import Verdict, degraded, judged, wrong

_OPEN = (Periodic(),) * 6
_NUMBER = 256
_BLOCKS = 20
_FINE = 0.004
"""A step short enough for neighbours a tenth of a diameter apart, in diameters at thermal speed."""


def side_of(packing: float, number: int = _NUMBER) -> float:
    """Return the side of the cube in which molecules of diameter 1 fill so much of the space."""
    return float((number * math.pi / 6.0 / packing) ** (1.0 / 3.0))


def compressibility(trial: Trial, gas: Parcel, settle: float, block: float) -> tuple[float, float]:
    """Return Z of a gas whose momentum is zero, from the virial of its contacts, and its standard error."""
    trial.run(gas, settle)
    factors = []
    for _ in range(_BLOCKS):
        virial, time = float(gas.virial.sum()), gas.time
        trial.run(gas, time + block)
        kinetic = gas.energy()[0] * (gas.number / (gas.number - 1.0))
        factors.append(1.0 + (float(gas.virial.sum()) - virial) / (2.0 * kinetic * (gas.time - time)))
    mean, error = block_average(factors, _BLOCKS)
    return float(mean), float(error)


def crystal_compressibility(packing: float) -> float:
    """Return Z of the face-centred crystal of hard spheres (Speedy 1998, J. Phys.: Condens. Matter 10, 4387)."""
    share = packing / (math.pi / math.sqrt(18.0))
    return 3.0 / (1.0 - share) - 0.5921 * (share - 0.7072) / (share - 0.601)


def _pressed(trial: Trial, new: Callable[[], Parcel], expected: float, settle: float, block: float) -> Verdict:
    """Return the verdict on how hard a gas presses; where there are steps, also on what finer ones make of it."""
    gas = new()
    z, error = compressibility(trial, gas, settle, block)
    if by_chance(gas):
        return degraded(f"Z of molecules that take no room, instead of {expected:.3g}", z, 1.0, 1e-12)
    allowed = 4.0 * error + 1.5 * (expected - 1.0) / _NUMBER
    if not step_of(gas):
        return judged("Z", z, expected, allowed)
    if not 1.0 < z < expected + allowed:
        return wrong(f"Z = {z:.3g} does not lie between 1 and {expected:.3g}")
    fine = []
    for step in (_FINE, 0.5 * _FINE):
        gas = new()
        if isinstance(gas, MarchingParcel):
            gas.divide(step)
        fine.append(compressibility(trial, gas, settle, block))
    (coarse, error), (better, less) = fine
    # what is off by the first order of the step goes away; the square of what is off stays
    off = (better - coarse) ** 2 / (expected - 1.0)
    what = f"Z as steps of δ = {_FINE} and of half of that point to; with its own step the engine has {z:.3g}"
    tolerance = 4.0 * math.hypot(error, 2.0 * less) + 4.0 * off + 1.5 * (expected - 1.0) / _NUMBER
    return degraded(what, 2.0 * better - coarse, expected, tolerance)


@extreme("packing-0.49", "φ = 0.49")
def fluid(trial: Trial) -> Verdict:
    """Press spheres together to the brink of freezing: they press as the equation of state says."""
    packing = 0.49
    expected = float(theory.compressibility_factor(packing))
    return _pressed(trial, lambda: trial.gas(_NUMBER, (side_of(packing),) * 3, walls=_OPEN), expected, 10.0, 2.0)


def _crystal(trial: Trial, packing: float) -> Verdict:
    side = side_of(packing)
    sites = lattice_positions((side,) * 3, np.ones(_NUMBER), periodic=(True,) * 3)
    velocity = maxwell_velocities(1.0, np.ones(_NUMBER), np.random.default_rng(2), exact=True)

    def new() -> Parcel:
        return trial.box(sites, velocity, length=(side,) * 3, walls=_OPEN)

    return _pressed(trial, new, crystal_compressibility(packing), 2.0, 1.0)


@extreme("packing-0.58", "φ = 0.58")
def crystal(trial: Trial) -> Verdict:
    """Start a lattice where a fluid would be a glass: it stays a crystal and presses as one."""
    return _crystal(trial, 0.58)


@extreme("packing-0.64", "φ = 0.64")
def close_packed(trial: Trial) -> Verdict:
    """Start a lattice at the density of random close packing: it stays a crystal and presses as one."""
    return _crystal(trial, 0.64)


@extreme("packing-0.75", "φ = 0.75")
def overfull(trial: Trial) -> Verdict:
    """Ask for more than the 0.7405 of space that any packing of spheres fills: it is refused before it is tried."""
    return trial.refused(lambda: trial.gas(_NUMBER, (side_of(0.75),) * 3, walls=_OPEN), "no packing of spheres")
