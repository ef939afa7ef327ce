"""Runs of an hour, by hand: ``pytest -m soak``; ``--soak-report FILE`` writes their figures down as they go on."""

import json
import resource
import time

import numpy as np
import pytest

from atmosbox.engine import FollowPressure, HeatBath, Mist, ParcelSet, Periodic, Piston, Specular
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from tests.engine.boxes import WATER, apart

pytestmark = pytest.mark.soak

CONTACTS = 1.2e9  # of all exact boxes together
SMOOTH = (Specular(),) * 5


def gas(fraction, edge=8, seed=3):
    """Return places on a lattice, velocities and the side of a box with this packing fraction."""
    number = edge**3
    side = (number * np.pi / 6.0 / fraction) ** (1.0 / 3.0)
    site = np.stack(np.meshgrid(*[np.arange(edge)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    return (site + 0.5) * side / edge, np.random.default_rng(seed).normal(size=(number, 3)), side


def column(fraction):
    x, v, side = gas(fraction)
    walls = (Periodic(),) * 4 + (HeatBath(1.0), HeatBath(1.5))
    return ParcelSet(x, v, length=(side,) * 3, walls=walls, gravity=0.05, rotation=2.0, rotational_energy=1.0)


def crowded():
    x, v, side = gas(0.49)
    return ParcelSet(x, v, length=(side,) * 3, walls=(Periodic(),) * 6)


def lifted(kind=ParcelSet, **more):
    x, v, side = gas(0.1)
    follow = FollowPressure([0.0, 1e9], [0.3, 0.15], mean_free_time=1.0)
    return kind(x, v, length=(side,) * 3, walls=(*SMOOTH, Piston()), driver=follow, rotation=2.0, **more)


def mist():
    return lifted(MoistParcelSet, mass=np.tile([1.0, 0.62], 256), liquid=Mist(WATER, number=40, kT=1.0))


BOXES = {
    "column": lambda: column(0.1),
    "periodic, nearly frozen": crowded,
    "piston": lifted,
    "mist under a piston": mist,
}


def deepest_overlap(box):
    """Return the deepest overlap of a pair, in diameters; negative if no pair overlaps."""
    x = box.snapshot().position
    distance = apart(x, x, box.length, box.periodic)
    return float(1.0 - distance[~np.eye(len(x), dtype=bool)].min())


@pytest.fixture
def figures(request):
    """Return a function that writes results at once, so that those of a soak test that is stopped are kept."""
    path = request.config.getoption("--soak-report")
    began, memory = time.process_time(), []

    def write(name, box, **more):
        now = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        memory.append(now)
        said = {"box": name, "collisions": box.contacts, "ledger": box.ledger(), "escaped": box.escaped()}
        said |= {"memory_growth_kB": now - memory[0], "cpu_seconds": round(time.process_time() - began, 1), **more}
        if path:
            with open(path, "a", encoding="utf-8") as file:
                file.write(json.dumps(said) + "\n")
        return said

    return write


@pytest.mark.parametrize("name", BOXES)
def test_an_exact_box_stays_lawful(name, request, figures):
    wanted = request.config.getoption("--soak") * CONTACTS / len(BOXES)
    box = BOXES[name]()
    box.advance(1000.0)
    deepest, told = deepest_overlap(box), box.contacts
    figures(name, box, deepest_overlap=deepest)
    while box.contacts < wanted:
        box.advance(box.time + 1000.0)
        deepest = max(deepest, deepest_overlap(box))
        assert box.escaped() == 0
        assert deepest < 1e-9
        if box.contacts > told + wanted / 50:
            told = box.contacts
            figures(name, box, deepest_overlap=deepest)
    said = figures(name, box, deepest_overlap=deepest)
    assert said["ledger"] < 1e-10
    assert said["memory_growth_kB"] < 50_000
