"""A box of gas in one line, and the end of tests that hang."""

import faulthandler
import sys

import numpy as np
import pytest

from atmosbox.engine import (
    ParcelSet,
    Periodic,
    Piston,
    Specular,
    maxwell_velocities,
    random_positions,
    rotational_energies,
)

SPECULAR = (Specular(),) * 6
EVERYTHING = {"walls": (Periodic(),) * 4 + (Specular(), Piston()), "gravity": 1e-12}
"""Options of a box that uses the kernels of all features; so weak a gravity, and masses so close, change no result."""


def new_gas(number, length, *, walls=SPECULAR, seed, kT=1.0, spin_kT=None, planar=False, **options):
    """Return a gas at random places whose kinetic energy is exactly that of kT, for every seed."""
    rng = np.random.default_rng(seed)
    ones = np.ones(number)
    periodic = tuple(isinstance(wall, Periodic) for wall in walls[::2])
    diameter, mass = (ones * options.pop(name, 1.0) for name in ("diameter", "mass"))
    rotation = ones * options.pop("rotation", 0.0)
    if options.get("gravity") == EVERYTHING["gravity"] and rotation.any():
        mass[::2] *= 1.0 + 1e-9
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


@pytest.fixture(autouse=True)
def nothing_hangs(request):
    """End the whole run, with a traceback, if a test makes no progress: Ctrl-C cannot stop a kernel."""
    long = request.node.get_closest_marker("nightly") is not None
    faulthandler.dump_traceback_later(7200.0 if long else 900.0, exit=True, file=sys.__stderr__)
    yield
    faulthandler.cancel_dump_traceback_later()


@pytest.fixture(scope="session")
def gas():
    return new_gas
