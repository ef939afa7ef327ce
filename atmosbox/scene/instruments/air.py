"""The thermometer, the barometer and the energy budget of the whole box."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import Parcel, Snapshot
from atmosbox.engine.core.account import GIVEN, STORES
from atmosbox.engine.core.measure import temperature
from atmosbox.scene.instruments.instrument import Readings, series
from atmosbox.scene.units import Scale

Array = NDArray[np.float64]
_ALWAYS = {"kinetic_energy", "rotational_energy", "potential_energy", "heat_from_wall", "work_by_piston"}
"""Terms of the energy budget that every file has; others are left out where they are zero in all frames."""


def open_faces(parcel: Parcel) -> Array:
    """Return the area of each wall that the centres of the molecules can reach [length^2; of a plane gas, length].

    Zero where a periodic axis has no wall.

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
    """The thermometer, the barometer and the energy budget of the whole box.

    Parameters
    ----------
    barometer
        The walls that measure the air pressure: ``all`` of them, or the ``floor``.
    """

    def __init__(self, barometer: str = "all") -> None:
        self.barometer = barometer
        self._kT: list[float] = []
        self._impulse = np.zeros(6)
        self._time = 0.0
        self._rows: list[dict[str, Any]] = []

    def sample(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Read the thermometer."""
        self._kT.append(temperature(parcel, snapshot))

    def end_frame(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Read the barometer and the energy budget."""
        area = open_faces(parcel)
        lasted = parcel.time - self._time
        impulse = parcel.wall_impulse - self._impulse
        with np.errstate(invalid="ignore", divide="ignore"):
            wall_pressure = np.where(area > 0.0, impulse / (area * lasted), np.nan)
        chosen = slice(None) if self.barometer == "all" else slice(4, 5)
        budget = parcel.budget()
        self._rows.append(
            {
                "air_temperature": float(np.mean(self._kT)),
                "air_pressure": float(impulse[chosen].sum() / (area[chosen].sum() * lasted or math.nan)),
                "wall_pressure": wall_pressure,
                **budget,
                "gravity": parcel.gravity,
                "ledger_residual": parcel.ledger(budget),
                "collision_count": parcel.contacts,
                "wall_hit_count": int(parcel.wall_hits.sum()),
                "wall_temperature": parcel.wall_kT(),
            }
        )
        self._kT = []
        self._impulse = parcel.wall_impulse
        self._time = parcel.time

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the series; see `Instrument`."""
        units = {
            **dict.fromkeys(("air_temperature", "wall_temperature"), scale.temperature),
            **dict.fromkeys(("air_pressure", "wall_pressure"), scale.pressure),
            **dict.fromkeys((*STORES, *GIVEN), scale.total_energy),
            "gravity": scale.acceleration,
        }
        found = series(self._rows, units)
        for name in {*STORES, *GIVEN} - _ALWAYS:
            if name in found and not found[name].any():
                del found[name]
        if "work_by_gravity" not in found:  # gravity changes during the run in few boxes only
            found.pop("gravity", None)
        return found
