"""Molecules never overlap nor leave the box, keep what mechanics keeps, and a driver moves their piston."""

import math

import numpy as np
import pytest

from atmosbox.engine import HeatBath, ParcelSet, Piston, Ramp, RefusedError, Specular
from atmosbox.engine.exact.reference import Reference
from tests.engine.boxes import SMOOTH, TURNING, Pulse, apart, many_events

GENTLE = (0.1, -0.15, 0.0, -0.05, 0.1)


def lattice(number, sides, diameter):
    """Return the first sites of a simple lattice that fills the box."""
    sides = np.asarray(sides, float)
    many = np.maximum((sides / (1.02 * diameter)).astype(int), 1)
    index = np.stack(np.meshgrid(*map(np.arange, many), indexing="ij"), axis=-1).reshape(-1, 3)
    chosen = np.random.default_rng(4).permutation(len(index))[:number]
    return (index[chosen] + 0.5) * sides / many


def box(name, number=40, **changes):
    """Return the arguments of a box, whose name is that of the set of kernels that it needs."""
    random = np.random.default_rng(9)
    images = name == "periodic rotation"  # so small a box that a molecule meets several images of another
    number, sides = (min(number, 16), (3.0, 3.1, 3.2)) if images else (number, (5.5, 5.5, 6.0))
    made = {
        "position": lattice(number, sides, 1.0),
        "velocity": random.normal(size=(number, 3)),
        "length": sides,
        "walls": SMOOTH,
        "seed": 77,
    }
    mixture = {"mass": random.choice([1.0, 30.0], number), "diameter": random.choice([0.1, 0.3, 1.0], number)}
    if name == "piston":
        made |= {"walls": (*(Specular(),) * 4, HeatBath(1.5), Piston()), "gravity": 0.3, "driver": Pulse(speeds=GENTLE)}
    elif name == "mixed":
        made |= mixture | {"walls": (HeatBath(Ramp(0.5, 2.0, start=1.0, end=9.0), accommodation=0.7), *SMOOTH[:5])}
    elif name == "periodic rotation":
        made |= mixture | {
            "walls": TURNING,
            "rotation": random.choice([0.0, 2.0, 3.0], number),
            "collision_number": 2.0,
        }
    elif name == "everything":
        made |= mixture | {
            "walls": (*TURNING[:4], HeatBath(1.0), Piston()),
            "gravity": 0.3,
            "rotation": random.choice([0.0, 2.0, 3.0], number),
            "driver": Pulse(speeds=GENTLE),
        }
    return made | changes


NAMES = ["equal", "piston", "mixed", "periodic rotation", "everything"]
by_name = pytest.mark.parametrize("name", NAMES)


def least_gap(parcel):
    """Return the smallest distance of two molecules minus that of contact, over all pairs and images."""
    position, radius = parcel.snapshot().position, 0.5 * parcel.diameter
    gaps = apart(position, position, parcel.length, parcel.periodic) - radius[:, None] - radius[None, :]
    return gaps[np.triu_indices(len(position), 1)].min()


# ------------------------------------------------------------------ what happens in the box


@by_name
def test_molecules_never_overlap_nor_leave_the_box_and_the_energy_budget_closes(name):
    parcel = ParcelSet(**box(name))
    radius = 0.5 * parcel.diameter[:, None]
    inside = np.where(parcel.periodic, 0.0, radius)
    for time in np.linspace(0.0, 40.0, 41)[1:]:
        parcel.advance(time)
        position = parcel.snapshot().position
        assert least_gap(parcel) > -1e-9
        assert (position >= inside - 1e-9).all()
        assert (position <= parcel.length - inside + 1e-9).all()
        assert parcel.ledger() < 1e-12
    events = parcel.events
    assert events["contacts"] > 100
    assert (events["wall_hits"] > 100) == (not all(parcel.periodic))
    assert events["wall_hits"] == parcel.wall_hits.sum()


@pytest.mark.parametrize("name", ["piston", "mixed"])
def test_what_the_walls_take_up_is_what_the_molecules_lose(name):
    # smooth walls: heat baths also exert forces along the wall
    parcel = ParcelSet(**box(name, driver=None, walls=(*SMOOTH[:5], Piston() if name == "piston" else Specular())))
    mass = parcel.mass[:, None]
    start = np.sum(mass * parcel.snapshot().velocity, axis=0)
    parcel.advance(20.0)
    low, high = parcel.wall_impulse[0::2], parcel.wall_impulse[1::2]
    assert (parcel.wall_impulse > 0.0).all()
    fallen = np.array([0.0, 0.0, parcel.gravity * 20.0 * parcel.mass.sum()])
    assert np.sum(mass * parcel.snapshot().velocity, axis=0) - start == pytest.approx(low - high - fallen, abs=1e-9)


def test_a_driven_piston_is_one_constant_piston_after_another():
    smooth = (*SMOOTH[:5], Piston())
    made = box("piston", number=5, walls=smooth, driver=Pulse(interval=0.5, speeds=GENTLE))
    parcel = ParcelSet(**made)
    arguments = {key: value for key, value in made.items() if key not in ("driver", "seed")}
    hits = 0
    for turn, speed in enumerate(np.tile(GENTLE, 6)):
        reference = Reference(**arguments | {"walls": (*SMOOTH[:5], Piston(speed))})
        reference.advance(0.5)
        parcel.advance(0.5 * (turn + 1))
        now = parcel.snapshot()
        assert now.position == pytest.approx(reference.position, abs=1e-6)
        assert now.velocity == pytest.approx(reference.velocity, abs=1e-6)
        length = (*arguments["length"][:2], reference.place(5))
        assert parcel.ceiling == pytest.approx(length[2])
        # the reference continues from the engine's state, so that chaos does not matter
        arguments |= {"position": now.position, "velocity": now.velocity, "length": length}
        hits = parcel.wall_hits[5]
    assert hits > 3
    assert parcel.work != 0.0


@pytest.mark.nightly  # cells that hold lists need other kernels
@many_events
def test_many_molecules_in_one_cell_get_a_longer_row():
    random = np.random.default_rng(2)
    position = lattice(600, (10, 10, 10), 1.0)
    velocity = (np.array([0.3, 0.3, 0.3]) - position) * random.uniform(0.97, 1.03, (600, 1))
    parcel = ParcelSet(position, velocity, length=(10, 10, 10), diameter=0.02)
    before = parcel.memory()
    parcel.advance(1.2)
    assert parcel.memory() > before
    assert parcel.contacts > 100
    assert least_gap(parcel) > -1e-9
    assert parcel.ledger() < 1e-12


# ------------------------------------------------------------------ runs watched and divided


@many_events
def test_time_reads_what_was_asked_for_even_while_nothing_happens():
    # slow molecules between warm walls: their first event is many epochs away
    parcel = ParcelSet([[1, 1, 2], [3, 3, 2]], [[1e-6, 0, 0]] * 2, length=(4, 4, 4), walls=(HeatBath(1.0),) * 6)
    for time in (0.3, 3000.3, 5000.7, 6000.1, 100_000.0 / 3.0):
        parcel.advance(time)
        assert parcel.time == time
        parcel.advance(time)


def test_the_driver_is_asked_at_the_multiples_of_its_interval():
    driver = Pulse(speeds=GENTLE)
    parcel = ParcelSet(**box("piston", driver=driver))
    for time in (0.1, 0.75, 2.0, 2.0, 4.4):
        parcel.advance(time)
    assert driver.asked == pytest.approx([0.0, 0.75, 1.5, 2.25, 3.0, 3.75])


# ------------------------------------------------------------------ small and special boxes


# boxes with no or one molecule need further kernels: numba knows arrays of so few elements by another type
LATER = [pytest.param("piston", number, marks=pytest.mark.nightly) for number in (0, 1)]


@pytest.mark.parametrize(("name", "number"), [("piston", 2), ("piston", 3), *LATER])
def test_a_box_may_hold_hardly_anything(name, number):
    parcel = ParcelSet(**box(name, number=number))
    parcel.advance(30.0)
    assert parcel.number == len(parcel.snapshot().position) == number
    assert parcel.ledger() < 1e-12
    assert (parcel.events["wall_hits"] > 0) == (number > 0)
    assert math.isfinite(parcel.degrees_of_freedom)
    assert repr(parcel).startswith(f"<ParcelSet: {number} molecules")


def test_energy_is_that_of_its_parts():
    parcel = ParcelSet(
        [[1, 1, 1], [1, 1, 3]], [[1, 2, 2], [0, 0, 1]], length=(8, 8, 8), mass=[2.0, 4.0], diameter=[0.5, 1.0],
        gravity=0.5, rotation=[2.0, 0.0], rotational_energy=[3.0, 0.0], walls=(*TURNING[:4], Specular(), Piston()),
    )  # fmt: skip
    assert parcel.energy() == pytest.approx((9.0 + 2.0, 3.0, 0.5 * (2.0 + 12.0)))


# ------------------------------------------------------------------ refusals


def test_molecules_that_touch_or_stand_at_a_wall_by_rounding_are_accepted():
    above = math.nextafter(1.5, 0.0)
    parcel = ParcelSet([[0.5 - 1e-15, 2, 2], [above, 2, 3.5]], np.zeros((2, 3)), length=(4, 4, 4))
    assert parcel.snapshot().position[0, 0] == 0.5


def test_time_does_not_run_backward_nor_for_ever():
    parcel = ParcelSet(**box("equal", number=2))
    parcel.advance(1.0)
    for until in (-1.0, 0.5, math.nan, np.float64("inf"), "x", None):
        told = until if isinstance(until, str | None) else float(until)
        with pytest.raises(RefusedError, match=rf"^until = {told!r} .*: give a "):
            parcel.advance(until)
    assert parcel.time == 1.0


def test_only_a_piston_can_be_moved_and_at_a_finite_velocity():
    with pytest.raises(RefusedError, match="no piston"):
        ParcelSet(**box("equal")).set_piston_velocity(0.1)
    parcel = ParcelSet(**box("piston", driver=None))
    for velocity in (math.nan, -math.inf, "fast"):
        with pytest.raises(RefusedError, match="velocity of the piston = "):
            parcel.set_piston_velocity(velocity)
    assert parcel.piston_velocity == 0.0
