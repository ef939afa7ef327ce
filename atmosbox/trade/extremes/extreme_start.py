"""Starts: in contact, overlapping, outside, in single precision, and with numbers that are none."""

import math
from typing import Any

import numpy as np

from atmosbox.engine import Periodic
from atmosbox.trade.extremes.extreme import extreme
from atmosbox.trade.extremes.guarded_run import Trial, deepest_overlap
from atmosbox.trade.extremes.law import by_chance
from atmosbox.trade.extremes.verdict import Verdict, degraded, judged, wrong

_GOOD: dict[str, Any] = {
    "position": [[1, 2, 2], [3, 2, 2]],
    "velocity": [[1, 0, 0], [-1, 0, 0]],
    "length": (4, 4, 4),
}
_NO_NUMBERS: dict[str, tuple[Any, ...]] = {
    "mass": (0, -1, math.nan, math.inf, "x", None),
    "diameter": (-1, math.nan, math.inf, "x", None),
    "gravity": (-1, math.nan, math.inf, "x", None),
    "length": ((1, 2), (4, 4, 0), (4, 4, math.nan), (4, 4, math.inf), "x", None),
    "collision_number": (0.5, -1, math.nan, "x", None),
    "layers": (0, 2.5, math.nan, "x", None),
    "seed": (-1, 1.5, math.nan, "x", None),
    "position": ([[math.nan, 2, 2], [3, 2, 2]], [[math.inf, 2, 2], [3, 2, 2]], [[1, 2], [3, 2]], None),
    "velocity": ([[math.nan, 0, 0], [0, 0, 0]], [[math.inf, 0, 0], [0, 0, 0]], None),
}


@extreme("touching-start", "in contact at the start")
def touching(trial: Trial) -> Verdict:
    """Start with two molecules in contact: the one that presses hands its velocity on at once."""
    box = trial.box([[1, 2, 2], [2, 2, 2]], [[1, 0, 0], [0, 0, 0]], length=(4, 4, 4))
    trial.run(box, 1.0)
    if by_chance(box):
        return degraded("who meets whom is left to chance; change of the energy", sum(box.energy()) - 0.5, 0.0, 1e-13)
    return judged("velocity handed on", float(box.snapshot().velocity[1, 0]), 1.0, 1e-12)


@extreme("overlapping-start", "overlap at the start")
def overlapping(trial: Trial) -> Verdict:
    """Start with two molecules that overlap: they are refused, or part and keep their energy."""
    still, open_box = np.zeros((2, 3)), (Periodic(),) * 6
    if trial.engine in ("dsmc", "classic"):
        box = trial.box([[1, 2, 2], [1.5, 2, 2]], [[1, 0, 0], [-1, 0, 0]], length=(4, 4, 4))
        trial.run(box, 0.75)
        apart = deepest_overlap(box) <= 0.0 or by_chance(box)
        if not apart:
            return wrong("a pair that overlaps at the start does not come apart")
        return degraded("accepted, and comes apart; change of the energy", sum(box.energy()) - 1.0, 0.0, 1e-13)
    across = trial.refused(
        lambda: trial.box([[0.2, 2, 2], [3.8, 2, 2]], still, length=(4, 4, 4), walls=open_box), "molecules 0 and 1"
    )
    if not across.passed:
        return across
    return trial.refused(lambda: trial.box([[1, 2, 2], [1.5, 2, 2]], still, length=(4, 4, 4)), "molecules 0 and 1")


@extreme("outside-start", "outside at the start")
def outside(trial: Trial) -> Verdict:
    """Start with a molecule that reaches through a wall: it is refused by the name of the wall."""
    verdict = wrong("nothing was tried")
    for place, wall in (([-1, 2, 2], "x_low"), ([2, 3.6, 2], "y_high"), ([2, 2, 0.4], "z_low")):
        verdict = trial.refused(lambda x=place: trial.box([x], [[0, 0, 0]], length=(4, 4, 4)), wall)  # type: ignore[misc]
        if not verdict.passed:
            break
    return verdict


@extreme("no-numbers", "NaN, ∞, words, wrong signs")
def no_numbers(trial: Trial) -> Verdict:
    """Give what is no number, or none that a box can have: it is refused by its name."""
    verdict, tried = wrong("nothing was tried"), 0
    for name, values in _NO_NUMBERS.items():
        for value in values:
            box = _GOOD | {name: value}
            position, velocity = box.pop("position"), box.pop("velocity")
            verdict = trial.refused(lambda x=position, v=velocity, b=box: trial.box(x, v, **b), name[:7])  # type: ignore[misc]
            if not verdict.passed:
                return wrong(f"{name} = {value!r}: {verdict.sentence}")
            tried += 1
    return Verdict("refused", f"all of {tried}, each by its name; the last: {verdict.sentence}")


@extreme("single-precision", "float32 arrays")
def single_precision(trial: Trial) -> Verdict:
    """Give arrays of single precision: the run is the same as that of the same numbers in double precision."""
    rng = np.random.default_rng(3)
    x = (1.0 + 2.0 * np.stack(np.meshgrid(*[np.arange(4.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)).astype("f4")
    v = rng.standard_normal(x.shape).astype("f4")
    single = trial.run(trial.box(x, v, length=(9, 9, 9), diameter=np.ones(len(x), "f4")), 20.0)
    double = trial.run(trial.box(x.astype("f8"), v.astype("f8"), length=(9, 9, 9)), 20.0)
    if single.contacts < 20:
        return wrong(f"only {single.contacts} contacts")
    return judged(
        "difference from the same numbers in double precision",
        float(np.abs(single.snapshot().position - double.snapshot().position).max()),
    )
