"""Wind, temperature, density and pressure in cells of height and width; rolls; and molecules released at the floor."""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.engine import Parcel, Snapshot
from atmosbox.scene.instruments.instrument import Readings, bins, series
from atmosbox.scene.statistics import overlapping_average
from atmosbox.scene.units import Scale

Array = NDArray[np.float64]

CORE = (0.299, 0.701)
"""Between which shares of the height the lapse rate of the core is measured."""
LOW = 0.1
"""Share of the height within which molecules are released at the floor, and of the width above a chimney."""
MODES = 6
"""Number of waves across the box whose amplitude is measured."""


class Flow:
    r"""Fields of the air in cells, frame by frame; its wind less thermal noise; and a share of the molecules followed.

    Parameters
    ----------
    rows, columns
        Number of cells along the height and along the width.
    release
        Number of frames after which the molecules near the floor are tagged.
    chimney
        Whether only those in the middle of the width are tagged.

    Notes
    -----
    **Wind less noise.** Of n molecules in a cell with momentum :math:`\mathbf P`, the mean of
    :math:`(P^2 - \sum_i p_i^2) / n (n - 1)` is the square of the wind without the part of each molecule alone, which is
    noise. So is :math:`a^2 - (2/N)^2 \sum_i w_i^2 s_i^2` for the mode :math:`a = (2/N) \sum_i w_i s_i`,
    :math:`s = \sin(\pi z / L) \cos(\pi n x / L_x)` in the middle of the molecule's cell; between periodic sides n
    counts half waves too, and only even numbers fit, of any phase.

    **Error of a field.** How much the frames that have settled scatter about their mean, cell by cell; earlier frames
    are given the same error.
    """

    def __init__(self, rows: int, columns: int, release: int, *, chimney: bool = False) -> None:
        self.shape = rows, columns
        self.release = release
        self.chimney = chimney
        self._tagged = np.zeros(0, np.bool_)
        self._cells = self._sum = np.zeros((5, rows * columns))
        self._wind = 0.0
        self._mode = np.zeros((2, MODES))
        self._looks = 0
        self._fields: list[Array] = []
        self._rows: list[dict[str, Any]] = []
        self._sides = np.ones(3)
        self._periodic = False

    def sample(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Sum momentum and energy of each cell, and the modes."""
        rows, columns = self.shape
        cells, length, mass = rows * columns, parcel.length, float(parcel.mass[0])
        x, z = snapshot.position[:, 0] / float(length[0]), snapshot.position[:, 2] / float(length[2])
        row = np.clip((z * rows).astype(np.int64), 0, rows - 1)
        cell = row * columns + np.clip((x * columns).astype(np.int64), 0, columns - 1)
        u, v, w = snapshot.velocity.T
        number = np.bincount(cell, minlength=cells).astype(np.float64)
        along, up = np.bincount(cell, u, cells), np.bincount(cell, w, cells)
        upright = np.bincount(cell, w * w, cells)
        flat = np.bincount(cell, u * u, cells) + upright
        deep = 0.0 if parcel.planar else np.bincount(cell, v * v, cells)
        drift = (along**2 + up**2) / np.maximum(number, 1.0)
        freedom = np.maximum((2.0 if parcel.planar else 3.0) * number - 2.0, 0.0)
        self._cells = np.stack([number, along, up, 0.5 * mass * (flat + deep - drift), freedom])
        self._sum = self._sum + self._cells
        pairs = number > 1.0
        self._wind += float(np.sum((along**2 + up**2 - flat)[pairs] / (number[pairs] - 1.0))) / len(u)
        self._sides, self._periodic = np.array(length, np.float64), bool(parcel.periodic[0])
        high, phases = modes_of_flow(rows, columns, periodic=self._periodic)
        part, alone = (
            high**power @ each.reshape(rows, columns) * (2.0 / len(u)) ** power
            for power, each in ((1, up), (2, upright))
        )
        amplitude = np.array([phase @ part for phase in phases])
        self._mode += amplitude[0], np.sum(amplitude**2, axis=0) - sum(phase**2 @ alone for phase in phases)
        self._looks += 1

    def layers(self) -> Array:
        """Return the number, energy of disordered motion and degrees of freedom in the last sample, layer by layer."""
        return np.asarray(self._cells[[0, 3, 4]].reshape(3, *self.shape).sum(axis=2))

    def end_frame(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Finish the fields of a frame, and tag the molecules near the floor when it is time."""
        looks = max(self._looks, 1)
        number, along, up, energy, freedom = self._sum
        rows, columns = self.shape
        with np.errstate(invalid="ignore", divide="ignore"):
            density = number / looks / (parcel.volume / (rows * columns))
            kT = np.where(freedom > 0.0, 2.0 * energy / freedom, np.nan)
            factor = np.ones_like(density)
            if parcel.planar:
                packing = law.packing_fraction_discs(density, float(parcel.diameter[0]))
                factor = law.compressibility_factor_discs(np.minimum(packing, 0.9))
            self._fields.append(np.stack([kT, density, density * kT * factor, along / number, up / number]))
            height = (np.arange(rows) + 0.5) / rows
            inside = (height > CORE[0]) & (height < CORE[1])
            warmth, free_rows = (row.reshape(rows, columns).sum(axis=1) for row in (energy, freedom))
            profile = 2.0 * warmth / free_rows
            core = height[inside] - height[inside].mean()
            lapse = -float(core @ profile[inside]) / float(core @ core) / float(parcel.length[2])
        if len(self._rows) == self.release:
            low = snapshot.position[:, 2] < LOW * float(parcel.length[2])
            middle = np.abs(snapshot.position[:, 0] / float(parcel.length[0]) - 0.5) < LOW
            self._tagged = low & middle if self.chimney else low
        aloft = snapshot.position[self._tagged, 2] > 0.5 * float(parcel.length[2]) if self._tagged.any() else []
        share = float(np.mean(aloft)) if len(aloft) else math.nan
        self._rows.append(
            {
                "wind_speed": _root(self._wind / looks),
                "roll_amplitude": self._mode[0] / looks,
                "roll_speed": _root(float(np.sum(self._mode[1])) / looks),
                "core_lapse_rate": lapse,
                "tracer_share_aloft": share,
                "tracer_share_aloft_se": math.sqrt(share * (1.0 - share) / len(aloft)) if len(aloft) else math.nan,
            }
        )
        self._sum = np.zeros_like(self._sum)
        self._wind, self._looks = 0.0, 0
        self._mode = np.zeros((2, MODES))

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return fields and series of all frames; see `Instrument`."""
        if not self._rows:
            return Readings()
        rows, columns = self.shape
        edges = np.linspace(0.0, float(self._sides[0]), columns + 1) * scale.length
        speed = scale.velocity
        units = dict.fromkeys(("wind_speed", "roll_amplitude", "roll_speed"), speed)
        units["core_lapse_rate"] = scale.temperature / scale.length
        found = Readings(series(self._rows, units), mode=_half_waves(periodic=self._periodic))
        found |= bins("distance", edges)
        names = {
            "cell_temperature": scale.temperature,
            "cell_number_density": scale.number_density,
            "cell_pressure": scale.pressure,
            "horizontal_wind": speed,
            "upward_wind": speed,
        }
        fields = np.swapaxes(np.array(self._fields).reshape(-1, len(names), rows, columns), 2, 3)
        settled = fields[settle:]
        scatter = settled.std(axis=0, ddof=1) if len(settled) >= 4 else np.full(fields.shape[1:], math.nan)
        for place, (name, factor) in enumerate(names.items()):
            found[name] = fields[:, place] * factor
            found[f"{name}_se"] = np.broadcast_to(scatter[place] * factor, fields[:, place].shape)
        middle = slice(columns // 4, max(columns - columns // 4, columns // 4 + 1))
        late = found["horizontal_wind"][settle:, middle].mean(axis=1)
        if len(late) >= 4:
            mean, error = overlapping_average(late, min(8, len(late) // 2))
            found |= {"layer_wind": mean, "layer_wind_se": error}
        return found


@functools.cache
def modes_of_flow(rows: int, columns: int, *, periodic: bool) -> tuple[Array, Array]:
    """Return the modes of the upward wind, by height : (row,), and across the box : (1 or 2, mode, column).

    Across it they are cosines, and sines if it is periodic.

    >>> high, across = modes_of_flow(2, 4, periodic=True)
    >>> high.round(3).tolist(), across.shape[0]
    ([0.707, 0.707], 2)
    """
    wave = _half_waves(periodic=periodic)[:, None] * (math.pi * ((np.arange(columns) + 0.5) / columns))
    across = [np.cos(wave), np.sin(wave)] if periodic else [np.cos(wave)]
    return np.sin(math.pi * ((np.arange(rows) + 0.5) / rows)), np.stack(across)


def _half_waves(*, periodic: bool) -> Array:
    """Return the numbers of half waves across the box."""
    return np.arange(1.0, MODES + 1.0) * (2.0 if periodic else 1.0)


def _root(square: float) -> float:
    """Return the root of a square, negative where noise has made it negative."""
    return math.copysign(math.sqrt(abs(square)), square)
