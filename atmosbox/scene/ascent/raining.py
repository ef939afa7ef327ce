r"""How far chance takes the rain of a parcel, and what more or less of it does to the temperature from there on.

A cloud of few molecules scatters about its equilibrium, its surplus falls out one by one, and what has fallen is gone.
Two numbers tell what chance has done: R, by how many molecules more have rained than on average, and S, by how much
more entropy the parcel has, over k, than theory's parcel at the same temperature with as much water.

**How they grow.** The cloud holds m molecules more than it keeps, on average, and as many as :math:`m + x`, where x
scatters by s (`near_equilibrium`). A molecule that has fallen is missing in the cloud, and so is one that warmer air
holds as vapour, :math:`v_S = v (1 + v/N) \lambda / C_p` for a unit of entropy. With the rate r and :math:`a = m/s`,

.. math:: dR = -r \, \Phi(a) \, (R + v_S S) \, dt + dW, \qquad
   \frac{d \langle W^2 \rangle}{dt} = r \langle (m + x)_+ \rangle
   + 2 r^2 \int_0^\infty \mathrm{cov}\big[(m + x)_+, (m + x_t)_+\big] \, dt ,

since a surplus rains for the share :math:`\Phi(a)` of the time, as a mean :math:`\langle (m + x)_+ \rangle = m \Phi(a)
+ s \varphi(a)`, one molecule after the other, and x is remembered for a time :math:`\tau`. In Hermite's polynomials the
integral is :math:`s^2 \tau [\Phi^2 + \varphi^2 \sum_{k \geq 2} He_{k-2}^2(a) / k \, k!]`, with :math:`s^2 \tau =
(G^{-1} L^{-1} G^{-1})_{nn}`. So R is none before it rains, follows the surplus while it rains, and stays. The entropy
walks as `dissipation` says; beside, water that is missing would have changed its entropy with the temperature,
:math:`dS = c_l R \, d \ln T`.

**What they show.** At a given pressure a cloud is warmer by :math:`T S / C_p`, whatever has rained. Where the cloud has
evaporated, a molecule that is missing needed no latent heat: :math:`T \, [S + (\lambda - \ln f) R] / C_p`, with the
relative humidity f and the heat capacity of clear air. Where rain decides whether there is a cloud still, both count,
by the chance of either.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.ascent.dissipation import entropy_gain, gathered
from atmosbox.scene.ascent.near_equilibrium import Cloud

__all__ = ["Walk", "walk"]

Array = NDArray[np.float64]
_TERMS = 12
"""Of Hermite's polynomials: the twelfth adds a millionth."""
_FAR = 30.0


class Walk(NamedTuple):
    """What entropy and rain have gathered by chance."""

    covariance: Array
    """Of S and R, (moment, 2, moment, 2)."""
    more: Array
    """Molecules that have rained more on average, because the cloud scatters, (moment,)."""
    clear: Array
    """The chance that there is no cloud, (moment,)."""

    def shown(self, gain: Array) -> Array:
        """Return the covariance between moments of what S and R show by a gain, (moment, 2)."""
        return np.asarray(np.einsum("ti,tiuj,uj->tu", gain, self.covariance, gain, optimize=True))


def _normal(a: float) -> tuple[float, float]:
    """Return the share of a normal distribution below a, and its density there.

    Examples
    --------
    >>> [round(each, 3) for each in _normal(1.0)]
    [0.841, 0.242]
    """
    return 0.5 * math.erfc(-a / math.sqrt(2.0)), math.exp(-0.5 * a * a) / math.sqrt(2.0 * math.pi)


def _remembered(a: float) -> float:
    r"""Return :math:`\int \mathrm{cov}[(a + z)_+, (a + z_t)_+] \, dt` for a z that is forgotten as :math:`e^{-t}`.

    Examples
    --------
    Far above zero it is that of z itself, one:

    >>> [round(_remembered(a), 3) for a in (-9.0, 0.0, 9.0)]
    [0.0, 0.292, 1.0]
    """
    share, density = _normal(a)
    found, before, polynomial = share * share, 0.0, 1.0
    for k in range(2, _TERMS):
        found += (density * polynomial) ** 2 / (k * math.factorial(k))
        before, polynomial = polynomial, a * polynomial - (k - 2) * before
    return found


def _mean(rate: float) -> float:
    """Return the mean of exp(-rate t) for t between 0 and 1.

    Examples
    --------
    >>> _mean(0.0), round(_mean(1.0), 3)
    (1.0, 0.632)
    """
    return -math.expm1(-rate) / rate if rate > 0.0 else 1.0


def walk(cloud: Cloud) -> Walk:
    """Return what a parcel has gathered by chance along its way, see the head of this file.

    Examples
    --------
    Without rain there is only the entropy, which is kept:

    >>> from atmosbox import scenarios
    >>> from atmosbox.scene.ascent import along_frames
    >>> from atmosbox.simulation.preparation import prepare
    >>> ascent = scenarios.load("lifting-moist")._ascent(prepare("lifting-moist", {}).settings)
    >>> found = walk(along_frames(ascent, np.geomspace(1e5, 3e4, 60), 60, 1, ideal=True)).covariance
    >>> bool(found[:, 1].any()), bool(found[20, 0, 20, 0] == found[20, 0, 50, 0])
    (False, True)
    """
    number = len(cloud.moment)
    entropy = gathered(entropy_gain(cloud).variance, cloud.moment)
    covariance = np.zeros((number, 2, number, 2))
    if not cloud.rains:
        covariance[:, 0, :, 0] = np.minimum(entropy[:, None], entropy)
        return Walk(covariance, np.zeros(number), np.where(cloud.liquid > 0.0, 0.0, 1.0))
    steps, gathers = np.diff(cloud.moment, prepend=0.0), np.diff(entropy, prepend=0.0)
    warms = law.LIQUID_HEAT_CAPACITY * np.diff(np.log(cloud.temperature), prepend=np.log(cloud.temperature[0]))
    inverse = np.linalg.inv(cloud.resists)
    scatter = inverse[:, 0, 0]
    lasting = (inverse @ np.linalg.inv(cloud.yields) @ inverse)[:, 0, 0]
    dries = cloud.dries
    # what clear air lacks to be saturated: it would cool by what evaporates into it
    lacks = cloud.vapour * (1.0 / cloud.humidity - 1.0) * cloud.clear_heat / cloud.cloudy_heat
    holds = cloud.liquid - lacks
    now, excess, more, clear = np.zeros((2, 2)), 0.0, np.zeros(number), np.zeros(number)
    for k in range(number):
        missing = np.array([dries[k], 1.0])
        off = float(missing @ now @ missing)
        surplus, spread = holds[k] - cloud.keeps, math.sqrt(scatter[k] + off)
        a = min(max((surplus - excess) / spread, -_FAR), _FAR)
        often, density = _normal(a)
        falls = spread * max(a * often + density, 0.0)
        # within a step all of them relax towards where they would stay
        passes = cloud.rains * often * steps[k]
        part = passes * _mean(passes)
        moves = np.array([[1.0, warms[k]], [-part * dries[k], 1.0 - part]])
        unsteady = 2.0 * cloud.rains * lasting[k] * _remembered(a)
        noise = cloud.rains * (falls + unsteady) * steps[k] * _mean(2.0 * passes)
        excess += cloud.rains * (falls - max(surplus, 0.0)) * steps[k] * _mean(passes)
        covariance[k, :, :k] = np.einsum("ij,juv->iuv", moves, covariance[k - 1, :, :k])
        covariance[:k, :, k] = np.moveaxis(covariance[k, :, :k], 0, 2)
        now = moves @ now @ moves.T + np.diag([gathers[k], noise])
        covariance[k, :, k] = now
        off = float(missing @ now @ missing)
        more[k] = excess
        clear[k] = _normal((excess - holds[k]) / math.sqrt(off))[0] if off > 0.0 else float(holds[k] <= 0.0)
    return Walk(covariance, more, clear)
