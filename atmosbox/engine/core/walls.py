r"""The laws of the walls: specular, periodic, heat bath and piston.

A **specular** wall reverses the normal velocity. A **periodic** pair of walls is no wall: a molecule that leaves on one
side enters on the other. A **heat bath** gives the molecule a new velocity, drawn at random at the temperature of the
wall. Its normal velocity follows Rayleigh's law, :math:`p(v) \propto v \exp(-m v^2 / 2 k T)`: the factor v is there
because fast molecules hit a wall more often, and so must leave it more often. The two tangential velocities are
Gaussian. A **piston** is a specular wall that moves at velocity u: :math:`v' = -v + 2 u`. It does work on the
molecules.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from atmosbox.engine.core.elementary import log_of_normal
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.random import gamma, gaussian_pair, uniform
from atmosbox.engine.core.refusal import LARGEST, RefusedError, number, shown
from atmosbox.engine.core.schedule import Schedule, as_schedule, interpolate
from atmosbox.engine.core.state import Walls

SPECULAR, PERIODIC, HEAT_BATH, PISTON, POOL = 0, 1, 2, 3, 4
"""The laws by number. The floor of a box with a `liquid.Pool` is a `POOL`, whatever law was given for it."""
WALL_NAMES = ("x_low", "x_high", "y_low", "y_high", "z_low", "z_high")


@dataclass(frozen=True)
class Specular:
    """A smooth, rigid wall at rest."""


@dataclass(frozen=True)
class Periodic:
    """No wall: the box continues periodically. Both walls of an axis must be periodic, or neither."""


@dataclass(frozen=True)
class HeatBath:
    """A wall that a molecule leaves with a random velocity, at the temperature of the wall.

    Parameters
    ----------
    kT
        Temperature of the wall [energy], a number or a schedule.
    accommodation
        Share of the hits, 0 to 1, after which a molecule leaves at the temperature of the wall; others are specular.
    """

    kT: float | Schedule
    accommodation: float = 1.0


@dataclass(frozen=True)
class Piston:
    """A ceiling that moves upward at a velocity [length/time], which a driver may change.

    See `ParcelSet.set_piston_velocity`.
    """

    velocity: float = 0.0


Wall = Specular | Periodic | HeatBath | Piston
_LAWS = {Specular: SPECULAR, Periodic: PERIODIC, HeatBath: HEAT_BATH, Piston: PISTON}


def new_walls(walls: tuple[Wall, ...], height: float) -> Walls:
    """Return the six walls, in the order of `WALL_NAMES`, as arrays; what is impossible is refused.

    >>> new_walls((Specular(),) * 5 + (Piston(0.1),), 2.0).piston
    array([2. , 0.1, 0. ])
    """
    if len(walls) != 6:
        raise RefusedError(f"{len(walls)} walls are given: give six, {', '.join(WALL_NAMES)}")
    laws: list[int] = []
    accommodations: list[float] = []
    schedules: list[list[tuple[float, float]]] = []
    velocity = 0.0
    # each law is checked and becomes a number, with its accommodation and the corners of its schedule
    for name, wall in zip(WALL_NAMES, walls, strict=True):
        corners, accommodation = [(0.0, 1.0)], 0.0
        if type(wall) not in _LAWS:
            raise RefusedError(f"wall {name} = {shown(wall)} is not a law: give Specular, Periodic, HeatBath or Piston")
        if isinstance(wall, HeatBath):
            accommodation = number(wall.accommodation, f"accommodation of wall {name}", least=0.0, most=1.0)
            corners = as_schedule(wall.kT, f"kT of wall {name}")
        elif isinstance(wall, Piston):
            if name != "z_high":
                raise RefusedError(f"wall {name} cannot be a piston: only the ceiling, z_high, moves")
            velocity = number(wall.velocity, "velocity of the piston", least=-LARGEST, most=LARGEST)
        laws.append(_LAWS[type(wall)])
        accommodations.append(accommodation)
        schedules.append(corners)
    for axis in range(3):
        pair = laws[2 * axis : 2 * axis + 2]
        if (PERIODIC in pair) and pair != [PERIODIC, PERIODIC]:
            low, high = WALL_NAMES[2 * axis : 2 * axis + 2]
            raise RefusedError(f"walls {low} and {high} must both be periodic or neither")
    # the schedules of all walls are in one array; `start` tells where that of each wall begins. Here the schedule of
    # the floor has three corners, and those of the other walls have one each:
    #
    #   wall    x_low  x_high  y_low  y_high  z_low       z_high
    #   start     0      1       2      3       4           7     8
    #   time      0      0       0      0       0  10  20   0
    #   kT        1      1       1      1       1   2   3   1
    flat = [corner for corners in schedules for corner in corners]
    start = np.cumsum([0, *map(len, schedules)])
    return Walls(
        law=np.array(laws, np.int64),
        accommodation=np.array(accommodations),
        schedule=start.astype(np.int64),
        schedule_time=np.array([time for time, _ in flat]),
        schedule_kT=np.array([kT for _, kT in flat]),
        piston=np.array([height, velocity, 0.0]),
        epoch=np.zeros(1),
    )


def first_bath_kT(walls: Walls) -> list[float]:
    """Return the temperatures [energy] that the heat baths have at the start."""
    starts = zip(walls.law, walls.schedule_kT[walls.schedule[:-1]], strict=True)
    return [float(kT) for law, kT in starts if law == HEAT_BATH]


@kernel(plain=True)
def wall_kT(walls: Any, wall: Any, time: Any) -> Any:
    """Return the temperature of a wall [energy] at a time [time] since the start.

    >>> from atmosbox.engine.core.schedule import Ramp
    >>> bath = HeatBath(Ramp(1.0, 3.0, start=0.0, end=10.0))
    >>> float(wall_kT(new_walls((Specular(),) * 4 + (bath, Specular()), 1.0), 4, 5.0))
    2.0
    """
    first, last = walls.schedule[wall], walls.schedule[wall + 1]
    return interpolate(time, walls.schedule_time[first:last], walls.schedule_kT[first:last])


@kernel
def resolve_wall_hit(wall, time, velocity, spin, kind, walls, planar, state):
    """Return velocity and rotational energy after a wall hit, and the change of the velocity along the wall's axis.

    ``spin`` is the rotational energy before; ``kind`` are mass and rotational degrees of freedom of the molecule. In a
    plane gas the y velocity stays zero. The state of the random numbers is advanced.

    A piston that recedes at 1 slows a molecule from a speed of 3 to 1:

    >>> walls = new_walls((Specular(),) * 5 + (Piston(1.0),), 2.0)
    >>> resolve_wall_hit(5, 0.0, (0.5, 0.5, 3.0), 0.0, (1.0, 0.0), walls, False, np.array([1], np.uint64))
    ((0.5, 0.5, -1.0), 0.0, -4.0)
    """
    vx, vy, vz = velocity
    mass, rotation = kind
    # walls are numbered 2 * axis, plus 1 for the upper one
    axis = wall >> 1
    # the velocities along the wall's axis, and along the two others in the order x, y, z
    came, first, second = (vx, vy, vz) if axis == 0 else ((vy, vx, vz) if axis == 1 else (vz, vx, vy))
    law = walls.law[wall]
    went = -came
    if law == PISTON:
        went += 2.0 * walls.piston[1]
    elif law != SPECULAR and uniform(state) < walls.accommodation[wall]:
        kT = wall_kT(walls, wall, time)
        thermal_speed = math.sqrt(kT / mass)
        # away from the wall: Rayleigh's law, from one uniform number; along the wall: two Gaussian numbers
        inward = 1.0 if wall & 1 == 0 else -1.0
        went = inward * thermal_speed * math.sqrt(-2.0 * log_of_normal(uniform(state)))
        first, second = gaussian_pair(state)
        first *= thermal_speed
        second *= thermal_speed
        if planar:  # no molecule of a plane gas hits the walls along y
            if axis == 0:
                first = 0.0
            else:
                second = 0.0
        spin = kT * gamma(rotation, state)
    after = (went, first, second) if axis == 0 else ((first, went, second) if axis == 1 else (first, second, went))
    return after, spin, went - came
