"""Two gases that mix: how far they have mixed, and the entropy of mixing, counted."""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.engine import Parcel, Snapshot
from atmosbox.scene.instruments.instrument import Instrument, Readings, bins
from atmosbox.scene.units import Scale

Array = NDArray[np.float64]
Counts = NDArray[np.integer]

MOMENTS = {"early": 0.1, "middle": 0.5, "late": 2.0}
"""Moments at which the share of one gas is drawn across the box, in mixing times."""
PRIOR = 2.0
"""Number of molecules, divided as theory expects, that are added to those of a bin for the error of its share."""


class Mixing(Instrument):
    r"""The slowest mode of the difference of two gases, the entropy of mixing, and both profiles at some moments.

    Parameters
    ----------
    right : (molecule,)
        Which molecules began on the right.
    moments
        Moments of the profiles, by the names of `MOMENTS` [reduced time]; each is taken at the end of the nearest
        frame.
    bins
        Number of equal parts into which the box is divided along x.

    Notes
    -----
    The mode is :math:`A = \langle s \cos (\pi x / L) \rangle` over its value :math:`2/\pi` for two gases that are
    apart, with s = 1 for one gas and -1 for the other, and x measured over the length that centres can reach.

    The entropy is counted in bins, :math:`-\sum_b \frac{n_b}{N} \sum_a c_{ab} \ln c_{ab}`. A bin with few molecules
    looks more ordered than it is: if K gases have been found among n molecules, :math:`(K - 1) / 2n` is added [1]_.

    References
    ----------
    .. [1] Miller, G. A. (1955), Note on the bias of information estimates, in: Information Theory in Psychology.
    """

    def __init__(self, right: NDArray[np.bool_], moments: dict[str, float], bins: int = 20) -> None:
        self.right = np.asarray(right, np.bool_)
        self.moments = moments
        self.bins = bins
        self._rows: list[tuple[float, float]] = []
        self._shares: dict[str, tuple[float, Array, Array]] = {}
        self._length = 1.0

    def end_frame(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Count both gases across the box."""
        radius = 0.5 * float(np.max(parcel.diameter, initial=0.0)) * (not parcel.periodic[0])
        self._length = float(parcel.length[0]) - 2.0 * radius
        across = (snapshot.position[:, 0] - radius) / self._length
        sign = np.where(self.right, -1.0, 1.0)
        amplitude = float(np.mean(sign * np.cos(math.pi * across))) * math.pi / 2.0
        place = np.clip((across * self.bins).astype(int), 0, self.bins - 1)
        left, right = (np.bincount(place[chosen], minlength=self.bins) for chosen in (~self.right, self.right))
        self._rows.append((amplitude, entropy_of_counts(left, right)))
        for name, moment in self.moments.items():
            off = abs(parcel.time - moment)
            if name not in self._shares or off < self._shares[name][0]:
                self._shares[name] = (off, left.astype(float), (left + right).astype(float))

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the series of mode and entropy, and the shares across the box."""
        if not self._rows:
            return Readings()
        amplitude, entropy = np.array(self._rows).T
        edges = np.linspace(0.0, self._length, self.bins + 1) * scale.length
        found = Readings(mixing_amplitude=amplitude, mixing_entropy=entropy / math.log(2.0))
        found |= bins("distance", edges)
        for name, (_, left, both) in self._shares.items():
            expected, scatter = expected_share(self.bins, MOMENTS[name])
            found[f"left_gas_share_{name}"] = left / np.where(both > 0.0, both, math.nan)
            # two molecules as theory expects them are added, so that a bin of one gas alone has an error, too, but not
            # too large a one; the factor corrects the scatter that they take from the other molecules
            guess = (left + PRIOR * expected) / (both + PRIOR)
            counted = np.maximum(both, 1.0) * (1.0 - both / (both + PRIOR) ** 2)
            found[f"left_gas_share_{name}_se"] = np.sqrt(scatter * guess * (1.0 - guess) / counted)
        return found


@functools.cache
def expected_share(bins: int, passed: float) -> tuple[Array, Array]:
    """Return the share of the left gas after some mixing times, and its variance over that of independent draws."""
    return law.mixed_share(np.linspace(0.0, 1.0, bins + 1), passed), law.mixed_share_scatter(bins, passed)


def entropy_of_counts(left: Counts, right: Counts) -> float:
    """Return the entropy of mixing per molecule, in units of k, of two gases counted in bins; see `Mixing`.

    Gases that are apart have none; one molecule of each in a bin gives ln 2 plus the correction for few molecules:

    >>> entropy_of_counts(np.array([9, 0]), np.array([0, 9])), round(entropy_of_counts(np.array([1]), np.array([1])), 4)
    (0.0, 0.9431)
    """
    both = np.asarray(left + right, np.float64)
    held = both > 0.0
    parts = np.stack([left[held], right[held]]) / both[held]
    terms = np.where(parts > 0.0, -parts * np.log(np.where(parts > 0.0, parts, 1.0)), 0.0).sum(axis=0)
    unseen = 0.5 * ((parts > 0.0).sum(axis=0) - 1.0) / both[held]
    return float(np.sum(both[held] * (terms + unseen)) / both.sum()) if held.any() else 0.0
