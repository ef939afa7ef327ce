r"""The definition of the model, slow and simple: the exact engine must agree with it.

Before every event, all possible events are computed from scratch, for all pairs and all walls; the list is sorted, all
molecules fly to the first event in it, and that one is resolved. There are no cells, no calendar and no clocks, and
nothing is kept from one event to the next, so there is little to get wrong. The change of velocity at a contact or a
wall is not written twice: `pair.resolve`, `share_energy` and `resolve_wall_hit` are the engine's own, and so are the
random numbers, drawn in the same order.

Every event is the closing of a gap. The gap between two spheres, defined as
:math:`|r + v t|^2 - \sigma^2`, and the height above the floor, below the ceiling or below a moving piston,
with or without gravity, are all parabolas in time, so one formula (`time_to_close`) tells when each closes.
"""

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.hard_sphere import share_energy
from atmosbox.engine.core.pair import nearest_along, reach, resolve
from atmosbox.engine.core.random import new_state, uniform
from atmosbox.engine.core.walls import PERIODIC, PISTON, Specular, Wall, new_walls, resolve_wall_hit

Array = NDArray[np.float64]


class Event(NamedTuple):
    """An event: its time, what happens, and which molecules or walls take part.

    ``kind`` is "contact", "wall hit" or "crossing" (of a periodic boundary). ``first`` is a molecule;
    ``second`` is its partner, of higher index, or the wall, 0 to 5 in the order x low, x high, y low, y high,
    z low, z high.
    """

    time: float
    kind: str
    first: int
    second: int


def time_to_close(a: float, b: float, c: float) -> float:
    r"""Return when a gap :math:`a t^2 + b t + c` closes [time from now], ``inf`` for never.

    Then it is zero and shrinking: of the two roots this is the one where the slope is :math:`-\sqrt{b^2 - 4 a c}`,
    whatever the sign of a, written so that no digits are lost by cancellation. It is 0 for a gap that rounding has
    already closed, if it is still shrinking.

    Thrown upward at unit speed in unit gravity, a ball is back on the floor after two units of time:

    >>> time_to_close(-0.5, 1.0, 0.0)
    2.0

    A gap of 3 that shrinks at unit speed closes after 3, one that grows never does:

    >>> time_to_close(0.0, -1.0, 3.0), time_to_close(0.0, 1.0, 3.0)
    (3.0, inf)
    """
    square = b * b - 4.0 * a * c
    if a < 0.0:
        square = max(square, 0.0)  # a gap that accelerates towards closing always closes
    if square < 0.0:
        return math.inf
    root = math.sqrt(square)
    if b < 0.0:
        return max(2.0 * c / (root - b), 0.0)
    return (b + root) / (-2.0 * a) if a < 0.0 else math.inf


class Reference:
    """A set of molecules with its box, advanced by the slow method.

    It takes the arguments of `ParcelSet` below, and does not check them; a piston moves at its velocity for ever.
    `time`, `position`, `velocity` and `rotational_energy` are those after the last event. Two molecules that approach
    each other along x collide once and keep their energy:

    >>> pair = Reference([[1, 2, 2], [3, 2, 2]], [[1, 0, 0], [-1, 0, 0]], length=(4, 4, 4))
    >>> pair.step()
    Event(time=0.5, kind='contact', first=0, second=1)
    >>> pair.velocity[:, 0].tolist()
    [-1.0, 1.0]
    """

    def __init__(
        self, position: ArrayLike, velocity: ArrayLike, *, length: Sequence[float],
        walls: Sequence[Wall] = (Specular(),) * 6, mass: ArrayLike = 1.0, diameter: ArrayLike = 1.0,
        rotation: ArrayLike = 0.0, rotational_energy: ArrayLike = 0.0, gravity: float = 0.0, planar: bool = False,
        collision_number: float = 1.0, seed: int = 0,
    ) -> None:  # fmt: skip
        self.time = 0.0
        self.position: Array = np.array(position, np.float64)
        self.velocity: Array = np.array(velocity, np.float64)
        self.number = len(self.position)
        self.length: Array = np.array(length, np.float64)
        self.walls = new_walls(tuple(walls), float(length[2]))
        self.periodic = [bool(law == PERIODIC) for law in self.walls.law[::2]]
        # until one of them crosses a boundary, two molecules of a periodic box meet inside it or across its sides
        turns = [(-1.0, 0.0, 1.0) if periodic else (0.0,) for periodic in self.periodic]
        self.images = self.length * np.array(list(itertools.product(*turns)))
        self.mass, self.diameter, self.rotation, self.rotational_energy = (
            np.array(np.broadcast_to(np.asarray(values, np.float64), self.number))
            for values in (mass, diameter, rotation, rotational_energy)
        )
        self.gravity = float(gravity)
        self.planar = planar
        self.exchange = 1.0 / collision_number
        self.random: Any = new_state(seed)
        for axis in range(3):
            if self.periodic[axis]:
                self.position[:, axis] %= self.length[axis]

    def step(self) -> Event | None:
        """Go to the next event, resolve it and return it; None if there will be no event."""
        events = self.ahead()
        if not events:
            return None
        self._resolve(events[0])
        return events[0]

    def advance(self, until: float) -> None:
        """Advance to the time ``until`` [time since the start]."""
        while (events := self.ahead()) and events[0].time <= until:
            self._resolve(events[0])
        self._fly(until)

    def energy(self) -> float:
        """Return the sum of kinetic, rotational and potential energy [energy]."""
        kinetic = 0.5 * np.sum(self.mass * np.sum(self.velocity**2, axis=1))
        potential = self.gravity * np.sum(self.mass * self.position[:, 2])
        return float(kinetic + np.sum(self.rotational_energy) + potential)

    # ------------------------------------------------------------------ the possible events

    def ahead(self) -> list[Event]:
        """Return all possible events, each as if no other came before it, in order of time."""
        events = itertools.chain(self._wall_hits(), self._contacts())
        return sorted(event for event in events if event.time < math.inf)

    def _wall_hits(self) -> Iterator[Event]:
        for wall in range(6):
            axis = wall // 2
            inward = 1.0 if wall % 2 == 0 else -1.0
            radius = 0.0 if self.periodic[axis] else 0.5 * self.diameter
            gaps = (inward * (self.position[:, axis] - self.place(wall)) - radius).tolist()
            speeds = (inward * (self.velocity[:, axis] - self._speed(wall))).tolist()
            acceleration = -inward * self.gravity if axis == 2 else 0.0
            kind = "crossing" if self.periodic[axis] else "wall hit"
            for i in range(self.number):
                yield Event(self.time + time_to_close(0.5 * acceleration, speeds[i], gaps[i]), kind, i, wall)

    def _contacts(self) -> Iterator[Event]:
        for i, j in itertools.combinations(range(self.number), 2):
            distance = reach(0.5 * self.diameter[i], 0.5 * self.diameter[j])
            if distance == 0.0:
                continue  # points never collide
            v = self.velocity[i] - self.velocity[j]
            r = self.position[i] - self.position[j] + self.images
            slopes, gaps = 2.0 * r @ v, np.sum(r * r, axis=1) - distance**2
            for slope, gap in zip(slopes.tolist(), gaps.tolist(), strict=True):
                yield Event(self.time + time_to_close(float(v @ v), slope, gap), "contact", i, j)

    def relative(self, i: int, j: int) -> Array:
        """Return the position of molecule i relative to the nearest image of j [length]."""
        r: Array = self.position[i] - self.position[j]
        for axis in range(3):
            if self.periodic[axis]:
                r[axis] = nearest_along(r[axis], self.length[axis], 1.0 / self.length[axis])
        return r

    def place(self, wall: int) -> float:
        """Return the coordinate of a wall now [length]."""
        if wall % 2 == 0:
            return 0.0
        return float(self.length[wall // 2] + self._speed(wall) * self.time)

    def _speed(self, wall: int) -> float:
        return float(self.walls.piston[1]) if self.walls.law[wall] == PISTON else 0.0

    # ------------------------------------------------------------------ resolving an event

    def _fly(self, time: float) -> None:
        """Move all molecules to a time, each along its own parabola, and set the clock."""
        dt = time - self.time
        self.position += dt * self.velocity
        self.position[:, 2] -= 0.5 * self.gravity * dt * dt
        self.velocity[:, 2] -= self.gravity * dt
        self.time = time

    def _resolve(self, event: Event) -> None:
        self._fly(event.time)
        with np.errstate(over="ignore"):  # the random numbers count modulo 2^64
            if event.kind == "contact":
                self._meet(event.first, event.second)
            elif event.kind == "wall hit":
                self._hit(event.first, event.second)
            else:
                axis = event.second // 2
                self.position[event.first, axis] = self.length[axis] if event.second % 2 == 0 else 0.0

    def _hit(self, i: int, wall: int) -> None:
        axis = wall // 2
        inward = 1.0 if wall % 2 == 0 else -1.0
        self.position[i, axis] = self.place(wall) + inward * 0.5 * self.diameter[i]
        self.velocity[i], self.rotational_energy[i], _ = resolve_wall_hit(
            wall, self.time, tuple(self.velocity[i]), self.rotational_energy[i], (self.mass[i], self.rotation[i]),
            self.walls, self.planar, self.random,
        )  # fmt: skip

    def _meet(self, i: int, j: int) -> None:
        r = self.relative(i, j)
        before = self.velocity[i] - self.velocity[j]
        mass, other_mass = self.mass[i], self.mass[j]
        after = before + (1.0 + mass / other_mass) * np.array(resolve(*r, *before, mass, other_mass))
        if self.rotation.any() and (self.exchange >= 1.0 or uniform(self.random) < self.exchange):
            relative = 0.5 * mass * other_mass / (mass + other_mass) * (before @ before)
            shared, self.rotational_energy[i], self.rotational_energy[j] = share_energy(
                relative + self.rotational_energy[i] + self.rotational_energy[j],
                2.0 if self.planar else 3.0, self.rotation[i], self.rotation[j], self.random,
            )  # fmt: skip
            after *= math.sqrt(shared / relative)
        self.velocity[i] += (after - before) * other_mass / (mass + other_mass)
        self.velocity[j] -= (after - before) * mass / (mass + other_mass)
