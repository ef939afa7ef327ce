"""Contacts: nearly touching, grazing, many at exactly the same time."""

import itertools
import math

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.engine import Parcel, lattice_positions
from atmosbox.trade.extremes.extreme import extreme
from atmosbox.trade.extremes.guarded_run import Trial
from atmosbox.trade.extremes.law import by_chance, step_of
from atmosbox.trade.extremes.verdict import Verdict, degraded, judged, wrong


def _alike(one: ArrayLike, other: ArrayLike) -> bool:
    return bool(np.allclose(one, other, rtol=0.0, atol=1e-12))


def _left_to_chance(box: Parcel, energy: float) -> Verdict:
    """Return the verdict on an engine that lets molecules meet by chance: of mechanics it keeps the energy."""
    return degraded(
        "who meets whom is left to chance; change of the energy", sum(box.energy()) / energy - 1.0, 0.0, 1e-13
    )


@extreme("hair-gap", "gap of 10⁻¹⁵ σ")
def hair_gap(trial: Trial) -> Verdict:
    """Put two molecules a hair apart, 10⁻¹⁵ diameters: they meet when they have crossed it."""
    worst = 0.0
    for gap in (1e-15, 1e-12, 1e-9, 1e-6):
        box = trial.box([[4, 5, 5], [5 + gap, 5, 5]], [[1, 0, 0], [-1, 0, 0]], length=(10, 10, 10))
        apart = (5 + gap) - 4 - 1
        trial.run(box, 1.0)
        here = box.snapshot()
        if by_chance(box):
            return _left_to_chance(box, 1.0)
        if not _alike(here.velocity[:, 0], [-1.0, 1.0]):
            return wrong(f"with a gap of {gap:g} they leave with {here.velocity[:, 0].tolist()}")
        worst = max(worst, abs(float(here.position[0, 0]) - (4.0 + apart - box.time)))
    if late := step_of(box):
        return degraded("error of a position after a contact seen up to a step too late", worst, 0.0, 2.000001 * late)
    return judged("error of a position after the contact", worst, 0.0, 1e-14)


@extreme("grazing", "grazing by 10⁻¹⁶ to 10⁻⁹")
def grazing(trial: Trial) -> Verdict:
    """Let two molecules just touch in passing: they hardly change, seen to touch or not."""
    worst = 0.0
    for off in (0.0, 1e-16, -1e-16, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9):
        box = trial.box([[2, 5, 5], [6, 6 * (1 + off), 5]], [[1, 0, 0], [0, 0, 0]], length=(20, 20, 20))
        trial.run(box, 8.0)
        if by_chance(box):
            return _left_to_chance(box, 0.5)
        change = float(np.abs(box.snapshot().velocity - [[1, 0, 0], [0, 0, 0]]).max())
        # the impulse of a grazing contact goes with the root of what they overlap
        worst = max(worst, change / math.sqrt(12.0 * abs(off) + 1e-15))
        if (drift := abs(sum(box.energy()) - 0.5)) > 1e-14:
            return wrong(f"energy is off by {drift:.2g}")
    return judged("change of a velocity over the root of the overlap", worst, 0.0, 2.0)


@extreme("cradle", "Newton's cradle")
def cradle(trial: Trial) -> Verdict:
    """Let balls run into a row of others that touch: as many leave on one side as come on the other."""
    right = 0
    for moving in range(1, 5):
        x = [[2.0 + i + (2.0 if i >= moving else 0.0), 5.0, 5.0] for i in range(5)]
        v = [[1.0 if i < moving else 0.0, 0.0, 0.0] for i in range(5)]
        box = trial.run(trial.box(x, v, length=(20, 10, 10)), 4.0)
        if by_chance(box):
            return _left_to_chance(box, 0.5 * moving)
        right += _alike(box.snapshot().velocity[:, 0], [0.0] * (5 - moving) + [1.0] * moving)
    return judged("cradles of four that do as Newton's", right, 4, 0)


@extreme("hit-from-both-sides", "hit from both sides at once")
def both_sides(trial: Trial) -> Verdict:
    """Hit a ball from both sides at the same time: the two go back and it stays, in whatever order they are told."""
    where = np.array([[2.0, 5, 5], [5, 5, 5], [8, 5, 5]])
    velocity = np.array([[1.0, 0, 0], [0, 0, 0], [-1.0, 0, 0]])
    right = 0
    for order in itertools.permutations(range(3)):
        box = trial.box(where[list(order)], velocity[list(order)], length=(10, 10, 10))
        trial.run(box, 3.0)
        if by_chance(box):
            return _left_to_chance(box, 1.0)
        right += _alike(box.snapshot().velocity[np.argsort(order), 0], [-1.0, 0.0, 1.0])
    return judged("orders of six that come out right", right, 6, 0)


@extreme("lattice", "a lattice, all at the same time")
def lattice(trial: Trial) -> Verdict:
    """Start a lattice where everything happens at the same time: energy is kept, twice in the same way."""
    number, side = 256, 12.0
    where = lattice_positions((side,) * 3, np.ones(number))
    velocity = np.where(np.arange(number)[:, None] % 2 == 0, 1.0, -1.0) * np.ones((number, 3))
    boxes = [trial.run(trial.box(where, velocity, length=(side,) * 3), 50.0) for _ in range(2)]
    if boxes[0].contacts < 100:
        return wrong(f"only {boxes[0].contacts} contacts")
    if (boxes[0].snapshot().position != boxes[1].snapshot().position).any():
        return wrong("the same start ends twice in different ways")
    return judged("change of the energy", sum(boxes[0].energy()) / (1.5 * number) - 1.0, 0.0, 1e-12)
