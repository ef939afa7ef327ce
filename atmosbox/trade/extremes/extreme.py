"""The table of extremes, boxes that are difficult to simulate: what is built, what is measured, what is expected."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from atmosbox import theory
from atmosbox.engine import Drops, HeatBath, Mist, Piston, Pool, RandomBath, SquareWell
from atmosbox.engine import lattice_positions as sites
from atmosbox.trade.extremes.extreme_box import BATHS, CURVED, OPEN, SMOOTH, Box, at, crystal, gas, moist, orbit
from atmosbox.trade.extremes.guarded_run import GuardedRun
from atmosbox.trade.extremes.probe import (
    Probe,
    alike,
    comes_to,
    contacts,
    cooled,
    curved,
    emptiness,
    energy,
    force,
    heat,
    hits,
    parted,
    pressure,
    refused,
    stopped,
    swept,
    vapour,
    weight,
    wells,
)
from atmosbox.trade.extremes.verdict import Reading

__all__ = ["EXTREMES", "FAMILIES", "Extreme"]

INF, NAN = math.inf, math.nan
RNG = np.random.default_rng(3)


@dataclass(frozen=True)
class Extreme:
    """One row of the assessment.

    Parameters
    ----------
    name
        Its name: words joined by hyphens.
    title
        Its title in a table.
    asked
        The task of the engine, and the correct result, in a sentence.
    probe
        Function that builds the boxes, lets time pass and returns the measured number.
    long
        Whether it takes longer than some seconds.
    """

    name: str
    title: str
    asked: str
    probe: Probe
    long: bool = False


def side_of(packing: float, number: int = 256) -> float:
    """Return the side of the cube in which molecules of diameter 1 have a packing fraction."""
    return float((number * math.pi / 6.0 / packing) ** (1.0 / 3.0))


def crystal_factor(packing: float) -> float:
    """Return Z of the face-centred cubic crystal of hard spheres (Speedy 1998, J. Phys.: Condens. Matter 10, 4387)."""
    share = packing / (math.pi / math.sqrt(18.0))
    return 3.0 / (1.0 - share) - 0.5921 * (share - 0.7072) / (share - 0.601)


def dense(packing: float, finer: float = 0.0) -> Probe:
    """Return a probe of the pressure of a fluid or, above the freezing density, of a crystal.

    ``finer`` is the step of stepped in place of the usual one [diameters].
    """
    if packing > 0.494:
        return pressure(crystal(256, side_of(packing)), crystal_factor(packing), 2.0, 1.0)
    options = {"stepped": {"delta": finer}} if finer else {}
    new = gas(256, side_of(packing), walls=OPEN, options=options)
    return pressure(new, float(theory.compressibility_factor(packing)), 10.0, 2.0)


def coarse(step: float) -> Probe:
    """Return a probe of the contacts in a thin gas, with a step in diameters or, for dsmc, in mean free times."""
    options = {"stepped": {"delta": step}, "dsmc": {"dt": step}}
    return contacts(gas(256, side_of(0.01), walls=OPEN, options=options), 100.0, 4000.0, slack=0.005)


def many(run: GuardedRun) -> Reading:
    """Count the contacts of a million molecules."""
    return contacts(gas(1_000_000, side_of(0.01, 1_000_000)), 2.0, 2.0, slack=0.005)(run)


def pushed(*speed: float) -> Any:
    """Return velocities along x, one molecule for each speed."""
    return [[u, 0.0, 0.0] for u in speed]


def pair(x: float, speeds: tuple[float, float] = (0.0, 0.0), **box: Any) -> Box:
    """Return a box of side 4 with two molecules, one at x = 1."""
    return at([[1, 2, 2], [x, 2, 2]], pushed(*speeds), (4, 4, 4), **box)


def impossible() -> list[tuple[Box, str]]:
    """Return boxes with impossible numbers, each with the word, or its first letters, that the refusal must contain."""
    bad: dict[str, tuple[Any, ...]] = {
        "mass": (0, -1, NAN, INF, "x", None),
        "diameter": (-1, NAN, INF, "x", None),
        "gravity": (-1, NAN, INF, "x", None),
        "length": ((1, 2), (4, 4, 0), (4, 4, NAN), (4, 4, INF), "x", None),
        "collision_number": (0.5, -1, NAN, "x", None),
        "layers": (0, 2.5, NAN, "x", None),
        "seed": (-1, 1.5, NAN, "x", None),
        "position": ([[NAN, 2, 2], [3, 2, 2]], [[INF, 2, 2], [3, 2, 2]], [[1, 2], [3, 2]], None),
        "velocity": ([[NAN, 0, 0], [0, 0, 0]], [[INF, 0, 0], [0, 0, 0]], None),
    }
    good = {"position": [[1, 2, 2], [3, 2, 2]], "velocity": pushed(1, -1), "length": (4, 4, 4)}
    cases = [good | {name: value} for name, values in bad.items() for value in values]
    names = [name[:7] for name, values in bad.items() for _ in values]
    boxes = [at(box.pop("position"), box.pop("velocity"), **box) for box in cases]
    return list(zip(boxes, names, strict=True))


def mixed(number: int, few: int, rare: float, usual: float) -> Any:
    """Return a property of molecules that is ``rare`` for the first few and ``usual`` for the others."""
    return np.where(np.arange(number) < few, rare, usual)


GAPS = (1e-15, 1e-12, 1e-9, 1e-6)
MISSES = (0.0, 1e-16, -1e-16, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9)
THREE = [[2, 5, 5], [7, 5.3, 5.2], [5, 2, 8]], [[0.13, 0.07, 0.03], [-0.11, -0.02, 0.09], [0.03, 0.08, -0.1]]
FEW = [[1.5, 2.0, 3.5], [4.5, 2.5, 1.5], [2.0, 5.0, 1.0]]
PLACES = np.array([[2.0, 5, 5], [5, 5, 5], [8, 5, 5]])
ORDERS = [list(order) for order in itertools.permutations(range(3))]
GRID = (1.0 + 2.0 * np.stack(np.meshgrid(*[np.arange(4.0)] * 3), axis=-1).reshape(-1, 3)).astype("f4")
SPEEDS = RNG.standard_normal(GRID.shape).astype("f4")
ORBIT = orbit(1.5, 0.1)
COLD, DOWN = HeatBath(1e-300), (*SMOOTH[:5],)
MIXED: dict[str, Any] = {"seed": 8, "diameter": 0.7, "walls": (*OPEN[:4], HeatBath(1.2), HeatBath(0.8, 0.5))}


def drawn(range: float, warmth: float) -> Probe:
    """Return a probe of the pressure of a thin gas with attraction; its virial coefficients give the expected value."""
    density = 6.0 / math.pi * 0.01
    well: dict[str, Any] = {"well": SquareWell(range, 1.0 / warmth), "bath": RandomBath(1.0, 1.0)}
    factor = float(theory.square_well_compressibility(density, warmth, range))
    return pressure(gas(256, side_of(0.01), walls=OPEN, **well), factor, 50.0, 50.0)


def one_drop(waters: int, vapour: int = 0, **liquid: Any) -> Box:
    """Return a box with one drop with a curvature effect; saturated vapour at 95 degC is 40 molecules in it."""
    return moist(Drops, 95.0, 40.0, waters, vapour=vapour, drops=1, **CURVED | liquid)


def few(number: int) -> Box:
    """Return a box of two or three molecules between heat baths."""
    return at(FEW[:number], np.random.default_rng(7).standard_normal((number, 3)), (6, 6, 6), walls=BATHS, seed=number)


FAMILIES: Mapping[str, tuple[Extreme, ...]] = {
    "steps": (
        Extreme("step-of-a-quarter", "steps of σ / 4",
            "Step so far that a contact in six is missed.", coarse(0.25)),
        Extreme("step-of-ten-diameters", "steps of 10 σ",
            "Step so far that molecules pass through each other: they meet as theory says, or it is refused.",
            coarse(10.0)),
        Extreme("step-of-the-box", "steps of 40 boxes",
            "Step so far that molecules pass through the box dozens of times.", coarse(1000.0)),
    ),
    "how many": (
        Extreme("no-molecules", "N = 0",
            "Let time pass in an empty box: it has no energy and no temperature, and nothing is divided by zero.",
            emptiness(at(np.zeros((0, 3)), length=(4, 4, 4), gravity=1.0, walls=BATHS), 10.0)),
        Extreme("one-molecule", "N = 1",
            "Keep one molecule between six walls: it pushes them as its speed and the length of its way say.",
            force(at([[3.0, 4.0, 5.0]], [[0.7, 0.31, 0.17]]), 1000.0, 0.7)),
        Extreme("two-molecules", "N = 2",
            "Keep two molecules between heat baths: they meet as often as two of a gas would.",
            contacts(few(2), 100.0, 600_000.0, slack=0.02)),
        Extreme("three-molecules", "N = 3",
            "Keep three molecules, the fewest that can meet at once: they meet as theory says.",
            contacts(few(3), 100.0, 200_000.0, slack=0.02)),
        Extreme("million", "N = 10⁶",
            "Take a million molecules: each meets others as theory says.",
            many, long=True),
    ),
    "how dense": (
        Extreme("packing-0.49", "φ = 0.49",
            "Press spheres together until they almost freeze: they press as the equation of state says.",
            dense(0.49)),
        Extreme("packing-0.49-fine", "φ = 0.49, steps of σ / 250",
            "The same in steps of a tenth of the mean free path, which is a twenty-fourth of a diameter here.",
            dense(0.49, finer=0.004)),
        Extreme("packing-0.58", "φ = 0.58",
            "Start a lattice where a fluid would be a glass: it stays a crystal and presses as one.", dense(0.58)),
        Extreme("packing-0.64", "φ = 0.64",
            "Start a lattice at the density of random close packing: it stays a crystal and presses as one.",
            dense(0.64)),
        Extreme("packing-0.75", "φ = 0.75",
            "Ask for more than the 0.7405 of space that any packing of spheres fills: it is refused.",
            refused([(gas(256, side_of(0.75), walls=OPEN), "no packing of spheres")])),
    ),
    "how unlike": (
        Extreme("mass-ratio", "masses 1 : 10⁶",
            "Mix molecules with others a million times as heavy: they meet as theory says.",
            contacts(gas(100, 12.0, mass=mixed(100, 10, 1e6, 1.0), walls=OPEN), 10.0, 1500.0)),
        Extreme("count-of-pi", "masses 1 : 100ᵏ at a wall",
            "Push a light ball to a wall with a heavy one: the hits are the digits of π (Galperin 2003).",
            hits([at([[5, 5, 5], [8, 5, 5]], pushed(0, -1), (300, 10, 10), mass=[1.0, 100.0**k]) for k in range(4)],
                 100.0, (3, 31, 314, 3141))),
        Extreme("size-ratio", "sizes 1 : 100",
            "Mix molecules with others a hundred times as large: they meet as the theory of mixtures says.",
            contacts(gas(400, 40.0, diameter=mixed(400, 4, 10.0, 0.1), walls=OPEN), 5.0, 4000.0, distance=5.05,
                     coarsely=60.0)),
    ),
    "walls": (
        Extreme("hot-and-cold", "walls at kT = 10⁶ and 1",
            "Put points between walls of kT = 10⁶ and 1: they carry the heat of a formula that is exact.",
            heat(gas(200, 1.0, few=20, diameter=0.0, walls=(HeatBath(1e6), HeatBath(1.0), *SMOOTH[:4]),
                     options={"stepped": {"dt": 2e-5}}), 1e6, 5.0, 200.0)),
        Extreme("frozen-walls", "walls at kT = 10⁻³⁰⁰",
            "Enclose a gas in walls at hardly any temperature: they take all energy, or it is refused.",
            cooled(gas(50, 10.0, walls=(COLD,) * 6), (10.0, 1e3), "warm it")),
        Extreme("no-temperature", "walls at kT = 0, −1, NaN, ∞",
            "Give a heat bath no temperature above zero: it is refused by the name of the wall.",
            refused([(gas(2, 5.0, walls=(*SMOOTH[:4], HeatBath(kT), SMOOTH[5])), "kT of wall z_low")
                     for kT in (0.0, -1.0, NAN, INF)])),
        Extreme("three-walls-at-once", "into a corner",
            "Run a molecule into a corner: it hits three walls at the same time and comes back on its own path.",
            comes_to([at([[5, 5, 5]], [[1, 1, 1]])], 9.0, position=[[[5, 5, 5]]], velocity=[[[-1, -1, -1]]],
                     tolerance=1e-9)),
        Extreme("edge-for-ever", "along an edge, 10⁴ times",
            "Run a molecule into an edge ten thousand times: it comes back to its place on the diagonal.",
            comes_to([at([[2, 2, 5]], [[1, 1, 0.1]])], 90_000.0, position=[[[2, 2, 5]]], velocity=[[[1, 1, 0.1]]],
                     tolerance=1e-6)),
        Extreme("thousand-crossings", "10³ crossings between two samples",
            "Let molecules cross the box thousands of times between two samples: they keep their energy.",
            energy(gas(20, 5.0, kT=1e6), 15.0, pieces=3, events=30_000)),
    ),
    "gravity": (
        Extreme("nothing-moves", "g = 0, T = 0",
            "Wait where nothing moves and nothing pulls: nothing happens.",
            comes_to([at(sites((10, 10, 10), np.ones(100)))], 1e3, position=[sites((10, 10, 10), np.ones(100))],
                     tolerance=0.0)),
        Extreme("strong-gravity", "mgσ/kT = 10³",
            "Pull a thousand times too strongly: energy is kept, and the floor carries the weight.",
            weight(gas(100, 10.0, 10.0, 100.0, top=10.0, gravity=1e3), 0.6)),
        Extreme("crushing-gravity", "mgσ/kT = 10⁶",
            "Pull so strongly that all lie on the floor: energy is kept, and the floor carries the weight.",
            weight(gas(100, 10.0, 10.0, 100.0, top=10.0, gravity=1e6), 0.02)),
        Extreme("ball-at-rest", "at rest on the floor",
            "Put a ball at rest on the floor, where bounces have no height and no end: it rests, or is refused.",
            comes_to([at([[5.0, 5.0, 0.5]], gravity=1.0)], 10.0, position=[[[5.0, 5.0, 0.5]]], tolerance=1e-9)),
        Extreme("stack-at-rest", "three in a stack, at rest",
            "Stack three balls at rest: they rest, or are refused; they neither sink nor heat.",
            comes_to([at([[5.0, 5.0, z] for z in (0.5, 1.5, 2.5)], gravity=1.0)], 10.0,
                     position=[[[5.0, 5.0, z] for z in (0.5, 1.5, 2.5)]], tolerance=1e-9)),
        Extreme("bouncing-ball", "10³ bounces",
            "Drop a ball: it has its energy after a thousand bounces.",
            energy(at([[5, 5, 4.5]], length=(10, 10, 100), gravity=1.0), 1000.0 * math.sqrt(32.0), events=10,
                   tolerance=1e-10)),
        Extreme("tall-column", "10⁷ scale heights",
            "Take a box much taller than its atmosphere: it costs no memory.",
            energy(gas(100, 6.0, 6.0, 6e8, top=60.0, gravity=1.0), 100.0)),
        Extreme("cold-floor", "floor at kT = 10⁻³⁰⁰",
            "Cool the floor so far that bounces pile up without end: all lie down, or it is refused.",
            cooled(gas(50, 10.0, gravity=1.0, walls=(*OPEN[:4], COLD, SMOOTH[5])), (100.0,), "warm it")),
    ),
    "contacts": (
        Extreme("hair-gap", "gap of 10⁻¹⁵ σ",
            "Put two molecules 10⁻¹⁵ to 10⁻⁶ diameters apart: they meet when they have crossed the gap.",
            comes_to([at([[4, 5, 5], [5 + gap, 5, 5]], pushed(1, -1)) for gap in GAPS], 1.0,
                     position=[[[4 + (5 + gap) - 4 - 2, 5, 5], [6, 5, 5]] for gap in GAPS],
                     velocity=[pushed(-1, 1)] * 4, tolerance=1e-14)),
        Extreme("grazing", "grazing by 10⁻¹⁶ to 10⁻⁹",
            "Let two molecules just touch in passing: they change as little as the root of the overlap.",
            comes_to([at([[2, 5, 5], [6, 6 * (1 + off), 5]], pushed(1, 0), (20, 20, 20)) for off in MISSES], 8.0,
                     velocity=[pushed(1, 0)] * 9, per=[math.sqrt(12.0 * abs(off) + 1e-15) for off in MISSES],
                     tolerance=2.0)),
        Extreme("cradle", "Newton's cradle",
            "Let balls run into a row of others that touch: as many leave on one side as come on the other.",
            comes_to([at([[2.0 + i + (2.0 if i >= n else 0.0), 5, 5] for i in range(5)],
                         pushed(*[1.0] * n, *[0.0] * (5 - n)), (20, 10, 10)) for n in range(1, 5)], 4.0,
                     velocity=[pushed(*[0.0] * (5 - n), *[1.0] * n) for n in range(1, 5)])),
        Extreme("hit-from-both-sides", "hit from both sides at once",
            "Hit a ball from both sides at the same time: two go back and it stays, in whatever order they are.",
            comes_to([at(PLACES[order], np.array(pushed(1, 0, -1))[order]) for order in ORDERS], 3.0,
                     velocity=[np.array(pushed(-1, 0, 1))[order] for order in ORDERS])),
        Extreme("lattice", "a lattice, all at the same time",
            "Start a lattice where everything happens at the same time: energy is kept.",
            energy(at(sites((12, 12, 12), np.ones(256)),
                      np.where(np.arange(256)[:, None] % 2 == 0, 1.0, -1.0) * np.ones((256, 3)), (12, 12, 12)),
                   50.0, events=100)),
    ),
    "starts": (
        Extreme("touching-start", "in contact at the start",
            "Start with two molecules in contact: the one that presses hands its velocity on at once.",
            comes_to([pair(2.0, (1.0, 0.0))], 1.0, velocity=[pushed(0, 1)])),
        Extreme("overlapping-start", "overlap at the start",
            "Start with two molecules that overlap: they are refused.",
            parted([pair(1.5, (1.0, -1.0)), at([[0.2, 2, 2], [3.8, 2, 2]], pushed(-1, 1), (4, 4, 4), walls=OPEN)],
                   "molecules 0 and 1")),
        Extreme("outside-start", "outside at the start",
            "Start with a molecule that reaches through a wall: it is refused by the name of the wall.",
            refused([(at([place], length=(4, 4, 4)), wall) for place, wall in
                     (([-1, 2, 2], "x_low"), ([2, 3.6, 2], "y_high"), ([2, 2, 0.4], "z_low"))])),
        Extreme("no-numbers", "NaN, ∞, words, wrong signs",
            "Give what is no number, or none that a box can have: it is refused by its name.",
            refused(impossible())),
        Extreme("single-precision", "float32 arrays",
            "Give arrays of single precision: the run is that of the same numbers in double precision.",
            alike(at(GRID, SPEEDS, (9, 9, 9), diameter=np.ones(64, "f4")),
                  at(GRID.astype("f8"), SPEEDS.astype("f8"), (9, 9, 9)), 20.0)),
    ),
    "pistons": (
        Extreme("crushing-piston", "a piston that crushes",
            "Let a piston come down on a hundred spheres: it is stopped, in a sentence, before it crushes them.",
            stopped(gas(100, 6.0, 6.0, 12.0, walls=(*DOWN, Piston(-2.0))), 7.0, "the piston has come down")),
        Extreme("piston-on-points", "a piston on points",
            "Let a piston come down on points: it is stopped, in a sentence, before the box is gone.",
            stopped(gas(100, 6.0, 6.0, 12.0, diameter=0.0, walls=(*DOWN, Piston(-0.5)),
                        options={"stepped": {"dt": 0.02}}), 30.0, "the piston has come down")),
        Extreme("supersonic-piston", "a piston of Mach 10⁶",
            "Sweep up points at rest: they leave with twice the velocity of the piston, and its work is theirs.",
            swept(at(np.random.default_rng(4).random((500, 3)) * [6.0, 6.0, 12.0], length=(6, 6, 12),
                     walls=(*DOWN, Piston(-1e6)), diameter=0.0, options={"stepped": {"dt": 1e-7}}), 1e6)),
        Extreme("fleeing-piston", "a piston that flies away",
            "Let a piston fly away faster than any molecule: the gas expands into nothing, with its energy.",
            energy(gas(100, 6.0, 6.0, 10.0, walls=(*DOWN, Piston(1e6))), 250.0, pieces=5)),
    ),
    "time": (
        Extreme("clock-at-1e9", "t = 10⁹ on the clock",
            "Start with a clock that reads a thousand million: the run is that of one that starts at zero.",
            alike(gas(500, 14.0, diameter=0.8), gas(500, 14.0, diameter=0.8), 100.0, later=1e9)),
        Extreme("long-run", "t = 10⁶",
            "Run for a million units of time: rounding makes no more error than a random walk.",
            energy(at(*THREE), 1e6, pieces=10, events=10_000, tolerance=3e-12)),
        Extreme("longer-run", "t = 10⁹",
            "Run for 10⁹ units of time (in steps, 10⁷): rounding makes no more error than a random walk.",
            lambda run: energy(at(*THREE), 1e9 if run.exact else 1e7, pieces=10, events=100_000, tolerance=1e-10)(run),
            long=True),
        Extreme("cut-into-pieces", "cut into 100 pieces",
            "Cut a run into pieces and take samples: it is the same to the last bit.",
            alike(gas(100, 8.0, gravity=0.1, **MIXED), gas(100, 8.0, gravity=0.1, **MIXED), 20.0, cuts=100)),
    ),
    "attraction": (
        Extreme("wells-of-no-depth", "depth 0",
            "Let molecules attract each other by nothing: they meet as often as hard spheres.",
            contacts(gas(256, side_of(0.01), walls=OPEN, well=SquareWell(1.5, 0.0)), 100.0, 2000.0, slack=0.005)),
        Extreme("wells-of-a-million", "depth 10⁶ kT",
            "Let molecules fall into wells a million times as deep as they are warm: energy is kept.",
            energy(gas(108, 10.0, walls=OPEN, seed=2, well=SquareWell(1.5, 1e6)), 0.1, pieces=3, events=1000)),
        Extreme("narrow-wells", "range 1.01 σ, T* = 0.3",
            "Let the wells end a hundredth of a diameter from contact: the gas presses as its virial coefficients say.",
            drawn(1.01, 0.3)),
        Extreme("wide-wells", "range 2 σ, T* = 2",
            "Let the wells reach twice as far as the molecules: the gas presses as its virial coefficients say.",
            drawn(2.0, 2.0)),
        Extreme("hot-wells", "T* = 100",
            "Let molecules be far too fast for their wells: they press as its virial coefficients say.",
            drawn(1.5, 100.0)),
        Extreme("cold-wells", "T* = 0.3",
            "Cool a gas far below the temperature at which it condenses: it warms itself, and energy is kept.",
            energy(gas(200, 12.0, kT=0.3, walls=OPEN, well=SquareWell()), 60.0, pieces=3, events=1000)),
        Extreme("orbit-in-a-well", "two in a well, 10³ rounds",
            "Let two molecules circle in their well on a square: after a thousand rounds they are where they were.",
            comes_to([at(*ORBIT, well=SquareWell(1.5, 1.0))], 1e4, position=[ORBIT[0]], velocity=[ORBIT[1]],
                     tolerance=1e-9)),
        Extreme("crystal-of-wells", "a crystal of wells",
            "Start a crystal whose wells reach the nearest neighbours alone: each molecule stays in twelve of them.",
            wells(crystal(256, side_of(0.68), well=SquareWell(1.25, 4.0)), 20.0, 12.0)),
    ),
    "water": (
        Extreme("one-molecule-of-water", "one molecule of water alone",
            "Keep one molecule of water in a mist without air: it is vapour nine tenths of the time.",
            vapour(moist(Mist, 20.0, 9.0, 1, air=0), 20.0, 1, 30_000.0)),
        Extreme("all-water", "all water",
            "Take the air away: the vapour alone has the saturation pressure.",
            vapour(moist(Mist, 20.0, 100.0, 300, vapour=100, air=0), 20.0, 300, 1000.0)),
        Extreme("water-at-minus-60", "−60 °C",
            "Cool liquid water to −60 °C: the vapour has the saturation pressure.",
            vapour(moist(Mist, -60.0, 40.0, 120), -60.0, 120, 2000.0)),
        Extreme("water-at-95", "95 °C",
            "Heat water almost to its boiling point: the vapour has the saturation pressure.",
            vapour(moist(Mist, 95.0, 40.0, 120), 95.0, 120, 2000.0)),
        Extreme("touching-drops", "drops that touch",
            "Put two drops in contact: water and energy are conserved, and the vapour has the right number.",
            vapour(moist(Drops, 95.0, 40.0, 120), 95.0, 120, 20_000.0)),
        Extreme("drying-pool", "a pool that dries out",
            "Give a pool a box that holds a hundred times as much vapour: all of it evaporates.",
            vapour(moist(Pool, 20.0, 4000.0, 40, nuclei=50.0), 20.0, 40, 1000.0)),
        Extreme("supersaturation-10", "supersaturation 10",
            "Start with ten times as much vapour as saturated air has: nine tenths condense.",
            vapour(moist(Mist, 20.0, 40.0, 400, vapour=400), 20.0, 400, 2000.0)),
        Extreme("drop-of-pure-water", "one drop, no salt",
            "Let a drop feel its curvature: the vapour beside it has the right number, by counting states.",
            curved(one_drop(220), 40.0, 0.0, 20_000.0)),
        Extreme("drop-of-salt", "one drop, 10⁹ ions",
            "Give a drop a million ions for each molecule of water: it takes all vapour.",
            curved(one_drop(220, vapour=100, dissolved=(1e9,)), 40.0, 1e9, 20_000.0)),
        Extreme("drop-in-tenfold-vapour", "one drop, supersaturation 10",
            "Start with ten times as much vapour as a flat surface leaves: the drop leaves as many as counting says.",
            curved(one_drop(460, vapour=400), 40.0, 0.0, 20_000.0)),
        Extreme("surface-beyond-binding", "a surface that costs more than it binds",
            "Give a drop so large a tension that its first molecule is not bound: it is refused.",
            refused([(one_drop(220, surface_tension=100.0), "surface_tension")])),
    ),
}  # fmt: skip
"""The extremes by subject."""

EXTREMES: Mapping[str, Extreme] = {each.name: each for family in FAMILIES.values() for each in family}
"""The extremes by name."""
