"""Wind, temperature, density and pressure in cells of height and width; rolls; and molecules released at the floor."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.engine import Parcel, Snapshot
from atmosbox.scene.instruments.instrument import Readings
from atmosbox.scene.statistics import block_average
from atmosbox.scene.units import Scale

__all__ = ["CORE", "LOW", "MODES", "Flow"]

Array = NDArray[np.float64]

CORE = (0.35, 0.65)
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
    :math:`s = \sin(\pi z / L) \cos(\pi n x / L_x)` in the middle of the molecule's cell; between periodic sides n counts
    half waves too, and only even numbers fit, of any phase.

    **Errors of a field.** At one moment the velocities of n molecules give a wind with the variance :math:`kT / mn`, a
    temperature with :math:`2 T^2 / f n`, a number with :math:`n / X`, where X is the stiffness of the gas. The variance
    of a mean over the samples of a frame is that less the variance of the samples within the frame; this share is the
    mean of all cells.
    """

    def __init__(self, rows: int, columns: int, release: int, *, chimney: bool = False) -> None:
        self._shape = rows, columns
        self._release = release
        self._chimney = chimney
        self._tagged = np.zeros(0, np.bool_)
        self._sum = np.zeros((8, rows * columns))
        self._wind = 0.0
        self._mode = np.zeros((2, MODES))
        self._noise = np.zeros(MODES)
        self._looks = 0
        self._fields: list[Array] = []
        self._errors: list[Array] = []
        self._rows: list[dict[str, Any]] = []
        self._sides = np.ones(3)
        self._mass = 1.0
        self._turn = False

    def sample(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Sum momentum and energy of each cell, and the modes."""
        rows, columns = self._shape
        cells, length, mass = rows * columns, parcel.length, float(parcel.mass[0])
        x, z = snapshot.position[:, 0] / float(length[0]), snapshot.position[:, 2] / float(length[2])
        row = np.clip((z * rows).astype(np.int64), 0, rows - 1)
        cell = row * columns + np.clip((x * columns).astype(np.int64), 0, columns - 1)
        u, w = snapshot.velocity[:, 0], snapshot.velocity[:, 2]
        number = np.bincount(cell, minlength=cells).astype(np.float64)
        along, up = np.bincount(cell, u, cells), np.bincount(cell, w, cells)
        twice = np.bincount(cell, np.sum(snapshot.velocity**2, axis=1), cells)
        upright = np.bincount(cell, w * w, cells)
        flat = np.bincount(cell, u * u, cells) + upright
        held = np.maximum(number, 1.0)
        drift = (along**2 + up**2) / held
        freedom = np.maximum((2.0 if parcel.planar else 3.0) * number - 2.0, 0.0)
        energy = 0.5 * mass * (twice - drift)
        square = np.divide(energy**2, freedom, out=np.zeros(cells), where=freedom > 0.0)
        self._sum += number, along, up, energy, freedom, number**2, drift, square
        pairs = number > 1.0
        self._wind += float(np.sum((along**2 + up**2 - flat)[pairs] / (number[pairs] - 1.0))) / len(u)
        self._sides, self._mass, self._turn = np.array(length, np.float64), mass, bool(parcel.periodic[0])
        height, across = (np.arange(rows) + 0.5) / rows, (np.arange(columns) + 0.5) / columns
        high = np.sin(math.pi * height)
        wave = self._waves()[:, None] * (math.pi * across)
        phases = (np.cos(wave), np.sin(wave)) if self._turn else (np.cos(wave),)
        part, alone = (
            high**power @ each.reshape(rows, columns) * (2.0 / len(u)) ** power
            for power, each in ((1, up), (2, upright))
        )
        amplitude = np.array([phase @ part for phase in phases])
        self._mode += amplitude[0], np.sum(amplitude**2, axis=0) - sum(phase**2 @ alone for phase in phases)
        self._noise += phases[0] ** 2 @ alone
        self._looks += 1

    def _waves(self) -> Array:
        """Return the numbers of half waves across the box."""
        return np.arange(1.0, MODES + 1.0) * (2.0 if self._turn else 1.0)

    def end_frame(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Finish the fields of a frame, and tag the molecules near the floor when it is time."""
        looks = max(self._looks, 1)
        number, along, up, energy, freedom, squares, drift, square = self._sum
        rows, columns = self._shape
        mass, planar = self._mass, parcel.planar
        volume = parcel.volume / (rows * columns)
        with np.errstate(invalid="ignore", divide="ignore"):
            density = number / looks / volume
            u, w = along / number, up / number
            kT = np.where(freedom > 0.0, 2.0 * energy / freedom, np.nan)
            diameter = float(parcel.diameter[0]) if planar else 0.0
            stiff = factor = np.ones_like(density)
            if planar:
                packing = np.minimum(law.packing_fraction_discs(density, diameter), 0.9)
                stiff, factor = law.inverse_compressibility_discs(packing), law.compressibility_factor_discs(packing)
            each = np.maximum(number / looks, 1e-9)
            free = np.maximum(freedom / looks, 1e-9)
            known = np.isfinite(kT)
            apart = mass * (drift - (along**2 + up**2) / np.maximum(number, 1.0))
            windy = _left(np.sum(apart[known]), 2.0 * np.sum(kT[known]), looks)
            warmer = 4.0 * square - 4.0 * energy**2 / np.maximum(freedom, 1e-9)
            warm = _left(np.sum((warmer / (2.0 * kT**2))[known]), float(known.sum()), looks)
            crowd = _left(np.sum((squares / looks - each**2) * looks), np.sum(each / stiff), looks)
            error_wind = np.sqrt(kT / (mass * each) * windy)
            error_warm = np.sqrt(2.0 / free * warm)
            error_crowd = np.sqrt(crowd / (stiff * each))
        self._fields.append(np.stack([kT, density, density * kT * factor, u, w]))
        self._errors.append(
            np.stack(
                [
                    kT * error_warm,
                    density * error_crowd,
                    density * kT * factor * np.hypot(error_warm, stiff / factor * error_crowd),
                    error_wind,
                    error_wind,
                ]
            )
        )
        height = (np.arange(rows) + 0.5) / rows
        inside = (height > CORE[0]) & (height < CORE[1])
        warmth, free_rows = (row.reshape(rows, columns).sum(axis=1) for row in (energy, freedom))
        with np.errstate(invalid="ignore", divide="ignore"):
            profile = 2.0 * warmth / free_rows
            core = height[inside] - height[inside].mean()
            lapse = -float(core @ profile[inside]) / float(core @ core) / float(parcel.length[2])
        if len(self._rows) == self._release:
            low = snapshot.position[:, 2] < LOW * float(parcel.length[2])
            middle = np.abs(snapshot.position[:, 0] / float(parcel.length[0]) - 0.5) < LOW
            self._tagged = low & middle if self._chimney else low
        aloft = snapshot.position[self._tagged, 2] > 0.5 * float(parcel.length[2]) if self._tagged.any() else []
        share = float(np.mean(aloft)) if len(aloft) else math.nan
        self._rows.append(
            {
                "wind_speed": _root(self._wind / looks),
                "roll_amplitude": self._mode[0] / looks,
                "roll_amplitude_se": np.sqrt(self._noise / looks),
                "roll_speed": _root(float(np.sum(self._mode[1])) / looks),
                "core_lapse_rate": lapse,
                "tracer_share_aloft": share,
                "tracer_share_aloft_se": math.sqrt(share * (1.0 - share) / len(aloft)) if len(aloft) else math.nan,
            }
        )
        self._sum = np.zeros_like(self._sum)
        self._wind, self._looks = 0.0, 0
        self._mode, self._noise = np.zeros((2, MODES)), np.zeros(MODES)

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return fields and series of all frames; see `Instrument`."""
        if not self._rows:
            return Readings()
        rows, columns = self._shape
        edges = np.linspace(0.0, float(self._sides[0]), columns + 1) * scale.length
        speed = scale.velocity
        units = {
            "wind_speed": speed,
            "roll_amplitude": speed,
            "roll_amplitude_se": speed,
            "roll_speed": speed,
            "core_lapse_rate": scale.temperature / scale.length,
        }
        found = Readings(
            {name: np.array([row[name] for row in self._rows]) * units.get(name, 1.0) for name in self._rows[0]},
            mode=self._waves(),
            distance=0.5 * (edges[1:] + edges[:-1]),
            distance_bnds=np.stack([edges[:-1], edges[1:]], axis=1),
        )
        names = {
            "cell_temperature": scale.temperature,
            "cell_number_density": scale.number_density,
            "cell_pressure": scale.pressure,
            "horizontal_wind": speed,
            "upward_wind": speed,
        }
        for values, suffix in ((self._fields, ""), (self._errors, "_se")):
            stacked = np.array(values).reshape(-1, len(names), rows, columns)
            for place, (name, factor) in enumerate(names.items()):
                found[f"{name}{suffix}"] = stacked[:, place] * factor
        middle = slice(columns // 4, max(columns - columns // 4, columns // 4 + 1))
        late = found["horizontal_wind"][settle:, :, middle].mean(axis=2)
        if len(late) >= 4:
            mean, error = block_average(late, min(20, len(late) // 2))
            found |= {"layer_wind": mean, "layer_wind_se": error}
        return found


def _left(within: float, single: float, looks: int) -> float:
    """Return the variance of a mean over that of a single sample, from the sum of squares within the frame."""
    share = 1.0 - within / (looks * single) if single > 0.0 else 1.0
    return min(max(float(share), 1.0 / looks), 1.0)


def _root(square: float) -> float:
    """Return the root of a square, negative where noise has made it negative."""
    return math.copysign(math.sqrt(abs(square)), square)
