"""Runs of an hour, by hand: ``pytest -m soak``."""

import resource

import numpy as np
import pytest

from atmosbox.engine import FollowPressure, HeatBath, Mist, ParcelSet, Periodic, Piston, Specular, Substance
from atmosbox.engine.dsmc.dsmc_parcel import DsmcParcel
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet

pytestmark = pytest.mark.soak

CONTACTS = 1e9  # of all exact boxes together
WATER = Substance(mass=0.62, diameter=1.0, rotation=3.0, binding_energy=4.0, heat_capacity=9.0, volatility=1.0)
SMOOTH = (Specular(),) * 5


def gas(fraction, edge=8, seed=3):
    """Return places on a lattice, velocities and the side of a box so full."""
    number = edge**3
    side = (number * np.pi / 6.0 / fraction) ** (1.0 / 3.0)
    site = np.stack(np.meshgrid(*[np.arange(edge)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    return (site + 0.5) * side / edge, np.random.default_rng(seed).normal(size=(number, 3)), side


def column(fraction):
    x, v, side = gas(fraction)
    walls = (Periodic(),) * 4 + (HeatBath(1.0), HeatBath(1.5))
    return ParcelSet(x, v, length=(side,) * 3, walls=walls, gravity=0.05, rotation=2.0, rotational_energy=1.0)


def baths():
    x, v, side = gas(0.2)
    return ParcelSet(x, v, length=(side,) * 3, walls=tuple(HeatBath(1.0 + 0.1 * k) for k in range(6)), rotation=3.0)


def lifted(kind=ParcelSet, **more):
    x, v, side = gas(0.1)
    follow = FollowPressure([0.0, 1e9], [0.3, 0.15], mean_free_time=1.0)
    return kind(x, v, length=(side,) * 3, walls=(*SMOOTH, Piston()), driver=follow, rotation=2.0, **more)


def mist():
    return lifted(MoistParcelSet, mass=np.tile([1.0, 0.62], 256), liquid=Mist(WATER, number=40, kT=1.0))


BOXES = {
    "dilute column": lambda: column(0.01),
    "column": lambda: column(0.1),
    "dense column": lambda: column(0.3),
    "six baths": baths,
    "piston": lifted,
    "mist under a piston": mist,
}


@pytest.mark.parametrize("name", BOXES)
def test_an_exact_box_stays_lawful(name, request):
    wanted = request.config.getoption("--soak") * CONTACTS / len(BOXES)
    box = BOXES[name]()
    box.advance(1.0)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    while box.contacts < wanted:
        box.advance(box.time + 100.0)
        assert box.escaped() == 0
    assert box.ledger() < 1e-10
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < memory + 50_000  # kB


def test_many_molecules_of_dsmc_stay_lawful(request):
    share = request.config.getoption("--soak")
    number, steps = int(max(1e7 * share, 1e4)), int(max(1e4 * share, 100))
    random = np.random.default_rng(1)
    side = (number / 0.02) ** (1.0 / 3.0)
    box = DsmcParcel(random.uniform(1.0, side - 1.0, (number, 3)), random.normal(size=(number, 3)), length=(side,) * 3)
    for step in range(10):
        box.advance(0.1 * (step + 1) * steps / 10)
    assert box.contacts > 0
    assert box.escaped() == 0
    assert box.ledger() < 1e-10
