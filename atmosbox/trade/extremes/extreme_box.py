"""The boxes of extremes: each function here returns a function that builds a box with the engine of a run."""

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
"""Heat capacity of nuclei [k], so large that the liquid keeps its temperature."""
CURVED = {"nucleus": 2.0, "molecule_radius": 0.5, "surface_tension": 1.5}
"""Properties of a drop with a curvature effect: at kT = 1, 150 molecules need 1.7 times as much vapour as a pool."""
AT_REST = "at rest"
OPEN, SMOOTH, BATHS = (Periodic(),) * 6, (Specular(),) * 6, (HeatBath(1.0),) * 6


def at(position: Any, velocity: Any = AT_REST, length: Any = (10, 10, 10), **box: Any) -> Box:
    """Return a box of molecules at given positions, at rest unless velocities are given."""
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
    """Return a box of molecules at random positions with Maxwell's velocities; one side length makes a cube.

    ``few`` is the number of molecules for engines that are not exact, if their steps must be short; ``top`` is the
    greatest height of a molecule at the start.
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
    """Return positions and velocities of two molecules that circle in a well; ``rate`` is rounds in a unit of time.

    Relative to one molecule, the other moves along a square whose corners are on the edge of the well. It starts in the
    middle of a side.
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
        Mist, pool or drops.
    celsius
        The temperature [degC].
    saturated
        Number of molecules of saturated vapour in the box, which determines the size of the box.
    waters, vapour, air
        Number of molecules of water, of those that are vapour at the start, and of air.
    drops
        2 for two drops that touch, 1 for one drop in the middle.
    liquid
        Further properties of the liquid.
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
