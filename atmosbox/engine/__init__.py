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
`account`    what a box has counted, and whether its energy adds up
`arrangement` what a box may be given, and what may move its piston
`adjustment` what may be changed while time passes
`parcel`     the box: what it is given, holds and tells
`box`        the box, as the kernels know it
`kind`       molecules that are alike
`stall`      when time can go no further
`parcelset`  the box, advanced exactly
`substance`  what condenses, and as what
`liquid`     water that has condensed: a ledger, and its laws
`room`       where there is room for a molecule
`phase`      a molecule leaves the box, or comes into it
`moist_account`  what a box with liquid in it holds
`moist`      from event to event, with liquid in the box
`moist_parcelset`  the box of moist air, advanced exactly
`drop_shape` drops as bodies
`drop`       drops that can be seen, from event to event
`drop_parcelset`  the box with such drops in it
`marching`   the box, advanced step by step
`classic_tally`      what the three classic schemes share
`classic_strips`     equal discs, sorted into strips
`classic_lookahead`  unequal discs, which look ahead
`classic_spheres`    spheres, all pairs
`classic`            the box, as teaching applets move it: one of the three
`window`        a glance at eight neighbours at once
`neighbourhood` who overlaps whom
`filing`        molecules filed by cell, for those that look for neighbours
`gridding`      how the box is cut into those cells
`flight`        a step of free flight
`bounce`        a step of those that come near walls
`stepped`       step by step: all move, those that overlap collide
`stepped_start` what a start in time steps must be
`stepped_parcel`  the box, advanced in such steps
`swarm`      many molecules in columns, sorted into cells
`streaming`  a step of free flight for all of them, with walls on the way
`pairing`    who of a cell collide, drawn by chance
`moist_swarm`  what liquid does in a step among many molecules, and a mist
`moist_pool`   what a pool does
`dsmc`       collisions with whom chance chooses nearby
`dsmc_parcel`  the box, advanced by direct simulation Monte Carlo
`moist_dsmc_parcel`  the box of moist air, advanced so
`measure`    what is read off it
`course`     how far along its planned way a parcel is
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
