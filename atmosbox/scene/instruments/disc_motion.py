"""Every disc of a plane gas, and the balance of their energy and momentum."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import Parcel, Snapshot
from atmosbox.engine.core.measure import momentum
from atmosbox.scene.instruments.instrument import Instrument, Readings, series
from atmosbox.scene.units import Scale

Array = NDArray[np.float64]


class Discs(Instrument):
    """Every disc of a plane gas, the energies of the light and the heavy half, and the balance of momentum.

    Heat from a wall that was warmed by hand does not count as a change of energy; from then on the residual of the
    momentum is NaN.
    """

    def __init__(self) -> None:
        self._rows: list[dict[str, Any]] = []
        self._mass = np.zeros(0)
        self._diameter = np.zeros(0)
        self._length = np.zeros(3)

    def end_frame(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Store all discs."""
        outward = parcel.wall_impulse
        self._rows.append(
            {
                "position": snapshot.position,
                "velocity": snapshot.velocity,
                "momentum": momentum(parcel, snapshot),
                "given": outward[::2] - outward[1::2],
                "heat": float(parcel.wall_heat.sum()),
                "warmed": bool(np.isfinite(parcel.wall_kT()).any()),
            }
        )
        self._mass, self._diameter, self._length = parcel.mass, parcel.diameter, parcel.length

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the discs and the balance of their energy and momentum."""
        if not self._rows:
            return Readings()
        position, velocity, p, given, heat, warmed = series(self._rows, {}).values()
        energy = 0.5 * self._mass * np.sum(velocity**2, axis=2)
        total = energy.sum(axis=1)
        missing = (p - given) - (p[0] - given[0])
        # a warm wall pushes sideways, too, and that impulse is not counted
        residual = np.where(np.logical_or.accumulate(warmed), np.nan, np.sqrt(np.sum(missing**2, axis=1)))
        size = math.sqrt(2.0 * float(self._mass.sum()) * float(total[0])) or 1.0
        order = np.argsort(self._mass, kind="stable")
        half = len(order) // 2
        light_energy = energy[:, order[:half]].mean(axis=1) * scale.energy
        heavy_energy = energy[:, order[half:]].mean(axis=1) * scale.energy
        frames = np.arange(len(energy)) + 1.0
        return Readings(
            kinetic_energy_light=light_energy,
            kinetic_energy_heavy=heavy_energy,
            running_energy_light=np.cumsum(light_energy) / frames,
            running_energy_heavy=np.cumsum(heavy_energy) / frames,
            momentum=p * scale.mass * scale.velocity,
            momentum_residual=residual / size,
            energy_change=(total - (heat - heat[0])) / total[0] - 1.0,
            disc_position=position * scale.length,
            disc_velocity=velocity * scale.velocity,
            disc_mass=self._mass * scale.mass,
            disc_diameter=self._diameter * scale.length,
            box_length=self._length * scale.length,
        )
