"""The classic schemes do what applets did, contact by contact and wall by wall, and their energy ledger is right."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from atmosbox.engine import (
    HeatBath,
    Periodic,
    Ramp,
    Specular,
    maxwell_velocities,
    random_positions,
)
from atmosbox.engine.classic.classic import SCHEMES, ClassicParcel
from atmosbox.engine.classic.classic_strips import strips_across
from atmosbox.engine.core.jit import COMPILED

many_steps = pytest.mark.skipif(not COMPILED, reason="so many pairs take minutes without numba")

SMOOTH = (Specular(),) * 6
PLANE = ("strips", "lookahead")


def pair(scheme, apart, approach, *, mass=(1.0, 1.0), dt=1e-3, **options):
    """Return a pair of unit discs or spheres whose centres are that far apart [x, z], closing at that velocity."""
    x = np.array([[5.0, 5.0, 5.0], [5.0 + apart[0], 5.0, 5.0 + apart[1]]])
    v = np.array([[approach[0], 0.0, approach[1]], [0.0, 0.0, 0.0]])
    box = {"length": (10.0, 10.0, 10.0), "mass": mass, "planar": True, "dt": dt}
    return ClassicParcel(x, v, scheme=scheme, **(box | options))


def gas(kind, /, *, number=20, side=7.5, seed=5, **options):
    """Return a small gas for a scheme: equal discs, unequal discs, or unequal spheres."""
    planar = kind in PLANE
    rng = np.random.default_rng(seed)
    alike = np.ones(number)
    mass = alike if kind == "strips" else np.where(np.arange(number) % 3 == 0, 4.0, 1.0)
    diameter = alike if kind == "strips" else np.where(np.arange(number) % 4 == 0, 0.5, 1.0)
    length = (side, 2.0, side) if planar else (0.6 * side,) * 3
    made = {
        "position": random_positions(length, diameter, rng, planar=planar),
        "velocity": maxwell_velocities(1.0, mass, rng, planar=planar),
        "length": length,
        "mass": mass,
        "diameter": diameter,
        "planar": planar,
        "scheme": kind,
        "seed": seed,
    }
    return ClassicParcel(**(made | options))


def same(one, other):
    """Return whether two boxes hold the same bytes."""
    fields = zip(one.snapshot()[1:], other.snapshot()[1:], strict=True)
    tallies = (one.wall_heat, one.wall_impulse, one.virial), (other.wall_heat, other.wall_impulse, other.virial)
    return all(np.array_equal(a, b) for a, b in [*fields, *zip(*tallies, strict=True)])


# ---------------------------------------------------------------------------------------------- contacts


@pytest.mark.parametrize("scheme", SCHEMES)
def test_head_on_equal_molecules_swap_velocities(scheme):
    box = pair(scheme, (0.999, 0.0), (1.0, 0.0))
    box.advance(1e-3)
    assert box.contacts == 1
    assert box.snapshot().velocity == pytest.approx(np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]), abs=1e-15)


@pytest.mark.parametrize("scheme", ["lookahead", "spheres"])
def test_a_light_molecule_bounces_off_a_heavy_one(scheme):
    box = pair(scheme, (0.999, 0.0), (1.0, 0.0), mass=(1.0, 3.0))
    box.advance(1e-3)
    assert box.snapshot().velocity[:, 0] == pytest.approx([-0.5, 0.5], abs=1e-15)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_an_oblique_contact_keeps_energy_and_momentum_and_what_lies_across(scheme):
    mass = (1.0, 1.0) if scheme == "strips" else (2.0, 7.0)
    for angle in (0.1, 1.0, 2.5, 4.0):
        normal = np.array([math.cos(angle), math.sin(angle)])
        across = np.array([-normal[1], normal[0]])
        box = pair(scheme, 0.99 * normal, 1.0 * normal + 0.3 * across, mass=mass, dt=1e-300)
        before = box.snapshot().velocity[:, [0, 2]]
        box.advance(1e-300)
        after = box.snapshot().velocity[:, [0, 2]]
        weight = np.array(mass)[:, None]
        assert box.contacts == 1
        assert np.sum(weight * after, axis=0) == pytest.approx(np.sum(weight * before, axis=0), abs=1e-14)
        assert np.sum(weight * after**2) == pytest.approx(np.sum(weight * before**2), rel=1e-14)
        assert after @ across == pytest.approx(before @ across, abs=1e-14)
        assert np.diff(after @ normal) == pytest.approx(-np.diff(before @ normal), abs=1e-14)
        impulse = weight[0, 0] * (after[0] - before[0]) @ normal
        assert box.virial.sum() == pytest.approx(-0.99 * impulse, rel=1e-6)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_pair_that_overlaps_and_parts_is_left_alone(scheme):
    box = pair(scheme, (0.9, 0.0), (-1.0, 0.0))
    box.advance(1e-3)
    assert box.contacts == 0


def test_looking_ahead_passes_over_a_pair_that_grazes():
    grazing = (0.0004, 1.0)  # r . v = -0.0004 > -epsilon v^2 / 2
    for scheme, contacts in (("strips", 1), ("lookahead", 0), ("spheres", 1)):
        box = pair(scheme, (0.999, 0.0), grazing, dt=1e-300)
        box.advance(1e-300)
        assert box.contacts == contacts
    box = pair("lookahead", (0.999, 0.0), grazing, dt=1e-300, epsilon=1e-5)
    box.advance(1e-300)
    assert box.contacts == 1


def test_three_in_contact_are_resolved_one_pair_after_another():
    places = np.array([[4.0, 5.0, 5.0], [4.99, 5.0, 5.0], [5.98, 5.0, 5.0]])
    came = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    found = []
    for order in ([0, 1, 2], [2, 1, 0]):
        box = ClassicParcel(places[order], came[order], length=(10.0,) * 3, scheme="spheres", dt=1e-6)
        box.advance(1e-6)
        found.append(box.snapshot().velocity[np.argsort(order), 0])
    # in the order of the collisions it passes through all three in one step; in the reverse order it needs another step
    assert found[0] == pytest.approx([0.0, 0.0, 1.0])
    assert found[1] == pytest.approx([0.0, 1.0, 0.0])


def test_spheres_that_forget_to_ask_hang_together():
    wrong = pair("spheres", (0.9, 0.0), (-1.0, 0.1), dt=0.01, closing_only=False)
    energy = wrong.energy()[0]
    wrong.advance(0.5)
    assert wrong.contacts > 40
    assert 0 < wrong.parting_contacts < wrong.contacts
    assert wrong.repeated_contacts == wrong.contacts - 1
    assert wrong.energy()[0] == pytest.approx(energy, rel=1e-13)


def test_molecules_in_one_place_do_no_harm():
    for scheme in SCHEMES:
        box = pair(scheme, (0.0, 0.0), (0.0, 0.0), closing_only=False)
        box.advance(0.01)
        assert box.contacts == 0
        assert np.isfinite(box.snapshot().velocity).all()


def test_contacts_are_counted_by_height():
    box = pair("strips", (0.999, 0.0), (1.0, 0.0), layers=4)
    box.advance(1e-3)
    assert np.flatnonzero(box.virial).tolist() == [2]


# ---------------------------------------------------------------------------------------------- strips


def by_all_pairs(x, v, side, periodic, strips):
    """Let all pairs that overlap and approach collide; all pairs are checked, in the order of the strips."""
    n = len(x)
    strip = np.minimum((x[:, 0] / side * strips).astype(int), strips - 1)
    pairs = []
    for i in range(n):
        for j in range(n):
            apart = x[j] - x[i]
            if periodic:
                apart = apart - side * np.rint(apart / side)
            if i == j or not apart @ apart < 1.0:
                continue
            away = strip[j] - strip[i]
            last_meets_first = periodic and strips > 1 and away == 1 - strips
            if (away == 0 and i < j) or away == 1 or last_meets_first:
                pairs.append((strip[i], i, away != 0, j, apart))
            elif away == 0 or away == -1 or (periodic and strips > 1 and away == strips - 1):
                continue
            else:
                raise AssertionError("a pair that overlaps is not in neighbouring strips")
    contacts = 0
    v = v.copy()
    for _, i, _, j, apart in sorted(pairs, key=lambda found: found[:4]):
        if apart @ (v[i] - v[j]) > 0.0:
            normal = apart / math.sqrt(apart @ apart)
            change = ((v[j] - v[i]) @ normal) * normal
            v[i] += change
            v[j] -= change
            contacts += 1
    return v, contacts


@settings(max_examples=60)
@given(
    seed=st.integers(0, 2**32 - 1),
    number=st.integers(0, 40),
    side=st.floats(1.5, 14.0),
    periodic=st.booleans(),
)
def test_strips_find_the_pairs_that_all_pairs_find(seed, number, side, periodic):
    if periodic:
        side = max(side, 3.1)
    rng = np.random.default_rng(seed)
    x = np.full((number, 3), 1.0)
    edge = 0.0 if periodic else 0.5
    x[:, [0, 2]] = rng.uniform(edge, side - edge, (number, 2))
    v = rng.normal(size=(number, 3))
    v[:, 1] = 0.0
    walls = (Periodic(),) * 2 + SMOOTH[:2] + ((Periodic(),) * 2 if periodic else SMOOTH[:2])
    box = ClassicParcel(
        x, v, length=(side, 2.0, side), planar=True, walls=walls if periodic else SMOOTH, scheme="strips", dt=1e-300
    )
    box.advance(1e-300)
    strips = strips_across(side, 1.0, number, periodic)
    expected, contacts = by_all_pairs(x[:, [0, 2]], v[:, [0, 2]], side, periodic, strips)
    assert strips == math.floor(side * (1.0 - 1e-12)) or 4 * number < side
    assert box.contacts == contacts
    assert box.snapshot().velocity[:, [0, 2]] == pytest.approx(expected, abs=1e-11)


@many_steps
def test_strips_spare_fifty_tests_of_fifty_one():
    number, width = 3000, 148.5
    rng = np.random.default_rng(8)
    x = rng.uniform(0.5, width - 0.5, (number, 3))
    x[:, 1] = 1.0
    v = maxwell_velocities(1.0, np.ones(number), rng, planar=True)
    tests = {}
    for scheme in PLANE:
        box = ClassicParcel(x, v, length=(width, 2.0, width), planar=True, scheme=scheme, dt=1e-3)
        box.advance(1e-3)
        tests[scheme] = box.pair_tests
    assert tests["lookahead"] == 4_498_500
    assert tests["strips"] == pytest.approx(91_000, rel=0.01)


# ---------------------------------------------------------------------------------------------- walls


def one_at_the_wall(scheme, walls=SMOOTH):
    """Return one molecule a quarter of a step from the wall x low."""
    return ClassicParcel(
        [[0.75, 1.0, 3.0]], [[-1.0, 0.0, 0.0]], length=(6, 2, 6), walls=walls, planar=True, scheme=scheme, dt=1.0
    )


def test_a_wall_undoes_the_move_or_holds_the_disc_or_mirrors_it():
    for scheme, place in (("strips", 0.75), ("lookahead", 0.5), ("spheres", 1.25)):
        box = one_at_the_wall(scheme)
        box.advance(1.0)
        here = box.snapshot()
        assert here.position[0].tolist() == [place, 1.0, 3.0]
        assert here.velocity[0].tolist() == [1.0, 0.0, 0.0]
        assert box.wall_impulse.tolist() == [2.0, 0.0, 0.0, 0.0, 0.0, 0.0]
        assert box.wall_hits.tolist() == [1, 0, 0, 0, 0, 0]
        assert box.events["wall_hits"] == 1


def test_a_heat_bath_emits_at_the_end_of_the_step():
    for scheme, place in (("strips", 0.75), ("lookahead", 0.5), ("spheres", 0.5)):
        box = one_at_the_wall(scheme, walls=(HeatBath(2.0), *SMOOTH[:5]))
        box.advance(1.0)
        here = box.snapshot()
        assert here.position[0, 0] == place
        assert here.velocity[0, 0] > 0.0
        assert here.velocity[0, 2] != 0.0
        assert here.velocity[0, 1] == 0.0
        assert box.wall_heat[0] == pytest.approx(0.5 * np.sum(here.velocity**2) - 0.5, rel=1e-14)
        assert box.ledger() < 1e-15


def test_a_mirror_reflects_as_often_as_it_takes():
    box = ClassicParcel([[1.0, 1.0, 3.0]], [[23.0, 0.0, 0.0]], length=(6, 2, 6), planar=True, scheme="spheres", dt=1.0)
    box.advance(1.0)
    here = box.snapshot()
    # 23.5 beyond the low wall is four widths of 5 and 3.5 more
    assert here.position[0, 0] == pytest.approx(4.0)
    assert here.velocity[0, 0] == 23.0
    assert box.wall_hits[:2].tolist() == [2, 2]


@pytest.mark.parametrize("scheme", SCHEMES)
def test_no_molecule_is_ever_outside(scheme):
    for dt, law in itertools.product((1e-3, 0.1, 3.0, 1000.0), (Specular(), HeatBath(2.0, accommodation=0.5))):
        box = gas(scheme, dt=dt, gravity=0.3, walls=(law,) * 6)
        for step in range(1, 60 if COMPILED else 4):
            box.advance(step * dt)
            assert box.steps == step
            assert box.escaped() == 0
        assert box.ledger() < 1e-10
        assert dt < 1.0 or box.wall_hits[[0, 1, 4]].min() > 0


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_periodic_box_takes_in_on_one_side_what_leaves_on_the_other(scheme):
    sides = (Periodic(),) * 2
    box = gas(scheme, walls=sides + (sides if scheme == "spheres" else SMOOTH[:2]) + sides, dt=0.05)
    momentum = box.mass @ box.snapshot().velocity
    for step in range(1, 200):
        box.advance(step * 0.05)
        assert box.escaped() == 0
    assert box.contacts > 20
    assert box.events["wall_hits"] == 0
    assert box.mass @ box.snapshot().velocity == pytest.approx(momentum, abs=1e-12)


def test_a_box_as_narrow_as_its_molecules_holds_them():
    for scheme in SCHEMES:
        box = ClassicParcel(
            [[0.5, 1.0, 2.0]], [[1.0, 0.0, 1.0]], length=(1, 2, 4), planar=True, scheme=scheme, dt=0.1, gravity=0.1
        )
        box.advance(20.0)
        assert box.snapshot().position[0, 0] == 0.5
        assert box.escaped() == 0
        assert box.wall_hits[:2].min() > 0


# ---------------------------------------------------------------------------------------------- ledger


@pytest.mark.parametrize("scheme", SCHEMES)
def test_energy_the_scheme_makes_is_told_and_is_no_heat(scheme):
    still = gas(scheme, walls=(*SMOOTH[:4], HeatBath(2.0), Specular()))
    still.advance(20.0)
    assert still.contacts > 20
    assert still.wall_heat[4] != 0.0
    assert still.numerical_heat == 0.0
    assert still.ledger() < 1e-12
    assert still.internal_energy() == pytest.approx(still.energy()[0], rel=1e-12)
    falling = gas(scheme, gravity=0.3)
    falling.advance(20.0)
    assert falling.contacts > 20
    assert falling.numerical_heat > 0.0
    assert (falling.wall_heat == 0.0).all()
    assert falling.ledger() < 1e-12
    start = gas(scheme, gravity=0.3)
    assert sum(falling.energy()) - sum(start.energy()) == pytest.approx(falling.numerical_heat, rel=1e-9)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_momentum_is_that_of_walls_and_weight(scheme):
    box = gas(scheme, gravity=0.3, dt=0.02)
    before = box.mass @ box.snapshot().velocity
    box.advance(20.0)
    low, high = box.wall_impulse[::2], box.wall_impulse[1::2]
    weight = np.array([0.0, 0.0, -0.3 * box.mass.sum() * box.time])
    assert box.wall_hits.sum() > 20
    assert box.mass @ box.snapshot().velocity - before == pytest.approx(low - high + weight, abs=1e-9)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_same_seed_gives_the_same_bytes_however_the_run_is_cut(scheme):
    walls = (HeatBath(Ramp(1.0, 3.0, start=1.0, end=5.0), accommodation=0.7),) * 6
    whole = gas(scheme, walls=walls, gravity=0.2)
    whole.advance(10.0)
    cut = gas(scheme, walls=walls, gravity=0.2)
    for time in [0.001, 0.3, 0.3, 3.21, 3.22, 9.999, 10.0]:
        cut.advance(time)
        cut.snapshot()
    assert whole.contacts > 10
    assert same(whole, cut)
    other = gas(scheme, walls=walls, gravity=0.2, seed=6)
    other.advance(10.0)
    assert not same(whole, other)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_few_molecules_or_none(scheme):
    for number in range(4):
        box = gas(scheme, number=number, gravity=0.1, walls=(HeatBath(1.0),) * 6)
        box.advance(20.0)
        assert box.time == pytest.approx(20.0, abs=box.time_step)
        assert box.snapshot().position.shape == (number, 3)
        assert box.escaped() == 0
        assert box.ledger() < 1e-12
        assert number or box.energy() == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_points_never_meet_and_are_not_tested(scheme):
    box = gas(scheme, diameter=0.0)
    box.advance(20.0)
    assert box.ideal
    assert box.contacts == box.pair_tests == 0
    assert box.wall_hits.sum() > 0


@pytest.mark.parametrize("scheme", SCHEMES)
def test_molecules_at_rest_stay_there(scheme):
    box = gas(scheme, velocity=np.zeros((20, 3)))
    before = box.snapshot().position
    box.advance(10.0)
    assert (box.snapshot().position == before).all()


# ---------------------------------------------------------------------------------------------- arguments


def test_the_scheme_follows_from_the_molecules_unless_it_is_chosen():
    assert gas("strips", scheme=None).scheme == "strips"
    assert gas("lookahead", scheme=None).scheme == "lookahead"
    assert gas("spheres", scheme=None).scheme == "spheres"
    assert gas("strips", scheme="lookahead").scheme == "lookahead"
    assert gas("lookahead", scheme="spheres").scheme == "spheres"


def test_the_step_is_a_tenth_of_a_passage_of_the_fastest_over_the_smallest():
    box = pair("lookahead", (3.0, 0.0), (2.0, 0.0), mass=(4.0, 1.0), dt=None, diameter=(1.0, 0.5))
    # kT = 4 * 2^2 / (2 * 2), so that the light one's thermal speed is 2
    assert box.time_step == pytest.approx(0.1 * 0.5 / 2.0)
    hot = pair("strips", (3.0, 0.0), (1.0, 0.0), dt=None, delta=0.02, walls=(HeatBath(9.0), *SMOOTH[:5]))
    assert hot.time_step == pytest.approx(0.02 / 3.0)
    hot.divide(0.01)
    assert hot.time_step == pytest.approx(0.005)
    hot.advance(0.005)
    assert hot.steps == 1


@many_steps
def test_a_watch_is_called_often_where_all_pairs_are_tested():
    box = gas("spheres", number=60, side=11.0, dt=0.01)
    times = []
    box.advance(50.0, times.append)
    assert len(times) > 2
    assert times[-1] == box.time == pytest.approx(50.0)


def test_the_memory_is_that_of_the_arrays():
    assert 80 * 20 <= gas("spheres").memory() <= 120 * 20
