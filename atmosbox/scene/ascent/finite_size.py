r"""The systematic errors of the model: how far a parcel is known to be from its adiabat.

The model differs from a cloud of kilometres in two ways: the ascent takes nanoseconds, and few of the molecules are
vapour, so that a cloud consists of few molecules. The sign and size of the errors that follow are known, see `drift`,
and a run is compared with a theory that includes them.

Left out is what is small compared with the scatter of a run: the energy of the flow (0.005 K in the scene lifting-moist
as it comes); the work that the piston extracts from fluctuations as it gives way to them (0.01 K, 0.14 K with 2000
molecules); and with the engine ``exact`` the volume of the molecules (0.09 K at 300 hPa).
"""

import functools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.ascent.near_equilibrium import Cloud, cloud_along
from atmosbox.scene.ascent.random_walk import entropy_gain, gathered, walk
from atmosbox.scene.ascent.way import MoistAscent

Array = NDArray[np.float64]


class Drift(NamedTuple):
    """Known deviations of a parcel from its adiabat along its planned ascent, (moment,)."""

    pressure: Array
    """Pressure of the environment at each moment [Pa]."""
    rate: Array
    """Too warm, because of friction and of condensation at a finite rate [K]."""
    clusters: Array
    """Too warm, because of molecules in clusters in clear air and at the cloud base [K]."""
    lag: Array
    """Too cold, because vapour and heat are still on their way to the liquid [K]."""
    late: Array
    """Molecules of vapour that are still on their way to the liquid."""
    clustered: Array
    """Mean number of liquid molecules that fluctuations add to theory's liquid."""
    latent: Array
    """Latent heat of a molecule, in kT."""

    @property
    def warmer(self) -> Array:
        """How much too warm the parcel is, all in all; negative if it is too cold [K]."""
        return self.rate + self.clusters - self.lag

    def at(self, pressure: Array) -> Array:
        """Return how much too warm the parcel is where it first meets these pressures [Pa], in K."""
        rising = slice(0, int(np.argmin(self.pressure)) + 1)
        return np.interp(np.log(pressure), np.log(self.pressure[rising][::-1]), self.warmer[rising][::-1])


@functools.lru_cache(maxsize=8)
def _planned_cloud(ascent: MoistAscent, ideal: bool) -> Cloud:
    shares, path = ascent.planned
    return cloud_along(ascent, np.array(ascent.route), shares, ideal=ideal, path=path)


@functools.lru_cache(maxsize=8)
def drift(ascent: MoistAscent, *, ideal: bool) -> Drift:
    r"""Return how far a parcel is known to be from its adiabat along its ascent.

    An entropy gain :math:`\delta S` warms the parcel by :math:`T \, \delta S / C_p`, see `random_walk`; vapour and heat
    on their way to the liquid lag behind it by :math:`(L G)^{-1} \dot x`, see `near_equilibrium`.

    Parameters
    ----------
    ascent
        The ascent.
    ideal
        Whether molecules have no volume.
    """
    cloud = _planned_cloud(ascent, ideal)
    gain, t = entropy_gain(cloud), cloud.temperature
    per_entropy = t / cloud.heat
    behind = np.linalg.solve(np.einsum("tij,tjk->tik", cloud.yields, cloud.resists), cloud.change[:, :, None])[:, :, 0]
    return Drift(
        pressure=cloud.pressure,
        rate=per_entropy * gathered(gain.friction + gain.condensing, cloud.moment),
        clusters=t * cloud.latent * cloud.clustered / (3.5 * ascent.molecules),
        lag=t * np.einsum("ti,ti->t", cloud.seen(), behind),
        late=np.maximum(behind[:, 0], 0.0),
        clustered=cloud.clustered,
        latent=cloud.latent,
    )


def least_cloud(ascent: MoistAscent) -> float:
    """Return how much liquid a cloud must hold before it rains, so that fluctuations alone make no rain [kg kg-1].

    This is three standard deviations of the liquid: what a cluster loses as rain does not come back.
    """
    if not ascent.vapour:
        return 0.0
    cloud = _planned_cloud(ascent, False)
    scatter = math.sqrt(float(np.linalg.inv(cloud.resists[int(np.argmin(cloud.pressure))])[0, 0]))
    return law.WATER_MASS_RATIO * 3.0 * scatter / (ascent.molecules - ascent.vapour)


def comparable(ascent: MoistAscent) -> bool:
    """Tell whether theory, which leaves fluctuations out, can predict how much it rains."""
    return not ascent.rains or ascent.most_liquid >= least_cloud(ascent)


def rained(ascent: MoistAscent) -> law.ParcelPath:
    """Return the path of a parcel that rains, with the scatter that the liquid of so few molecules has."""
    cloud = _planned_cloud(ascent, False)
    raining = cloud.liquid > 0.0
    if not raining.any():
        return ascent.planned[1]
    variance = float(np.linalg.inv(cloud.resists[raining])[:, 0, 0].mean())
    scatter = law.WATER_MASS_RATIO * math.sqrt(variance) / (ascent.molecules - ascent.vapour)
    return ascent.path(np.array(ascent.route), ascent.planned[0], scatter)


def rain_scatter(ascent: MoistAscent) -> float:
    """Return the standard deviation of the rain of a whole ascent, per dry air [kg kg-1]; at least one molecule."""
    lost = math.sqrt(max(float(walk(_planned_cloud(ascent, False)).covariance[-1, 1, -1, 1]), 1.0))
    return law.WATER_MASS_RATIO * lost / (ascent.molecules - ascent.vapour)
