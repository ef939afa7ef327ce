"""Changes by hand: the energy budget closes, molecules react, and a box that is not changed stays the same."""

import math

import numpy as np
import pytest

from atmosbox.engine import (
    HeatBath,
    Mist,
    ParcelSet,
    Periodic,
    Piston,
    Pool,
    Ramp,
    RefusedError,
    Specular,
    Substance,
    maxwell_velocities,
    random_positions,
)
from atmosbox.engine.dsmc.dsmc_parcel import DsmcParcel
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from atmosbox.engine.stepped.stepped_parcel import SteppedParcel

ENGINES = (ParcelSet, SteppedParcel, DsmcParcel)
BATHS = (HeatBath(1.0),) * 6
COLUMN = (Periodic(),) * 4 + (HeatBath(1.0), Specular())
WATER = Substance(mass=1.0, diameter=1.0, binding_energy=2.0, heat_capacity=9.0, volatility=1.0)


def box(engine, *, number=200, side=12.0, seed=1, **more):
    """Return a gas at kT = 1."""
    rng = np.random.default_rng(seed)
    length = (side,) * 3
    if engine is SteppedParcel:
        more.setdefault("delta", 0.01)
    walls = more.setdefault("walls", BATHS)
    turns = tuple(isinstance(wall, Periodic) for wall in walls[::2])
    place = random_positions(length, np.ones(number), rng, periodic=turns)
    return engine(place, maxwell_velocities(1.0, np.ones(number), rng), length=length, seed=seed, **more)


def damp(liquid):
    """Return a molecule of vapour and one of air over a liquid."""
    facts = {"length": (4, 4, 4), "mass": [1.0, 2.0], "rotation": [3.0, 2.0]}
    return MoistParcelSet([[1, 1, 1], [3, 3, 3]], np.zeros((2, 3)), liquid=liquid, **facts)


@pytest.mark.parametrize("engine", ENGINES)
def test_molecules_become_as_warm_as_walls_that_are_made_warmer(engine):
    gas = box(engine)
    gas.advance(5.0)
    gas.set_wall_kT(3.0)
    gas.advance(40.0)
    seen = []
    for t in range(42, 202, 2):
        gas.advance(float(t))
        seen.append(2.0 * gas.energy()[0] / (3.0 * gas.number))
    # the gas forgets its energy at the walls within 4 V / A c = 2.7 units of time, and a block lasts 8
    blocks = np.mean(np.reshape(seen, (20, 4)), axis=1)
    error = blocks.std(ddof=1) / math.sqrt(20)
    assert abs(blocks.mean() - 3.0) < 4.0 * error + 0.02  # 4 errors of 20 blocks: 1 false alarm in 1300; steps: 0.02
    assert gas.ledger() < 1e-12
    assert gas.wall_kT().tolist() == [3.0] * 6
    assert not gas.escaped()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_change_of_gravity_is_in_the_energy_budget_and_moves_no_molecule(engine):
    gas = box(engine, walls=COLUMN, gravity=0.1)
    gas.advance(20.0)
    before = gas.snapshot()
    potential = gas.energy()[2]
    gas.set_gravity(0.25)
    after = gas.snapshot()
    assert np.allclose(before.position, after.position, rtol=0.0, atol=1e-12)
    assert np.array_equal(before.velocity, after.velocity)
    assert gas.gravity_work == pytest.approx(1.5 * potential, rel=1e-12)
    gas.advance(60.0)
    gas.set_gravity(0.0)
    assert gas.energy()[2] == 0.0
    gas.advance(70.0)
    gas.set_gravity(0.05)
    gas.advance(80.0)
    assert gas.ledger() < 1e-12
    assert not gas.escaped()
    assert gas.gravity == 0.05


@pytest.mark.parametrize("engine", [pytest.param(ParcelSet, marks=pytest.mark.nightly), *ENGINES[1:]])
def test_without_collisions_molecules_meet_walls_alone(engine):
    gas = box(engine, collisions=False)
    gas.advance(20.0)
    assert gas.contacts == 0
    assert gas.wall_hits.sum() > 100
    assert gas.ideal
    assert gas.ledger() < 1e-12
    assert not gas.escaped()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_smooth_wall_becomes_a_heat_bath_and_is_smooth_again(engine):
    gas = box(engine, number=50, walls=(Specular(),) * 6)
    gas.set_wall(0, HeatBath(4.0))
    gas.advance(20.0)
    heat = gas.wall_heat.tolist()
    assert heat[0] > 1.0
    assert heat[1:] == [0.0] * 5
    gas.set_wall(0, Specular())
    warm = sum(gas.energy())
    gas.advance(40.0)
    assert sum(gas.energy()) == pytest.approx(warm, rel=1e-12)
    assert gas.wall_heat.tolist() == heat
    assert gas.ledger() < 1e-12


def test_a_change_that_a_box_cannot_have_is_refused_in_a_sentence_and_changes_nothing():
    column = box(ParcelSet, walls=COLUMN, gravity=0.1)
    under_piston = box(ParcelSet, number=2, walls=(Specular(),) * 5 + (Piston(),))
    endless = box(ParcelSet, number=2, walls=(Periodic(),) * 6)
    mist, pool = damp(Mist(WATER, number=2, kT=1.0)), damp(Pool(WATER, number=2, kT=1.0))
    cases = [
        (column.set_wall_kT, (0.0,), "above 0"),
        (column.set_wall_kT, (1.0, 5), "z_high is not a heat bath"),
        (column.set_gravity, (-1.0,), "at least 0 and at most "),
        (under_piston.set_wall_kT, (2.0,), "make one a HeatBath"),
        (endless.set_gravity, (1.0,), "fall for ever"),
        (mist.set_gravity, (1.0,), "no gravity"),
        (mist.set_open_pool, (0.5,), "only a pool can be covered"),
        (pool.set_open_pool, (1.5,), r"open share of the pool = 1\.5"),
        (under_piston.set_wall, (5, HeatBath(1.0)), "wall z_high is neither smooth nor a heat bath: choose"),
        (under_piston.set_wall, (0, Periodic()), "wall x_low = Periodic.*: give Specular or HeatBath"),
        (under_piston.set_wall, (0, HeatBath(Ramp(1.0, 2.0, start=0.0, end=1.0))), "changes with time: give one"),
    ]
    for engine in ENGINES[1:]:
        gas = box(engine, walls=COLUMN, gravity=0.1)
        cases += [(gas.set_wall_kT, (100.0,), "too hot for the step"), (gas.set_gravity, (1e6,), "within a step")]
    for change, given, words in cases:
        parcel = change.__self__
        before = parcel.gravity, parcel._walls.law.tolist(), parcel.wall_kT().tolist()
        with pytest.raises(RefusedError, match=words):
            change(*given)
        assert repr((parcel.gravity, parcel._walls.law.tolist(), parcel.wall_kT().tolist())) == repr(before)
