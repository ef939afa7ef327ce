"""Positions and velocities of all molecules, and the kind of box they are in."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import Snapshot
from atmosbox.scene.instruments.instrument import Instrument, Readings, padded
from atmosbox.scene.units import Scale
from atmosbox.theory.constants import DRY_AIR, WATER

Array = NDArray[np.float64]
Single = NDArray[np.float32]

LAWS = ("specular", "periodic", "heat_bath", "piston", "pool")
"""What a wall may be, in the order of the numbers that the engine and the file give to these laws."""


def wall_laws(parcel: Any) -> tuple[str, ...]:
    """Return the law, a name in `LAWS`, of each wall of a box: x low, x high, y low, y high, z low, z high.

    Examples
    --------
    >>> from atmosbox.engine import ParcelSet
    >>> from atmosbox.engine.core.walls import HeatBath, Piston, Specular
    >>> walls = (Specular(),) * 4 + (HeatBath(1.0), Piston())
    >>> wall_laws(ParcelSet([[1, 1, 1]], [[1, 0, 0]], length=(4, 4, 3), walls=walls))[4:]
    ('heat_bath', 'piston')
    """
    return tuple(LAWS[int(law)] for law in parcel.laws)


class Molecules(Instrument):
    """Positions and velocities of all molecules and the box they are in, for ``--save-molecules``.

    A molecule in the liquid has neither position nor velocity; both are NaN. Where there is water, the readings say
    which molecules are water, and where the visible drops are. Where molecules attract each other, the readings give
    the number of neighbours of each.

    Parameters
    ----------
    right : (molecule,), optional
        Which molecules belong to the second of two gases, where there are two.
    """

    def __init__(self, right: NDArray[np.bool_] | None = None) -> None:
        self._right = right
        self._position: list[Single] = []
        self._velocity: list[Single] = []
        self._sides: list[Array] = []
        self._drops: list[tuple[Array, Array]] = []
        self._neighbours: list[NDArray[np.int64]] = []
        self._mass = np.zeros(0)
        self._diameter = np.zeros(0)
        self._laws: tuple[str, ...] = ()
        self._moist = False

    def end_frame(self, parcel: Any, snapshot: Snapshot) -> None:
        """Store all molecules in single precision, the drops and the size of the box."""
        present = parcel.present
        for kept, each in ((self._position, snapshot.position), (self._velocity, snapshot.velocity)):
            kept.append(np.full((present.size, 3), np.nan, np.float32))
            kept[-1][present] = each
        self._sides.append(np.array(parcel.length))
        if hasattr(parcel, "neighbours"):
            self._neighbours.append(parcel.neighbours())
        if hasattr(parcel, "drops"):
            self._drops.append(parcel.drops()[:2])
        if not self._laws:
            self._laws, self._moist = wall_laws(parcel), hasattr(parcel, "vapour")
            self._mass, self._diameter = np.full(present.size, np.nan), np.full(present.size, np.nan)
        if np.isnan(self._mass).any():  # molecules of water that have never been in the gas
            self._mass[present], self._diameter[present] = parcel.mass, parcel.diameter

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return positions, velocities and speeds, the kind of each molecule, and the box."""
        if not self._position:
            return Readings()
        mass, diameter = self._mass * scale.mass, self._diameter * scale.length
        hidden = np.isnan(mass)
        water = hidden | (mass < 0.5 * (DRY_AIR.molecule_mass + WATER.molecule_mass))
        if hidden.any():
            mass[hidden] = WATER.molecule_mass
            diameter[hidden] = np.nanmean(diameter[water] if not hidden[water].all() else diameter)
        velocity = np.array(self._velocity) * np.float32(scale.velocity)
        found = Readings(
            molecule_position=np.array(self._position) * np.float32(scale.length),
            molecule_velocity=velocity,
            molecule_speed=np.sqrt(np.sum(velocity**2, axis=2)),
            molecule_mass=mass,
            molecule_diameter=diameter,
            box_side=np.array(self._sides) * scale.length,
            wall_law=np.array([LAWS.index(law) for law in self._laws], np.int8),
        )
        if self._neighbours:
            found["molecule_neighbour_count"] = np.minimum(self._neighbours, 127).astype(np.int8)
        if self._right is not None:
            found["gas"] = np.asarray(self._right, np.int8)
        if self._moist:
            found["species"] = water.astype(np.int8)
        if self._drops:
            for name, each in zip(("drop_position", "drop_radius"), zip(*self._drops, strict=True), strict=True):
                found[name] = padded(each, np.nan) * scale.length
        return found
