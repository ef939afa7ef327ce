"""What is built for an extreme: each function returns how to make a box once an engine is known."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from atmosbox.engine import (
    Drops,
    HeatBath,
    Liquid,
    Mist,
    Parcel,
    Periodic,
    Pool,
    Specular,
    Wall,
    lattice_positions,
    maxwell_velocities,
    random_positions,
)
from atmosbox.scene.moisture import moist_air, water
from atmosbox.scene.units import Scale
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR
from atmosbox.trade.extremes.guarded_run import GuardedRun

__all__ = ["BATHS", "CURVED", "OPEN", "SMOOTH", "Box", "at", "crystal", "gas", "moist", "orbit"]

Box = Callable[[GuardedRun], Parcel]
STEADY = 1e7
"""Heat capacity of nuclei [k] that keeps the liquid at its temperature, as a small one would not."""
CURVED = {"nucleus": 2.0, "molecule_radius": 0.5, "surface_tension": 1.5}
"""What a drop is given that feels its curvature: at kT = 1, 150 molecules need 1.7 times as much vapour as a pool."""
AT_REST = "at rest"
OPEN, SMOOTH, BATHS = (Periodic(),) * 6, (Specular(),) * 6, (HeatBath(1.0),) * 6


def at(position: Any, velocity: Any = AT_REST, length: Any = (10, 10, 10), **box: Any) -> Box:
    """Return a box of molecules at given places, at rest unless velocities are given."""
    speeds = np.zeros(np.shape(position)) if velocity is AT_REST else velocity
    return lambda run: run.box(position, speeds, length=length, **box)


def gas(
    number: int,
    *sides: float,
    few: int | None = None,
    kT: float = 1.0,
    top: float | None = None,
    walls: tuple[Wall, ...] = SMOOTH,
    seed: int = 1,
    **box: Any,
) -> Box:
    """Return a box of molecules at random places with Maxwell's velocities; one side makes a cube.

    ``few`` is their number for engines that go in steps, where these are short; ``top`` is up to where they stand.
    """
    x, y, z = sides * 3 if len(sides) == 1 else sides
    facts: dict[str, Any] = {"mass": 1.0, "diameter": 1.0, **box, "length": (x, y, z), "walls": walls, "seed": seed}
    periodic = (walls is OPEN,) * 3

    def build(run: GuardedRun) -> Parcel:
        n, rng = number if run.exact or few is None else few, np.random.default_rng(seed)
        sizes, masses = (np.broadcast_to(np.asarray(facts[name], np.float64), n) for name in ("diameter", "mass"))
        where = random_positions((x, y, z), sizes, rng, periodic=periodic, top=top)
        return run.box(where, maxwell_velocities(kT, masses, rng, exact=True), **facts)

    return build


def crystal(number: int, side: float, **box: Any) -> Box:
    """Return a periodic cube of molecules on a lattice with Maxwell's velocities."""
    sites = lattice_positions((side,) * 3, np.ones(number), periodic=(True,) * 3)
    speeds = maxwell_velocities(1.0, np.ones(number), np.random.default_rng(2), exact=True)
    return at(sites, speeds, (side,) * 3, walls=OPEN, **box)


def orbit(range: float, rate: float) -> tuple[Any, Any]:
    """Return places and velocities of two molecules that circle in a well, so many times in a unit of time.

    Seen from one, the other goes along a square whose corners are on the edge of the well. It starts in the middle of
    a side.
    """
    half = range * np.sqrt(0.5)
    speed = 8.0 * half * rate
    places = [[5.0, 5.0 - 0.5 * half, 5.0], [5.0, 5.0 + 0.5 * half, 5.0]]
    return places, [[-0.5 * speed, 0.0, 0.0], [0.5 * speed, 0.0, 0.0]]


def moist(
    kind: type[Liquid],
    celsius: float,
    saturated: float,
    waters: int,
    *,
    vapour: int = 0,
    air: int = 20,
    drops: int = 2,
    **liquid: Any,
) -> Box:
    """Return a box with real water between heat baths of its temperature.

    Parameters
    ----------
    kind
        Mist, pool or drops; the drops are two that touch.
    celsius
        The temperature [degC].
    saturated
        How many molecules of vapour are in balance with the liquid: the box is as large as they need.
    waters, vapour, air
        How many molecules of water there are, how many of them are vapour at the start, and how many of air.
    drops
        Two drops that touch, or 1 in the middle.
    liquid
        What else the liquid is given.
    """
    scale = Scale(DRY_AIR.diameter, DRY_AIR.molecule_mass, BOLTZMANN * (celsius + 273.15))
    substance, held = water(scale), waters - vapour
    side = 1.0 + (saturated / substance.saturation_pressure(1.0)) ** (1.0 / 3.0)
    middle, reach = 0.5 * side, (8.0 + 0.125 * 0.5 * held) ** (1.0 / 3.0)
    beside = (-reach, reach) if drops == 2 else (0.0,)
    shapes: dict[type[Liquid], dict[str, Any]] = {
        Mist: {"area": 6.0 * side**2},
        Pool: {},
        Drops: {"position": tuple((middle + away, middle, middle) for away in beside), "nucleus": 2.0},
    }
    walls = (*BATHS[:4], Specular() if kind is Pool else BATHS[4], BATHS[5])

    def build(run: GuardedRun) -> Parcel:
        start = moist_air(vapour + air, vapour, np.random.default_rng(1))
        sizes = np.ones(vapour + air)
        return run.box(
            lattice_positions((side, side, 0.25 * side), sizes) if len(sizes) else np.zeros((0, 3)),
            start.velocity,
            length=(side,) * 3,
            mass=start.mass,
            rotation=start.rotation,
            rotational_energy=start.rotational_energy,
            walls=walls,
            seed=1,
            liquid=kind(substance, number=held, **{"nuclei": STEADY} | shapes[kind] | liquid),
        )

    return build
