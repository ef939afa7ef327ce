"""The engine: colliding molecules, and nothing of meteorology.

Read it in this order:

`state`      what is known of a molecule, of its box, of what lies ahead
`motion`     free flight
`random`     random numbers
`contact`    two molecules meet
`schedule`   numbers that change with time
`walls`      what walls do, one law each
`cells`      who can meet whom
`calendar`   what happens next
`plan`       what lies ahead of a molecule
`encounter`  what an encounter does
`crossing`   from cell to cell
`exact`      from event to event
`reference`  the same, slow and obvious: the oracle of the tests
`refusal`    the errors
`inputs`     what is refused
`packing`    how much of the space molecules fill
`overlap`    those that overlap are pushed apart
`scatter`    where molecules stand at the start, at random
`lattice`    the same, on a lattice
`start`      how they move at the start
`parcel`     the box: what it is given, holds and tells
`parcelset`  the box, advanced exactly
`marching`   the box, advanced step by step
`classic_tally`      what the three classic schemes share
`classic_strips`     equal discs, sorted into strips
`classic_lookahead`  unequal discs, which look ahead
`classic_spheres`    spheres, all pairs
`classic`            the box, as teaching applets move it: one of the three
`measure`    what is read off it
`lift`       a piston that follows a pressure
`_jit`       the one door to numba

Everything is in reduced units; the engine knows no kelvin, no file and no scenario.
"""

from atmosbox.engine.lift import FollowPressure
from atmosbox.engine.parcel import Driver, Parcel, Snapshot
from atmosbox.engine.parcelset import ParcelSet
from atmosbox.engine.refusal import PackingError, RefusedError, StalledError
from atmosbox.engine.schedule import Constant, Ramp, Steps
from atmosbox.engine.walls import HeatBath, Periodic, Piston, Specular

__all__ = [
    "Constant",
    "Driver",
    "FollowPressure",
    "HeatBath",
    "PackingError",
    "Parcel",
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
