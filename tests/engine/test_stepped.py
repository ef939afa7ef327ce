"""The time-stepped engine finds every pair, keeps its balances, and does the same for any division and threads.

The boxes below need few kernels: each new set of flags costs seconds of compilation. Most have all at once, or are
equal molecules in a column with gravity.
"""

import itertools
import math
import warnings
from dataclasses import dataclass

import numpy as np
import pytest

from atmosbox.engine import (
    CoarseStepWarning,
    HeatBath,
    ParcelSet,
    Periodic,
    Piston,
    Ramp,
    RefusedError,
    Specular,
    StalledError,
    maxwell_velocities,
    random_positions,
    rotational_energies,
)
from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.stepped.stepped_parcel import SteppedParcel

many_steps = pytest.mark.skipif(not COMPILED, reason="so many steps take minutes without numba")

S, P = Specular(), Periodic()
BATH = HeatBath(Ramp(0.5, 2.0, start=1.0, end=9.0), accommodation=0.7)


@dataclass
class Pulse:
    """A driver that moves the piston out and in."""

    interval: float = 0.75
    speeds: tuple = (0.1, -0.15, 0.0, -0.05, 0.1)

    def velocity(self, parcel):
        return self.speeds[round(parcel.time / self.interval) % len(self.speeds)]


def parcel(position, velocity, **options):
    """Return a parcel, coarse or not."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CoarseStepWarning)
        return SteppedParcel(position, velocity, **options)


def gas(number, length, *, walls=(S,) * 6, seed=1, planar=False, diameter=1.0, mass=1.0, rotation=0.0, **options):
    """Return a gas at random places."""
    rng = np.random.default_rng(seed)
    diameter, mass, rotation = (np.broadcast_to(a, number).astype(float) for a in (diameter, mass, rotation))
    periodic = tuple(isinstance(wall, Periodic) for wall in walls[::2])
    x = random_positions(length, diameter, rng, periodic=periodic, planar=planar)
    v = maxwell_velocities(1.0, mass, rng, planar=planar, exact=True)
    spin = rotational_energies(1.0, rotation, rng)
    return parcel(
        x, v, length=length, walls=walls, planar=planar, diameter=diameter, mass=mass, rotation=rotation,
        rotational_energy=spin, seed=seed, **options,
    )  # fmt: skip


def mixture(number=300):
    """Return masses, diameters and rotational degrees of freedom of three kinds."""
    kind = np.random.default_rng(5).integers(0, 3, number)
    return {
        "mass": np.array([1.0, 4.0, 30.0])[kind],
        "diameter": np.array([0.3, 0.6, 1.0])[kind],
        "rotation": np.array([0.0, 2.0, 3.0])[kind],
    }


BOXES = {
    "equal, gravity, baths": {"length": (9.0, 9.0, 12.0), "walls": (S, S, P, P, BATH, BATH), "gravity": 0.2},
    "all at once": {
        "length": (9.0, 9.0, 9.0),
        "walls": (BATH, S, P, P, HeatBath(1.5), Piston()),
        "gravity": 0.1,
        "driver": Pulse(),
        "layers": 3,
        "collision_number": 2.0,
        **mixture(),
    },
}

RESTING = {"walls": (P,) * 4 + (S, Piston()), "gravity": 1e-300}
"""A box in which nothing accelerates, for unlike molecules that rotate: with the kernels of all features at once."""


def state(box):
    """Return everything in which runs can differ, as bytes."""
    now = box.snapshot()
    arrays = (now.position, now.velocity, now.rotational_energy, box.wall_impulse, box.wall_heat, box.virial)
    return b"".join(np.ascontiguousarray(a).tobytes() for a in arrays) + repr((box.contacts, box.receding)).encode()


def boxes_but(other):
    """Return a mark that tests every box, the named one in the validate tier: each compiles its own set of kernels."""
    params = [pytest.param(name, marks=pytest.mark.validate if name == other else ()) for name in BOXES]
    return pytest.mark.parametrize("name", params)


@many_steps
@boxes_but("equal, gravity, baths")
def test_a_run_is_the_same_however_it_is_cut(name):
    whole, pieces = (gas(300, delta=0.03, **BOXES[name]) for _ in range(2))
    whole.advance(8.0)
    for time in np.sort(np.random.default_rng(3).uniform(0.0, 8.0, 60)):
        pieces.advance(time)
        pieces.snapshot()
    pieces.advance(8.0)
    assert whole.contacts > 300
    assert whole.steps == pieces.steps
    assert state(whole) == state(pieces)


@many_steps
@boxes_but("all at once")
def test_a_run_has_the_same_bits_on_any_number_of_threads(name):
    # threads that wait for each other take processor time: few steps
    boxes = [gas(300, delta=0.03, threads=threads, **BOXES[name]) for threads in (1, 3)]
    for box in boxes:
        box.advance(1.5)
    assert boxes[0].contacts > 50
    assert len({state(box) for box in boxes}) == 1


@pytest.mark.parametrize("name", BOXES)
def test_a_short_run_is_the_same_in_two_halves(name):
    options = {key: (value[:20] if isinstance(value, np.ndarray) else value) for key, value in BOXES[name].items()}
    whole, halves = (gas(20, delta=0.05, **options) for _ in range(2))
    whole.advance(3.0)
    halves.advance(1.2)
    halves.advance(3.0)
    assert whole.wall_hits.sum() > 3
    assert state(whole) == state(halves)
    assert whole.ledger() < 1e-12


@many_steps
def test_another_seed_is_another_run():
    runs = []
    for seed in (1, 2):
        options = {"length": (5.0, 5.0, 5.0), "walls": (P,) * 4 + (HeatBath(1.0),) * 2, "gravity": 0.2}
        box = gas(20, **options)
        box = parcel(*box.snapshot()[1:3], seed=seed, **options)
        box.advance(5.0)
        runs.append(state(box))
    assert runs[0] != runs[1]


@many_steps
def test_the_ledger_closes_with_baths_a_piston_and_rotation():
    box = gas(300, (9.0, 9.0, 9.0), walls=(HeatBath(1.5), HeatBath(0.7), P, P, HeatBath(1.0, 0.5), Piston()),
              gravity=0.05, seed=2, diameter=0.8, mass=[1.0, 1.5] * 150, rotation=2.0)  # fmt: skip
    exchanged = 0.0
    for stroke in range(20):
        box.set_piston_velocity(-0.1 if stroke % 2 else 0.1)
        heat, work = box.wall_heat, box.work
        box.advance(box.time + 10.0)
        exchanged += float(np.abs(box.wall_heat - heat).sum()) + abs(box.work - work)
        assert box.ledger() <= 1e-10
    assert exchanged > 5.0 * sum(box.energy())
    assert box.wall_hits[5] > 1000
    assert box.contacts > 30_000
    assert abs(box.numerical_heat) <= 1e-10 * box.energy()[0]


@many_steps
@pytest.mark.parametrize("walls", ["mirror", "fold", "flip", "clamp", "rewind"])
def test_the_books_close_whatever_the_rules(walls):
    laws, sides = (S, S, P, P, S, Piston()), (9.0, 9.0, 9.0)
    for motion in ("parabola", "euler", "semi-implicit"):
        box = gas(200, sides, walls=laws, gravity=0.3, smooth_walls=walls, motion=motion, seed=8, **mixture(200))
        box.advance(30.0)
        assert box.wall_hits[[0, 1, 4, 5]].min() > 100
        assert box.ledger() <= 1e-11
        makes = motion != "parabola" or walls in ("fold", "clamp")
        assert (abs(box.numerical_heat) > 1e-4 * box.energy()[0]) == makes, motion


@many_steps
def test_every_collision_keeps_energy_and_momentum():
    box = gas(300, (8.0, 8.0, 8.0), delta=0.1, **RESTING, **mixture())
    before = sum(box.energy())
    momentum = box.mass @ box.snapshot().velocity
    box.advance(20.0)
    assert box.contacts > 1000
    assert sum(box.energy()) == pytest.approx(before, rel=1e-12)
    momentum[2] += box.wall_impulse[4] - box.wall_impulse[5]
    assert box.mass @ box.snapshot().velocity == pytest.approx(momentum, abs=1e-10)


def reach_through(box):
    """Return how far a molecule reaches through a wall [length]."""
    x, sides = box.snapshot().position, box.length
    radius = np.where(np.array(box.periodic), 0.0, 0.5 * box.diameter[:, None])
    assert np.isfinite(x).all()
    return np.maximum(radius - x, x - (sides - radius)).max()


@many_steps
@pytest.mark.parametrize("walls", ["mirror", "fold", "clamp", "rewind"])
def test_nobody_is_ever_outside_however_long_the_step(walls):
    sides = (9.0, 9.0, 9.0)
    sizes = {key: mixture(100)[key] for key in ("mass", "diameter")}
    boxes = (
        {"walls": (S, S, P, P, S, S), "gravity": 0.3},
        {"walls": (HeatBath(1.0), S, P, P, HeatBath(0.5), Piston()), "gravity": 0.3, "rotation": 2.0} | sizes,
        {"walls": (P,) * 6},
    )
    for made, dt in itertools.product(boxes, (1e-3, 0.1, 1.2)):
        box = gas(100, sides, dt=dt, smooth_walls=walls, seed=8, **made)
        for _ in range(100):
            box.advance(box.time + max(dt, 0.02))
            assert reach_through(box) <= 1e-12 * sides[0]
        assert box.ledger() < 1e-11


@many_steps
def test_one_that_flips_overshoots_by_no_more_than_a_step():
    box = gas(100, (9.0, 9.0, 9.0), smooth_walls="flip", dt=0.1, diameter=0.0)
    way = 0.1 * np.abs(box.snapshot().velocity).max()
    furthest = -math.inf
    for _ in range(200):
        box.advance(box.time + 0.1)
        furthest = max(furthest, reach_through(box))
    assert 0.5 * way < furthest <= way


FEW = [
    pytest.param(walls, number, marks=pytest.mark.validate if number < 2 and P in walls else ())  # kernels of their own
    for walls in ((S,) * 6, (P,) * 6, (*(HeatBath(1.0),) * 2, P, P, HeatBath(1.0), Piston(0.01)))
    for number in range(4)
]


@many_steps
@pytest.mark.parametrize(("walls", "number"), FEW)
def test_few_molecules_are_no_exception(number, walls):
    all_at_once = {"gravity": 0.1, "mass": [1.0, 4.0, 1.0][:number], "rotation": 2.0}
    facts = all_at_once if walls[5] == Piston(0.01) else {}
    x = np.array([[1.0, 1.5, 1.5], [2.5, 1.5, 1.5], [1.7, 3.0, 1.7]])[:number]
    v = np.array([[1.0, 0.2, 0.1], [-1.0, 0.3, 0.2], [0.1, -1.0, 0.3]])[:number]
    box = parcel(x, v, length=(4.0, 4.0, 4.0), walls=walls, delta=0.1, **facts)
    box.advance(20.0)
    assert box.time == pytest.approx(20.0, abs=box.time_step)
    assert box.snapshot().position.shape == (number, 3)
    assert (box.contacts > 0) == (number > 1)
    assert box.ledger() < 1e-12
    assert number == 0 or reach_through(box) <= 1e-12


@many_steps
def test_nothing_happens_where_nothing_moves():
    box = parcel([[1, 1, 1], [3, 3, 3]], np.zeros((2, 3)), length=(4, 4, 4))
    box.advance(1e3)
    assert box.contacts == 0
    assert box.snapshot().position.tolist() == [[1, 1, 1], [3, 3, 3]]


COLUMN = {"length": (4, 4, 4), "walls": (P, P, P, P, S, S), "gravity": 1.0}


@many_steps
def test_one_at_rest_on_the_floor_stays_there():
    box = parcel([[1, 1, 0.5], [3, 3, 0.5]], np.zeros((2, 3)), delta=0.01, **COLUMN)
    box.advance(50.0)
    assert box.snapshot().position[:, 2] == pytest.approx([0.5, 0.5], abs=1e-12)
    assert sum(box.energy()) == pytest.approx(1.0, abs=1e-12)


@many_steps
def test_one_that_bounces_in_gravity_rises_as_high_as_it_fell():
    box = parcel([[1, 1, 2.5], [3, 3, 2.5]], np.zeros((2, 3)), dt=0.1, **COLUMN)
    heights = []
    for _ in range(400):
        box.advance(box.time + 0.1)
        t = (box.time + 2.0) % 4.0 - 2.0
        heights.append(box.snapshot().position[:, 2] - (2.5 - 0.5 * t * t))
    assert np.abs(heights).max() < 1e-10
    assert box.wall_hits.tolist() == [0, 0, 0, 0, 20, 0]


def test_a_corner_turns_all_three_velocities():
    box = parcel([[1, 1, 1]], [[-1, -1, -1]], length=(4, 4, 4), dt=0.4)
    box.advance(0.8)
    assert box.snapshot().velocity.tolist() == [[1, 1, 1]]
    assert box.snapshot().position == pytest.approx(np.full((1, 3), 0.8))
    assert box.wall_hits.tolist() == [1, 0, 1, 0, 1, 0]


def test_those_in_contact_at_the_start_are_welcome_and_collide():
    with pytest.warns(CoarseStepWarning):
        box = SteppedParcel([[1, 2, 2], [2, 2, 2]], [[0.5, 0, 0], [-0.5, 0, 0]], length=(4, 4, 4), delta=0.1)
    box.advance(0.5)
    assert box.contacts == 1
    assert box.snapshot().velocity[:, 0].tolist() == [-0.5, 0.5]


@pytest.mark.parametrize("walls", [(S,) * 6, (P,) * 6])
def test_those_that_overlap_at_the_start_are_refused_as_the_exact_engine_does(walls):
    x = [[0.6, 2, 2], [5.4, 2, 2], [3, 2, 2], [3.6, 2.2, 2]]
    v = np.ones((4, 3))
    said = []
    for made in (ParcelSet, parcel):
        with pytest.raises(RefusedError, match="overlap at the start") as refused:
            made(x, v, length=(6, 6, 6), walls=walls)
        said.append(str(refused.value))
    assert said[0] == said[1]


def test_the_step_is_what_was_asked_for():
    v = [[2, 0, 0], [-2, 0, 0]]
    unlike = {"diameter": [0.5, 1.0], "mass": [1.0, 4.0]}
    box = parcel([[1, 2, 2], [3, 2, 2]], v, length=(4, 4, 4), rotation=2.0, delta=0.1, **RESTING, **unlike)
    # 3 kT = (4 + 16) / 2, and the lighter one is the faster
    assert box.time_step == pytest.approx(0.1 * 0.5 / math.sqrt(10.0 / 3.0))
    assert box.delta == pytest.approx(0.1)
    warm = parcel(
        [[1, 2, 2]],
        [[2, 0, 0]],
        length=(4, 4, 4),
        delta=0.1,
        walls=(HeatBath(Ramp(1.0, 9.0, start=0.0, end=1.0)), *(S,) * 5),
    )
    assert warm.time_step == pytest.approx(0.1 / 3.0)
    asked = parcel([[1, 2, 2]], [[2, 0, 0]], length=(4, 4, 4), dt=0.01, diameter=0.0)
    assert (asked.time_step, asked.delta) == (0.01, 0.0)


@many_steps
def test_one_giant_among_thousands_of_dwarfs_is_refused():
    rng = np.random.default_rng(1)
    x = np.concatenate([[[10, 10, 10]], rng.uniform([0.1, 0.1, 0.1], [19.9, 19.9, 2.0], (9000, 3))])
    diameter = np.full(len(x), 0.01)
    diameter[0] = 15.0
    with pytest.raises(RefusedError, match="make it smaller, or use the exact engine"):
        parcel(x, np.zeros_like(x), length=(20, 20, 20), diameter=diameter)


def test_a_coarse_step_is_warned_of_with_the_step_that_would_do():
    x, v = [[1, 2, 2], [3, 2, 2]], [[1, 0, 0], [-1, 0, 0]]
    with pytest.warns(CoarseStepWarning, match=r"delta_max = dt v_max / radius = 0.2.* dt = 0.05 would do"):
        SteppedParcel(x, v, length=(4, 4, 4), dt=0.1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        SteppedParcel(x, v, length=(4, 4, 4), dt=0.05)


@many_steps
def test_a_piston_is_stopped_before_it_crushes():
    sizes = {"mass": mixture(20)["mass"], "rotation": 2.0, "gravity": 0.1}
    box = gas(20, (5.0, 5.0, 5.0), walls=(S, S, P, P, S, Piston(-0.2)), delta=0.05, **sizes)
    with pytest.raises(StalledError, match="would crush"):
        box.advance(100.0)
    assert 1.02 <= box.ceiling < 1.1
    assert reach_through(box) <= 1e-12
    assert box.ledger() < 1e-10


PERIODIC = [(False, False, False), (True, True, True), (True, False, True), (False, True, False)]


# unlike molecules in a box that has no floor, or no periodic sides, need kernels of their own
SIDES = [
    *((periodic, False) for periodic in PERIODIC),
    *(((turns, True, False), True) for turns in (True, False)),
    *(pytest.param(periodic, True, marks=pytest.mark.validate) for periodic in PERIODIC[:3]),
]


@many_steps
@pytest.mark.parametrize(("periodic", "mixed"), SIDES)
def test_every_pair_in_overlap_is_found_once(monkeypatch, periodic, mixed):
    found = []
    monkeypatch.setattr("atmosbox.engine.stepped.stepped_parcel.judge_overlap", lambda pairs, *_: found.append(pairs))
    facts = {"walls": [wall for turn in periodic for wall in ((P, P) if turn else (S, S))]}
    if mixed and any(periodic[:2]) and not periodic[2]:
        facts = RESTING | {"walls": [*facts["walls"][:4], *RESTING["walls"][4:]], "rotation": 2.0}
    i, j = np.triu_indices(200, 1)
    boxes = [(2.4, 2.5, 2.6), (3.2, 4.0, 9.0), (7.0, 7.0, 7.0), (3.0, 30.0, 3.0)]
    # unlike discs that turn along y alone would need kernels of their own
    plane = (False,) if mixed and not periodic[0] else (False, True)
    for length, planar in itertools.product(boxes, plane):
        rng = np.random.default_rng(2)
        x = 0.5 + rng.random((200, 3)) * (np.array(length) - 1.0)
        if planar:
            x[:, 1] = 1.2
        diameter = rng.choice([0.2, 0.6, 1.0], 200) if mixed else np.ones(200)
        box = parcel(x, np.zeros_like(x), length=length, diameter=diameter, dt=0.01, planar=planar, **facts)
        apart = x[i] - x[j]
        apart -= np.where(box.periodic, box.length * np.rint(apart / box.length), 0.0)
        gap = np.sqrt(np.sum(apart**2, axis=1)) - 0.5 * (diameter[i] + diameter[j])
        pairs = [tuple(sorted(pair)) for pair in found.pop().tolist()]
        assert len(pairs) == len(set(pairs)) > 20
        assert set(zip(i[gap < 0.0], j[gap < 0.0], strict=True)) <= set(pairs)
        assert set(pairs) <= set(zip(i[gap < 1e-4], j[gap < 1e-4], strict=True))


@many_steps
def test_more_pairs_than_there_was_room_for_change_nothing():
    roomy, cramped = (
        gas(4000, (18.0, 18.0, 18.0), walls=(P,) * 4 + (S, S), gravity=0.2, delta=0.1, threads=2) for _ in range(2)
    )
    cramped._pairs = np.zeros((2, 7, 2), np.uint32)
    for box in (roomy, cramped):
        box.advance(1.0)
    assert roomy.contacts > 2000
    assert state(roomy) == state(cramped)


@many_steps
@pytest.mark.parametrize("masses", [(1.0, 1.0), (1.0, 5.0)])
def test_a_collision_of_two_converges_to_the_exact_one_with_the_step(masses):
    errors = []
    rng = np.random.default_rng(6)
    facts = {"walls": (P,) * 6} if len(set(masses)) == 1 else RESTING | {"rotation": 2.0, "collision_number": math.inf}
    aim = [(b, phase) for b in (0.1, 0.4, 0.7) for phase in rng.random(16)]
    for step in (0.02, 0.01, 0.005, 0.0025):
        off = []
        for b, phase in aim:
            x, v = [[2.0 - step * phase, 3.0, 3.0], [4.0, 3.0 + b, 3.0]], [[1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]
            exact = ParcelSet(x, v, length=(6, 6, 6), mass=masses)
            box = parcel(x, v, length=(6, 6, 6), mass=masses, dt=step, **facts)  # they meet no wall
            for one in (exact, box):
                one.advance(1.6)
            assert box.contacts == exact.contacts == 1
            off.append(np.abs(box.snapshot().velocity - exact.snapshot().velocity).max())
        errors.append(np.mean(off))
    slope = np.polyfit(np.log([0.02, 0.01, 0.005, 0.0025]), np.log(errors), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.15)
    assert errors[-1] < 0.01
