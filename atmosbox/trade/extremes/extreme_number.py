"""How many: none, one, two, three, a million."""

import math

import numpy as np

from atmosbox import theory
from atmosbox.engine import HeatBath
from atmosbox.engine.core.measure import layer_sample, temperature
from atmosbox.trade.extremes.extreme import extreme
from atmosbox.trade.extremes.guarded_run import Trial
from atmosbox.trade.extremes.law import by_chance, judged_contacts, step_of
from atmosbox.trade.extremes.verdict import Verdict, degraded, judged, wrong

_SIDE = 6.0


@extreme("no-molecules", "N = 0")
def no_molecules(trial: Trial) -> Verdict:
    """Let time pass in an empty box: it has no energy and no temperature, and nothing is divided by zero."""
    nobody = np.zeros((0, 3))
    box = trial.box(nobody, nobody, length=(4, 4, 4), gravity=1.0, walls=(HeatBath(1.0),) * 6)
    trial.run(box, 10.0)
    if not math.isnan(temperature(box, box.snapshot())) or layer_sample(box, box.snapshot(), 3).number.any():
        return wrong("an empty box has a temperature, or molecules in its layers")
    return judged("energy of an empty box", sum(box.energy()), 0.0, 0.0)


@extreme("one-molecule", "N = 1")
def one_molecule(trial: Trial) -> Verdict:
    """Keep one molecule between six walls: it pushes them as its speed and the room say, to one hit."""
    speed, length, time = 0.7, 10.0, 1000.0
    box = trial.box([[3.0, 4.0, 5.0]], [[speed, 0.31, 0.17]], length=(length,) * 3)
    trial.run(box, time)
    force = float(box.wall_impulse[1]) / box.time
    expected = speed**2 / (length - 1.0)
    return judged("force of one molecule on one wall", force, expected, 2.0 * speed / box.time)


def _few(trial: Trial, number: int) -> Verdict:
    where = [[1.5, 2.0, 3.5], [4.5, 2.5, 1.5], [2.0, 5.0, 1.0]][:number]
    velocity = np.random.default_rng(7).standard_normal((number, 3))
    box = trial.box(where, velocity, length=(_SIDE,) * 3, walls=(HeatBath(1.0),) * 6, seed=number)
    trial.run(box, 100.0)
    before, time = box.contacts, box.time
    trial.run(box, 20_100.0)
    counted = box.contacts - before
    free = (_SIDE - 1.0,) * 3
    pairs = 0.5 * number * (number - 1)
    expected = pairs * 4.0 * math.sqrt(math.pi) / math.prod(free) * (box.time - time)
    if not by_chance(box):
        # walls are in the way of some contacts, and centres keep a sphere of one diameter clear of each other
        closed = 4.0 / 3.0 * math.pi * (1.0 - 3.0 / 8.0 * sum(1.0 / side for side in free)) / math.prod(free)
        expected *= 2.0 * theory.contact_share(free, 1.0, 2) / (1.0 - closed)
    tolerance = 4.0 * math.sqrt(expected) + 0.02 * expected
    return judged_contacts(box, f"contacts of {number} molecules", counted, expected, tolerance)


@extreme("two-molecules", "N = 2")
def two_molecules(trial: Trial) -> Verdict:
    """Keep two molecules between heat baths: they meet as often as two of a gas would."""
    return _few(trial, 2)


@extreme("three-molecules", "N = 3")
def three_molecules(trial: Trial) -> Verdict:
    """Keep three molecules, the fewest that can meet at once, between heat baths: they meet as theory says."""
    return _few(trial, 3)


def _all_pairs(trial: Trial) -> Verdict:
    """Return the verdict on an engine that tests all pairs in every step."""
    number = 2000
    gas = trial.gas(number, (28.0,) * 3)
    trial.run(gas, 10.0 * step_of(gas))
    tested = getattr(gas, "pair_tests", 0) / (0.5 * number * (number - 1) * gas.time / step_of(gas))
    what = "pairs tested in a step over N (N − 1) / 2, of 2000 molecules; a million would have 5·10¹¹"
    return degraded(what, tested, 1.0, 1e-12)


@extreme("million", "N = 10⁶", long=True)
def million(trial: Trial) -> Verdict:
    """Take a million molecules: they meet as often as theory says, and none takes more memory than one of few."""
    if trial.engine == "classic":
        return _all_pairs(trial)
    number = 1_000_000
    side = (number * math.pi / 6.0 / 0.01) ** (1.0 / 3.0)
    box = trial.gas(number, (side,) * 3)
    trial.run(box, 2.0)  # pushed apart at the start, they must first forget it
    before, time = box.contacts, box.time
    trial.run(box, 4.0)
    density = number / (side - 1.0) ** 3
    rate = 0.5 * number * float(theory.collision_rate(density, 1.0, 1.0, 1.0)) * (box.time - time)
    if by_chance(box):
        expected = rate / float(theory.contact_value(theory.packing_fraction(density, 1.0)))
    else:
        expected = rate * theory.contact_share([side - 1.0] * 3, 1.0, number)
    each = box.memory() / number
    if each > 400.0:
        return wrong(f"a molecule takes {each:.0f} bytes of memory")
    counted = box.contacts - before
    what = f"contacts; {each:.0f} bytes a molecule"
    return judged_contacts(box, what, counted, expected, 4.0 * math.sqrt(expected) + 0.005 * expected)
