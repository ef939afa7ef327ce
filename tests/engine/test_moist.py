"""Moist air keeps its balances at every event, does the same however a run is divided, also with very few molecules.

The boxes below need three sets of kernels, those of scenes and that of a pool under a ceiling at rest: each new set
costs seconds of compilation.
"""

import math
import subprocess
import sys
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from atmosbox.engine import (
    FollowPressure,
    HeatBath,
    Mist,
    ParcelSet,
    Periodic,
    Piston,
    Pool,
    Specular,
    StalledError,
    Substance,
    lattice_positions,
    random_positions,
)
from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.liquid import moist_parcelset
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from atmosbox.engine.liquid.reservoir import AIR_MET
from atmosbox.scene.statistics import block_average

many_events = pytest.mark.skipif(not COMPILED, reason="so many events take minutes without numba")

SMOOTH = (Specular(),) * 6
TURNING = (Periodic(),) * 6
WARM = (HeatBath(1.0),) * 6
LIFTED = (*SMOOTH[:5], Piston())
PHI = 8.0
MASS, DIAMETER = 0.62, 0.8


def water(saturation=0.1, **changes):
    """Return water of a saturation pressure at kT = 1."""
    facts = {"mass": MASS, "diameter": DIAMETER, "binding_energy": PHI, "heat_capacity": 9.0} | changes
    return Substance(**facts, volatility=saturation * math.exp(facts["binding_energy"]))


@dataclass
class Pulse:
    """A driver that moves the piston up and down."""

    interval: float = 0.75
    speeds: tuple = (0.3, -0.45, 0.0, -0.15, 0.3)

    def velocity(self, parcel):
        return self.speeds[round(parcel.time / self.interval) % len(self.speeds)]


def up_and_down(pressure):
    """Return a driver that makes the pressure rise by half and fall again ten times, and then keeps it."""
    turn = np.arange(20)
    return FollowPressure(3.0 * turn, pressure * 1.5 ** (turn % 2), mean_free_time=0.5)


def moist(liquid, air=20, vapour=10, *, sides=(5.5, 5.5, 6.0), kT=1.0, seed=9, **options):
    """Return a box of air and vapour at random places, with its liquid."""
    rng = np.random.default_rng(seed)
    walls = options.get("walls", SMOOTH)
    periodic = tuple(isinstance(wall, Periodic) for wall in walls[::2])
    mass = np.r_[np.full(vapour, liquid.substance.mass), np.ones(air)]
    diameter = np.r_[np.full(vapour, liquid.substance.diameter), np.ones(air)]
    rotation = np.r_[np.full(vapour, liquid.substance.rotation), np.full(air, 2.0)]
    position = random_positions(sides, diameter, rng, periodic=periodic) if air + vapour else np.zeros((0, 3))
    facts = {
        "mass": mass,
        "diameter": diameter,
        "rotation": rotation,
        "rotational_energy": kT * rng.standard_gamma(0.5 * rotation),
        "length": sides,
        "seed": seed,
    }
    velocity = options.pop("velocity", rng.standard_normal((air + vapour, 3)) * np.sqrt(kT / mass)[:, None])
    return MoistParcelSet(options.pop("position", position), velocity, liquid=liquid, **facts | options)


def box(name, **changes):
    """Return a box by the name of its special feature."""
    facts = {"number": 30, "nuclei": 50.0, "rain": 0.02, "sticking": 0.8}
    mist, pool = {"area": 60.0} | facts, facts
    lift = (*TURNING[:4], Specular(), Piston())
    cases = {
        "mist": lambda: moist(Mist(water(), **mist), walls=WARM, **changes),
        "pool": lambda: moist(Pool(water(), **pool), walls=(*WARM[:4], Specular(), HeatBath(1.0)), **changes),
        "periodic": lambda: moist(Mist(water(), **mist), walls=TURNING, **changes),
        "lifted mist": lambda: moist(
            Mist(water(diameter=1.0), **mist), walls=LIFTED, driver=up_and_down(0.3), **changes
        ),
        "mist under a piston": lambda: moist(Mist(water(), **mist), walls=lift, driver=Pulse(), **changes),
        "pool under a piston": lambda: moist(Pool(water(), **pool), walls=lift, driver=Pulse(), **changes),
    }
    return cases[name]()


NAMES = ["mist", "pool", "lifted mist", "periodic", "mist under a piston", "pool under a piston"]
OWN_KERNELS = ("periodic", "mist under a piston", "pool under a piston")  # no scene has such a box
by_name = pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.validate if name in OWN_KERNELS else ()) for name in NAMES]
)


def state(parcel):
    """Return everything that can be read off a parcel, as bytes."""
    now, ledger = parcel.snapshot(), parcel._reservoir
    arrays = [now.position, now.velocity, now.rotational_energy, parcel.wall_heat, parcel.wall_impulse, parcel.virial]
    arrays += [ledger.energy, ledger.count, ledger.spectrum, ledger.absent[: ledger.top[0]], parcel._tallies.random]
    numbers = (parcel.time, parcel.ceiling, parcel.work, parcel.contacts, parcel.number, parcel.liquid)
    return [array.tobytes() for array in arrays], numbers, parcel.wall_hits.tolist()


def deepest_overlap(parcel):
    """Return how deep a pair of molecules overlaps [length], looking at all pairs and images."""
    position = parcel.snapshot().position
    away = position[:, None] - position[None, :]
    away -= np.where(parcel.periodic, parcel.length * np.rint(away / parcel.length), 0.0)
    touching = 0.5 * (parcel.diameter[:, None] + parcel.diameter[None, :])
    overlap = touching - np.sqrt(np.sum(away**2, axis=-1))
    np.fill_diagonal(overlap, -math.inf)
    return overlap.max(initial=-math.inf)


def is_lawful(parcel, waters):
    """Assert what must hold of every box at every time."""
    now = parcel.snapshot()
    assert np.isfinite(now.position).all()
    assert np.isfinite(now.velocity).all()
    assert (now.rotational_energy >= 0.0).all()
    assert parcel.escaped() == 0
    assert deepest_overlap(parcel) < 1e-9
    assert min(parcel.liquid, parcel.vapour, parcel.condensed, parcel.evaporated, parcel.rained) >= 0
    assert parcel.liquid + parcel.vapour + parcel.rained == waters
    assert len(now.position) == parcel.number == len(parcel.mass) == len(parcel.diameter)
    # the rounding error that is left when the last molecule takes all energy
    assert parcel.liquid_energy >= -1e-11
    assert parcel.ledger() < 1e-10


# ------------------------------------------------------------------ its balances, event by event


def happened(parcel):
    return np.array([parcel.condensed, parcel.evaporated, parcel._reservoir.count[AIR_MET], parcel.rained])


@pytest.fixture
def by_single_events(monkeypatch):
    """Make a box return after every event."""
    monkeypatch.setattr(moist_parcelset, "_CHUNK", 1)


@many_events
@by_name
def test_energy_and_water_close_at_every_event(name, by_single_events):
    parcel = box(name)
    waters = parcel.vapour + parcel.liquid
    start = sum(parcel.energy()) + parcel.condensed_energy
    seen = [happened(parcel)]

    def check(time):
        now = happened(parcel)
        if (now == seen[-1]).all():
            return
        assert np.sum(now - seen[-1]) == 1
        seen.append(now)
        assert parcel.vapour + parcel.liquid + parcel.rained == waters
        assert parcel.number == 20 + parcel.vapour
        kinetic, rotational, potential = parcel.energy()
        inside = kinetic + rotational + parcel.liquid_energy + PHI * parcel.vapour + parcel._reservoir.energy[1]
        assert potential == 0.0
        assert inside - parcel.wall_heat.sum() - parcel.work == pytest.approx(start, rel=1e-10)
        assert parcel.ledger() < 1e-10

    end = 0.0
    while (seen[-1] < 8).any():
        end += 5.0
        assert end < 500.0
        parcel.advance(end, watch=check)
    assert len(seen) - 1 == seen[-1].sum()
    assert (parcel.work != 0.0) == (parcel._driver is not None)
    if "pool" in name:
        # each molecule that hits the pool is counted, and its impulse acts on the floor
        assert parcel.wall_hits[4] >= parcel.condensed + parcel._reservoir.count[AIR_MET]
        assert parcel.wall_impulse[4] > 0.0
    is_lawful(parcel, waters)


@many_events
@by_name
def test_rain_takes_all_water_in_the_end(name):
    parcel = box(name)
    parcel.advance(3000.0)
    assert parcel.rained > 35
    is_lawful(parcel, 40)


@many_events
def test_it_rains_only_what_the_liquid_does_not_keep(by_single_events):
    parcel = moist(Mist(water(), number=30, nuclei=50.0, area=60.0, rain=0.5, keeps=12), walls=WARM)
    fell = []

    def check(time):
        if parcel.rained > len(fell):
            fell.append(parcel.liquid)

    parcel.advance(40.0, watch=check)
    # at most one more than the excess can fall as rain
    assert min(fell) >= 12
    assert len(fell) == parcel.rained > 15
    is_lawful(parcel, 40)


@many_events
def test_the_spectrum_counts_each_that_left():
    parcel = box("mist")
    parcel.advance(100.0)
    edges, counts = parcel.emitted_energy
    assert counts.sum() == parcel.evaporated > 100
    assert len(edges) == len(counts) + 1
    middle = 0.5 * (edges[1:] + edges[:-1])
    # seven degrees of freedom, each half a kT
    assert 3.0 < np.sum(middle * counts) / counts.sum() < 4.0


# ------------------------------------------------------------------ hardly any molecules


@pytest.mark.parametrize("kind", ["mist", "pool"])
@pytest.mark.parametrize("least", [1, pytest.param(0, marks=pytest.mark.validate)])  # without a kind: more kernels
@settings(max_examples=12)
@given(
    number=st.integers(0, 2),
    vapour=st.integers(0, 3),
    air=st.integers(0, 5),
    nuclei=st.sampled_from([0.0, 50.0]),
    sticking=st.sampled_from([0.3, 1.0]),
    rain=st.sampled_from([0.0, 0.0, 0.01]),
    seed=st.integers(0, 10_000),
    bath=st.booleans(),
)
def test_a_box_may_hold_hardly_any_water_and_air(kind, least, number, vapour, air, nuclei, sticking, rain, seed, bath):
    assume(min(number + vapour, air) >= least)
    facts = {"number": number, "nuclei": nuclei, "sticking": sticking, "rain": rain}
    substance = water(0.05, binding_energy=2.0)
    liquid = Mist(substance, area=40.0, **facts) if kind == "mist" else Pool(substance, **facts)
    walls = (*WARM[:4], Specular(), HeatBath(1.0)) if bath else SMOOTH
    parcel = moist(liquid, air, vapour, sides=(4.0, 4.0, 4.0), seed=seed, walls=walls)
    for time in (0.3, 3.0, 30.0 if COMPILED else 4.0):
        parcel.advance(time)
        is_lawful(parcel, number + vapour)


@pytest.mark.validate
@settings(max_examples=40)
@given(
    kind=st.sampled_from(["mist", "pool"]),
    number=st.integers(0, 2),
    vapour=st.integers(0, 3),
    nuclei=st.sampled_from([0.0, 50.0]),
    seed=st.integers(0, 10_000),
    speed=st.sampled_from([0.1, 1.0, 3.0]),
)
def test_a_piston_may_move_over_hardly_any_water(kind, number, vapour, nuclei, seed, speed):
    substance = water(0.05, binding_energy=2.0)
    facts = {"number": number, "nuclei": nuclei}
    liquid = Mist(substance, area=40.0, **facts) if kind == "mist" else Pool(substance, **facts)
    walls = (*TURNING[:4], Specular(), Piston())
    driver = Pulse(speeds=(speed, -speed, 0.5 * speed, -0.5 * speed))
    parcel = moist(liquid, 2, vapour, sides=(5.0, 5.0, 5.0), seed=seed, walls=walls, driver=driver)
    for time in (0.3, 3.0, 15.0 if COMPILED else 4.0):
        parcel.advance(time)
        is_lawful(parcel, number + vapour)


# ------------------------------------------------------------------ runs watched and divided


@many_events
@by_name
def test_looking_changes_nothing(name):
    watched, alone = box(name), box(name)
    for time in np.linspace(0.0, 9.0, 31)[1:]:
        watched.advance(time)
        watched.snapshot(), watched.energy(), watched.ledger(), watched.open_density, repr(watched)
        watched.liquid_kT, watched.degrees_of_freedom, watched.memory()
        watched.emitted_energy[1][:] = 0
    alone.advance(9.0)
    assert watched.condensed > 3
    assert state(watched) == state(alone)


@many_events
@by_name
def test_a_run_is_the_same_to_the_last_byte_however_it_is_cut(name):
    few = {"air": 4, "vapour": 3}
    whole = box(name, **few)
    epoch = whole._epoch_length
    end = 3.3 * epoch
    whole.advance(end)
    random = np.random.default_rng(6)
    cuts = [
        np.linspace(0.0, end, 8)[1:],
        [epoch, 2.0 * epoch, 3.0 * epoch, end],
        [*np.sort(random.uniform(0.0, end, 200)), end],
        [0.0, 0.75, 0.75, 1.5, math.nextafter(epoch, 0.0), math.nextafter(epoch, math.inf), end, end],
    ]
    assert whole._walls.epoch[0] == 3.0 * epoch
    assert whole.condensed > 10
    for times in cuts:
        parcel = box(name, **few)
        for time in times:
            parcel.advance(time)
            assert parcel.time == time
        assert state(parcel) == state(whole)


@many_events
def test_cutting_changes_nothing_while_all_water_is_in_the_liquid():
    # only sometimes vapour, and air that rests in a corner where nothing meets it: often no molecule has a next event
    def new():
        corner = {"position": [[5e-4] * 3], "diameter": [1e-3], "velocity": np.zeros((1, 3))}
        return moist(Mist(water(1e-4), number=8, nuclei=10.0, area=100.0), 1, 0, seed=3, **corner)

    whole = new()
    end = 40.5 * whole._epoch_length
    whole.advance(end)
    assert whole.evaporated > 20
    assert whole.vapour == 0
    assert not whole.snapshot().velocity.any()
    for pieces in (7, 81, 1000):
        parcel = new()
        for time in np.linspace(0.0, end, pieces)[1:]:
            parcel.advance(time)
        assert state(parcel) == state(whole)


@many_events
def test_chunks_of_events_change_nothing(monkeypatch):
    whole = box("mist")
    whole.advance(10.0)
    for chunk in (1, 3, 17):
        monkeypatch.setattr(moist_parcelset, "_CHUNK", chunk)
        parcel = box("mist")
        parcel.advance(10.0)
        assert state(parcel) == state(whole)


class Stop(Exception):
    """What a watch may raise, as Ctrl-C does."""


@many_events
@by_name
def test_a_run_that_is_interrupted_can_be_looked_at_and_go_on(name, by_single_events):
    def interrupt(time):
        if random.uniform() < 0.05:
            raise Stop

    random = np.random.default_rng(8)
    interrupted, whole = box(name), box(name)
    whole.advance(6.0)
    stops = 0
    while interrupted.time < 6.0:
        try:
            interrupted.advance(6.0, watch=interrupt)
        except Stop:
            stops += 1
            is_lawful(interrupted, 40)
    assert stops > 5
    assert state(interrupted) == state(whole)


# ------------------------------------------------------------------ extremes


@many_events
@pytest.mark.parametrize("kind", [Mist, Pool])
def test_without_any_water_nothing_condenses_and_air_keeps_its_energy(kind):
    parcel = moist(kind(water()), 20, 0, mass=np.r_[np.ones(10), np.full(10, 2.0)])
    energy = sum(parcel.energy())
    parcel.advance(100.0)
    assert (parcel.vapour, parcel.liquid, parcel.condensed, parcel.evaporated) == (0, 0, 0, 0)
    assert sum(parcel.energy()) == pytest.approx(energy, rel=1e-12)
    assert parcel.contacts > 100
    assert math.isnan(parcel.liquid_kT)
    assert parcel.liquid_energy == pytest.approx(0.0, abs=1e-12)
    is_lawful(parcel, 0)


@pytest.mark.validate
def test_an_empty_box_with_an_empty_mist_lets_time_pass():
    parcel = moist(Mist(water(rotation=0.0)), 0, 0)
    parcel.advance(1e6)
    assert (parcel.time, parcel.number, parcel.energy(), parcel.ledger()) == (1e6, 0, (0.0, 0.0, 0.0), 0.0)


@many_events
def test_all_vapour_condenses_where_none_can_leave():
    parcel = moist(Mist(water(1e-30), nuclei=50.0, area=60.0), 20, 10)
    parcel.advance(100.0)
    assert (parcel.vapour, parcel.liquid, parcel.evaporated, parcel.number) == (0, 10, 0, 20)
    # the binding energy warms the rest: the liquid has a heat capacity of 140, the air of 50
    values = []
    for k in range(2000):
        parcel.advance(101.0 + k)
        values.append(parcel.liquid_kT)
    mean, error = block_average(values)
    exact = (sum(parcel.energy()) + parcel.condensed_energy) / (140.0 + 50.0)
    assert exact > 1.05
    # a false alarm in 1 500 for a fresh seed
    assert abs(mean - exact) <= 4.0 * error
    is_lawful(parcel, 10)


@many_events
@pytest.mark.parametrize("kind", [Mist, Pool])
@pytest.mark.parametrize("nuclei", [0.0, 50.0])
def test_a_liquid_that_boils_dries_out(kind, nuclei):
    wide = {"area": 60.0} if kind is Mist else {}
    liquid = kind(water(1e4), number=20, nuclei=nuclei, **wide)
    parcel = moist(liquid, 20, 0, sides=(7.0, 7.0, 7.0), walls=WARM[:4] + SMOOTH[:2])
    time = 0.0
    while parcel.liquid and time < 200.0:
        time += 1.0
        parcel.advance(time)
    assert (parcel.liquid, parcel.vapour, parcel.number) == (0, 20, 40)
    assert parcel.liquid_energy == pytest.approx(nuclei * parcel.liquid_kT if nuclei else 0.0, abs=1e-11)
    is_lawful(parcel, 20)
    parcel.advance(time + 20.0)
    is_lawful(parcel, 20)


@many_events
def test_water_as_cold_as_in_a_polar_night_stays_and_closes():
    substance = water(1e-4, binding_energy=32.0)
    parcel = moist(Mist(substance, number=30, nuclei=50.0, area=60.0), 20, 3)
    parcel.advance(300.0)
    assert parcel.condensed >= 3
    is_lawful(parcel, 33)


@many_events
def test_a_single_molecule_of_liquid_without_nuclei_comes_and_goes():
    parcel = moist(Mist(water(0.02, binding_energy=2.0), number=1, area=100.0), 3, 0)
    seen = set()
    for k in range(1, 400):
        parcel.advance(0.5 * k)
        seen.add(parcel.liquid)
        is_lawful(parcel, 1)
    assert seen == {0, 1}
    assert min(parcel.condensed, parcel.evaporated) > 5


@many_events
def test_a_liquid_that_is_cold_at_the_start_warms_up():
    parcel = moist(Mist(water(), number=3, kT=0.0, area=60.0), 20, 5)
    parcel.advance(100.0)
    assert parcel.evaporated == parcel.emitted_energy[1].sum() > 0
    is_lawful(parcel, 8)


def crowd(liquid):
    """Return a box of which 0.45 is filled with molecules, half of them vapour."""
    rng = np.random.default_rng(4)
    number, sides = 186, (6.0, 6.0, 6.0)
    rotation = np.where(np.arange(number) % 2, 2.0, 3.0)
    return MoistParcelSet(
        lattice_positions(sides, np.ones(number), rng=rng),
        rng.standard_normal((number, 3)),
        length=sides,
        mass=np.where(rotation == 2.0, 1.0, MASS),
        rotation=rotation,
        rotational_energy=rng.standard_gamma(0.5 * rotation),
        liquid=liquid,
        seed=4,
    )


@many_events
@pytest.mark.parametrize("kind", [Mist, Pool])
def test_in_a_crowd_water_finds_room_or_says_that_there_is_none(kind):
    parcel = crowd(kind(water(1e9, diameter=1.0), number=100, nuclei=500.0))
    with pytest.raises(StalledError, match=r"finds no place among the 1\d\d others, which fill"):
        parcel.advance(50.0)
    assert parcel.time < 50.0
    assert parcel.number == 186 + parcel.evaporated - parcel.condensed
    is_lawful(parcel, 193)


@many_events
@pytest.mark.parametrize("kind", [Mist, Pool])
def test_in_a_crowd_vapour_condenses(kind):
    parcel = crowd(kind(water(1e-20, diameter=1.0), nuclei=500.0))
    parcel.advance(30.0)
    assert parcel.condensed > 10
    is_lawful(parcel, 93)


@many_events
def test_a_small_box_full_of_a_few_condenses():
    # the centres of three can reach an eighth of the room that their bodies fill
    parcel = moist(Mist(water(1e-20, diameter=1.0), nuclei=50.0, area=6.0), 2, 3, sides=(2.3, 2.3, 2.3), seed=2)
    parcel.advance(100.0)
    assert parcel.vapour == 0
    is_lawful(parcel, 3)


@many_events
def test_a_gas_almost_at_rest_that_a_piston_wakes_meets_the_mist():
    liquid = Mist(water(1e-20, diameter=1.0), nuclei=50.0, area=600.0)
    # the ceiling rests, and then comes down so fast that molecules become a thousand times as fast as they were
    fall = FollowPressure([0.0, 10.0, 30.0], [6e-8, 6e-8, 5e-7], mean_free_time=20.0)
    parcel = moist(liquid, 10, 10, sides=(5.0, 5.0, 20.0), walls=LIFTED, kT=1e-6, driver=fall)
    parcel.advance(10.0)
    assert parcel.condensed == 0
    parcel.advance(16.0)
    # at the speed that molecules had before, the next to meet the mist would do so after 20
    assert parcel.condensed > 3
    parcel.advance(60.0)
    assert parcel.contacts > 20
    is_lawful(parcel, 10)


@many_events
def test_a_piston_may_compress_the_mist_until_it_would_crush_it():
    liquid = Mist(water(diameter=1.0), number=20, nuclei=50.0, area=60.0)
    down = FollowPressure([0.0, 40.0, 100.0], [0.15, 1.0, 1e9], mean_free_time=1.0)
    parcel = moist(liquid, 20, 10, sides=(5.0, 5.0, 12.0), walls=LIFTED, driver=down)
    before = parcel.liquid_kT
    parcel.advance(40.0)
    assert parcel.work > 0.0
    assert parcel.liquid_kT > before
    is_lawful(parcel, 30)
    with pytest.raises(StalledError, match=r"the piston has come down|finds no place among"):
        parcel.advance(100.0)
    is_lawful(parcel, 30)


# ------------------------------------------------------------------ readings


@many_events
def test_a_box_tells_what_it_holds():
    parcel = moist(Mist(water(), number=30, kT=0.9, nuclei=50.0), 20, 10)
    assert (parcel.number, parcel.vapour, parcel.liquid, parcel.rained) == (30, 10, 30, 0)
    assert parcel.liquid_kT == pytest.approx(0.9, rel=1e-14)
    assert parcel.liquid_energy == pytest.approx(0.9 * (30 * 9.0 + 50.0), rel=1e-14)
    assert parcel.condensed_energy == pytest.approx(parcel.liquid_energy + 10 * PHI, rel=1e-14)
    assert parcel.degrees_of_freedom == pytest.approx((20 * 5.0 + 10 * 6.0) / 30)
    assert parcel.mass.sum() == pytest.approx(20.0 + 10 * MASS)
    assert repr(parcel).startswith("<MoistParcelSet: 30 molecules in 5.5 x 5.5 x 6")
    while parcel.number == 30:
        parcel.advance(parcel.time + 1.0)
    free = 20 * 5.0 + parcel.vapour * 6.0
    assert parcel.degrees_of_freedom == pytest.approx(free / parcel.number)
    assert parcel.internal_energy() == pytest.approx(sum(parcel.energy()), rel=1e-10)
    reach = [(parcel.length - d).prod() for d in parcel.diameter]
    assert parcel.open_density == pytest.approx(np.sum(1.0 / np.array(reach)))


def test_a_whole_number_may_be_given_as_a_decimal():
    assert moist(Mist(water(), number=3.0)).liquid == 3


# ------------------------------------------------------------------ costs for dry air


def test_dry_air_never_hears_of_water():
    code = (
        "import sys\n"
        "from atmosbox.engine import ParcelSet\n"
        "box = ParcelSet([[1, 2, 2], [3, 2, 2]], [[1, 0, 0], [-1, 0, 0]], length=(4, 4, 4))\n"
        "box.advance(1.0)\n"
        "print(box.contacts, sorted(name for name in sys.modules if name.startswith('atmosbox.engine.')))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    contacts, names = done.stdout.split(" ", 1)
    assert contacts == "1"
    assert "'atmosbox.engine.exact.exact'" in names
    assert "'atmosbox.engine.liquid" not in names


def test_the_kernels_of_dry_air_have_no_phases():
    parcel = ParcelSet([[1, 2, 2], [3, 2, 2]], np.zeros((2, 3)), length=(4, 4, 4))
    assert (parcel._modes.phases, parcel._modes.pool) == (False, False)
    assert isinstance(parcel._present, slice)
