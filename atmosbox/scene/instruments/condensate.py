"""Drops of molecules that attract each other: which molecules form a drop, and their energy and pressure."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import Parcel, Snapshot
from atmosbox.engine.core.measure import temperature
from atmosbox.scene.instruments.instrument import Readings, series
from atmosbox.scene.units import Scale

CROWDED = 5
"""Least number of wells of a molecule that counts as liquid: in vapour it is in one or two wells, in a drop in ten."""


def drops_of(pairs: NDArray[np.int64], number: int) -> NDArray[np.int64]:
    """Return the drop of each molecule, 0 for the largest, and -1 for a molecule of the vapour.

    ``pairs : (pair, 2)`` are the molecules that are in each other's well. Molecules in `CROWDED` wells or more are
    liquid; two of them in each other's well belong to the same drop. A molecule at the surface, in the well of one of
    them, belongs to that drop as well.

    Six molecules that are all in each other's wells, one at the surface, and one alone:

    >>> import itertools
    >>> bound = [*itertools.combinations(range(6), 2), (0, 6)]
    >>> drops_of(np.array(bound), 8).tolist()
    [0, 0, 0, 0, 0, 0, 0, -1]
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    liquid = np.bincount(pairs.reshape(-1), minlength=number) >= CROWDED
    first, second = pairs.T
    inner = liquid[first] & liquid[second]
    links = coo_array((np.ones(int(inner.sum())), (first[inner], second[inner])), shape=(number, number))
    label = connected_components(links, directed=False)[1].astype(np.int64)
    label[~liquid] = -1
    for one, two in ((first, second), (second, first)):  # the surface
        outer = liquid[one] & ~liquid[two]
        label[two[outer]] = label[one[outer]]
    found, size = np.unique(label[label >= 0], return_counts=True)
    rank = np.full(number, -1, np.int64)
    rank[found[np.argsort(-size, kind="stable")]] = np.arange(found.size)
    return np.where(label >= 0, rank[label], -1)


class Clusters:
    """The largest drop, the free vapour, the energy of attraction, and the pressure inside.

    The pressure is the sum of the kinetic part and the virial part, :math:`p = n k T + W / 3 V`; it needs no wall.

    Parameters
    ----------
    molecules
        Number of molecules that attract each other; they are the first ones.
    liquid
        Density of the liquid, from which a page estimates the volume of the drops [1/length^3].
    """

    def __init__(self, molecules: int, liquid: float = 1.0) -> None:
        self.molecules = molecules
        self.liquid = liquid
        self._kT: list[float] = []
        self._rows: list[dict[str, float]] = []
        self._virial = 0.0
        self._time = 0.0

    def sample(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Read the thermometer."""
        self._kT.append(temperature(parcel, snapshot))

    def end_frame(self, parcel: Any, snapshot: Snapshot) -> None:
        """Count the drops, and read the sums of the frame."""
        n = self.molecules
        drop = drops_of(parcel.pairs(), parcel.number)[:n]
        lasted = parcel.time - self._time
        virial = float(parcel.virial.sum())
        motion = parcel.number * float(np.mean(self._kT))
        self._rows.append(
            {
                "largest_drop_molecule_count": float(np.sum(drop == 0)),
                "vapor_molecule_count": float(np.sum(drop < 0)),
                "drop_count": float(drop.max(initial=-1) + 1),
                "attraction_energy": parcel.well_energy,
                "molecular_energy": sum(parcel.energy()),
                "virial_pressure": (motion + (virial - self._virial) / (3.0 * lasted)) / parcel.volume,
                "well_count": float(parcel.number_of_wells),
            }
        )
        self._kT = []
        self._virial = virial
        self._time = parcel.time

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the series; see `Instrument`."""
        energies = ("attraction_energy", "molecular_energy")
        return series(self._rows, dict.fromkeys(energies, scale.total_energy) | {"virial_pressure": scale.pressure})
