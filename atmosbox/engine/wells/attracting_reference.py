r"""The definition of the model with attraction, slow and simple: `attracting_parcelset` must agree with it.

As in `reference`, all possible events are computed from scratch before every event. The pairs inside
their wells are a plain set. Inside, the gap :math:`\lambda^2 \sigma^2 - |r + v t|^2` to the edge of the well is a
parabola too, and it always closes.
"""

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.engine.core.elementary import log_of_normal
from atmosbox.engine.core.random import gaussian_pair, uniform
from atmosbox.engine.core.square_well import BOUNCE, CAPTURE, CORE, RELEASE, resolve_crossing
from atmosbox.engine.core.walls import wall_kT
from atmosbox.engine.exact.reference import Event, Reference, time_to_close
from atmosbox.engine.wells.attraction import RandomBath, SquareWell, new_bath, well_table

_KINDS = {"contact": CORE, "capture": CAPTURE, "release": RELEASE}


class AttractingReference(Reference):
    """A box of a few molecules that attract each other, with the arguments of `Reference` and of `AttractingParcelSet`.

    Its additional kinds of events are "capture", "release" and "drawn": the bath draws a velocity again.

    >>> pair = AttractingReference([[4, 5, 5], [7, 5, 5]], [[1, 0, 0], [-1, 0, 0]], length=(10,) * 3, well=SquareWell())
    >>> [pair.step().kind for _ in range(3)]
    ['capture', 'contact', 'release']
    """

    def __init__(
        self, position: ArrayLike, velocity: ArrayLike, *, length: Sequence[float], well: SquareWell,
        species: ArrayLike = 0, bath: RandomBath | None = None, **box: Any,
    ) -> None:  # fmt: skip
        super().__init__(position, velocity, length=length, **box)
        kind = np.broadcast_to(np.asarray(species), (self.number,))
        ranges, depths = well_table(well, int(kind.max(initial=0)) + 1)
        contact = 0.5 * (self.diameter[:, None] + self.diameter[None, :])
        self.depth = depths[np.ix_(kind, kind)]
        self.edge = ranges[np.ix_(kind, kind)] * contact
        self.core = contact
        self.hard = (self.depth == 0.0) | (self.edge == contact)
        self.inside = {
            (i, j)
            for i, j in itertools.combinations(range(self.number), 2)
            if not self.hard[i, j] and np.sum(self.relative(i, j) ** 2) < self.edge[i, j] ** 2
        }
        self.bath = new_bath(bath)
        self.draws_at = math.inf
        with np.errstate(over="ignore"):
            self._wait()

    def _wait(self) -> None:
        rate = self.bath.rate * self.number
        if rate > 0.0:
            self.draws_at = self.time - float(log_of_normal(uniform(self.random))) / rate

    def energy(self) -> float:
        """Return the sum of kinetic and potential energy, that of the wells included [energy]."""
        return super().energy() - sum(float(self.depth[pair]) for pair in self.inside)

    def ahead(self) -> list[Event]:
        """Return all possible events, each as if no other came before it, in order of time."""
        drawn = [Event(self.draws_at, "drawn", 0, 0)] if self.draws_at < math.inf else []
        return sorted([*super().ahead(), *drawn])

    def _contacts(self) -> Iterator[Event]:
        for i, j in itertools.combinations(range(self.number), 2):
            v = self.velocity[i] - self.velocity[j]
            r = self.position[i] - self.position[j] + self.images
            square = np.sum(r * r, axis=1)
            nearest = int(np.argmin(square))
            speed_squared = float(v @ v)
            slopes = (2.0 * r @ v).tolist()
            for k, slope in enumerate(slopes):
                if k == nearest and (i, j) in self.inside:
                    gap = float(square[k] - self.core[i, j] ** 2)
                    yield Event(self.time + time_to_close(speed_squared, slope, gap), "contact", i, j)
                    gap = float(self.edge[i, j] ** 2 - square[k])
                    if speed_squared > 0.0:
                        yield Event(self.time + time_to_close(-speed_squared, -slope, gap), "release", i, j)
                else:
                    distance = self.core[i, j] if self.hard[i, j] else self.edge[i, j]
                    kind = "contact" if self.hard[i, j] else "capture"
                    gap = float(square[k] - distance**2)
                    if distance > 0.0:
                        yield Event(self.time + time_to_close(speed_squared, slope, gap), kind, i, j)

    def _resolve(self, event: Event) -> None:
        if event.kind in _KINDS:
            self._fly(event.time)
            self._cross(_KINDS[event.kind], event.first, event.second)
        elif event.kind == "drawn":
            self._fly(event.time)
            with np.errstate(over="ignore"):
                self._draw_anew()
        else:
            super()._resolve(event)

    def _cross(self, which: int, i: int, j: int) -> None:
        r, u = tuple(self.relative(i, j)), tuple(self.velocity[i] - self.velocity[j])
        change, what = resolve_crossing(r, u, which, self.mass[i], self.mass[j], self.depth[i, j])
        self.velocity[i] += change
        self.velocity[j] -= self.mass[i] / self.mass[j] * np.array(change)
        if what == CAPTURE:
            self.inside.add((i, j))
        elif what not in (CORE, BOUNCE):
            self.inside.remove((i, j))

    def _draw_anew(self) -> None:
        i = min(int(uniform(self.random) * self.number), self.number - 1)
        speed = math.sqrt(wall_kT(self.bath, 0, self.time) / self.mass[i])
        vx, vy = gaussian_pair(self.random)
        vz, _ = gaussian_pair(self.random)
        self.velocity[i] = speed * vx, 0.0 if self.planar else speed * vy, speed * vz
        self._wait()
