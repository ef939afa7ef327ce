"""The engine: colliding molecules, and nothing of meteorology.

Read it in this order: `state` (what is known of a molecule), `motion` (free flight), `random`, `contact`
(a pair meets), `schedule` and `walls` (one law each), `cells` (who can meet whom), `calendar` (what
happens next), `plan`, `encounter` and `crossing` (what lies ahead of a molecule, and what becomes of it),
`exact` (from event to event), `reference` (the same, slow and obvious: the oracle of the tests),
`parcelset` (the box that a scene uses), `inputs` and `refusal` (what is refused), `packing` and `start`
(how a box begins), `measure` (what is read off it), `lift` (a piston that follows a pressure), `_jit` (the one door
to numba).

Everything is in reduced units; the engine knows no kelvin, no file and no scenario.
"""

from atmosbox.engine.lift import FollowPressure
from atmosbox.engine.parcelset import Driver, ParcelSet, Snapshot
from atmosbox.engine.refusal import PackingError, RefusedError, StalledError
from atmosbox.engine.schedule import Constant, Ramp, Steps
from atmosbox.engine.walls import HeatBath, Periodic, Piston, Specular

__all__ = [
    "Constant",
    "Driver",
    "FollowPressure",
    "HeatBath",
    "PackingError",
    "ParcelSet",
    "Periodic",
    "Piston",
    "Ramp",
    "RefusedError",
    "Snapshot",
    "Specular",
    "StalledError",
    "Steps",
]
