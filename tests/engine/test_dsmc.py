"""Direct simulation Monte Carlo keeps its counters, keeps its molecules in the box, and does the same on any
number of threads; what does not depend on chance, it does as the exact engine does.
"""

import math

import numpy as np
import pytest

from atmosbox.engine import HeatBath, ParcelSet, Periodic, Piston, Ramp, Specular, StalledError
from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.core.measure import momentum
from atmosbox.engine.dsmc.columns import BLOCK
from atmosbox.engine.dsmc.dsmc_parcel import DsmcParcel

many_molecules = pytest.mark.skipif(not COMPILED, reason="so many molecules take minutes without numba")

SMOOTH, TURNING = (Specular(),) * 6, (Periodic(),) * 6
RAMP = HeatBath(Ramp(0.5, 2.0, start=1.0, end=20.0), accommodation=0.7)
ALL_LAWS = (*SMOOTH[:2], RAMP, HeatBath(1.5), HeatBath(1.0), Piston())


class Pulse:
    """A driver that moves the piston out and in, depending on the state of the gas."""

    interval = 3.3

    def velocity(self, parcel):
        return 0.05 * math.sin(parcel.time) + 1e-3 * parcel.internal_energy() / max(parcel.number, 1)


def box(number, side=30.0, *, kT=1.0, seed=5, **changes):
    """Return a gas at random places, whose molecules may overlap."""
    rng = np.random.default_rng(seed)
    made = {
        "position": 0.5 + (side - 1.0) * rng.random((number, 3)),
        "velocity": math.sqrt(kT) * rng.normal(size=(number, 3)),
        "length": (side,) * 3,
        "walls": TURNING,
        "seed": seed,
    }
    return DsmcParcel(**(made | changes))


def everything(number=12_000, **changes):
    """Return a gas with all features: every law of walls, gravity, rotation, a piston with a driver."""
    spin = np.random.default_rng(6).exponential(size=number)
    return box(
        number, 60.0, walls=ALL_LAWS, gravity=0.02, driver=Pulse(), rotation=2, rotational_energy=spin,
        collision_number=3.0, **changes,
    )  # fmt: skip


def counters(parcel):
    """Return all results of a run, as bytes."""
    now = parcel.snapshot()
    told = (*now[1:], parcel.wall_heat, parcel.wall_impulse, parcel.wall_hits, [parcel.work, parcel.contacts, now.time])
    return b"".join(np.asarray(a, np.float64).tobytes() for a in told)


@pytest.mark.parametrize("rotation", [0, 2, 3])
def test_collisions_keep_energy_and_momentum(rotation):
    number = 3000
    spin = np.full(number, 0.7) if rotation else None
    gas = box(number, rotation=rotation, rotational_energy=spin)
    energy, total = sum(gas.energy()), momentum(gas, gas.snapshot())
    gas.advance(20.0)
    assert gas.contacts > 5 * number
    assert sum(gas.energy()) == pytest.approx(energy, rel=1e-12)
    assert np.abs(momentum(gas, gas.snapshot()) - total).max() < 1e-10 * number
    assert (np.ptp(gas.snapshot().rotational_energy) > 0.0) == bool(rotation)


@many_molecules
def test_the_energy_budget_closes_with_every_wall_gravity_rotation_and_a_driven_piston():
    gas = everything()
    gas.advance(100.0)
    assert min(gas.wall_hits) > 1000
    assert gas.work != 0.0
    assert np.abs(gas.wall_heat[2:5]).min() > 1.0
    assert gas.ledger() <= 1e-12
    assert gas.escaped() == 0
    assert gas.virial.sum() == 0.0
    assert gas.ideal


@pytest.mark.nightly  # the kernel for several threads takes longer to compile than any other
@many_molecules
def test_a_run_is_the_same_on_any_number_of_threads_and_however_it_is_cut():
    runs = []
    for threads in (1, 7):
        gas = everything(threads=threads)
        gas.advance(30.0)
        runs.append(counters(gas))
    gas = everything()
    for time in np.linspace(0.0, 30.0, 37):
        gas.advance(time)
    runs.append(counters(gas))
    assert gas.steps > 65
    assert gas.contacts > 10_000
    assert len(set(runs)) == 1


@pytest.mark.parametrize(
    ("walls", "gravity"), [(TURNING, 0.0), ((*TURNING[:4], *SMOOTH[:2]), 0.3), ((*SMOOTH[:5], Piston(-0.05)), 0.3)]
)
def test_points_that_never_meet_fly_as_in_the_exact_engine_and_keep_their_names(walls, gravity):
    number, side = (BLOCK + 500, 8.0) if COMPILED else (40, 8.0)
    small = 1e-7  # so that there are cells, and no collisions
    gas = box(number, side, walls=walls, gravity=gravity, diameter=small, dt=0.2)
    start = gas.snapshot()
    exact = ParcelSet(*start[1:3], length=(side,) * 3, walls=walls, gravity=gravity, diameter=small)
    gas.advance(75.0)  # far enough to be put in the order of cells twice
    exact.advance(gas.time)
    assert gas.steps > 65
    ours, theirs = gas.snapshot(), exact.snapshot()
    apart = np.abs(ours.position - theirs.position)
    apart = np.minimum(apart, np.where(gas.periodic, gas.length - apart, np.inf))
    assert apart.max() < 1e-9
    assert np.abs(ours.velocity - theirs.velocity).max() < 1e-9
    assert gas.wall_impulse == pytest.approx(exact.wall_impulse, rel=1e-10)
    assert gas.wall_hits.tolist() == exact.wall_hits.tolist()
    assert gas.work == pytest.approx(exact.work, rel=1e-9, abs=1e-12)
    assert gas.contacts == 0


@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize("walls", [TURNING, ALL_LAWS])
def test_a_box_of_dsmc_may_hold_three_molecules_or_none(number, walls):
    gas = box(number, 5.0, walls=walls, rotation=2, gravity=0.1 if walls == ALL_LAWS else 0.0)
    gas.advance(500.0)
    assert gas.steps > 0
    assert gas.escaped() == 0
    assert gas.ledger() <= 1e-12
    assert (gas.contacts > 0) == (number > 1)


@pytest.mark.parametrize("dt", [0.01, 1.0, 10.0])
def test_no_molecule_of_dsmc_leaves_the_box(dt):
    gas = box(500, 12.0, walls=(*SMOOTH[:4], HeatBath(1.0), Piston(-0.2)), gravity=5.0, dt=dt)
    for time in np.arange(1.0, 30.0, 2.0):
        gas.advance(time)
        assert gas.escaped() == 0
    assert gas.ledger() <= 1e-12


def test_a_gas_at_rest_falls_and_collides():
    number = 1000
    gas = box(number, 20.0, velocity=np.zeros((number, 3)), walls=SMOOTH, gravity=0.1)
    gas.advance(300.0)
    assert gas.contacts > number
    assert gas.energy()[0] > 0.0
    assert gas.ledger() <= 1e-12
    still = box(number, 20.0, velocity=np.zeros((number, 3)))
    still.advance(10.0)
    assert still.contacts == 0


def test_a_piston_that_comes_down_too_far_says_so():
    gas = box(30, 10.0, walls=(*SMOOTH[:5], Piston(-1.0)))
    with pytest.raises(StalledError, match=r"the piston has come down to 1\.\d+ at t = [89]\.\d+"):
        gas.advance(20.0)
    assert gas.escaped() == 0
    with pytest.raises(StalledError, match="the piston has come down"):
        gas.advance(21.0)
    gas.set_piston_velocity(1.0)
    gas.advance(20.0)
    assert gas.ceiling > 5.0
