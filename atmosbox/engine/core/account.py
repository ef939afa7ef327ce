"""What a box has counted since its start, and whether the account of energy closes."""

import math
from abc import ABC, abstractmethod
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

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
    """The tallies of a box of molecules, read in words; `Parcel` keeps them."""

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
        """Return all molecules as they are now; nothing in the box changes by being looked at."""

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
        """How often each wall has been hit since the start."""
        return np.array(self._tallies.hits)

    def wall_kT(self) -> Array:
        """Return the temperature of each wall now [energy], NaN for one that has none."""
        plain = getattr(wall_kT, "py_func", wall_kT)  # asked once a frame: not worth compiling
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
        """Return kinetic, rotational and potential energy now [energy]; that of gravity, and of attraction if any."""
        position, velocity, spin = self.snapshot()[1:]
        kinetic = 0.5 * float(np.sum(self.mass * np.sum(velocity * velocity, axis=1)))
        rotational = float(np.sum(spin)) if self._rotates else 0.0
        potential = self._gravity * float(np.sum(self.mass * position[:, 2])) if self._gravity else 0.0
        return kinetic, rotational, potential

    def ledger(self) -> float:
        """Return by how much the energy ledger fails to close, relative to the energy that there is or has passed.

        Kinetic + rotational + potential energy and that of a liquid = what there was at the start + heat from the
        walls and from a random bath + work of the piston + what changes of gravity and of attraction gave + what an
        approximate scheme has made by itself.
        """
        parts = self.energy()
        total = sum(parts) + self.condensed_energy
        given = self._given()
        passed = float(np.abs(self._tallies.heat).sum()) + abs(self.work) + abs(self.gravity_work)
        passed += abs(self.bath_heat) + abs(self.attraction_work)
        # in deep wells a large kinetic energy and a large negative potential one may add up to little
        scale = max(abs(total), abs(self._start_energy), passed, *(abs(part) for part in parts))
        return abs(total - self._start_energy - given) / scale if scale > 0.0 else 0.0

    def _given(self) -> float:
        """Return all energy that has come in since the start [energy]."""
        walls = float(self._tallies.heat.sum())
        given = walls + self.work + self.gravity_work + self.numerical_heat
        return given + self.bath_heat + self.attraction_work

    @property
    def bath_heat(self) -> float:
        """Heat that a random bath has given since the start [energy]; most boxes have none."""
        return 0.0

    @property
    def attraction_work(self) -> float:
        """Energy that changes of an attraction have given since the start [energy]; hard spheres have none."""
        return 0.0

    @property
    def numerical_heat(self) -> float:
        """Energy that the engine's scheme itself has made, beside heat and work [energy]; an exact one makes none."""
        return 0.0

    @property
    def condensed_energy(self) -> float:
        """Energy of the liquid, of its vapour's binding and of the rain [energy]; dry air has none."""
        return 0.0

    def escaped(self) -> int:
        """Return how many molecules are outside the box or nowhere: none, or the engine is wrong."""
        position, velocity = self.snapshot()[1:3]
        lawful = np.isfinite(position).all(axis=1) & np.isfinite(velocity).all(axis=1)
        for axis in (0, 2) if self._planar else (0, 1, 2):
            reach = 0.0 if self._periodic[axis] else 0.5 * self.diameter
            slack = 1e-9 * self.length[axis]
            lawful &= position[:, axis] >= reach - slack
            lawful &= position[:, axis] <= self.length[axis] - reach + slack
        return int(np.sum(~lawful))

    def internal_energy(self) -> float:
        """Return kinetic + rotational energy from the ledger, without looking at the molecules [energy].

        Meant for boxes without gravity, where it costs nothing however many molecules there are.
        """
        return self._start_energy + self._given() - self.condensed_energy
