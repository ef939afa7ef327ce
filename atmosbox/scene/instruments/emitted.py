"""The energies of the molecules that leave the liquid."""

from __future__ import annotations

from typing import Any

import numpy as np

from atmosbox.engine import Snapshot
from atmosbox.scene.instruments.instrument import Readings
from atmosbox.scene.units import Scale

__all__ = ["Leaving"]


class Leaving:
    """Histogram of the energies of the molecules that evaporate, counted from a molecule at rest in the liquid.

    Where the pool has been covered by hand, also which share of it was open at the end of each frame.

    This energy is the binding energy plus the translational and rotational energy outside the liquid. No molecule
    leaves with less than the binding energy, and the bins below it stay empty. All molecules that have left since the
    start are counted. They are independent of each other, so that the standard error of a share q of n is
    sqrt(q (1 - q) / n).

    Parameters
    ----------
    binding_energy
        Energy that pulls a molecule out of the liquid [reduced energy].
    merged
        Number of the engine's bins that are merged into one.
    """

    def __init__(self, binding_energy: float, merged: int = 2) -> None:
        self.binding = binding_energy
        self.merged = merged
        self._edges = np.array([0.0, 1.0])
        self._counts = np.zeros(1)
        self._open: list[float] = []

    def sample(self, parcel: Any, snapshot: Snapshot) -> None:
        """Need no sample of single molecules."""

    def end_frame(self, parcel: Any, snapshot: Snapshot) -> None:
        """Read the energies of the molecules that have left, and how much of the surface is open."""
        self._open.append(parcel.sticking)
        edges, counts = parcel.emitted_energy
        self._edges, self._counts = edges[:: self.merged], counts.reshape(-1, self.merged).sum(axis=1)

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the histogram, which begins at zero energy; see `Instrument`."""
        width = float(self._edges[1])
        below = np.linspace(0.0, self.binding, max(round(self.binding / width), 1), endpoint=False)
        edges = np.concatenate([below, self.binding + self._edges]) * scale.energy
        counts = np.concatenate([np.zeros(len(below)), self._counts])
        out = Readings(energy=0.5 * (edges[1:] + edges[:-1]), energy_bnds=np.stack([edges[:-1], edges[1:]], axis=1))
        number = counts.sum()
        if number:
            share, widths = counts / number, np.diff(edges)
            out["leaving_energy_probability_density"] = share / widths
            out["leaving_energy_probability_density_se"] = np.sqrt(share * (1.0 - share) / number) / widths
        else:
            out["leaving_energy_probability_density"] = np.full(len(counts), np.nan)
            out["leaving_energy_probability_density_se"] = np.full(len(counts), np.nan)
        if min(self._open, default=1.0) < 1.0:  # few pools are covered while they run
            out["pool_open_share"] = np.array(self._open)
        return out
