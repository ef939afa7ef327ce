"""The engine: colliding molecules, without any meteorology.

Read `core` first, then `exact`; the other folders when you need them. Each lists its files; docs/engine.md leads
through them in an afternoon.

`core`     molecules, walls, schedules, random numbers, collision laws, tallies, refusals
`start`    positions and velocities of the molecules at the start
`exact`    event-driven: time jumps from one event to the next; and a slow reference
`wells`    molecules that attract each other, event-driven too
`liquid`   condensed water: as a reservoir, a mist, drops or a pool
`stepped`  in equal time steps, as in teaching applets: all molecules move, then those that overlap collide
`dsmc`     direct simulation Monte Carlo: all molecules move, then pairs drawn at random collide

Everything is in reduced units: a scene chooses the units of length, mass and energy, and the engine knows neither
kelvins nor files nor scenes. The names below are imported when they are first used: a program that needs only some of
them does not wait for numba.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # for type checkers, which do not run this file
    from atmosbox.engine.core.lift import Course, FollowPressure
    from atmosbox.engine.core.packing import packing_fraction
    from atmosbox.engine.core.parcel import Driver, Parcel, Snapshot
    from atmosbox.engine.core.random import RandomNumbers
    from atmosbox.engine.core.refusal import CoarseStepWarning, PackingError, RefusedError, StalledError
    from atmosbox.engine.core.schedule import Ramp, Schedule
    from atmosbox.engine.core.walls import HeatBath, Periodic, Piston, Specular, Wall
    from atmosbox.engine.exact.parcelset import ParcelSet
    from atmosbox.engine.liquid.substance import Drops, Liquid, Mist, Pool, Substance
    from atmosbox.engine.start.lattice import lattice_positions
    from atmosbox.engine.start.overlap import clear_of_drops
    from atmosbox.engine.start.scatter import random_positions
    from atmosbox.engine.start.start import EqualSpeeds, Maxwell, Placed, Rotating, Scattered, Start
    from atmosbox.engine.start.velocity import equal_speeds, maxwell_velocities, rotational_energies
    from atmosbox.engine.wells.attracting_parcelset import AttractingParcelSet
    from atmosbox.engine.wells.attraction import RandomBath, SquareWell

# the file that defines each name
_HOMES = {
    "core.lift": "Course FollowPressure",
    "core.packing": "packing_fraction",
    "core.parcel": "Driver Parcel Snapshot",
    "core.random": "RandomNumbers",
    "core.refusal": "CoarseStepWarning PackingError RefusedError StalledError",
    "core.schedule": "Ramp Schedule",
    "core.walls": "HeatBath Periodic Piston Specular Wall",
    "exact.parcelset": "ParcelSet",
    "liquid.substance": "Drops Liquid Mist Pool Substance",
    "start.lattice": "lattice_positions",
    "start.overlap": "clear_of_drops",
    "start.scatter": "random_positions",
    "start.start": "EqualSpeeds Maxwell Placed Rotating Scattered Start",
    "start.velocity": "equal_speeds maxwell_velocities rotational_energies",
    "wells.attracting_parcelset": "AttractingParcelSet",
    "wells.attraction": "RandomBath SquareWell",
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names.split()}

__all__ = [
    "AttractingParcelSet", "CoarseStepWarning", "Course", "Driver", "Drops", "EqualSpeeds",
    "FollowPressure", "HeatBath", "Liquid", "Maxwell", "Mist", "PackingError", "Parcel", "ParcelSet", "Periodic",
    "Piston", "Placed", "Pool", "Ramp", "RandomBath", "RandomNumbers", "RefusedError", "Rotating", "Scattered",
    "Schedule", "Snapshot", "Specular", "SquareWell", "StalledError", "Start", "Substance", "Wall",
    "clear_of_drops", "equal_speeds", "lattice_positions", "maxwell_velocities", "packing_fraction", "random_positions",
    "rotational_energies",
]  # fmt: skip


def __getattr__(name: str) -> Any:
    """Import a public name from the file that defines it: Python calls this when the name is first used."""
    if name not in _HOME_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(f"{__name__}.{_HOME_OF[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
