"""The hygrometer: vapour, liquid, the rates at which they turn into each other, and the molecules that leave."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import Parcel, Snapshot
from atmosbox.scene.instruments.instrument import Instrument, Readings, bins
from atmosbox.scene.units import Scale

HIGHEST_SATURATED = 647.0
"""Temperature above which no saturation is computed, just below the critical one [K]."""


def gas_kT(parcel: Parcel) -> float:
    """Return the temperature of the gas from all energy of its molecules, rotation included [energy].

    >>> from atmosbox.engine import ParcelSet
    >>> gas_kT(ParcelSet([[1, 1, 1], [3, 3, 1]], [[1, 0, 0], [0, 2, 0]], length=(4, 4, 3))) * 6.0
    5.0
    """
    return 2.0 * parcel.internal_energy() / (parcel.degrees_of_freedom * max(parcel.number, 1))


def vapour_pressure(parcel: Any, kT: float) -> float:
    """Return the partial pressure of the vapour at a temperature of the gas, its share of n k T Z [energy/length^3]."""
    density = parcel.open_density
    if not density > 0.0:
        return 0.0
    factor = 1.0
    if not parcel.ideal:
        filled = float(law.packing_fraction(parcel.number / parcel.volume, float(parcel.diameter[0])))
        factor = float(law.compressibility_factor(filled))
    return float(parcel.vapour / parcel.number * density * kT * factor)


class Water:
    """Vapour pressure and relative humidity, the liquid and its temperature, and both rates of phase change.

    All are means over the samples within a frame, but the numbers of molecules are those at its end.

    Parameters
    ----------
    rains
        Whether water may leave the box as rain, which is then measured, too.
    """

    def __init__(self, *, rains: bool = False) -> None:
        self._rains = rains
        self._looks: list[tuple[float, ...]] = []
        self._rows: list[tuple[float, ...]] = []
        self._last = (0.0, 0, 0)

    def sample(self, parcel: Any, snapshot: Snapshot) -> None:
        """Read vapour pressure and temperatures, and the amounts of vapour, liquid and rain."""
        kT = gas_kT(parcel)
        air = parcel.number - parcel.vapour
        shares = ((each / air if air else math.nan) for each in (parcel.vapour, parcel.liquid, parcel.rained))
        self._looks.append((kT, vapour_pressure(parcel, kT), parcel.liquid_kT, *shares))

    def end_frame(self, parcel: Any, snapshot: Snapshot) -> None:
        """Read the counters."""
        time, condensed, evaporated = self._last
        lasted = parcel.time - time
        rates = (parcel.condensed - condensed) / lasted, (parcel.evaporated - evaporated) / lasted
        self._rows.append((*np.mean(self._looks, axis=0), *rates, parcel.vapour, parcel.liquid, parcel.rained))
        self._last = (parcel.time, parcel.condensed, parcel.evaporated)
        self._looks = []

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the series; see `Instrument`."""
        if not self._rows:
            return Readings()
        kT, pressure, liquid_kT, vapour, liquid, rain, condensing, evaporating, *counts = np.array(self._rows).T
        count = np.array(counts, np.int64)
        saturation = law.saturation_vapor_pressure(np.minimum(kT * scale.temperature, HIGHEST_SATURATED))
        e = pressure * scale.pressure
        with np.errstate(divide="ignore", invalid="ignore"):
            humidity = np.where(saturation > 0.0, e / saturation, np.nan)
        found = Readings(
            water_vapor_partial_pressure=e,
            saturation_vapor_pressure=saturation,
            relative_humidity=humidity,
            gas_temperature=kT * scale.temperature,
            liquid_temperature=liquid_kT * scale.temperature,
            condensation_rate=condensing * scale.weight / scale.time,
            evaporation_rate=evaporating * scale.weight / scale.time,
            humidity_mixing_ratio=vapour * law.WATER_MASS_RATIO,
            cloud_liquid_water_mixing_ratio=liquid * law.WATER_MASS_RATIO,
            vapor_molecule_count=count[0],
            liquid_molecule_count=count[1],
            rained_molecule_count=count[2],
        )
        if self._rains:
            found["rain_mixing_ratio"] = rain * law.WATER_MASS_RATIO
        return found


class Leaving(Instrument):
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
        out, number = bins("energy", edges), counts.sum() or math.nan
        share, widths = counts / number, np.diff(edges)
        out["leaving_energy_probability_density"] = share / widths
        out["leaving_energy_probability_density_se"] = np.sqrt(share * (1.0 - share) / number) / widths
        if min(self._open, default=1.0) < 1.0:  # few pools are covered while they run
            out["pool_open_share"] = np.array(self._open)
        return out
