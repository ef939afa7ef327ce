"""Time: very long runs, clocks that read large numbers, runs cut into pieces."""

import math

import numpy as np

from atmosbox.engine import HeatBath, Parcel, Piston, Specular
from atmosbox.engine.core.marching import MarchingParcel
from atmosbox.trade.extremes.extreme import extreme
from atmosbox.trade.extremes.guarded_run import Trial
from atmosbox.trade.extremes.law import by_chance
from atmosbox.trade.extremes.verdict import Verdict, judged, wrong

_S = Specular()


def _wound(parcel: Parcel, time: float) -> float:
    """Let a parcel that has not begun read a later time on its clock; return what it reads."""
    if isinstance(parcel, MarchingParcel):
        parcel._step = round(time / parcel.time_step)
        parcel._now = parcel._step * parcel.time_step
    else:
        parcel._walls.epoch[0] = 2.0 ** round(math.log2(time))
    return parcel.time


@extreme("clock-at-1e9", "t = 10⁹ on the clock")
def late_clock(trial: Trial) -> Verdict:
    """Start with a clock that reads a thousand million: the run goes the way of one that starts at zero."""
    boxes = [trial.gas(64, (8.0,) * 3, diameter=0.8) for _ in range(2)]
    began = _wound(boxes[1], 1e9)
    steps = 400
    pace = boxes[0].time_step if isinstance(boxes[0], MarchingParcel) else 0.025
    trial.run(boxes[0], steps * pace)
    trial.run(boxes[1], began + steps * pace)
    if boxes[0].contacts < 20:
        return wrong(f"only {boxes[0].contacts} contacts")
    if by_chance(boxes[0]):
        one, other = boxes[0].contacts, boxes[1].contacts
        what = "contacts, over those with a clock that starts at 0; chance takes another way"
        return judged(what, other / one, 1.0, 4.0 * math.sqrt(1.0 / one + 1.0 / other))
    apart = np.abs(boxes[0].snapshot().position - boxes[1].snapshot().position).max()
    # what the reading of the end of the run is rounded to, times the speed of the fastest
    allowed = 10.0 * float(np.spacing(began))
    return judged("difference from a clock that starts at 0", float(apart), 0.0, allowed)


def _for_ever(trial: Trial, until: float) -> Verdict:
    where = [[2, 5, 5], [7, 5.3, 5.2], [5, 2, 8]]
    velocity = [[0.13, 0.07, 0.03], [-0.11, -0.02, 0.09], [0.03, 0.08, -0.1]]
    box = trial.box(where, velocity, length=(10, 10, 10))
    before = sum(box.energy())
    for k in range(1, 11):
        trial.run(box, 0.1 * k * until)
    hits = int(box.wall_hits.sum()) + box.contacts
    if hits < 0.01 * until:
        return wrong(f"only {hits} events")
    # rounding is a random walk: a drift would grow with the number of events and not with its root
    drift = abs(sum(box.energy()) / before - 1.0)
    return judged(f"drift of the energy until t = {until:.0e}", drift, 0.0, 1e-14 * math.sqrt(hits))


@extreme("long-run", "t = 10⁶")
def long_run(trial: Trial) -> Verdict:
    """Run for a million units of time: three molecules are inside, apart, and have their energy."""
    return _for_ever(trial, 1e6)


@extreme("longer-run", "t = 10⁹", long=True)
def longer_run(trial: Trial) -> Verdict:
    """Run for a thousand million units of time (in steps, ten million): three molecules have kept their energy."""
    return _for_ever(trial, 1e9 if trial.exact else 1e7)


def _mixed(trial: Trial) -> Parcel:
    number = 100
    baths = (HeatBath(1.2), HeatBath(0.8, 0.5), _S, _S, _S)
    if trial.engine == "classic":
        return trial.gas(number, (8.0,) * 3, seed=8, diameter=0.7, walls=(*baths, _S), gravity=0.1)
    return trial.gas(
        number, (8.0,) * 3, seed=8, diameter=0.7, walls=(*baths, Piston(0.05)), rotation=2,
        rotational_energy=np.ones(number), collision_number=3.0, gravity=0.1,
    )  # fmt: skip


@extreme("cut-into-pieces", "cut into 100 pieces")
def pieces(trial: Trial) -> Verdict:
    """Cut a run into pieces and look at it: it is the same to the last bit."""
    whole, cut = trial.run(_mixed(trial), 20.0), _mixed(trial)
    for time in np.sort(np.random.default_rng(9).random(100)) * 20.0:
        trial.run(cut, float(time))
        cut.energy()
    trial.run(cut, 20.0)
    if whole.contacts < 200:
        return wrong(f"only {whole.contacts} contacts")
    one, other = whole.snapshot(), cut.snapshot()
    same = one.position.tobytes() == other.position.tobytes() and one.velocity.tobytes() == other.velocity.tobytes()
    same &= whole.wall_heat.tobytes() == cut.wall_heat.tobytes() and whole.events == cut.events
    return judged("whether all bits agree", float(same), 1.0, 0.0)
