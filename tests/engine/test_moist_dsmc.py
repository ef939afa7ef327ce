"""Moist air keeps its counters at every step, does the same on any number of threads and however a run is divided.

The boxes below need six sets of kernels in all: each new set costs seconds of compilation.
"""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from atmosbox.engine import (
    HeatBath,
    Mist,
    Periodic,
    Piston,
    Pool,
    Specular,
    StalledError,
    Substance,
)
from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.dsmc.dsmc_parcel import DsmcParcel
from atmosbox.engine.dsmc.moist_dsmc_parcel import MoistDsmcParcel
from atmosbox.engine.liquid.reservoir import AIR_MET
from atmosbox.scene.statistics import block_average

many_steps = pytest.mark.skipif(not COMPILED, reason="so many steps take minutes without numba")

SMOOTH, TURNING, WARM = (Specular(),) * 6, (Periodic(),) * 6, (HeatBath(1.0),) * 6
LIFT = (*TURNING[:4], Specular(), Piston())
PHI, MASS = 8.0, 0.62


def water(saturation=0.1, **changes):
    """Return water of a saturation pressure at kT = 1."""
    facts = {"mass": MASS, "diameter": 1.0, "binding_energy": PHI, "heat_capacity": 9.0} | changes
    return Substance(**facts, volatility=saturation * math.exp(facts["binding_energy"]))


class Pulse:
    """A driver that moves the piston up and down, and a little by the state of the parcel."""

    interval = 0.75

    def velocity(self, parcel):
        warmth = parcel.internal_energy() / (parcel.degrees_of_freedom * max(parcel.number, 1))
        return (0.3, -0.45, 0.0, -0.15, 0.3)[round(parcel.time / self.interval) % 5] + 0.01 * math.sin(100.0 * warmth)


def moist(liquid, air=20, vapour=10, *, sides=(5.5, 5.5, 6.0), kT=1.0, seed=9, **options):
    """Return a box of air and vapour at random places, with its liquid."""
    rng = np.random.default_rng(seed)
    mass = np.r_[np.full(vapour, liquid.substance.mass), np.ones(air)]
    rotation = np.r_[np.full(vapour, liquid.substance.rotation), np.full(air, 2.0)]
    number = air + vapour
    facts = {
        "mass": mass,
        "rotation": rotation,
        "rotational_energy": kT * rng.standard_gamma(0.5 * rotation),
        "length": sides,
        "walls": SMOOTH,
        "seed": seed,
    }
    position = 0.5 + (np.array(sides) - 1.0) * rng.random((number, 3))
    velocity = rng.standard_normal((number, 3)) * np.sqrt(kT / mass)[:, None]
    return MoistDsmcParcel(position, velocity, liquid=liquid, **facts | options)


def box(name, **changes):
    """Return a box by the name of its special feature."""
    facts = {"number": 30, "nuclei": 50.0, "rain": 0.02, "sticking": 0.8}
    mist, pool = {"area": 60.0} | facts, facts
    cases = {
        "mist": lambda: moist(Mist(water(), **mist), walls=WARM, **changes),
        "pool": lambda: moist(Pool(water(), **pool), walls=(*WARM[:4], Specular(), HeatBath(1.0)), **changes),
        "periodic": lambda: moist(Mist(water(), **mist), walls=TURNING, **changes),
        "mist under a piston": lambda: moist(Mist(water(), **mist), walls=LIFT, driver=Pulse(), **changes),
        "pool under a piston": lambda: moist(Pool(water(), **pool), walls=LIFT, driver=Pulse(), **changes),
    }
    return cases[name]()


NAMES = ["mist", "pool", "periodic", "mist under a piston", "pool under a piston"]
by_name = pytest.mark.parametrize("name", NAMES)


def many(name, **changes):
    """Return a number of molecules that is large enough for several threads."""
    facts = {"number": 3000, "nuclei": 50.0, "rain": 0.01, "sticking": 0.8}
    liquid = Mist(water(0.2), area=3000.0, **facts) if name == "mist" else Pool(water(0.2), **facts)
    return moist(liquid, 8000, 1000, sides=(30.0, 30.0, 20.0), walls=LIFT, driver=Pulse(), **changes)


def state(parcel):
    """Return everything that can be read off a parcel, as bytes."""
    now, ledger = parcel.snapshot(), parcel._reservoir
    arrays = [*now[1:], parcel.wall_heat, parcel.wall_impulse, parcel.wall_hits, parcel.mass, parcel.present]
    arrays += [ledger.energy, ledger.count, ledger.spectrum, ledger.absent[: ledger.top[0]]]
    arrays += [[parcel.time, parcel.ceiling, parcel.work, parcel.contacts, parcel.number, parcel.liquid]]
    return b"".join(np.asarray(array, np.float64).tobytes() for array in arrays)


def is_lawful(parcel, waters):
    """Assert what must hold of every box at every time."""
    now, n = parcel.snapshot(), parcel.number
    assert parcel.escaped() == 0
    assert (now.rotational_energy >= 0.0).all()
    assert min(parcel.liquid, parcel.vapour, parcel.condensed, parcel.evaporated, parcel.rained) >= 0
    assert parcel.liquid + parcel.vapour + parcel.rained == waters
    assert len(now.position) == n == len(parcel.mass) == len(parcel.diameter) == parcel.present.sum()
    names = parcel._columns.identity[:n]
    assert np.array_equal(np.sort(names), np.flatnonzero(parcel.present))
    # the number of molecules of each kind is constant, and the columns agree with the list
    assert np.array_equal(parcel._gas.masses[parcel._columns.kind[:n]], parcel._mass[names])
    # the rounding error that is left when the last molecule takes all energy
    assert parcel.liquid_energy >= -1e-11
    assert parcel.ledger() < 1e-10


# ------------------------------------------------------------------ its counters, step by step


@by_name
def test_energy_and_water_close_at_every_step(name):
    parcel = box(name)
    start = sum(parcel.energy()) + parcel.condensed_energy
    happened = np.zeros(4, np.int64)
    while (happened < (8 if COMPILED else 2)).any():
        assert parcel.steps < 5000
        parcel.advance((parcel.steps + 1) * parcel.time_step)
        assert parcel.vapour + parcel.liquid + parcel.rained == 40
        assert parcel.number == 20 + parcel.vapour == len(parcel.snapshot().position)
        kinetic, rotational, potential = parcel.energy()
        inside = kinetic + rotational + parcel.liquid_energy + PHI * parcel.vapour + parcel._reservoir.energy[1]
        assert potential == 0.0
        assert inside - parcel.wall_heat.sum() - parcel.work == pytest.approx(start, rel=1e-10)
        assert parcel.internal_energy() == pytest.approx(kinetic + rotational, rel=1e-9)
        assert parcel.ledger() < 1e-10
        happened[:] = parcel.condensed, parcel.evaporated, parcel._reservoir.count[AIR_MET], parcel.rained
    assert parcel.contacts > 0
    if "piston" in name:
        assert parcel.work != 0.0
    if "pool" in name:
        # each molecule that hits the pool is counted, and its impulse acts on the floor
        assert parcel.wall_hits[4] == parcel.condensed + parcel._reservoir.count[AIR_MET]
        assert parcel.wall_impulse[4] > 0.0
    is_lawful(parcel, 40)


@many_steps
@by_name
def test_rain_takes_all_water_in_the_end(name):
    parcel = box(name)
    parcel.advance(3000.0)
    assert parcel.rained > 35
    is_lawful(parcel, 40)


@many_steps
def test_it_rains_only_what_the_liquid_does_not_keep():
    parcel = moist(Mist(water(), number=30, nuclei=50.0, area=60.0, rain=0.5, keeps=12), walls=WARM)
    held = []
    while parcel.time < 60.0:
        rained = parcel.rained
        parcel.advance((parcel.steps + 1) * parcel.time_step)
        held += [parcel.liquid] * (parcel.rained > rained)
    assert parcel.rained > 15
    # after rain within a step some molecules may still have evaporated, hardly ever many
    assert 10 <= min(held) <= 12
    is_lawful(parcel, 40)


@many_steps
def test_the_spectrum_counts_each_that_left():
    parcel = box("mist")
    parcel.advance(100.0)
    edges, counts = parcel.emitted_energy
    assert counts.sum() == parcel.evaporated > 100
    middle = 0.5 * (edges[1:] + edges[:-1])
    # seven degrees of freedom, each half a kT
    assert 3.0 < np.sum(middle * counts) / counts.sum() < 4.0


def test_a_contact_of_unlike_molecules_keeps_energy_and_momentum():
    still = Mist(water(1e-300), number=0, area=1e-9)
    parcel = moist(still, 300, 300, sides=(10.0, 10.0, 10.0), walls=TURNING)
    before = parcel.snapshot()
    momentum, energy = parcel.mass @ before.velocity, sum(parcel.energy())
    parcel.advance(10.0 if COMPILED else 1.0)
    after = parcel.snapshot()
    assert parcel.contacts > 500
    assert sum(parcel.energy()) == pytest.approx(energy, rel=1e-12)
    assert parcel.mass @ after.velocity == pytest.approx(momentum, abs=1e-11)


@many_steps
def test_unlike_molecules_come_to_one_temperature():
    still = Mist(water(1e-300), number=0, area=1e-9)
    parcel = moist(still, 3000, 3000, sides=(30.0, 30.0, 30.0), walls=TURNING, kT=1.0)
    is_vapour = parcel.mass < 0.9
    # the air starts with twice the velocity along x, out of equilibrium
    parcel._columns.vx[:6000][~is_vapour] *= 2.0
    parcel.advance(100.0)
    rows = []
    for k in range(400):
        parcel.advance(100.0 + 2.0 * k)
        now = parcel.snapshot()
        flight = parcel.mass * np.sum(now.velocity**2, axis=1) / 3.0
        turns = now.rotational_energy / np.where(is_vapour, 1.5, 1.0)
        rows.append([values[kind].mean() for values in (flight, turns) for kind in (is_vapour, ~is_vapour)])
    mean, error = block_average(rows)
    exact = sum(parcel.energy()) / (3000 * 3.0 + 3000 * 2.5)
    # four numbers: a false alarm in 400 for a fresh seed
    assert (error < 0.005).all()
    assert (np.abs(mean - exact) <= 4.0 * error).all()


# ------------------------------------------------------------------ hardly any molecules


@settings(max_examples=60 if COMPILED else 10)
@given(
    kind=st.sampled_from(["mist", "pool"]),
    number=st.integers(0, 2),
    vapour=st.integers(0, 3),
    air=st.integers(0, 5),
    nuclei=st.sampled_from([0.0, 50.0]),
    sticking=st.sampled_from([0.3, 1.0]),
    rain=st.sampled_from([0.0, 0.0, 0.01]),
    seed=st.integers(0, 10_000),
    walls=st.sampled_from(["bath", "smooth", "piston"]),
)
def test_a_box_may_hold_hardly_any_water_and_air(kind, number, vapour, air, nuclei, sticking, rain, seed, walls):
    facts = {"number": number, "nuclei": nuclei, "sticking": sticking, "rain": rain}
    substance = water(0.05, binding_energy=2.0)
    liquid = Mist(substance, area=40.0, **facts) if kind == "mist" else Pool(substance, **facts)
    given = {"bath": (*WARM[:4], Specular(), HeatBath(1.0)), "smooth": SMOOTH, "piston": LIFT}[walls]
    driver = Pulse() if walls == "piston" else None
    parcel = moist(liquid, air, vapour, sides=(4.0, 4.0, 4.0), seed=seed, walls=given, driver=driver)
    for time in (0.3, 3.0, 12.0 if COMPILED else 4.0):
        parcel.advance(time)
        is_lawful(parcel, number + vapour)


# ------------------------------------------------------------------ runs watched, divided and shared by threads


@many_steps
@by_name
def test_a_run_is_the_same_to_the_last_byte_however_it_is_cut_and_looked_at(name):
    whole = box(name)
    whole.advance(60.0)
    assert whole.steps > 100
    assert whole.condensed > 20
    random = np.random.default_rng(6)
    for times in (np.linspace(0.0, 60.0, 8), [*np.sort(random.uniform(0.0, 60.0, 200)), 60.0]):
        parcel = box(name)
        for time in times:
            parcel.advance(time)
            parcel.snapshot(), parcel.energy(), parcel.ledger(), parcel.open_density, repr(parcel)
            parcel.liquid_kT, parcel.degrees_of_freedom, parcel.memory(), parcel.resolution()
            parcel.emitted_energy[1][:] = 0
        assert state(parcel) == state(whole)
    other = box(name, seed=10)
    other.advance(60.0)
    assert state(other) != state(whole)


@many_steps
@pytest.mark.validate  # half a minute to compile; that of dry air is in the plain tier
@pytest.mark.parametrize("name", ["mist", "pool"])
def test_a_run_is_the_same_on_any_number_of_threads(name):
    runs = []
    for threads in (1, 2, 3):
        parcel = many(name, threads=threads)
        parcel.advance(20.0)
        runs.append(state(parcel))
    assert parcel.steps > 60
    assert min(parcel.condensed, parcel.evaporated, parcel.rained) > 100
    is_lawful(parcel, 4000)
    assert len(set(runs)) == 1


class Stop(Exception):
    """What a watch may raise, as Ctrl-C does."""


def test_a_run_that_is_interrupted_can_be_looked_at_and_go_on():
    def interrupt(time):
        if random.uniform() < 0.3:
            raise Stop

    random = np.random.default_rng(8)
    interrupted, whole = box("mist under a piston"), box("mist under a piston")
    whole.advance(15.0)
    stops = 0
    while interrupted.time < whole.time:
        try:
            interrupted.advance(15.0, watch=interrupt)
        except Stop:
            stops += 1
            is_lawful(interrupted, 40)
    assert stops > 3
    assert state(interrupted) == state(whole)


# ------------------------------------------------------------------ extremes


@many_steps
@pytest.mark.parametrize("kind", [Mist, Pool])
def test_without_any_water_air_is_dry(kind):
    parcel = moist(kind(water()), 20, 0)
    energy = sum(parcel.energy())
    parcel.advance(100.0)
    assert (parcel.vapour, parcel.liquid, parcel.condensed, parcel.evaporated) == (0, 0, 0, 0)
    assert sum(parcel.energy()) == pytest.approx(energy, rel=1e-12)
    assert parcel.contacts > 100
    assert math.isnan(parcel.liquid_kT)
    is_lawful(parcel, 0)


@many_steps
def test_without_water_and_liquid_all_is_as_in_dry_air_to_the_last_byte():
    # of one kind, with a mist so thin that no molecule ever hits it
    rng = np.random.default_rng(5)
    facts = {
        "position": 0.5 + 19.0 * rng.random((2000, 3)),
        "velocity": rng.normal(size=(2000, 3)),
        "rotation": 2.0,
        "rotational_energy": rng.exponential(size=2000),
        "length": (20.0,) * 3,
        "walls": (*WARM[:5], Piston(0.05)),
        "seed": 3,
    }
    dry = DsmcParcel(**facts)
    moist_air = MoistDsmcParcel(**facts, liquid=Mist(water(), area=1e-12))
    dry.advance(60.0)
    moist_air.advance(60.0)
    assert dry.steps > 50
    assert moist_air.contacts == dry.contacts
    for ours, theirs in zip(moist_air.snapshot()[1:], dry.snapshot()[1:], strict=True):
        assert np.array_equal(ours, theirs)
    assert np.array_equal(moist_air.wall_impulse, dry.wall_impulse)


def test_an_empty_box_with_an_empty_mist_lets_time_pass():
    parcel = moist(Mist(water(rotation=0.0)), 0, 0)
    parcel.advance(1e3)
    assert (parcel.number, parcel.energy(), parcel.ledger()) == (0, (0.0, 0.0, 0.0), 0.0)


@many_steps
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
    assert exact > 1.02
    # a false alarm in 1 500 for a fresh seed
    assert abs(mean - exact) <= 4.0 * error
    is_lawful(parcel, 10)


@many_steps
@pytest.mark.parametrize("kind", [Mist, Pool])
@pytest.mark.parametrize("nuclei", [0.0, 50.0])
def test_a_liquid_that_boils_dries_out(kind, nuclei):
    wide = {"area": 60.0} if kind is Mist else {}
    liquid = kind(water(1e4), number=20, nuclei=nuclei, **wide)
    parcel = moist(liquid, 20, 0, sides=(7.0, 7.0, 7.0), walls=WARM[:4] + SMOOTH[:2])
    while parcel.liquid and parcel.time < 200.0:
        parcel.advance(parcel.time + 1.0)
    assert (parcel.liquid, parcel.vapour, parcel.number) == (0, 20, 40)
    assert parcel.liquid_energy == pytest.approx(nuclei * parcel.liquid_kT if nuclei else 0.0, abs=1e-11)
    is_lawful(parcel, 20)
    parcel.advance(parcel.time + 20.0)
    is_lawful(parcel, 20)


@many_steps
@pytest.mark.parametrize("kind", [Mist, Pool])
def test_a_hundred_thousand_molecules_of_vapour_condense_and_come_back(kind):
    wide = {"area": 60_000.0} if kind is Mist else {}
    liquid = kind(water(0.3), number=1000, nuclei=100.0, **wide)
    parcel = moist(liquid, 20_000, 100_000, sides=(50.0, 50.0, 50.0), walls=(*TURNING[:4], *SMOOTH[:2]))
    parcel.advance(4.0)
    assert parcel.condensed > (10_000 if kind is Mist else 1000)
    assert parcel.evaporated > 1000
    is_lawful(parcel, 101_000)


@many_steps
@pytest.mark.parametrize("name", ["mist", "pool"])
def test_a_gas_at_rest_that_a_piston_wakes_meets_the_liquid(name):
    walls = (*TURNING[:4], Specular(), Piston(-0.5))
    substance = water(1e-20)
    liquid = Mist(substance, nuclei=50.0, area=600.0) if name == "mist" else Pool(substance, nuclei=50.0)
    parcel = moist(liquid, 10, 10, sides=(5.0, 5.0, 20.0), walls=walls, kT=0.0)
    parcel.advance(35.0)
    assert parcel.condensed > 0
    is_lawful(parcel, 10)


@many_steps
def test_a_piston_may_compress_the_mist_until_it_would_crush_it():
    walls = (*TURNING[:4], Specular(), Piston(-0.2))
    parcel = moist(Mist(water(), number=20, nuclei=50.0, area=60.0), 20, 10, sides=(5.0, 5.0, 12.0), walls=walls)
    before = parcel.liquid_kT
    parcel.advance(40.0)
    assert parcel.work > 0.0
    assert parcel.liquid_kT > before
    is_lawful(parcel, 30)
    with pytest.raises(StalledError, match="the piston has come down"):
        parcel.advance(100.0)
    is_lawful(parcel, 30)


# ------------------------------------------------------------------ readings


def test_a_box_tells_what_it_holds():
    parcel = moist(Mist(water(), number=30, kT=0.9, nuclei=50.0), 20, 10)
    assert (parcel.number, parcel.vapour, parcel.liquid, parcel.rained) == (30, 10, 30, 0)
    assert parcel.liquid_kT == pytest.approx(0.9, rel=1e-14)
    assert parcel.condensed_energy == pytest.approx(parcel.liquid_energy + 10 * PHI, rel=1e-14)
    assert parcel.degrees_of_freedom == pytest.approx((20 * 5.0 + 10 * 6.0) / 30)
    assert parcel.mass.sum() == pytest.approx(20.0 + 10 * MASS)
    assert repr(parcel).startswith("<MoistDsmcParcel: 30 molecules in 5.5 x 5.5 x 6")
    while parcel.number == 30:
        parcel.advance(parcel.time + 1.0)
    free = 20 * 5.0 + parcel.vapour * 6.0
    assert parcel.degrees_of_freedom == pytest.approx(free / parcel.number)
    assert parcel.internal_energy() == pytest.approx(sum(parcel.energy()), rel=1e-10)
    assert parcel.open_density == pytest.approx(parcel.number / np.prod(parcel.length - 1.0))
