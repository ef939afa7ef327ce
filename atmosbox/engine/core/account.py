"""The tallies of a box since its start, and whether its energy budget closes."""

import math
from abc import ABC, abstractmethod
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.energy_budget import GIVEN, STORES, residual
from atmosbox.engine.core.state import Tallies, Walls
from atmosbox.engine.core.walls import HEAT_BATH, wall_kT

__all__ = ["Account", "Snapshot"]

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
    _walls: Walls
    _gravity: float
    _planar: bool
    _rotates: bool
    _periodic: tuple[bool, bool, bool]
    _start_energy: float
    _gravity_work: float = 0.0

    @property
    @abstractmethod
    def time(self) -> float:
        """Time since the start [time]."""

    @property
    @abstractmethod
    def length(self) -> Array:
        """The three sides of the box now [length]."""

    @property
    @abstractmethod
    def mass(self) -> Array:
        """Mass of each molecule [mass]."""

    @property
    @abstractmethod
    def diameter(self) -> Array:
        """Diameter of each molecule [length]."""

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
        plain = getattr(wall_kT, "py_func", wall_kT)  # called once a frame: not worth compiling
        kT = [
            plain(self._walls, w, self.time) if law == HEAT_BATH else math.nan for w, law in enumerate(self._walls.law)
        ]
        return np.array(kT)

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
        """Return the terms of the energy budget now, by their names in a file [energy]; see `energy_budget`."""
        stored = zip(STORES, (*self.energy(), self.condensed_energy), strict=True)
        return dict(stored) | {name: getattr(self, held) for name, held in GIVEN.items()}

    def ledger(self) -> float:
        """Return the energy missing from the energy budget, relative to the largest of the energies in it [1]."""
        return float(residual(self.budget(), self._start_energy))

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
