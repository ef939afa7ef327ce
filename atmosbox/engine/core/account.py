"""The tallies of a box since its start, the terms of its energy budget, and whether it closes.

What is stored now is what was stored at the start plus all that was given since. `STORES` and `GIVEN` are the only
list of these terms: a box computes its residual from them, a run writes them into its file under these names, and the
file is checked with them again.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.state import Tallies, Walls
from atmosbox.engine.core.walls import HEAT_BATH, wall_kT

STORES = ("kinetic_energy", "rotational_energy", "potential_energy", "condensed_energy")
"""Energy that a box holds."""
GIVEN = {
    "heat_from_wall": "wall_heat",
    "work_by_piston": "work",
    "work_by_gravity": "gravity_work",
    "numerical_heat": "numerical_heat",
    "heat_from_bath": "bath_heat",
    "work_by_attraction": "attraction_work",
}
"""Energy given to a box since its start, with the property of the box that holds it."""


def residual(terms: Mapping[str, ArrayLike], start: float | None = None) -> NDArray[np.float64]:
    """Return the energy missing from a budget, relative to the largest energy in it [1].

    ``terms`` are given at one time or at several; those that a box lacks may be missing, and what is not in `STORES`
    was given. The last axis of ``heat_from_wall`` is that of the walls. ``start`` is the energy stored at the start;
    None for what the first of several times implies. A wall gives 2, another takes 1, and the piston does work of 3:

    >>> given = {"heat_from_wall": [[0.0, 0.0], [2.0, -1.0]], "work_by_piston": [0.0, 3.0]}
    >>> residual({"kinetic_energy": [10.0, 14.0], **given}).tolist()
    [0.0, 0.0]
    """
    stores = [np.asarray(terms[name], float) for name in STORES if name in terms]
    heat = np.asarray(terms.get("heat_from_wall", np.zeros(1)), float)
    given = [np.asarray(terms[name], float) for name in terms if name not in (*STORES, "heat_from_wall")]
    sizes = [np.abs(heat).sum(axis=-1), *map(np.abs, given)]
    total, entered = np.asarray(sum(stores)), np.asarray(heat.sum(axis=-1) + sum(given))
    begun = float((total - entered)[0]) if start is None else start
    # in deep wells a large kinetic and a large negative potential energy may have a small sum
    scale = np.maximum.reduce([np.abs(total), np.full(total.shape, abs(begun)), sum(sizes), *map(np.abs, stores)])
    missing: NDArray[np.float64] = np.abs(total - begun - entered) / np.where(scale > 0.0, scale, 1.0)
    return missing


Array = NDArray[np.float64]


class Snapshot(NamedTuple):
    """All molecules at one time.

    ``position``, ``velocity : (molecule, axis)`` [length, length/time]; ``rotational_energy :
    (molecule,)`` [energy].
    """

    time: float
    position: Array
    velocity: Array
    rotational_energy: Array


class Account(ABC):
    """The tallies of a box of molecules as properties with names and units; `Parcel` is one."""

    _tallies: Tallies
    _sides: Array
    _mass: Array
    _diameter: Array
    _now: float
    _asked: float | None
    _walls: Walls
    _gravity: float
    _planar: bool
    _rotates: bool
    _periodic: tuple[bool, bool, bool]
    _start_energy: float
    _gravity_work: float = 0.0

    @property
    def time(self) -> float:
        """Time since the start [time]."""
        return float(self._walls.epoch[0]) + self._now if self._asked is None else self._asked

    @property
    def length(self) -> Array:
        """The three sides of the box now [length]."""
        sides = self._sides.copy()
        sides[2] = self.ceiling
        return sides

    @property
    def ceiling(self) -> float:
        """Height of the ceiling now [length]."""
        position, speed, since = self._walls.piston
        return float(position + speed * (self._now - since))

    @property
    def piston_velocity(self) -> float:
        """Upward velocity of the ceiling [length/time]."""
        return float(self._walls.piston[1])

    @property
    def mass(self) -> Array:
        """Mass of each molecule [mass]."""
        return self._mass

    @property
    def diameter(self) -> Array:
        """Diameter of each molecule [length]."""
        return self._diameter

    @abstractmethod
    def snapshot(self) -> Snapshot:
        """Return all molecules as they are now; the box does not change."""

    @property
    def contacts(self) -> int:
        """Number of contacts since the start."""
        return int(self._tallies.count[0])

    @property
    def events(self) -> dict[str, int]:
        """Numbers of contacts, cells entered and left, stale predictions and wall hits since the start."""
        names = ("contacts", "entered", "left", "stale", "wall_hits")
        return {name: int(count) for name, count in zip(names, self._tallies.count, strict=True)}

    @property
    def wall_impulse(self) -> Array:
        """Outward normal impulse that each wall has taken up since the start [momentum]."""
        return np.array(self._tallies.impulse)

    @property
    def wall_heat(self) -> Array:
        """Heat that each wall has given since the start [energy]."""
        return np.array(self._tallies.heat)

    @property
    def wall_hits(self) -> NDArray[np.int64]:
        """Number of hits on each wall since the start."""
        return np.array(self._tallies.hits)

    def wall_kT(self) -> Array:
        """Return the temperature of each wall now [energy], NaN for one that has none."""
        laws, time = enumerate(self._walls.law), self.time
        return np.array([wall_kT(self._walls, w, time) if law == HEAT_BATH else math.nan for w, law in laws])

    @property
    def work(self) -> float:
        """Work that the piston has done on the molecules since the start [energy]."""
        return float(self._tallies.work.sum())

    @property
    def gravity_work(self) -> float:
        """Energy that changes of gravity have given to the molecules since the start [energy]."""
        return self._gravity_work

    @property
    def virial(self) -> Array:
        """Sum of r . dp over contacts since the start, by layer [energy]."""
        return np.array(self._tallies.virial)

    def energy(self) -> tuple[float, float, float]:
        """Return kinetic, rotational and potential energy now [energy]; potential: of gravity, and of attraction."""
        position, velocity, spin = self.snapshot()[1:]
        kinetic = 0.5 * float(np.sum(self.mass * np.sum(velocity * velocity, axis=1)))
        rotational = float(np.sum(spin)) if self._rotates else 0.0
        potential = self._gravity * float(np.sum(self.mass * position[:, 2])) if self._gravity else 0.0
        return kinetic, rotational, potential

    def budget(self) -> dict[str, float | Array]:
        """Return the terms of the energy budget now, by their names in a file [energy]."""
        stored = zip(STORES, (*self.energy(), self.condensed_energy), strict=True)
        return dict(stored) | {name: getattr(self, held) for name, held in GIVEN.items()}

    def ledger(self, budget: dict[str, float | Array] | None = None) -> float:
        """Return the energy missing from the budget (by default that of now), relative to its largest energy [1]."""
        return float(residual(budget or self.budget(), self._start_energy))

    def _given(self) -> float:
        """Return all energy that has entered since the start [energy]."""
        return float(sum(np.sum(getattr(self, held)) for held in GIVEN.values()))

    @property
    def bath_heat(self) -> float:
        """Heat that a random bath has given since the start [energy]; 0 without one."""
        return 0.0

    @property
    def attraction_work(self) -> float:
        """Energy that changes of the attraction have given since the start [energy]; 0 for hard spheres."""
        return 0.0

    @property
    def numerical_heat(self) -> float:
        """Energy that the engine's scheme itself has made, apart from heat and work [energy]; 0 for an exact engine."""
        return 0.0

    @property
    def condensed_energy(self) -> float:
        """Energy of the liquid, of the binding of its vapour, and of the rain [energy]; 0 for dry air."""
        return 0.0

    def escaped(self) -> int:
        """Return how many molecules are outside the box or have no finite position: 0, unless the engine is wrong."""
        position, velocity = self.snapshot()[1:3]
        lawful = np.isfinite(position).all(axis=1) & np.isfinite(velocity).all(axis=1)
        for axis in (0, 2) if self._planar else (0, 1, 2):
            reach = 0.0 if self._periodic[axis] else 0.5 * self.diameter
            slack = 1e-9 * self.length[axis]
            lawful &= position[:, axis] >= reach - slack
            lawful &= position[:, axis] <= self.length[axis] - reach + slack
        return int(np.sum(~lawful))

    def internal_energy(self) -> float:
        """Return kinetic + rotational energy from the ledger, without a sum over the molecules [energy].

        For boxes without gravity; there it costs the same for any number of molecules.
        """
        return self._start_energy + self._given() - self.condensed_energy
