"""What the tests of the engine share: a box of gas in one line, and a watch over where its molecules are."""

import faulthandler
import sys

import numpy as np
import pytest

from atmosbox.engine.parcelset import ParcelSet
from atmosbox.engine.start import maxwell_velocities, random_positions, rotational_energies
from atmosbox.engine.walls import Periodic, Specular

SPECULAR = (Specular(),) * 6


def new_gas(number, length, *, walls=SPECULAR, seed, kT=1.0, spin_kT=None, planar=False, **options):
    """Return a gas at random places whose kinetic energy is that of kT to rounding, whatever the seed."""
    rng = np.random.default_rng(seed)
    ones = np.ones(number)
    periodic = tuple(isinstance(wall, Periodic) for wall in walls[::2])
    diameter, mass = (ones * options.pop(name, 1.0) for name in ("diameter", "mass"))
    rotation = ones * options.pop("rotation", 0.0)
    x = random_positions(length, diameter, rng, periodic=periodic, planar=planar)
    v = maxwell_velocities(kT, mass, rng, planar=planar, exact=True)
    options.setdefault("rotational_energy", rotational_energies(kT if spin_kT is None else spin_kT, rotation, rng))
    return ParcelSet(
        options.pop("position", x),
        options.pop("velocity", v),
        length=length,
        walls=walls,
        diameter=diameter,
        mass=mass,
        rotation=rotation,
        planar=planar,
        seed=seed,
        **options,
    )


def furthest_out_of_place(box):
    """Return how far a molecule reaches through a wall, and how deep a pair overlaps, both in mean diameters."""
    x, sides, diameter = box.snapshot().position, box.length, box.diameter
    radius = 0.5 * diameter[:, None]
    walled = ~np.array(box.periodic)
    outside = np.maximum(radius - x, x - (sides - radius))[:, walled].max(initial=-np.inf)
    i, j = np.triu_indices(box.number, 1)
    apart = x[i] - x[j]
    apart -= np.where(walled, 0.0, sides * np.rint(apart / sides))
    touching = 0.5 * (diameter[i] + diameter[j])
    overlap = (touching - np.sqrt(np.sum(apart**2, axis=1))).max(initial=-np.inf)
    unit = diameter.mean() if diameter.max() > 0.0 else 1.0
    return outside / unit, overlap / unit


@pytest.fixture(autouse=True)
def nothing_hangs(request):
    """End the whole run, with a traceback, if a test stops making progress: a kernel hears no Ctrl-C."""
    long = request.node.get_closest_marker("validate") is not None
    faulthandler.dump_traceback_later(7200.0 if long else 900.0, exit=True, file=sys.__stderr__)
    yield
    faulthandler.cancel_dump_traceback_later()


@pytest.fixture(scope="session")
def gas():
    return new_gas


@pytest.fixture(scope="session")
def out_of_place():
    return furthest_out_of_place
