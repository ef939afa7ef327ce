"""Gravity: none, and so much that all lie on the floor."""

import math

import numpy as np

from atmosbox.engine import HeatBath, Specular, lattice_positions
from atmosbox.trade.extremes.extreme import ANY, extreme
from atmosbox.trade.extremes.guarded_run import Trial
from atmosbox.trade.extremes.law import by_chance, euler_heat, heat_made, step_of
from atmosbox.trade.extremes.verdict import Verdict, degraded, judged, wrong

_S = Specular()


@extreme("nothing-moves", "g = 0, T = 0")
def nothing_moves(trial: Trial) -> Verdict:
    """Wait where nothing moves and nothing pulls: nothing happens, for as long as one likes."""
    number, length = 100, (10.0, 10.0, 10.0)
    where = lattice_positions(length, np.ones(number))
    box = trial.box(where, np.zeros((number, 3)), length=length)
    until = min(1e9, 1e4 * step_of(box) or math.inf)  # whoever goes in steps goes ten thousand
    trial.run(box, until)
    return judged(
        f"furthest that a molecule has gone until t = {until:.2g}", float(np.abs(box.snapshot().position - where).max())
    )


def _weighed(trial: Trial, gravity: float) -> Verdict:
    """Return the verdict on molecules pulled to the floor: its impulse less the ceiling's is weight and momentum."""
    number = 100
    tall = 1e8 if trial.engine == "classic" else 100.0  # so that nobody sees the ceiling
    gas = trial.gas(number, (10.0, 10.0, tall), top=10.0, gravity=gravity)
    before, falling = sum(gas.energy()), float(gas.snapshot().velocity[:, 2].sum())
    trial.run(gas, max(20.0 / math.sqrt(gravity), 100.0 * step_of(gas)))
    if gas.wall_hits[4] < 100:
        return wrong(f"only {gas.wall_hits[4]} hits of the floor")
    if (off := abs((sum(gas.energy()) - heat_made(gas)) / before - 1.0)) > 1e-9:
        return wrong(f"energy is off by {off:.2g}")
    pushed = float(gas.wall_impulse[4] - gas.wall_impulse[5])
    weight = number * gravity * gas.time
    gained = float(gas.snapshot().velocity[:, 2].sum()) - falling
    rounding = 1e-12 * max(1.0, abs(pushed) / weight, abs(gained) / weight)
    carried = (pushed - gained) / weight
    if heat_made(gas):
        return (
            euler_heat(gas)
            if abs(carried - 1.0) <= rounding
            else wrong(f"the floor carries {carried:.6g} of the weight")
        )
    return judged("impulse of the floor over weight times time", carried, 1.0, rounding)


@extreme("strong-gravity", "mgσ/kT = 10³")
def strong_gravity(trial: Trial) -> Verdict:
    """Pull a thousand times too strongly: energy is kept, and the floor carries the weight."""
    return _weighed(trial, 1e3)


@extreme("crushing-gravity", "mgσ/kT = 10⁶")
def crushing_gravity(trial: Trial) -> Verdict:
    """Pull so strongly that all lie on the floor: energy is kept, and the floor carries the weight."""
    return _weighed(trial, 1e6)


@extreme("ball-at-rest", "at rest on the floor", may_refuse=ANY)
def ball_at_rest(trial: Trial) -> Verdict:
    """Put a ball at rest on the floor, where it bounces without end and without height: it rests, or is refused."""
    box = trial.box([[5.0, 5.0, 0.5]], np.zeros((1, 3)), length=(10, 10, 10), gravity=1.0)
    trial.run(box, 10.0)
    if heat_made(box):
        return euler_heat(box)
    return judged("height above the floor", float(box.snapshot().position[0, 2]) - 0.5, 0.0, 1e-9)


@extreme("stack-at-rest", "three in a stack, at rest", may_refuse=ANY)
def stack_at_rest(trial: Trial) -> Verdict:
    """Stack three balls at rest: they rest, or are refused; they neither sink nor heat."""
    where = [[5.0, 5.0, 0.5], [5.0, 5.0, 1.5], [5.0, 5.0, 2.5]]
    box = trial.box(where, np.zeros((3, 3)), length=(10, 10, 10), gravity=1.0)
    trial.run(box, 10.0)
    if heat_made(box):
        return euler_heat(box)
    gone, step = float(np.abs(box.snapshot().position - where).max()), step_of(box)
    if by_chance(box):
        return degraded(
            "falls, as its molecules take no room; change of the energy", sum(box.energy()) / 4.5 - 1.0, 0.0, 1e-12
        )
    if step:
        return degraded("furthest that one has gone: they tremble by the falls of some steps", gone, 0.0, 4.0 * step**2)
    return judged("furthest that one has gone", gone, 0.0, 1e-9)


@extreme("bouncing-ball", "10³ bounces")
def bouncing_ball(trial: Trial) -> Verdict:
    """Drop a ball: it comes back to its height after every one of a thousand bounces."""
    height = 4.0
    bounces = 10 if trial.engine == "classic" else 1000  # before the energy that it makes takes the ball to the ceiling
    box = trial.box([[5, 5, 0.5 + height]], np.zeros((1, 3)), length=(10, 10, 100), gravity=1.0)
    period = 2.0 * math.sqrt(2.0 * height)
    trial.run(box, bounces * period)
    if heat_made(box):
        return euler_heat(box)
    if box.wall_hits[4] not in (bounces - 1, bounces):
        return wrong(f"{box.wall_hits[4]} bounces in the time of {bounces}")
    # each step may round by half of the last digit, and always to the same side
    rounding = max(1e-12, 1e-16 * box.time / step_of(box)) if step_of(box) else 1e-12
    return judged("energy over what it was", sum(box.energy()) / (0.5 + height), 1.0, rounding)


@extreme("tall-column", "10⁷ scale heights", may_refuse=("dsmc",))
def tall_column(trial: Trial) -> Verdict:
    """Take a box much taller than its atmosphere: it costs no memory, and its ceiling is never hit."""
    gas = trial.gas(100, (6.0, 6.0, 6e8), top=60.0, gravity=1.0)
    before = sum(gas.energy())
    trial.run(gas, 100.0)
    if gas.memory() > 10_000_000 or gas.wall_hits[5]:
        return wrong(f"{gas.memory()} bytes for 100 molecules, {gas.wall_hits[5]} hits of the ceiling")
    if heat_made(gas):
        return euler_heat(gas)
    return judged("change of the energy", sum(gas.energy()) / before - 1.0, 0.0, 1e-12)


@extreme("cold-floor", "floor at kT = 10⁻³⁰⁰", may_refuse=ANY)
def cold_floor(trial: Trial) -> Verdict:
    """Cool the floor so far that bounces pile up without end: all lie down, or it is refused."""
    gas = trial.gas(50, (10.0,) * 3, gravity=1.0, walls=(_S, _S, _S, _S, HeatBath(1e-300), _S))
    trial.run(gas, 1000.0 if trial.exact else 100.0)
    return judged("kinetic energy that is left", gas.energy()[0] / 50.0, 0.0, 0.01)
