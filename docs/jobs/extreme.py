"""What breaks simulations: all engines in extreme cases, a ball under nine integrators, contacts that are missed."""

import math
import warnings
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from jobs.drawing import BLUE, axes_of, explain, save, sheet
from jobs.registry import Findings, job, rounded

from atmosbox import theory
from atmosbox.engine import Periodic, maxwell_velocities, random_positions
from atmosbox.scene.engines import choose, names
from tests.extremes.cases import FAMILIES, LONG, Outcome, Run, hold

Array = np.ndarray


def cell(found: Outcome, words: str) -> str:
    """Return what a cell of the table says; ``words`` are those of a refusal."""
    if found.kind != "off":
        return f"refused: {words}" if found.kind == "refused" else "right"
    value, expected, within = found.reading
    if not expected:
        return f"**off by {rounded(value)}**"
    percent = rounded(100.0 * found.error)
    return f"**off by {percent} %**" if abs(value - expected) > within else f"known to {rounded(100.0 * within)} %"


@job("extremes")
def extremes(found: Findings) -> None:
    """Run all engines in all extreme cases that do not take minutes, and hold each to what the tests hold it to."""
    rows: list[list[str]] = []
    for family, cases in FAMILIES.items():
        rows.append([f"**{family}**", *[""] * len(names())])
        for case in (each for each in cases if each.name not in LONG):
            cells = []
            for engine in names():
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")  # that a step is too long
                    try:
                        cells.append(cell(hold(case, Run(engine)), getattr(case, engine)))
                    except AssertionError as fault:
                        found.failures.append(f"{engine}, {case.name}: {fault}")
            rows.append([case.name, *cells])
    found.table(["case", *(f"`{name}`" for name in names())], rows)


def seen_share(delta: float) -> float:
    r"""Return the share of the contacts of a thin gas that an engine with steps of δ diameters sees.

    Of all pairs that come closer by :math:`x` diameters in a step it is :math:`1 - x^2 / 3` for :math:`x \le 1` and
    :math:`2 / 3 x` beyond; this is its mean over the relative speeds u of pairs that meet, :math:`u^3 \exp(-m u^2 / 4 k
    T)`.
    """
    a = 0.5 / delta
    fast = math.exp(-a * a)
    slow = 1.0 - (1.0 + a * a) * fast - 8.0 / 3.0 * delta**2 * (1.0 - (1.0 + a * a + 0.5 * a**4) * fast)
    return slow + (2.0 * fast / delta + 2.0 * math.sqrt(math.pi) * math.erfc(a)) / (12.0 * delta)


class Integrator(NamedTuple):
    """A way of computing a ball: one step of its fall, the rule of its floor, and its drift in units of m g² Δt."""

    name: str
    fall: Callable[[Array, Array, float], tuple[Array, Array]]
    floor: str
    law: float


def explicit(z: Array, v: Array, dt: float) -> tuple[Array, Array]:
    return z + v * dt, v - dt


def kick_first(z: Array, v: Array, dt: float) -> tuple[Array, Array]:
    v = v - dt
    return z + v * dt, v


def verlet(z: Array, v: Array, dt: float) -> tuple[Array, Array]:
    middle = v - 0.5 * dt
    return z + middle * dt, middle - 0.5 * dt


def midpoint(z: Array, v: Array, dt: float) -> tuple[Array, Array]:
    return z + (v - 0.5 * dt) * dt, v - dt


def parabola(z: Array, v: Array, dt: float) -> tuple[Array, Array]:
    return z + v * dt - 0.5 * dt * dt, v - dt


INTEGRATORS = (
    Integrator("Euler, flip", explicit, "flip", 0.5),
    Integrator("Euler, mirror", explicit, "mirror", 1.0),
    Integrator("Euler, undo", explicit, "undo", 1.0),
    Integrator("semi-implicit Euler, flip", kick_first, "flip", -0.5),
    Integrator("leapfrog, flip", kick_first, "leapfrog", -0.5),
    Integrator("midpoint, mirror", midpoint, "mirror", 0.5),
    Integrator("exact parabola, mirror", parabola, "mirror", 0.5),
    Integrator("velocity Verlet, flip", verlet, "flip", 0.0),
    Integrator("exact parabola, flip", parabola, "flip", 0.0),
)
"""In units of the height of the drop and of g; energies per mass."""


def energies(integrator: Integrator, height: Array, dt: float, steps: int, every: int) -> Array:
    """Return the energy of balls that are dropped from some heights, over what it was: (time, ball)."""
    z, v = height.copy(), np.zeros_like(height)
    staggered = integrator.floor == "leapfrog"
    if staggered:
        v += 0.5 * dt
    kept = [np.ones_like(height)]
    for step in range(1, steps + 1):
        old = z
        z, v = integrator.fall(z, v, dt)
        below = (z < 0.0) & (v < 0.0)
        if integrator.floor == "mirror":
            z = np.where(below, -z, z)
        elif integrator.floor == "undo":
            z = np.where(below, old, z)
        v = np.where(below, -v, v)
        if step % every == 0:
            speed = v - 0.5 * dt if staggered else v
            kept.append((0.5 * speed**2 + z) / height)
    return np.array(kept)


@job("bouncing-ball")
def bouncing_ball(found: Findings) -> None:
    """Drop four hundred balls under nine integrators and compare the drift of their energy with its law."""
    dt, steps, every, balls = 0.01 * math.sqrt(2.0), 8000, 20, 400
    height = np.random.default_rng(5).uniform(0.9, 1.1, balls)
    time = dt * every * np.arange(steps // every + 1)
    found.number("step", "1/100")
    curves, rows = [], []
    for integrator in INTEGRATORS:
        energy = energies(integrator, height, dt, steps, every)
        curves.append(energy)
        change = float(np.mean((energy[-1] - 1.0) * height) / (dt * time[-1]))
        # a bounce more or less at either end of the run, each of the drift of one period
        if abs(change - integrator.law) > 0.02:
            found.failures.append(f"{integrator.name}: {change:.4g}, but the law says {integrator.law:g}")
        rows.append([integrator.name, rounded(change, 3), f"{integrator.law:g}".replace("-", "−")])
    found.table(["integrator and floor", "drift of the energy, measured [m g² Δt]", "law"], rows)
    fall = math.sqrt(2.0)
    with sheet((9.0, 7.4)) as drawing:
        axes = drawing.subplots(3, 3, sharex=True, sharey=True)
        for axis, integrator, energy in zip(axes.flat, INTEGRATORS, curves, strict=True):
            axis.plot(time / fall, energy[:, :4], lw=0.7, color=BLUE, alpha=0.5)
            axis.plot([], [], lw=0.7, color=BLUE, alpha=0.8, label="four balls")
            axis.plot(time / fall, energy.mean(axis=1), color=BLUE, lw=2.4, label="mean of 400")
            axis.plot(time / fall, 1.0 + integrator.law * dt * time, "--", color="#1a1a1a", lw=1.4, label="law")
            sign = {0.0: "0", 1.0: "m g² Δt"}.get(integrator.law, f"{'−' if integrator.law < 0 else ''}½ m g² Δt")
            axis.set_title(integrator.name)
            axis.text(0.05, 0.87, f"law: {sign}", transform=axis.transAxes)
            axis.set_ylim(-0.1, 2.9)
        axes[0, 0].legend(loc="lower left", frameon=False, fontsize=9)
        for axis in axes[-1]:
            axis.set_xlabel("time, in times of the first fall")
        for axis in axes[:, 0]:
            axis.set_ylabel("energy over that at the start")
        save(found, drawing, "bouncing-ball")


def contacts_seen(engine: str, delta: float, contacts: float) -> tuple[float, float]:
    """Return contacts over theory in a thin gas, and the standard error of counting them."""
    number, packing = 500, 0.005
    side = (number * math.pi / 6.0 / packing) ** (1.0 / 3.0)
    rng = np.random.default_rng(round(1e4 * delta))
    gas = choose(engine).make(
        random_positions((side,) * 3, np.ones(number), rng, periodic=(True,) * 3),
        maxwell_velocities(1.0, np.ones(number), rng, exact=True),
        length=(side,) * 3,
        walls=(Periodic(),) * 6,
        seed=1,
    )
    rate = 0.5 * (number - 1) * float(theory.collision_rate(number / side**3, 1.0, 1.0, 1.0))
    gas.advance(20.0 * delta)
    before, time = gas.contacts, gas.time
    gas.advance(time + contacts / (rate * seen_share(delta)))
    met = gas.contacts - before
    return met / (rate * (gas.time - time)), math.sqrt(met) / (rate * (gas.time - time))


@job("tunnelling")
def tunnelling(found: Findings) -> None:
    """Count the contacts that steps of all lengths see."""
    deltas, points = (0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 6.4), []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that these steps are too long is what is to be seen
        for delta in deltas:
            share, error = contacts_seen(f"stepped:delta={delta:g}", delta, 4000.0)
            points.append((share, error))
            found.agree(f"stepped, δ = {delta:g}", share, error, seen_share(delta))
    delta = np.geomspace(0.02, 50.0, 300)
    with axes_of(1, (7.0, 4.8)) as (drawing, (axis,)):
        axis.plot(delta, [seen_share(each) for each in delta], color="#1a1a1a", label="law for all steps")
        small = delta[delta < 0.58]
        axis.plot(small, 1.0 - 8.0 / 3.0 * small**2, ":", color="#595959", label="1 − 8δ²/3")
        large = delta[delta > 0.32]
        axis.plot(large, math.sqrt(math.pi) / 6.0 / large, "--", color="#595959", label="√π / 6δ")
        shares, errors = np.array(points).T
        axis.errorbar(deltas, shares, errors, fmt="o", color=BLUE, capsize=3, label="stepped")
        axis.set(
            title="The longer the step, the fewer contacts it sees",
            xlabel="δ, length of a step in diameters at thermal speed",
            ylabel="contacts over those of kinetic theory",
            xscale="log",
            yscale="log",
            xlim=(0.02, 50.0),
            ylim=(0.004, 2.0),
        )
        axis.legend(loc="lower left")
        explain(drawing)
        save(found, drawing, "tunnelling")
