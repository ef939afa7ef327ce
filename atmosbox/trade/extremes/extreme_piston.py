"""Pistons: one that crushes, one that outruns, one that flies away."""

import math

import numpy as np

from atmosbox.engine import Piston, Specular, StalledError
from atmosbox.trade.extremes.extreme import extreme
from atmosbox.trade.extremes.guarded_run import Trial
from atmosbox.trade.extremes.verdict import Verdict, judged, wrong

_S = Specular()


def _pressed(trial: Trial, number: int, diameter: float, speed: float, until: float) -> Verdict:
    options = {"dt": 0.02} if trial.engine == "stepped" and not diameter else {}
    walls = (_S,) * 5 + (Piston(-speed),)
    gas = trial.gas(number, (6.0, 6.0, 12.0), diameter=diameter, walls=walls, options=options)
    try:
        trial.run(gas, until)
    except StalledError as stalled:
        sentence = str(stalled)
        if "the piston has come down" not in sentence:
            return wrong(f"the refusal does not name the piston: {sentence}")
        if gas.time > until:
            return wrong(f"refused at t = {gas.time:g}, beyond what was asked")
        return Verdict("refused", sentence)
    return wrong(f"the ceiling stands at {gas.ceiling:g}, and nothing was said")


@extreme("crushing-piston", "a piston that crushes", may_refuse=("classic",))
def crushing(trial: Trial) -> Verdict:
    """Let a piston come down on a hundred spheres: it is stopped, in a sentence, before it would crush them."""
    return _pressed(trial, 100, 1.0, 2.0, 7.0)


@extreme("piston-on-points", "a piston on points", may_refuse=("classic",))
def points(trial: Trial) -> Verdict:
    """Let a piston come down on points: it is stopped, in a sentence, at a thousandth of the box."""
    return _pressed(trial, 100, 0.0, 0.5, 30.0)


@extreme("supersonic-piston", "a piston of Mach 10⁶", may_refuse=("classic",))
def supersonic(trial: Trial) -> Verdict:
    """Sweep up points at rest: they leave with twice the velocity of the piston, and its work is theirs."""
    number, speed = 500, 1e6
    rng = np.random.default_rng(4)
    where = rng.random((number, 3)) * [6.0, 6.0, 12.0]
    walls = (_S,) * 5 + (Piston(-speed),)
    options = {"dt": 0.1 / speed} if trial.engine == "stepped" else {}
    gas = trial.box(where, np.zeros((number, 3)), length=(6, 6, 12), walls=walls, diameter=0.0, options=options)
    # within this time nobody who was hit can have come back from the floor
    trial.run(gas, 3.0 / speed)
    swept = int(np.sum(where[:, 2] > gas.ceiling))
    return judged("work over that of the molecules swept up", gas.work / (2.0 * speed**2 * swept), 1.0, 1e-9)


@extreme("fleeing-piston", "a piston that flies away", may_refuse=("stepped", "classic"))
def fleeing(trial: Trial) -> Verdict:
    """Let a piston fly away faster than any molecule: the gas expands into nothing and keeps its energy."""
    gas = trial.gas(100, (6.0, 6.0, 10.0), walls=(_S,) * 5 + (Piston(1e6),))
    before = sum(gas.energy())
    for k in range(1, 6):
        trial.run(gas, 50.0 * k)
    if not math.isclose(gas.ceiling, 10.0 + 1e6 * gas.time, rel_tol=1e-12):
        return wrong(f"the ceiling stands at {gas.ceiling:g}")
    return judged("change of the energy", sum(gas.energy()) / before - 1.0, 0.0, 1e-12)
