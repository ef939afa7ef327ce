r"""Entropy and rain that a parcel gains by chance on its ascent, and how more or less rain changes its temperature.

**Entropy.** An infinitely slow parcel keeps its entropy S. Three processes change S; rates are per mean free time at
the start, S is that of the whole parcel, in k, and e is the rate of expansion.

* **Friction**: :math:`D e^2 \tau N`, with D as in `atmosbox.theory.DISSIPATION`. A molecule carries momentum of the
  flow until it collides or, sooner, hits a droplet.
* **Condensation**: the fluxes :math:`\dot x` of molecules and heat into the liquid need forces :math:`L^{-1} \dot x`,
  and produce the entropy :math:`\dot x^T L^{-1} \dot x`.
* **Droplets** flow with the air, :math:`v_z = e z`, and molecules that hit them push them up and down. The mean work of
  these pushes is zero; its mean square per hit is :math:`\tfrac89 m e^2 h^2 / kT`, that is :math:`e^2 \langle z^2
  \rangle = e^2 h^2 / 3` times the mean square :math:`\tfrac83 m kT` of a push. This is the largest source of scatter:
  by itself it leaves the air at 300 hPa two or three tenths of a kelvin warmer or colder.

By the fluctuation-dissipation theorem friction and condensation make the variance of S grow at twice the rate at which
they produce S.

**Rain.** A cloud of few molecules fluctuates about its equilibrium; its surplus falls out molecule by molecule, and
what has fallen does not come back. Two numbers describe the result: R, the number of molecules that have rained in
excess of the average, and S, the excess of entropy of the parcel, in k, over theory's parcel at the same temperature
with as much water.

**How they grow.** On average the cloud holds m molecules more than it can keep; at a given moment it holds
:math:`m + x` more, where x has the standard deviation s (`near_equilibrium`). The cloud lacks each molecule that has
fallen, and also each molecule that warming turns into vapour, :math:`v_S = v (1 + v/N) \lambda / C_p` for a unit of
entropy. With the rate r and :math:`a = m/s`,

.. math:: dR = -r \, \Phi(a) \, (R + v_S S) \, dt + dW, \qquad
   \frac{d \langle W^2 \rangle}{dt} = r \langle (m + x)_+ \rangle
   + 2 r^2 \int_0^\infty \mathrm{cov}\big[(m + x)_+, (m + x_t)_+\big] \, dt .

Here :math:`\Phi(a)` is the share of the time in which there is a surplus, the mean surplus is :math:`\langle (m + x)_+
\rangle = m \Phi(a) + s \varphi(a)`, it rains one molecule after the other, and x has the correlation time :math:`\tau`.
In Hermite polynomials the integral is :math:`s^2 \tau [\Phi^2 + \varphi^2 \sum_{k \geq 2} He_{k-2}^2(a) / k \, k!]`,
with :math:`s^2 \tau = (G^{-1} L^{-1} G^{-1})_{nn}`. So R is zero before it rains, follows the surplus while it rains,
and keeps its value afterwards. The entropy does the random walk described above; in addition, water that is missing
would have changed its entropy with the temperature, :math:`dS = c_l R \, d \ln T`.

**How they change the temperature.** At a given pressure a cloud is warmer by :math:`T S / C_p`, whatever has rained.
Where the cloud has evaporated, a molecule that is missing needed no latent heat: the air is warmer by :math:`T \, [S +
(\lambda - \ln f) R] / C_p`, with the relative humidity f and the heat capacity of clear air. Where the amount of rain
decides whether there is still a cloud, both expressions count, each with its probability.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.ascent.near_equilibrium import Cloud

Array = NDArray[np.float64]
_SHEAR = 4.0 / 3.0 * 1.016 * 1.25
"""Share of shear in `law.DISSIPATION`; three quarters of it is the relaxation time of a shear in mean free times."""
_ROTATION = 8.0 / 25.0
"""Share in `law.DISSIPATION` of the rotation, which lags behind the other motion by 2 mean free times."""
_FAST_MEET = 1.6
"""How much sooner than average the molecules that carry a shear, weighted by v^2, hit a droplet: <v^5> / <v^4> <v>."""


class Gain(NamedTuple):
    """Rates per mean free time at the start, (moment,)."""

    friction: Array
    condensing: Array
    variance: Array
    """Rate at which the variance of the entropy grows."""


def entropy_gain(cloud: Cloud) -> Gain:
    """Return the rates at which a parcel gains entropy, see the head of this file."""
    number, e = cloud.gas, cloud.expansion
    often = cloud.free_time / cloud.meets
    shear = _SHEAR / (1.0 + 0.75 * _SHEAR * _FAST_MEET * often)
    friction = (shear + _ROTATION / (1.0 + 2.0 * often)) * e * e * cloud.free_time * number
    change = cloud.change
    condensing = np.einsum("ti,tij,tj->t", change, np.linalg.inv(cloud.yields), change)
    pushes = 8.0 / 9.0 * (e * cloud.height) ** 2 * cloud.hits
    return Gain(friction, condensing, 2.0 * (friction + condensing) + pushes)


def gathered(rate: Array, moment: Array) -> Array:
    """Return the integral of a rate up to each moment, from the start at zero.

    Parameters
    ----------
    rate, moment : (moment,)
        The rate, and the moments at which it is known, with the unit of time of the rate.

    Examples
    --------
    >>> gathered(np.array([2.0, 2.0, 4.0]), np.array([1.0, 2.0, 3.0]))
    array([2., 4., 7.])
    """
    steps = np.diff(moment, prepend=0.0)
    return np.cumsum(steps * 0.5 * (rate + np.concatenate([rate[:1], rate[:-1]])))


_TERMS = 12
"""Order at which the sum over Hermite polynomials ends: the twelfth term adds a millionth."""
_FAR = 30.0


class Walk(NamedTuple):
    """Fluctuations of entropy and rain that have accumulated along the ascent."""

    covariance: Array
    """Covariance of S and R, (moment, 2, moment, 2)."""
    more: Array
    """Mean number of molecules that have rained in addition because the cloud fluctuates, (moment,)."""
    clear: Array
    """Probability that there is no cloud, (moment,)."""

    def shown(self, gain: Array) -> Array:
        """Return the covariance between moments of the sum of S and R, each times its ``gain``, (moment, 2)."""
        return np.asarray(np.einsum("ti,tiuj,uj->tu", gain, self.covariance, gain, optimize=True))


def _normal(a: float) -> tuple[float, float]:
    """Return the probability of a standard normal variable to be below a, and its density at a.

    Examples
    --------
    >>> [round(each, 3) for each in _normal(1.0)]
    [0.841, 0.242]
    """
    return 0.5 * math.erfc(-a / math.sqrt(2.0)), math.exp(-0.5 * a * a) / math.sqrt(2.0 * math.pi)


def _remembered(a: float) -> float:
    r"""Return :math:`\int \mathrm{cov}[(a + z)_+, (a + z_t)_+] \, dt` for a z whose correlation is :math:`e^{-t}`.

    Examples
    --------
    Far above zero it equals the integral for z itself, which is one:

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
    """Return the fluctuations that a parcel has accumulated along its ascent, see the head of this file.

    Examples
    --------
    Without rain there is only the entropy, and it keeps what it has gained:

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
    # vapour that clear air lacks for saturation: air cools while that vapour evaporates into it
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
        # within a step R and its mean relax exponentially towards their steady values
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
