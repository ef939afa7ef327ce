"""The extreme cases, as one table: a box, what is measured in it, and what each engine must do.

For each engine a case says what must hold. 0: the number is right, within chance and rounding, and known to 5 %. A
number: the known error, relative to what is expected (to 1 where that is 0), which may not grow. A text: the case is
refused in a sentence with these words.

What is impossible from the start is refused in tests/engine/test_refusals.py; extremes of attraction, water and drops
are in tests/physics.
"""

import itertools
import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from atmosbox import theory
from atmosbox.engine import HeatBath, Periodic, Piston, RefusedError, Specular, StalledError, random_positions
from atmosbox.engine import lattice_positions as sites
from atmosbox.engine import maxwell_velocities as maxwell
from atmosbox.engine.core.marching import MarchingParcel
from atmosbox.errors import SettingError
from atmosbox.scene.engines import choose
from atmosbox.scene.statistics import block_average

OPEN, SMOOTH, BATHS = (Periodic(),) * 6, (Specular(),) * 6, (HeatBath(1.0),) * 6
ROUNDING = 1e-9
"""Largest distance outside the box [sides] and largest overlap of a pair [diameters]."""
LIMIT = 600.0
"""Processor time after which a run counts as one without an end [s]; the longest takes a tenth of it."""


class Reading(NamedTuple):
    """A number, what mechanics or kinetic theory expects, and how far chance and rounding may take it."""

    value: float
    expected: float = 0.0
    within: float = 0.0


class Run:
    """The boxes of one engine, with checks of everything that no engine may violate."""

    def __init__(self, engine, make=None, limit=LIMIT):
        self.engine, self.exact, self.limit = engine, engine == "exact", limit
        self.make = make or (lambda own, *arrays, **box: replace(choose(engine), options=own).make(*arrays, **box))

    def box(self, position, velocity, options=None, **box):
        """Return a box; ``options`` are those of engines, by name."""
        return self.checked(self.make((options or {}).get(self.engine, {}), position, velocity, **box))

    def advance(self, box, until):
        """Let time pass, and assert that it has passed, in a finite time, and that the state is lawful."""
        began = time.thread_time()

        def watch(now):
            assert time.thread_time() - began <= self.limit, f"hangs: not at t = {until:g}, but at {now:g}"

        try:
            box.advance(until, watch)
        finally:
            self.checked(box)
        slack = 1e-9 * max(abs(until), step_of(box))
        assert -step_of(box) - slack <= box.time - until <= slack, f"asked for t = {until:g}, it is at {box.time:g}"
        return box

    def checked(self, box):
        """Assert that nothing is lost, no number is infinite, and the energy is conserved; return the box."""
        here = box.snapshot()
        assert len(here.position) == len(here.velocity) == box.number, "molecules are lost"
        for numbers in (*here, box.energy(), box.wall_impulse, box.wall_heat, box.work, box.virial, box.ceiling):
            assert np.isfinite(numbers).all(), "a number is not finite"
        radius = np.where(box.periodic, 0.0, 0.5 * box.diameter[:, None])
        out = np.maximum(radius - here.position, here.position - (box.length - radius)) / box.length
        assert out.max(initial=-1.0) <= ROUNDING, "a molecule is outside"
        assert box.ledger() <= 1e-10, "the energy budget does not close"
        assert box.memory() <= 10_000_000 + 400 * box.number, "it takes too much memory"
        if self.exact and box.number <= 500:
            i, j = np.triu_indices(box.number, 1)
            apart = here.position[i] - here.position[j]
            apart -= np.where(box.periodic, box.length * np.rint(apart / box.length), 0.0)
            deep = 0.5 * (box.diameter[i] + box.diameter[j]) * (1.0 - ROUNDING) - np.sqrt(np.sum(apart**2, axis=1))
            assert deep.max(initial=-1.0) <= 0.0, "molecules overlap"
        return box


def step_of(box):
    """Return the length of a step [time]; 0 for an engine without steps."""
    return box.time_step if isinstance(box, MarchingParcel) else 0.0


# Functions that return a function of a run, which builds a box.


def at(position, velocity=None, length=(10, 10, 10), **box):
    """Put molecules at given positions, at rest unless velocities are given."""
    speeds = np.zeros(np.shape(position)) if velocity is None else velocity
    return lambda run: run.box(position, speeds, length=length, **box)


def gas(number, *sides, kT=1.0, top=None, walls=SMOOTH, seed=1, mass=1.0, diameter=1.0, **box):
    """Put molecules at random positions, below ``top``; one side makes a cube."""
    length = sides * 3 if len(sides) == 1 else sides

    def build(run):
        rng = np.random.default_rng(seed)
        sizes, masses = (np.broadcast_to(np.asarray(each, float), number) for each in (diameter, mass))
        where = random_positions(length, sizes, rng, periodic=(walls is OPEN,) * 3, top=top)
        facts = {"length": length, "walls": walls, "seed": seed, "mass": mass, "diameter": diameter}
        return run.box(where, maxwell(kT, masses, rng, exact=True), **facts, **box)

    return build


def along_x(*speeds):
    """Return velocities along x, one molecule for each speed."""
    return [[u, 0.0, 0.0] for u in speeds]


def side_of(packing, number=256):
    """Return the side of the cube in which molecules of diameter 1 have a packing fraction."""
    return float((number * math.pi / 6.0 / packing) ** (1.0 / 3.0))


# Functions that return a function of a run, which measures.


def comes_to(boxes, until, position=None, velocity=None, per=None, within=1e-12):
    """Compare positions and velocities at a time with those of mechanics; ``per`` are units, one for each box."""

    def read(run):
        worst = 0.0
        for k, new in enumerate(boxes):
            box = run.advance(new(run), until)
            here, off = box.snapshot(), 0.0
            if velocity is not None:
                off = np.abs(here.velocity - velocity[k]).max(initial=0.0)
            if position is not None:  # an engine with steps stops at the last whole step before the time
                moved = 0.0 if velocity is None else (box.time - until) * np.asarray(velocity[k], float)
                off = max(off, np.abs(here.position - np.asarray(position[k]) - moved).max(initial=0.0))
            worst = max(worst, off / per[k] if per else off)
        return Reading(worst, 0.0, within)

    return read


def hits(boxes, until, expected):
    """Count hits of walls and contacts: return the first wrong count, or else the last."""

    def read(run):
        ran = [run.advance(new(run), until) for new in boxes]
        counts = [box.contacts + int(box.wall_hits.sum()) for box in ran]
        off = [k for k in range(len(counts)) if counts[k] != expected[k]] or [-1]
        return Reading(counts[off[0]], expected[off[0]])

    return read


def energy(new, until, pieces=1, events=0, within=1e-12, left=1.0):
    """Compare the energy with that at the start; with ``left=0`` the energy of motion, which cold walls must take."""

    def read(run):
        box, parts = new(run), slice(None if left else 1)
        before = sum(box.energy()[parts])
        for k in range(1, pieces + 1):
            run.advance(box, until * k / pieces)
        assert box.contacts + box.wall_hits.sum() >= events
        return Reading(sum(box.energy()[parts]) / before, left, within)

    return read


def weight(new, until):
    """Compare the force on the floor with the weight of the molecules, whose energy must be conserved."""

    def read(run):
        box = new(run)
        before, falling = sum(box.energy()), box.snapshot().velocity[:, 2].sum()
        run.advance(box, max(until, 100.0 * step_of(box)))
        assert box.wall_hits[4] >= 100
        assert abs(sum(box.energy()) / before - 1.0) <= 1e-9
        pushed, weighed = box.wall_impulse[4] - box.wall_impulse[5], box.mass.sum() * box.gravity * box.time
        gained = box.snapshot().velocity[:, 2].sum() - falling
        rounding = 1e-12 * max(1.0, abs(pushed) / weighed, abs(gained) / weighed)
        return Reading((pushed - gained) / weighed, 1.0, rounding)

    return read


def contacts(new, settle, until, within=0.02, coarsely=None):
    """Compare the number of contacts with kinetic theory, for one or two kinds of molecules.

    ``within`` is the relative error of the theory; ``coarsely`` replaces ``until`` for an engine with short steps.
    """

    def read(run):
        box = new(run)
        step = step_of(box)
        run.advance(box, max(settle, 20.0 * step))
        before, time = box.contacts, box.time
        run.advance(box, time + (max(coarsely or until, 1000.0 * step) if step else until))
        kinds, members = np.unique(np.stack([box.diameter, box.mass]), axis=1, return_counts=True)
        free = box.length - np.where(box.periodic, 0.0, kinds[0].max())
        rate = np.asarray(theory.collision_rate_between(members / math.prod(free), kinds[0], kinds[1], 1.0))
        if any(box.periodic):
            rate = rate * (1.0 - np.eye(len(members)) / members)
        else:
            rate = rate * theory.contact_share(free, float(kinds[0].max()), box.number)
        expected = 0.5 * float(np.sum(members[:, None] * rate)) * (box.time - time)
        return Reading((box.contacts - before) / expected, 1.0, 4.0 / math.sqrt(expected) + within)

    return read


def pressure(packing, steps=None):
    """Compare the compressibility factor, from the virial of the contacts, with theory.

    Above the freezing density it is that of a crystal (Speedy 1998, doi:10.1088/0953-8984/10/20/006).
    """
    side, (settle, block) = side_of(packing), (10.0, 2.0) if packing < 0.494 else (2.0, 1.0)
    if packing < 0.494:
        expected = float(theory.compressibility_factor(packing))
        new = gas(256, side, walls=OPEN, options={"stepped": {"delta": steps}} if steps else {})
    else:
        share = packing / (math.pi / math.sqrt(18.0))
        expected = 3.0 / (1.0 - share) - 0.5921 * (share - 0.7072) / (share - 0.601)
        speeds = maxwell(1.0, np.ones(256), np.random.default_rng(2), exact=True)
        new = at(sites((side,) * 3, np.ones(256), periodic=(True,) * 3), speeds, (side,) * 3, walls=OPEN)

    def read(run):
        box, factors = run.advance(new(run), settle), []
        for _ in range(20):
            virial, time = box.virial.sum(), box.time
            run.advance(box, time + block)
            kinetic = box.energy()[0] * (box.number / (box.number - 1.0))
            factors.append(1.0 + (box.virial.sum() - virial) / (2.0 * kinetic * (box.time - time)))
        mean, error = block_average(factors, 20)
        return Reading(mean, expected, 4.0 * error + 1.5 * (expected - 1.0) / box.number)

    return read


# What each engine must do.


@dataclass(frozen=True)
class Case:
    """One row of the table; ``later`` names the engines that take seconds, or need kernels of their own."""

    name: str
    measure: Callable[[Run], Reading]
    exact: float | str = 0.0
    stepped: float | str = 0.0
    dsmc: float | str = 0.0
    later: str = ""


class Outcome(NamedTuple):
    """What an engine did: "right", "off" or "refused"; the number, or the sentence of the refusal."""

    kind: str
    reading: Reading = Reading(0.0)
    sentence: str = ""

    @property
    def error(self):
        """The error of the number, relative to what is expected unless that is 0."""
        return (self.reading.value - self.reading.expected) / (abs(self.reading.expected) or 1.0)


def outcome(case, run):
    """Run a case; an engine that does what no engine may do raises AssertionError."""
    try:
        reading = Reading(*map(float, case.measure(run)))
    except (RefusedError, StalledError, SettingError) as refusal:
        return Outcome("refused", sentence=" ".join(str(refusal).split()))
    assert math.isfinite(reading.value)
    known = not reading.expected or reading.within <= 0.05 * abs(reading.expected)
    right = known and abs(reading.value - reading.expected) <= reading.within
    return Outcome("right" if right else "off", reading)


def hold(case, run):
    """Assert that an engine does in a case what the table says, or better; return what it did."""
    found, must = outcome(case, run), getattr(case, run.engine)
    if isinstance(must, str):
        assert found.kind == "refused", found
        assert must in found.sentence, found
    elif must:  # chance may add twice what it may add to one run
        within = 2.0 * found.reading.within / (abs(found.reading.expected) or 1.0)
        assert found.kind != "refused", found
        assert abs(found.error) <= 1.25 * abs(must) + within, found
    else:
        assert found.kind == "right", found
    return found


def steps(length):
    """Count contacts in a thin gas in steps of a length in diameters or, for dsmc, in mean free times."""
    options = {"stepped": {"delta": length}, "dsmc": {"dt": length}}
    return contacts(gas(256, side_of(0.01), walls=OPEN, options=options), 100.0, 4000.0, within=0.005)


def few(number):
    """Put two or three molecules between walls of kT = 1."""
    where, velocity = [[1.5, 2.0, 3.5], [4.5, 2.5, 1.5], [2.0, 5.0, 1.0]], np.random.default_rng(7).normal(size=(3, 3))
    return at(where[:number], velocity[:number], (6, 6, 6), walls=BATHS, seed=number)


DOWN, COLD = SMOOTH[:5], HeatBath(1e-300)
GAPS = (1e-15, 1e-12, 1e-9, 1e-6)
MISSES = (0.0, 1e-16, -1e-16, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9)
THREE = [[2, 5, 5], [7, 5.3, 5.2], [5, 2, 8]], [[0.13, 0.07, 0.03], [-0.11, -0.02, 0.09], [0.03, 0.08, -0.1]]
EDGE = [[2, 2, 5]], [[1, 1, 0.1]]
PLACES = np.array([[2.0, 5, 5], [5, 5, 5], [8, 5, 5]])
ORDERS = [list(order) for order in itertools.permutations(range(3))]
STACK = [[5.0, 5.0, z] for z in (0.5, 1.5, 2.5)]
MANY = sites((12, 12, 12), np.ones(256))
SIGNS = np.where(np.arange(256)[:, None] % 2 == 0, 1.0, -1.0) * np.ones((256, 3))
ALIKE, TOO_LONG = "molecules of dsmc are all alike", "would cross the box"
FROZEN, AT_REST = "is too cold: warm it", "molecules come to rest"
CRUSHED = dict.fromkeys(("exact", "stepped"), "would crush the molecules")
CRUSHED |= {"dsmc": "leaves no box", "later": "exact stepped"}

FAMILIES = {
    "steps": (
        Case("steps of σ / 4", steps(0.25), stepped=-8 / 3 * 0.25**2, dsmc=-0.027, later="exact"),
        Case("steps of 10 σ", steps(10.0), stepped=TOO_LONG, dsmc=-0.023),
        Case("steps of 40 boxes", steps(1000.0), stepped=TOO_LONG, dsmc="a finite number, above 0 and at most 10"),
    ),
    "how many": (
        Case("no molecules", comes_to([at(np.zeros((0, 3)), walls=BATHS)], 10.0, [0.0]), later="exact"),
        Case("one molecule", comes_to([at([[3, 4, 5]], [[1, 0.5, 0.25]])], 720.0, [[[3, 4, 5]]], [[[1, 0.5, 0.25]]],
             within=1e-9), later="exact stepped"),
        Case("two molecules", contacts(few(2), 100.0, 600_000.0), dsmc=0.36, later="exact stepped dsmc"),
        Case("three molecules", contacts(few(3), 100.0, 200_000.0), dsmc=0.34, later="stepped"),
        Case("a million molecules", contacts(gas(1_000_000, side_of(0.01, 1_000_000)), 2.0, 2.0, within=0.005),
             stepped=-0.01, dsmc=-0.021, later="exact stepped dsmc"),
    ),
    "how dense": (
        Case("packing 0.49", pressure(0.49), stepped=-0.42, dsmc=1 / 12.2 - 1),
        Case("packing 0.49, steps of σ / 250", pressure(0.49, 0.004), stepped=-0.05, dsmc=1 / 12.2 - 1,
             later="stepped"),
        Case("packing 0.58, a crystal", pressure(0.58), stepped=-0.29, dsmc=1 / 13.6 - 1),
        Case("packing 0.64, a crystal", pressure(0.64), stepped=-0.51, dsmc=1 / 21.8 - 1),
    ),
    "how unlike": (
        Case("masses 1 and 10⁶", contacts(gas(100, 12.0, mass=np.where(np.arange(100) < 10, 1e6, 1.0), walls=OPEN),
             10.0, 1500.0), dsmc=ALIKE, later="exact stepped"),
        Case("the digits of π", hits([at([[5, 5, 5], [8, 5, 5]], along_x(0, -1), (300, 10, 10), mass=[1, 100.0**k])
             for k in range(4)], 100.0, (3, 31, 314, 3141)), dsmc=ALIKE, later="exact stepped"),
        Case("sizes 1 and 100", contacts(gas(400, 40.0, diameter=np.where(np.arange(400) < 4, 10.0, 0.1), walls=OPEN),
             5.0, 4000.0, coarsely=60.0), stepped=-0.072, dsmc=ALIKE, later="exact stepped"),
    ),
    "walls": (
        Case("walls of kT = 10⁻³⁰⁰", energy(gas(50, 10.0, walls=(COLD,) * 6), 1e3, left=0.0), exact=FROZEN),
        Case("into a corner", comes_to([at([[5, 5, 5]], [[1, 1, 1]])], 9.0, [[[5, 5, 5]]], [[[-1, -1, -1]]],
             within=1e-9), later="exact stepped"),
        Case("10⁴ times into an edge", comes_to([at(*EDGE)], 90_000.0, [EDGE[0]], [EDGE[1]], within=1e-6),
             later="exact stepped"),
        Case("10³ crossings between two samples", energy(gas(20, 5.0, kT=1e6), 15.0, pieces=3, events=30_000)),
    ),
    "gravity": (
        Case("nothing moves", comes_to([at(MANY, length=(12, 12, 12))], 1e3, [MANY], within=0.0)),
        Case("mgσ/kT = 10³", weight(gas(100, 10.0, 10.0, 100.0, top=10.0, gravity=1e3), 0.6), later="exact stepped"),
        Case("mgσ/kT = 10⁶", weight(gas(100, 10.0, 10.0, 100.0, top=10.0, gravity=1e6), 0.02), later="exact stepped"),
        Case("a ball at rest", comes_to([at(STACK[:1], gravity=1.0)], 10.0, [STACK[:1]], within=1e-9), exact=AT_REST,
             later="exact stepped"),
        Case("a stack of three at rest", comes_to([at(STACK, gravity=1.0)], 10.0, [STACK], within=1e-9), exact=AT_REST,
             stepped=7.5e-4, dsmc=3.1, later="exact stepped"),
        Case("10³ bounces", energy(at([[5, 5, 4.5]], length=(10, 10, 100), gravity=1.0), 1000.0 * math.sqrt(32.0),
             events=10, within=1e-10), later="exact stepped"),
        Case("10⁷ scale heights", energy(gas(100, 6.0, 6.0, 6e8, top=60.0, gravity=1.0), 100.0),
             dsmc="make the cells larger", later="exact stepped"),
        Case("a floor of kT = 10⁻³⁰⁰", energy(gas(50, 10.0, gravity=1.0, walls=(*OPEN[:4], COLD, SMOOTH[5])), 100.0,
             left=0.0), exact=FROZEN, later="stepped dsmc"),
    ),
    "contacts": (
        Case("a gap of 10⁻¹⁵ σ", comes_to([at([[4, 5, 5], [5 + gap, 5, 5]], along_x(1, -1)) for gap in GAPS], 1.0,
             [[[4 + (5 + gap) - 4 - 2, 5, 5], [6, 5, 5]] for gap in GAPS], [along_x(-1, 1)] * 4, within=1e-14),
             stepped=0.17, dsmc=2.0),
        Case("grazing by 10⁻¹⁶ to 10⁻⁹", comes_to([at([[2, 5, 5], [6, 6 * (1 + off), 5]], along_x(1, 0), (20, 20, 20))
             for off in MISSES], 8.0, velocity=[along_x(1, 0)] * 9,
             per=[math.sqrt(12.0 * abs(off) + 1e-15) for off in MISSES], within=2.0)),
        Case("in contact at the start", comes_to([at([[1, 2, 2], [2, 2, 2]], along_x(1, 0), (4, 4, 4))], 1.0,
             velocity=[along_x(0, 1)]), dsmc=1.0),
        Case("Newton's cradle", comes_to([at([[2.0 + i + (2.0 if i >= n else 0.0), 5, 5] for i in range(5)],
             along_x(*[1.0] * n, *[0.0] * (5 - n)), (20, 10, 10)) for n in range(1, 5)], 4.0,
             velocity=[along_x(*[0.0] * (5 - n), *[1.0] * n) for n in range(1, 5)]), dsmc=1.0),
        Case("hit from both sides at once", comes_to([at(PLACES[order], np.array(along_x(1, 0, -1))[order])
             for order in ORDERS], 3.0, velocity=[np.array(along_x(-1, 0, 1))[order] for order in ORDERS]), dsmc=2.0),
        Case("a lattice, in single precision", energy(at(MANY.astype("f4"), SIGNS.astype("f4"), (12, 12, 12)), 50.0,
             events=100)),
    ),
    "pistons": (
        Case("onto spheres", energy(gas(100, 6.0, 6.0, 12.0, walls=(*DOWN, Piston(-2.0))), 7.0), **CRUSHED),
        Case("onto points", energy(gas(100, 6.0, 6.0, 12.0, diameter=0.0, walls=(*DOWN, Piston(-0.5)),
             options={"stepped": {"dt": 0.02}}), 30.0), **CRUSHED),
        Case("onto points, at Mach 10⁶", comes_to([at([[3, 3, 2], [3, 3, 11]], length=(6, 6, 12), diameter=0.0,
             walls=(*DOWN, Piston(-1e6)), options={"stepped": {"dt": 1e-7}})], 3e-6, within=1e-3,
             velocity=[[[0, 0, 0], [0, 0, -2e6]]]), later="exact stepped"),
        Case("away, at Mach 10⁶", energy(gas(100, 6.0, 6.0, 10.0, walls=(*DOWN, Piston(1e6))), 250.0, pieces=5),
             stepped=TOO_LONG, later="exact"),
    ),
    "time": (
        Case("t = 10⁶", energy(at(*THREE), 1e6, pieces=10, events=10_000, within=3e-12)),
        Case("t = 10⁹, in steps 10⁷", lambda run: energy(at(*THREE), 1e9 if run.exact else 1e7, pieces=10,
             events=100_000, within=1e-10)(run), later="exact stepped dsmc"),
    ),
}  # fmt: skip
"""The cases by subject."""

LONG = ("a million molecules", "t = 10⁹, in steps 10⁷")
"""The cases that take minutes; the page leaves them out."""
