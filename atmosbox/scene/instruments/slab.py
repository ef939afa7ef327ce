"""A layer of liquid with vapour on both sides, or on one: its density, its pressure, its surface."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import Snapshot
from atmosbox.engine.core.measure import temperature
from atmosbox.scene.instruments.instrument import Readings, bins
from atmosbox.scene.statistics import overlapping_average
from atmosbox.scene.units import Scale

Array = NDArray[np.float64]

_BIN = 0.25
_BLOCKS = 10
_INSIDE, _OUTSIDE = 3.0, 4.0
"""Least distance from the middle of the surface at which a layer counts as liquid, and as vapour [diameter]."""


def inner_and_outer(height: Array, density: Array, periodic: bool) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Tell which layers are well inside the liquid, and which well outside; none if they cannot be told apart.

    The liquid is in the middle of a periodic box, else on the floor; lengths are in diameters.

    >>> height = np.arange(0.125, 40.0, 0.25)
    >>> inner, outer = inner_and_outer(height, np.where(abs(height - 20.0) < 6.0, 0.7, 0.02), True)
    >>> [float(height[which].min()) for which in (inner, outer)], float(height[inner].max())
    ([17.125, 0.125], 22.875)
    """
    middle = 0.5 * height[-1] if periodic else 0.0
    away = np.abs(height - middle)
    order = np.argsort(away, kind="stable")
    part = max(len(order) // 8, 1)
    dense, thin = float(density[order[:part]].mean()), float(density[order[-part:]].mean())
    filled = density > 0.5 * (dense + thin)
    none = np.zeros(len(height), np.bool_)
    if not dense > 3.0 * thin or filled.all():
        return none, none
    surface = float(filled.sum()) * (height[1] - height[0]) * (0.5 if periodic else 1.0)
    return away < surface - _INSIDE, away > surface + _OUTSIDE


class Slab:
    r"""Densities and energies of the liquid and of the vapour beside it, the normal pressure, the surface tension.

    A slab in a periodic box drifts, because the random bath does not conserve momentum: heights are
    measured so that the middle of the liquid is in the middle of the box. The pressure normal to the surface,
    :math:`p = n k T + W_{zz} / V`, is the same in liquid and vapour. The surface tension measures by how much the
    pressure along the surface is lower, :math:`\gamma = (W_{zz} - \tfrac12 (W_{xx} + W_{yy})) / 2 A t` for two
    surfaces [1]_.

    Parameters
    ----------
    molecules
        Number of molecules that attract each other; they are the first ones.

    References
    ----------
    .. [1] Kirkwood, J. G., Buff, F. P. (1949), doi:10.1063/1.1747248.
    """

    def __init__(self, molecules: int) -> None:
        self._molecules = molecules
        self._kT: list[float] = []
        self._looks: list[Array] = []
        self._frames: list[Array] = []
        self._series: list[tuple[float, float]] = []
        self._stress = np.zeros(3)
        self._time = 0.0
        self._height = 1.0
        self._area = 1.0
        self._periodic = True

    def sample(self, parcel: Any, snapshot: Snapshot) -> None:
        """Count by height the molecules, and the wells they are in."""
        self._height = float(parcel.length[2])
        self._area = float(parcel.length[0] * parcel.length[1])
        self._periodic = bool(parcel.periodic[2])
        layers = max(round(self._height / _BIN), 8)
        n = self._molecules
        wells = parcel.neighbours()[:n].astype(np.float64)
        z = snapshot.position[:n, 2]
        if self._periodic:
            angle = 2.0 * np.pi / self._height * z
            middle = math.atan2(float(wells @ np.sin(angle)), float(wells @ np.cos(angle))) * self._height / 2.0 / np.pi
            z = np.mod(z - middle + 0.5 * self._height, self._height)
        layer = np.clip((z / self._height * layers).astype(np.int64), 0, layers - 1)
        self._looks.append(np.stack([np.bincount(layer, minlength=layers), np.bincount(layer, wells, layers)]))
        self._kT.append(temperature(parcel, snapshot))

    def end_frame(self, parcel: Any, snapshot: Snapshot) -> None:
        """Finish the sums of a frame."""
        lasted = parcel.time - self._time
        stress = (parcel.stress - self._stress) / lasted
        pressure = (parcel.number * float(np.mean(self._kT)) + stress[2]) / float(parcel.volume)
        self._series.append((pressure, (stress[2] - 0.5 * (stress[0] + stress[1])) / (2.0 * self._area)))
        self._frames.append(np.mean(self._looks, axis=0))
        self._looks, self._kT = [], []
        self._stress = parcel.stress
        self._time = parcel.time

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the profile, and the series of liquid and vapour; see `Instrument`."""
        frames = np.array(self._frames)
        if len(frames) - settle < 4:
            return Readings()
        layers = frames.shape[2]
        edges = np.linspace(0.0, self._height, layers + 1)
        axis = bins("height", edges)
        volume = self._area * self._height / layers
        late = frames[settle:]
        # the surfaces move and the number in the vapour stays correlated over many frames: ten long blocks give the
        # error
        blocks = min(_BLOCKS, len(late) // 2)
        density, error = (each / volume for each in overlapping_average(late[:, 0], blocks))
        found = Readings({name: each * scale.length for name, each in axis.items()})
        found |= {"number_density": density * scale.number_density, "number_density_se": error * scale.number_density}
        pressure, tension = np.array(self._series).T
        found["normal_pressure"] = pressure * scale.pressure
        if self._periodic:
            found["surface_tension"] = tension * scale.pressure * scale.length
        parts = inner_and_outer(axis["height"], density, self._periodic)
        for name, part in zip(("liquid", "vapor"), parts, strict=True):
            if not part.any():
                continue
            number, wells = frames[:, :, part].sum(axis=2).T
            with np.errstate(invalid="ignore", divide="ignore"):
                energy = np.where(number > 0.0, -0.5 * wells / number, np.nan)
            found[f"{name}_number_density"] = number / (volume * part.sum()) * scale.number_density
            found[f"{name}_well_energy"] = energy * scale.energy
        return found
