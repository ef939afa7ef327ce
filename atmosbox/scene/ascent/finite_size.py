r"""The errors of the model itself: how far from its adiabat a parcel is known to be.

Three things are not as in a cloud of kilometres. The way takes nanoseconds; molecules have volume; and few of
them are vapour, so that a cloud consists of few molecules. What that does is known, with its sign: see `drift`.
"""

import functools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.ascent.dissipation import entropy_gain, gathered
from atmosbox.scene.ascent.near_equilibrium import Cloud, cloud_along
from atmosbox.scene.ascent.raining import walk
from atmosbox.scene.ascent.way import MoistAscent

__all__ = ["Drift", "comparable", "drift", "least_cloud", "rain_scatter", "rained"]

Array = NDArray[np.float64]
_PLACES = 24


class Drift(NamedTuple):
    """By how much a parcel is known to be off along its planned way, each not negative, (moment,)."""

    pressure: Array
    """Where on the way [Pa]."""
    rate: Array
    """Too warm, by friction and by condensing at a finite rate [K]."""
    flow: Array
    """Too warm, by the energy of the flow, :math:`m e^2 h^2 / 6` for each molecule [K]."""
    clusters: Array
    """Too warm, by molecules that are clustered in clear air and at the cloud base [K]."""
    lag: Array
    """Too cold, because vapour and heat are under way to the liquid [K]."""
    piston: Array
    """Too cold, because the piston gives way to fluctuations [K]."""
    room: Array
    """Too cold, because molecules have volume [K]."""
    late: Array
    """Molecules of vapour that are under way to the liquid."""
    clustered: Array
    """Molecules that chance adds to the liquid."""
    latent: Array
    """Latent heat of a molecule over kT."""

    @property
    def warmer(self) -> Array:
        """All that makes it too warm [K]."""
        return self.rate + self.flow + self.clusters

    @property
    def colder(self) -> Array:
        """All that makes it too cold [K]."""
        return self.lag + self.piston + self.room

    def at(self, pressure: float) -> tuple[float, float]:
        """Return how much too warm and how much too cold it is where it first meets a pressure [Pa], in K."""
        rising = slice(0, int(np.argmin(self.pressure)) + 1)
        where = np.log(self.pressure[rising][::-1])
        warmer, colder = (np.interp(math.log(pressure), where, x[rising][::-1]) for x in (self.warmer, self.colder))
        return float(warmer), float(colder)

    def allowed(self, pressure: float) -> float:
        """Return how far off it may be to either side [K]: the two kinds may make up for each other."""
        return max(self.at(pressure))


@functools.lru_cache(maxsize=8)
def _planned_cloud(ascent: MoistAscent, ideal: bool) -> Cloud:
    shares, path = ascent.planned
    return cloud_along(ascent, np.array(ascent.route), shares, ideal=ideal, path=path)


@functools.lru_cache(maxsize=8)
def drift(ascent: MoistAscent, *, ideal: bool) -> Drift:
    r"""Return how far from its adiabat a parcel is known to be along its way.

    Entropy that is gained shows as :math:`T \, \delta S / C_p`, see `dissipation`; vapour and heat that are under way
    to the liquid are :math:`(L G)^{-1} \dot x` behind it, see `near_equilibrium`.

    Parameters
    ----------
    ascent
        The way.
    ideal
        Whether molecules have no volume.
    """
    cloud = _planned_cloud(ascent, ideal)
    gain, t = entropy_gain(cloud), cloud.temperature
    per_entropy = t / cloud.heat
    behind = np.linalg.solve(np.einsum("tij,tjk->tik", cloud.yields, cloud.resists), cloud.change[:, :, None])[:, :, 0]
    flow = cloud.gas * (cloud.expansion * cloud.height) ** 2 / 6.0
    room = np.zeros_like(t)
    if not ideal:
        # by volume alone, as in dry air; in a cloud the heat of condensing makes good a part of it
        dry = law.Ascent((ascent.pressure, ascent.top_pressure), ascent.length, 0.0)
        places = np.geomspace(float(cloud.pressure.min()), float(cloud.pressure.max()), _PLACES)
        share = [dry.room(float(p), ascent.box(ideal=False)[0]) for p in places]
        room = t * np.interp(cloud.pressure, places, share) * 3.5 * cloud.gas / cloud.heat
    return Drift(
        pressure=cloud.pressure,
        rate=per_entropy * gathered(gain.friction + gain.condensing, cloud.moment),
        flow=t * (1.0 - cloud.slope) * flow / cloud.air_heat,
        clusters=t * cloud.latent * cloud.clustered / (3.5 * ascent.molecules),
        lag=np.maximum(t * np.einsum("ti,ti->t", cloud.seen(), behind), 0.0),
        piston=-per_entropy * gathered(gain.piston, cloud.moment),
        room=np.abs(room),
        late=np.maximum(behind[:, 0], 0.0),
        clustered=cloud.clustered,
        latent=cloud.latent,
    )


def least_cloud(ascent: MoistAscent) -> float:
    """Return how much liquid a cloud must hold before it rains, so that no chance surplus does [kg kg-1].

    Three times by how much the liquid scatters: what a cluster loses as rain does not come back.
    """
    if not ascent.vapour:
        return 0.0
    cloud = _planned_cloud(ascent, False)
    scatter = math.sqrt(float(np.linalg.inv(cloud.resists[int(np.argmin(cloud.pressure))])[0, 0]))
    return law.WATER_MASS_RATIO * 3.0 * scatter / (ascent.molecules - ascent.vapour)


def comparable(ascent: MoistAscent) -> bool:
    """Tell whether theory, which leaves chance out, says how much it rains."""
    return not ascent.rains or ascent.most_liquid >= least_cloud(ascent)


def rained(ascent: MoistAscent) -> law.ParcelPath:
    """Return the path of a parcel that rains, and whose liquid scatters as much as that of so few molecules."""
    cloud = _planned_cloud(ascent, False)
    raining = cloud.liquid > 0.0
    if not raining.any():
        return ascent.planned[1]
    variance = float(np.linalg.inv(cloud.resists[raining])[:, 0, 0].mean())
    scatter = law.WATER_MASS_RATIO * math.sqrt(variance) / (ascent.molecules - ascent.vapour)
    return ascent.path(np.array(ascent.route), ascent.planned[0], scatter)


def rain_scatter(ascent: MoistAscent) -> float:
    """Return by how much the rain of a whole way scatters, per dry air [kg kg-1]; at least by one molecule."""
    lost = math.sqrt(max(float(walk(_planned_cloud(ascent, False)).covariance[-1, 1, -1, 1]), 1.0))
    return law.WATER_MASS_RATIO * lost / (ascent.molecules - ascent.vapour)
