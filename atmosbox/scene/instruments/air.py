"""The thermometer, the barometer and the energy ledger of the whole box."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import Parcel, Snapshot
from atmosbox.engine.core.measure import temperature
from atmosbox.scene.instruments.instrument import Readings
from atmosbox.scene.units import Scale

__all__ = ["Air", "open_faces"]

Array = NDArray[np.float64]


def open_faces(parcel: Parcel) -> Array:
    """Return the area of each wall that the centres of the molecules can reach [length^2; of a plane gas, length].

    Zero where a periodic axis has no wall.

    Examples
    --------
    >>> from atmosbox.engine import ParcelSet
    >>> pair = ParcelSet([[1, 1, 1], [3, 3, 1]], [[1, 0, 0], [0, 2, 0]], length=(4, 4, 3))
    >>> open_faces(pair)
    array([6., 6., 6., 6., 9., 9.])
    """
    diameter = float(parcel.diameter.mean()) if parcel.number else 0.0
    sides = parcel.length - np.where(parcel.periodic, 0.0, diameter)
    if parcel.planar:
        sides[1] = 1.0
    face = np.prod(sides) / sides * ~np.array(parcel.periodic)
    if parcel.planar:
        face[1] = 0.0
    return np.repeat(face, 2)


class Air:
    """The thermometer, the barometer and the energy ledger of the whole box.

    Parameters
    ----------
    barometer
        The walls that measure the air pressure: ``all`` of them, or the ``floor``.
    """

    def __init__(self, barometer: str = "all") -> None:
        self._barometer = slice(None) if barometer == "all" else slice(4, 5)
        self._kT: list[float] = []
        self._impulse = np.zeros(6)
        self._time = 0.0
        self._rows: list[dict[str, Any]] = []

    def sample(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Read the thermometer."""
        self._kT.append(temperature(parcel, snapshot))

    def end_frame(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Read the barometer and the ledger."""
        area = open_faces(parcel)
        lasted = parcel.time - self._time
        impulse = parcel.wall_impulse - self._impulse
        with np.errstate(invalid="ignore", divide="ignore"):
            wall_pressure = np.where(area > 0.0, impulse / (area * lasted), np.nan)
        kinetic, rotational, potential = parcel.energy()
        chosen = self._barometer
        row: dict[str, Any] = {
            "air_temperature": float(np.mean(self._kT)),
            "air_pressure": float(impulse[chosen].sum() / (area[chosen].sum() * lasted))
            if area[chosen].any()
            else math.nan,
            "wall_pressure": wall_pressure,
            "kinetic_energy": kinetic,
            "rotational_energy": rotational,
            "potential_energy": potential,
            "heat_from_wall": parcel.wall_heat,
            "work_by_piston": parcel.work,
            "work_by_gravity": parcel.gravity_work,
            "gravity": parcel.gravity,
            "ledger_residual": parcel.ledger(),
            "numerical_heat": parcel.numerical_heat,
            "collision_count": parcel.contacts,
            "wall_hit_count": int(parcel.wall_hits.sum()),
            "wall_temperature": parcel.wall_kT(),
        }
        self._rows.append(row)
        self._kT = []
        self._impulse = parcel.wall_impulse
        self._time = parcel.time

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the series; see `Instrument`."""
        units = {
            "air_temperature": scale.temperature,
            "air_pressure": scale.pressure,
            "wall_pressure": scale.pressure,
            "kinetic_energy": scale.total_energy,
            "rotational_energy": scale.total_energy,
            "potential_energy": scale.total_energy,
            "heat_from_wall": scale.total_energy,
            "work_by_piston": scale.total_energy,
            "work_by_gravity": scale.total_energy,
            "gravity": scale.acceleration,
            "numerical_heat": scale.total_energy,
            "wall_temperature": scale.temperature,
        }
        if not self._rows:
            return Readings()
        columns = {name: np.array([row[name] for row in self._rows]) * units.get(name, 1) for name in self._rows[0]}
        if not columns["numerical_heat"].any():  # most ways of advancing make none
            del columns["numerical_heat"]
        if not columns["work_by_gravity"].any():  # gravity changes during the run in few boxes only
            del columns["work_by_gravity"], columns["gravity"]
        return Readings(columns)
