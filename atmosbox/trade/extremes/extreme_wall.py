"""Walls: a million times as hot as others, without any temperature, corners, and molecules that never rest."""

import math

import numpy as np

from atmosbox import theory
from atmosbox.engine import HeatBath, Specular, StalledError
from atmosbox.trade.extremes.extreme import ANY, extreme
from atmosbox.trade.extremes.guarded_run import Trial
from atmosbox.trade.extremes.verdict import Verdict, judged, wrong

_S = Specular()


@extreme("hot-and-cold", "walls 10⁶ apart")
def hot_and_cold(trial: Trial) -> Verdict:
    """Put points between walls of kT = 10⁶ and 1: they carry the heat of a formula that is exact."""
    hot = 1e6
    number = 200 if trial.exact else 20  # the hot ones make steps short
    walls = (HeatBath(hot), HeatBath(1.0), _S, _S, _S, _S)
    options = {"dt": 2e-5} if trial.engine == "stepped" else {}  # it wants to be told where molecules have no size
    gas = trial.gas(number, (1.0,) * 3, kT=1.0, diameter=0.0, walls=walls, options=options)
    trial.run(gas, 5.0)
    heat, hits, time = gas.wall_heat, gas.wall_hits, gas.time
    trial.run(gas, time + 200.0)
    given, times = gas.wall_heat - heat, gas.time - time
    expected = float(theory.free_molecular_slab(hot, 1.0, float(number), 1.0).heat_flux)
    flux = 0.5 * (given[0] - given[1]) / times
    # Of the slow molecules that the cold wall emits some take all day: the mean square of the time that one takes
    # for its way, 1 / v, grows with the logarithm of the run. The mean is sqrt(pi / 2), and the energy that it takes
    # back has a relative variance of 1 / 2. Accepted are 4 standard errors: 6 false alarms in 100 000.
    square = math.log(times) + 0.5 * (math.log(2.0) - 0.5772)
    error = math.sqrt((square / (0.5 * math.pi) - 0.5) / (gas.wall_hits - hits)[1])
    return judged("heat flux over theory", flux / expected, 1.0, 4.0 * error)


@extreme("frozen-walls", "walls at kT = 10⁻³⁰⁰", may_refuse=ANY)
def frozen_walls(trial: Trial) -> Verdict:
    """Enclose a gas in walls at hardly any temperature: they take all energy, or it is refused."""
    gas = trial.gas(50, (10.0,) * 3, walls=(HeatBath(1e-300),) * 6)
    before, refusal = sum(gas.energy()), ""
    for until in (10.0, 1e3, 1e5) if trial.exact else (10.0, 1e3):
        try:
            trial.run(gas, until)
        except StalledError as stalled:
            refusal = str(stalled)
    left = sum(gas.energy()) / before
    if left > 0.9:
        return wrong(f"{left:.3g} of the energy is left")
    if refusal and "warm it" not in refusal:
        return wrong(f"the refusal does not say what to change: {refusal}")
    return Verdict("refused", refusal) if refusal else judged("energy left", left, 0.0, 0.9)


@extreme("no-temperature", "walls at kT = 0, −1, NaN, ∞")
def no_temperature(trial: Trial) -> Verdict:
    """Give a heat bath no temperature above zero: it is refused by the name of the wall."""
    verdict = wrong("nothing was tried")
    for kT in (0.0, -1.0, math.nan, math.inf):
        walls = (_S, _S, _S, _S, HeatBath(kT), _S)
        verdict = trial.refused(lambda walls=walls: trial.gas(2, (5.0,) * 3, walls=walls), "kT of wall z_low")  # type: ignore[misc]
        if not verdict.passed:
            break
    return verdict


@extreme("three-walls-at-once", "into a corner")
def corner(trial: Trial) -> Verdict:
    """Run a molecule into a corner: it hits three walls at the same time and comes back on its own path."""
    box = trial.box([[5, 5, 5]], [[1, 1, 1]], length=(10, 10, 10))
    trial.run(box, 9.0)
    here = box.snapshot()
    if here.velocity.tolist() != [[-1.0, -1.0, -1.0]]:
        return wrong(f"it leaves with {here.velocity[0].tolist()}")
    off = float(np.abs(here.position - (14.0 - box.time)).max())
    if off > 1e-9:
        return wrong(f"it is {off:.3g} from where it should be")
    return judged("hits", int(box.wall_hits.sum()), 3, 0)


@extreme("edge-for-ever", "along an edge, 10⁴ times")
def edge(trial: Trial) -> Verdict:
    """Run a molecule into an edge ten thousand times: it stays on the diagonal that leads there."""
    box = trial.box([[2, 2, 5]], [[1, 1, 0.1]], length=(10, 10, 10))
    trial.run(box, 90_000.0)
    (x, y, _), (u, v, _) = box.snapshot().position[0], box.snapshot().velocity[0]
    if u != v or abs(x - y) > 1e-9:
        return wrong(f"it is {abs(x - y):.3g} off the diagonal")
    return judged("hits of wall x_high", int(box.wall_hits[1]), 5_000, 1)


@extreme("thousand-crossings", "10³ crossings between two looks")
def fast(trial: Trial) -> Verdict:
    """Look away while molecules cross the box thousands of times: they stay inside and keep their energy."""
    gas = trial.gas(20, (5.0,) * 3, kT=1e6)
    before = sum(gas.energy())
    for k in range(1, 4):
        trial.run(gas, 5.0 * k)
    if gas.wall_hits.min() < 5_000:
        return wrong(f"only {gas.wall_hits.min()} hits of a wall")
    return judged("change of the energy", sum(gas.energy()) / before - 1.0, 0.0, 1e-12)
