"""No contact is missed: the quick test of copies leaves out no partner, and the next contact is the right one.

Whole boxes are not compared with another run, which would diverge by chaos, but with the first contact of all pairs, in
double precision, computed from the engine's own state.
"""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from atmosbox.engine import ParcelSet, Piston
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.exact.rows import BATCH, CLOSING, PATH, SLACK, screen
from tests.engine.boxes import SMOOTH, many_events


@kernel(entry=True)
def screen_at(values, place, velocity, since, slack, within, seen):
    """Record which of the copies are found, each checked by a separate molecule."""
    for row in range(values.shape[0]):
        seen[row] = screen(
            values.reshape(-1), row * 7 * BATCH, False, (place[row, 0], place[row, 1], place[row, 2]),
            (velocity[row, 0], velocity[row, 1], velocity[row, 2]), since[row], (slack[0], slack[1], slack[2]),
            within[row],
        )  # fmt: skip


def unit(random, number):
    vector = random.normal(size=(number, 3))
    return vector / np.sqrt((vector**2).sum(axis=1, keepdims=True))


@settings(max_examples=60)
@given(
    st.integers(0, 2**32),
    st.sampled_from([1.6, 10.0, 150.0, 3000.0]),
    st.sampled_from([1.0, 1e-2, 1e-7, 0.0]),
    st.sampled_from([0.0, 1e-3, 1.0]),
    st.sampled_from([1.0, 1e-6, 1e-25]),
)
def test_the_quick_test_leaves_out_no_molecule_that_is_met(seed, width, head_on, fall, slow):
    """Pairs are made at the moment of contact, and moved back in time to a moment at which they share a cell."""
    random = np.random.default_rng(seed)
    number = 40 * BATCH
    top = 2.0
    duration = PATH * width / top
    gravity = fall * 0.5 * top / duration
    # the pair in contact, with a normal component of approach as small as wanted
    normal = unit(random, number)
    along = np.cross(normal, unit(random, number))
    relative = along + head_on * random.random((number, 1)) * np.sign(head_on) * -normal
    relative *= slow * random.random((number, 1)) / np.sqrt((relative**2).sum(axis=1, keepdims=True))
    common = 0.6 * unit(random, number) * random.random((number, 1)) * random.choice([1.0, slow], (number, 1))
    one = common + 0.5 * relative
    two = common - 0.5 * relative
    middle = random.uniform(-width + 1.0, width - 1.0, (number, 3))
    r_one, r_two = middle + 0.5 * normal, middle - 0.5 * normal
    # back in time as far as both stay within the width, in the frame of the box
    g = np.array([0.0, 0.0, gravity])
    back = (
        random.random(number)
        * random.choice([1e-3, 0.1, 1.0], number)
        * 2.0
        * width
        / np.maximum(np.abs(np.stack([one, two])).max(axis=(0, 2)), 1e-300)
    )
    if gravity:
        back = np.minimum(back, math.sqrt(16.0 * width / gravity))
    now, then = [], random.uniform(0.0, duration, number)
    for r, v in ((r_one, one), (r_two, two)):
        before = r - back[:, None] * v - 0.5 * g * back[:, None] ** 2
        now.append((before, v + g * back[:, None]))
    (x, v), (y, w) = now
    fits = (np.abs(x).max(axis=1) <= width) & (np.abs(y).max(axis=1) <= width)
    fall_now = 0.5 * g * then[:, None] ** 2, g * then[:, None]
    fits &= (np.sum((v + fall_now[1]) ** 2, axis=1) <= top**2) & (np.sum((w + fall_now[1]) ** 2, axis=1) <= top**2)
    values = np.full((number, 7, BATCH), 1e9, np.float32)
    slot = random.integers(BATCH, size=number)
    frame = w + fall_now[1]
    copy = np.concatenate([y + fall_now[0] - frame * then[:, None], frame], axis=1)
    values[np.arange(number)[:, None], np.arange(6), slot[:, None]] = copy
    seen = np.zeros(number, np.int64)
    slack = [1.0 + SLACK * width, SLACK * width**2, 4.0 * SLACK * width * top]
    assert CLOSING == 2
    screen_at(
        values, (x + fall_now[0]).astype(np.float32), (v + fall_now[1]).astype(np.float32), then.astype(np.float32),
        np.array(slack, np.float32), (back * (1.0 + 1e-9)).astype(np.float32), seen,
    )  # fmt: skip
    assert fits.any() or slow < 1.0 or fall == 1.0
    assert ((seen >> slot) & 1 == 1)[fits].all()


# ------------------------------------------------------------------ whole boxes


def next_pair(parcel):
    """Return the two molecules that touch first, of those that reach no wall before, and when [time from now]."""
    _, x, v, _ = parcel.snapshot()
    radius = 0.5 * parcel.diameter
    speed = np.abs(v)
    speed[:, 2] += abs(parcel.piston_velocity)
    if parcel.gravity:
        speed[:, 2] += np.sqrt(v[:, 2] ** 2 + 2.0 * parcel.gravity * parcel.ceiling)
    gap = np.minimum(x - radius[:, None], parcel.length - radius[:, None] - x)
    with np.errstate(divide="ignore"):
        free = (np.maximum(gap, 0.0) / speed).min(axis=1)
    i, j = np.triu_indices(len(x), 1)
    r, u = x[i] - x[j], v[i] - v[j]
    b, a, c = (np.einsum("pa,pa->p", *two) for two in ((r, u), (u, u), (r, r)))
    c -= (radius[i] + radius[j]) ** 2
    square = b * b - a * c
    meets = (square > 0.0) & (b < 0.0)
    time = np.full(len(i), math.inf)
    time[meets] = np.maximum(c[meets] / (np.sqrt(square[meets]) - b[meets]), 0.0)
    time[time > np.minimum(free[i], free[j])] = math.inf
    first = int(np.argmin(time))
    return [i[first], j[first]], float(time[first])


def misses_none(parcel, looks, step):
    """Check that the pair that must touch next does, unless a third molecule comes first; return how often it did."""
    seen = 0
    for _ in range(looks):
        parcel.advance(parcel.time + step)
        pair, due = next_pair(parcel)
        if not math.isfinite(due):
            continue
        now, velocity = parcel.time, parcel.snapshot().velocity[pair]

        def on_their_way(velocity=velocity, now=now, pair=pair):
            fallen = parcel.gravity * (parcel.time - now) * np.array([0.0, 0.0, 1.0])
            return np.isclose(parcel.snapshot().velocity[pair], velocity - fallen, rtol=1e-9, atol=1e-12).all(axis=1)

        parcel.advance(now + due * (1.0 - 1e-6))
        if on_their_way().all():
            parcel.advance(now + due * (1.0 + 1e-6) + 1e-12)
            assert not on_their_way().any()
            seen += 1
    return seen


def gas(number, sides, *, seed=3, diameter=1.0, **options):
    """Return molecules of unit temperature at random places of a lattice."""
    random = np.random.default_rng(seed)
    sides = np.array(sides, float)
    many = np.maximum((sides / (1.05 * np.max(diameter))).astype(int), 1)
    sites = random.choice(math.prod(many.tolist()), number, replace=False)
    x = (np.stack(np.unravel_index(sites, many), axis=1) + 0.5) * sides / many
    return {"position": x, "velocity": random.normal(size=(number, 3)), "length": tuple(sides), "diameter": diameter,
            "seed": seed, **options}  # fmt: skip


@many_events
def test_no_contact_of_a_molecule_at_a_thousand_thermal_speeds_is_missed():
    made = gas(300, (21.0,) * 3)
    made["velocity"][150] = 1000.0 * np.array([0.6, 0.48, 0.64])
    parcel = ParcelSet(**made)
    assert parcel._modes.rows
    speeds = np.sqrt((parcel.snapshot().velocity ** 2).sum(axis=1))
    assert np.sort(speeds)[-2] < parcel._cells.copies.epoch[2] < speeds.max()
    assert misses_none(parcel, 150, 2e-5) > 30
    # and so on until its energy is shared by all
    assert misses_none(parcel, 50, 1e-3) > 10
    assert parcel.ledger() < 1e-12


@many_events
def test_no_contact_is_missed_under_strong_gravity_and_a_piston_that_comes_down():
    # a hundred scale heights from floor to ceiling, then a tenth of the height
    parcel = ParcelSet(**gas(500, (16.0, 16.0, 60.0), walls=(*SMOOTH[:5], Piston()), gravity=1.5))
    assert parcel._modes.rows
    assert misses_none(parcel, 100, 0.05) > 10
    parcel.set_piston_velocity(-2.0)
    while parcel.ceiling > 7.0:
        misses_none(parcel, 3, 0.01)
        parcel.advance(parcel.time + 0.5)
    parcel.set_piston_velocity(3.0)  # and above the existing cells
    assert misses_none(parcel, 100, 0.3) > 10
    assert parcel.ceiling > 60.0
    assert parcel.ledger() < 1e-10


@many_events
def test_sizes_that_fit_the_cells_are_met_as_all_pairs_say():
    random = np.random.default_rng(5)
    sizes = random.choice([0.3, 0.8, 1.0], 300)
    parcel = ParcelSet(**gas(300, (32.0,) * 3, diameter=sizes, mass=sizes**3))
    assert parcel._modes.rows
    assert parcel._modes.mixed
    assert misses_none(parcel, 150, 0.2) > 40
