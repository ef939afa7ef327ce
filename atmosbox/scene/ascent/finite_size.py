r"""The systematic errors of the model: how far a parcel is known to be from its adiabat.

The model differs from a cloud of kilometres in three ways: the ascent takes nanoseconds; molecules have volume; and few
of the molecules are vapour, so that a cloud consists of few molecules. The sign and size of the errors that follow are
known: see `drift`.
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
    """Known deviations of a parcel from its adiabat along its planned ascent, none of them negative, (moment,)."""

    pressure: Array
    """Pressure of the environment at each moment [Pa]."""
    rate: Array
    """Too warm, because of friction and of condensation at a finite rate [K]."""
    flow: Array
    """Too warm, because of the energy of the flow, :math:`m e^2 h^2 / 6` for each molecule [K]."""
    clusters: Array
    """Too warm, because of molecules in clusters in clear air and at the cloud base [K]."""
    lag: Array
    """Too cold, because vapour and heat are still on their way to the liquid [K]."""
    piston: Array
    """Too cold, because the piston gives way to fluctuations [K]."""
    room: Array
    """Too cold, because molecules have volume [K]."""
    late: Array
    """Molecules of vapour that are still on their way to the liquid."""
    clustered: Array
    """Mean number of liquid molecules that fluctuations add to theory's liquid."""
    latent: Array
    """Latent heat of a molecule, in kT."""

    @property
    def warmer(self) -> Array:
        """Sum of all that makes the parcel too warm [K]."""
        return self.rate + self.flow + self.clusters

    @property
    def colder(self) -> Array:
        """Sum of all that makes the parcel too cold [K]."""
        return self.lag + self.piston + self.room

    def at(self, pressure: float) -> tuple[float, float]:
        """Return how much too warm and how much too cold the parcel is where it first meets a pressure [Pa], in K."""
        rising = slice(0, int(np.argmin(self.pressure)) + 1)
        where = np.log(self.pressure[rising][::-1])
        warmer, colder = (np.interp(math.log(pressure), where, x[rising][::-1]) for x in (self.warmer, self.colder))
        return float(warmer), float(colder)

    def allowed(self, pressure: float) -> float:
        """Return how far off the parcel may be to either side [K]: the two kinds of error may cancel each other."""
        return max(self.at(pressure))


@functools.lru_cache(maxsize=8)
def _planned_cloud(ascent: MoistAscent, ideal: bool) -> Cloud:
    shares, path = ascent.planned
    return cloud_along(ascent, np.array(ascent.route), shares, ideal=ideal, path=path)


@functools.lru_cache(maxsize=8)
def drift(ascent: MoistAscent, *, ideal: bool) -> Drift:
    r"""Return how far a parcel is known to be from its adiabat along its ascent.

    An entropy gain :math:`\delta S` warms the parcel by :math:`T \, \delta S / C_p`, see `dissipation`; vapour and heat
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
    flow = cloud.gas * (cloud.expansion * cloud.height) ** 2 / 6.0
    room = np.zeros_like(t)
    if not ideal:
        # by excluded volume alone, as in dry air; in a cloud the heat of condensation compensates a part of it
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
