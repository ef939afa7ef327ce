r"""The time-stepped engine: its errors follow their laws, its balances close, and the applets' rules do what they say.

In a dilute gas the errors follow from one pair. It enters with relative speed g and goes half a chord, of length l, to
where it is nearest; what is seen of it are points a distance x = g dt apart, the first at random. It collides at the
first point on that half, if there is one: with the chance min(1, l / x), at a depth s uniform in (0, min(x, l)), where
r . v = g (s - l). With l^2 uniform in (0, 1) (in a plane the impact parameter is), averaged over pairs as they meet,
:math:`g^3 \exp(-g^2/4)` (in a plane :math:`g^2`), that gives rate and virial for any step; to first order in
:math:`\delta`, collisions missed :math:`(8/3) \delta^2` (in a plane :math:`\delta^2`), and Z - 1 too low by
:math:`(4/\sqrt\pi) \delta` (:math:`3/\sqrt\pi`).

In a denser gas neighbours press a pair together, by the contact value chi of Enskog. Here molecules come nearer to
each other than they may, by the mean depth at which they collide, :math:`(\sqrt\pi/2) \delta \sigma`, and so keep each
other from less room: chi is that of spheres so much smaller, and rate and Z - 1 are low by another
:math:`d (d \ln\chi / d \ln\phi) (\sqrt\pi/2) \delta` in d dimensions: 6.6 phi delta, in a plane 2.8.

Means allow 4 standard errors from 20 blocks (a false alarm once in 1 500 for a fresh seed, never for these).
"""

import math
import warnings

import numpy as np
import pytest

from atmosbox.engine import (
    CoarseStepWarning,
    HeatBath,
    Periodic,
    Piston,
    Ramp,
    RefusedError,
    Specular,
    maxwell_velocities,
    random_positions,
    rotational_energies,
)
from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.stepped.stepped_parcel import SteppedParcel
from atmosbox.scene.statistics import block_average

many_steps = pytest.mark.skipif(not COMPILED, reason="takes minutes without numba")
S, P = Specular(), Periodic()
STEPS = np.array([0.0125, 0.025, 0.05, 0.1])
RULES = ("pairwise", "index-order", "look-ahead", "every-overlap")
WARMED = HeatBath(Ramp(1.0, 2.0, start=0.1, end=3.0))
ALL_AT_ONCE = {"walls": (WARMED, HeatBath(0.7), P, P, HeatBath(1.0, 0.5), Piston(0.1)), "gravity": 0.1}


def parcel(position, velocity, **options):
    """Return a parcel, coarse or not."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CoarseStepWarning)
        return SteppedParcel(position, velocity, **options)


def gas(number, length, *, seed=5, planar=False, walls=(P,) * 6, mass=1.0, diameter=1.0, **options):
    """Return a gas at random places, its energy that of kT = 1."""
    rng = np.random.default_rng(seed)
    mass, diameter = (np.broadcast_to(each, number) for each in (mass, diameter))
    periodic = tuple(isinstance(wall, Periodic) for wall in walls[::2])
    x = random_positions(length, diameter, rng, periodic=periodic, planar=planar)
    v = maxwell_velocities(1.0, mass, rng, planar=planar, exact=True)
    return parcel(x, v, length=length, walls=walls, planar=planar, seed=seed, mass=mass, diameter=diameter, **options)


def mixture(number):
    """Return molecules of two kinds that rotate."""
    few = np.arange(number) % 3 == 0
    return {"mass": np.where(few, 4.0, 1.0), "diameter": np.where(few, 1.0, 0.5), "rotation": 2.0}


# ------------------------------------------------------------------------------------------------ laws of collisions


def dilute(delta, dimensions):
    """Return collision rate and virial of a dilute gas as shares of the exact ones: the averages of the docstring."""
    g = np.linspace(0.0, 14.0, 1401)[1:, None]
    u = (np.arange(2000) + 0.5) / 2000
    half = u if dimensions == 3 else np.cos(0.5 * np.pi * u)
    x = g * delta
    seen = np.minimum(x, half)
    # half chords of length l are met in proportion to l dl; in a plane, at angle theta, to cos(theta) dtheta
    weight = g**dimensions * np.exp(-g * g / 4.0) * half
    rate = np.sum(weight * (seen / x)) / np.sum(weight)
    return rate, np.sum(weight * g * (half * seen - seen**2 / 2.0) / x) / np.sum(weight * g * half)


def scattered(delta, dimensions, pairs, seed, steps=1, **options):
    """Let isolated pairs meet; return the shares of collisions, and of virial, that are missing."""
    rng = np.random.default_rng(seed)
    g = 2.0 * np.sqrt(rng.standard_gamma(0.5 * (dimensions + 1), pairs))
    b = np.sqrt(rng.random(pairs)) if dimensions == 3 else rng.uniform(-1.0, 1.0, pairs)
    azimuth = 2.0 * np.pi * rng.random(pairs) if dimensions == 3 else 0.5 * np.pi
    half = np.sqrt(1.0 - b * b)
    along = half + g * delta * rng.random(pairs)
    many, index = math.ceil(pairs ** (1.0 / dimensions)), np.arange(pairs)
    site = 6.0 * np.stack([index % many, index // many % many, index // many // many], axis=1)
    planar = dimensions == 2
    if planar:
        site = site[:, [0, 2, 1]]
    first = np.add(site, [3.0, 0.5 if planar else 3.0, 3.0])
    away = np.stack([along, 0.0 * b if planar else b * np.cos(azimuth), b * np.sin(azimuth)], axis=1)
    v = np.stack([0.5 * g, 0.0 * g, 0.0 * g], axis=1)
    side = 6.0 * many + 3.0
    box = parcel(
        np.concatenate([first, first + away]), np.concatenate([v, -v]),
        length=(side, 1.0 if planar else side, side), dt=delta, planar=planar, **options,
    )  # fmt: skip
    box.advance(steps * delta)
    return 1.0 - box.contacts / pairs, 1.0 - float(box.virial.sum() / np.sum(g * half))


@many_steps
@pytest.mark.parametrize(("dimensions", "slope", "curvature"), [(3, 4.0, 8.0 / 3.0), (2, 3.0, 1.0)])
def test_pairs_are_missed_and_late_as_the_laws_say(dimensions, slope, curvature):
    for k, delta in enumerate(STEPS):
        blocks = [scattered(delta, dimensions, 20_000, 100 * k + block) for block in range(20)]
        mean, error = block_average(np.array(blocks))
        assert (np.abs(1.0 - mean - dilute(delta, dimensions)) <= 4.0 * error + 1e-5).all()
        # the laws themselves, which are the first terms
        assert abs(mean[0] - curvature * delta**2) <= 4.0 * error[0] + 10.0 * delta**3
        assert abs(mean[1] - slope / math.sqrt(math.pi) * delta) <= 4.0 * error[1] + 5.0 * delta**3


@many_steps
@pytest.mark.parametrize("delta", [0.4, 1.6])
def test_rotation_and_translation_come_to_one_temperature_however_long_the_step(delta):
    """Without detailed balance translation is warmer by 22 % at the first of these steps, by 36 % at the second."""
    number, rng = 2000, np.random.default_rng(1)
    side = (number * math.pi / 6.0 / 0.05) ** (1.0 / 3.0)
    spin = rotational_energies(1.0, np.full(number, 2.0), rng)
    # below a piston at rest: the kernels of lifting-dry
    box = gas(number, (side,) * 3, walls=(*(S,) * 5, Piston()), rotation=2.0, rotational_energy=spin, delta=delta)
    ratio = []
    for look in range(80):
        box.advance(60.0 + 8.0 * look)
        kinetic, rotational, _ = box.energy()
        ratio.append(2.0 * kinetic / (3.0 * rotational))
    mean, error = block_average(np.array(ratio))
    assert abs(mean - 1.0) <= 4.0 * error
    assert error < 0.01


# ------------------------------------------------------------------------------------------------ rules for pairs

BOXES = {
    "walls": {"length": (9.0, 16.0, 20.0), "walls": (S,) * 6},
    "periodic": {"length": (2.5, 30.0, 30.0), "walls": (P,) * 6},
    "plane": {"length": (60.0, 1.0, 18.0), "walls": (P, P, S, S, S, S), "planar": True},
    "narrow": {"length": (2.0, 60.0, 30.0), "walls": (S,) * 6},
    "all at once": {"length": (3.0, 9.0, 18.0), "collision_number": math.inf} | mixture(12) | ALL_AT_ONCE,
}
STARTS = range(600 if COMPILED else 2)


@pytest.mark.parametrize("name", BOXES)
def test_cells_find_the_pairs_that_a_test_of_all_pairs_finds(name):
    contacts = 0
    for seed in STARTS:  # so few molecules that no three overlap after a step: what follows would depend on the order
        cells, pairs = (gas(12, dt=0.2, seed=seed, rule=rule, **BOXES[name]) for rule in RULES[:2])
        for box in (cells, pairs):
            box.advance(0.2)
        assert cells.contacts == pairs.contacts
        assert cells.snapshot().velocity == pytest.approx(pairs.snapshot().velocity, abs=1e-12)
        contacts += cells.contacts
    assert contacts > (12 if COMPILED else 0)


def pair(rule, apart, approach, **options):
    """Return two molecules whose centres are that far apart (x, z) after an infinitesimal step, with that velocity."""
    x = np.array([[5.0, 5.0, 5.0], [5.0 + apart[0], 5.0, 5.0 + apart[1]]])
    v = np.array([[approach[0], 0.0, approach[1]], [0.0, 0.0, 0.0]])
    x[0] -= 0.1 * v[0]
    box = parcel(x, v, length=(10.0,) * 3, dt=0.1, rule=rule, **options)
    box.advance(0.1)
    return box


@pytest.mark.parametrize("rule", RULES)
def test_a_collision_keeps_energy_momentum_and_what_lies_across(rule):
    for angle in (0.1, 1.0, 2.5, 4.0):
        normal = np.array([math.cos(angle), math.sin(angle)])
        across = np.array([-normal[1], normal[0]])
        came = normal + 0.3 * across
        box = pair(rule, 0.99 * normal, came, mass=(2.0, 7.0))
        went = box.snapshot().velocity[:, [0, 2]]
        assert box.contacts == 1
        assert 2.0 * went[0] + 7.0 * went[1] == pytest.approx(2.0 * came, abs=1e-14)
        assert 2.0 * went[0] @ went[0] + 7.0 * went[1] @ went[1] == pytest.approx(2.0 * came @ came, rel=1e-14)
        assert went @ across == pytest.approx([0.3, 0.0], abs=1e-14)
        assert box.virial.sum() == pytest.approx(-0.99 * 2.0 * (went[0] - came) @ normal, rel=1e-12)


def test_the_rules_differ_in_a_pair_that_grazes_and_in_one_that_moves_apart():
    grazing = [pair(rule, (0.999, 0.0), (0.0004, 1.0)).contacts for rule in RULES]  # r . u = -0.0004 > -epsilon u^2 / 2
    parting = [pair(rule, (-0.999, 0.0), (0.5, 15.0)).contacts for rule in RULES]
    assert (grazing, parting) == ([1, 1, 0, 1], [0, 0, 0, 1])


# ------------------------------------------------------------------------------------------------ walls, and the fall


def forces(rule, d, seed, number=500):
    """Return the force of points on walls, and that if crossings took 0, 1/2 or 1 step longer, over the exact one."""
    rng = np.random.default_rng(seed)
    v = rng.normal(size=(number, 3))
    box = parcel(rng.random((number, 3)), v, length=(1, 1, 1), diameter=0.0, dt=d, smooth_walls=rule)
    box.advance(2.0)
    impulse, time = box.wall_impulse, box.time
    box.advance(102.0)
    assert box.energy()[0] == pytest.approx(0.5 * np.sum(v * v), rel=1e-12)
    force = float(np.sum(box.wall_impulse - impulse)) / (box.time - time)
    exact = np.sum(v * v)
    return [0.5 * force / exact, *(float(np.sum(v * v / (1.0 + late * d * np.abs(v))) / exact) for late in (0, 0.5, 1))]


@many_steps
@pytest.mark.parametrize(
    ("rule", "lost"), [("mirror", 0.0), ("fold", 0.0), ("undo", 0.0), ("clamp", 0.5), ("flip", 1.0)]
)
def test_walls_are_pressed_less_by_what_a_crossing_takes_longer(rule, lost):
    for d in (0.025, 0.1):
        rows = np.array([forces(rule, d, seed) for seed in range(20)])
        # the average of 1 / (whole number of steps) is that of 1 / (mean number) to second order
        mean, error = block_average(rows[:, 0] - rows[:, 1 + round(2.0 * lost)])
        assert abs(mean) <= 4.0 * error + 0.1 * d * d
        mean, error = block_average(rows[:, 0])
        assert abs(mean - (1.0 - 2.0 * lost * math.sqrt(2.0 / math.pi) * d)) <= 4.0 * error + 3.0 * lost * d * d
        assert error < 0.002


@many_steps
@pytest.mark.parametrize(
    ("motion", "rule", "made"),
    [
        ("parabola", "mirror", 0.0),
        ("parabola", "flip", 0.0),
        ("parabola", "fold", 0.5),
        ("parabola", "undo", 0.5),
        ("euler", "flip", 0.5),
        ("euler", "fold", 1.0),
    ],
)
def test_the_fall_and_the_floor_heat_as_their_laws_say(motion, rule, made):
    number, gravity, dt, rng = 400, 1.5, 0.02, np.random.default_rng(31)
    x, v = rng.random((number, 3)) * [1.0, 1.0, 4.0], rng.normal(size=(number, 3))
    box = parcel(x, v, length=(1, 1, 4), walls=(P, P, P, P, S, S), gravity=gravity, diameter=0.0, dt=dt, motion=motion,
                 smooth_walls=rule)  # fmt: skip
    start, rows = sum(box.energy()), []
    for _ in range(20):
        before, time = sum(box.energy()), box.time
        box.advance(time + 5.0)
        rows.append((sum(box.energy()) - before) / (number * (box.time - time)))
    assert box.wall_hits[4:].min() > 100
    assert box.numerical_heat == pytest.approx(sum(box.energy()) - start, abs=1e-9 * start)
    mean, error = block_average(rows)
    # the laws are exact in the fall, and first terms at the floor: molecules get faster
    assert abs(mean - made * gravity**2 * dt) <= 4.0 * error + 1e-12
    assert error <= 0.05 * mean + 1e-12


@many_steps
@pytest.mark.parametrize("walls", ["mirror", "fold", "flip", "clamp", "undo"])
@pytest.mark.parametrize("motion", ["parabola", "euler"])
def test_the_energy_budget_closes_and_no_molecule_is_outside_by_any_rules(walls, motion):
    facts = ALL_AT_ONCE | {"walls": (HeatBath(1.5), S, P, P, S, Piston())}
    box = gas(100, (9.0,) * 3, smooth_walls=walls, motion=motion, delta=0.2, **facts, **mixture(100))
    exchanged, furthest = 0.0, 0.0
    for stroke in range(20):
        box.set_piston_velocity(-0.1 if stroke % 2 else 0.1)
        heat, work = box.wall_heat, box.work
        box.advance(box.time + 5.0)
        exchanged += float(np.abs(box.wall_heat - heat).sum()) + abs(box.work - work)
        assert box.ledger() <= 1e-11
        x, reach = box.snapshot().position, np.where(box.periodic, 0.0, 0.5 * box.diameter[:, None])
        furthest = max(furthest, float(np.maximum(reach - x, x - (box.length - reach)).max()))
    assert exchanged > 0.5 * sum(box.energy())
    assert box.work != 0.0 == box.wall_heat[5]
    assert box.wall_hits[[0, 1, 4, 5]].min() > 100
    assert box.contacts > 300
    assert (furthest > 0.01) == (walls == "flip")
    assert (abs(box.numerical_heat) > 1e-4 * box.energy()[0]) == (motion == "euler" or walls not in ("mirror", "flip"))


# ------------------------------------------------------------------------------------------------ the box


def test_molecules_that_overlap_at_the_start_are_refused():
    x, v = [[0.6, 2, 2], [5.4, 2, 2], [3, 2, 2], [3.6, 2.2, 2]], np.ones((4, 3))
    for walls in ((S,) * 6, (P,) * 6):
        with pytest.raises(RefusedError, match="overlap at the start"):
            parcel(x, v, length=(6, 6, 6), walls=walls)


def test_the_step_is_what_was_asked_for_and_a_coarse_one_is_warned_of():
    x, v = [[1, 2, 2], [3, 2, 2]], [[2, 0, 0], [-2, 0, 0]]
    unlike = parcel(x, v, length=(4, 4, 4), delta=0.1, diameter=[0.5, 1.0], mass=[1.0, 4.0])
    # 3 kT = (4 + 16) / 2, and the lighter one is the faster
    assert unlike.time_step == pytest.approx(0.1 * 0.5 / math.sqrt(10.0 / 3.0))
    warm = parcel(x[:1], v[:1], length=(4, 4, 4), delta=0.1, walls=(HeatBath(9.0), *(S,) * 5))
    assert warm.time_step == pytest.approx(0.1 / 3.0)
    with pytest.warns(CoarseStepWarning, match=r"delta_max = dt v_max / radius = 0.4.* dt = 0.025 would do") as warned:
        SteppedParcel(x, v, length=(4, 4, 4), dt=0.1)
    assert warned[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        SteppedParcel(x, v, length=(4, 4, 4), dt=0.025)
