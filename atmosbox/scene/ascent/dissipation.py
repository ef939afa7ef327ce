r"""Entropy that a parcel gains because its ascent is not infinitely slow, and how far the gain scatters.

An infinitely slow parcel keeps its entropy S. Three processes change S; rates are per mean free time at the start, S is
that of the whole parcel, in k, and e is the rate of expansion.

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
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.scene.ascent.near_equilibrium import Cloud

__all__ = ["Gain", "entropy_gain", "gathered"]

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
