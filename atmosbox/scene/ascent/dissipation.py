r"""Entropy that a parcel gains on its way because it is not infinitely slow, and by how much chance changes it.

An infinitely slow parcel keeps its entropy S. Four things change it; rates are per mean free time at the start, S is
that of the whole parcel, over k, and e the rate of expansion.

* **Friction**: :math:`D e^2 \tau N`, with D as in `atmosbox.theory.DISSIPATION`. What a molecule carries of the flow it
  forgets at its contacts and, sooner, at the droplets.
* **Condensing**: the fluxes :math:`\dot x` of molecules and heat into the liquid need forces :math:`L^{-1} \dot x`, and
  make :math:`\dot x^T L^{-1} \dot x`.
* **The piston** gives way when the pressure happens to be high, within the time :math:`t_c` in which it closes a gap,
  and so takes work out of fluctuations that would have gone by themselves: :math:`-N \langle(\delta \ln p)^2\rangle /
  \gamma t_c`.
* **Droplets** flow with the air, :math:`v_z = e z`, and molecules that hit them push them up and down. The work of
  these pushes is zero on average; by chance it is :math:`\tfrac89 m e^2 h^2 / kT` in the square for each hit, that is
  :math:`e^2 \langle z^2 \rangle = e^2 h^2 / 3` times the mean square :math:`\tfrac83 m kT` of a push. This is the
  largest of all chances: it leaves the air at 300 hPa by itself two or three tenths of a kelvin warmer or colder.

By the theorem of fluctuation and dissipation the variance of S grows twice as fast as friction and condensing make S.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.ascent.near_equilibrium import Cloud
from atmosbox.scene.piston import CLOSING

__all__ = ["Gain", "entropy_gain", "gathered"]

Array = NDArray[np.float64]
_SHEAR = 4.0 / 3.0 * 1.016 * 1.25
"""Share of shear in `law.DISSIPATION`, and of it the time in which contacts take away a shear: three quarters."""
_ROTATION = 8.0 / 25.0
"""Share of the rotation that stays behind, which follows within 2 mean free times."""
_FAST_MEET = 1.6
"""How much sooner than the average the molecules that carry a shear, v^2, meet a droplet: <v^5> / <v^4> <v>."""


class Gain(NamedTuple):
    """Rates per mean free time at the start, (moment,)."""

    friction: Array
    condensing: Array
    piston: Array
    """Negative: what the piston takes away."""
    variance: Array
    """By how much the variance of the entropy grows."""


def entropy_gain(cloud: Cloud) -> Gain:
    """Return how fast a parcel gains entropy, see the head of this file."""
    number, e = cloud.gas, cloud.expansion
    often = cloud.free_time / cloud.meets
    shear = _SHEAR / (1.0 + 0.75 * _SHEAR * _FAST_MEET * often)
    friction = (shear + _ROTATION / (1.0 + 2.0 * often)) * e * e * cloud.free_time * number
    change = cloud.change
    condensing = np.einsum("ti,tij,tj->t", change, np.linalg.inv(cloud.yields), change)
    closing = float(law.adiabatic_index(5)) * CLOSING
    unsteady = cloud.pressure_scatter
    jolts = 8.0 / 9.0 * (e * e + unsteady / closing**2) * cloud.height**2 * cloud.hits
    return Gain(friction, condensing, -number * unsteady / closing, 2.0 * (friction + condensing) + jolts)


def gathered(rate: Array, moment: Array) -> Array:
    """Return the integral of a rate up to each moment, from the start at zero.

    Examples
    --------
    >>> gathered(np.array([2.0, 2.0, 4.0]), np.array([1.0, 2.0, 3.0]))
    array([2., 4., 7.])
    """
    steps = np.diff(moment, prepend=0.0)
    return np.cumsum(steps * 0.5 * (rate + np.concatenate([rate[:1], rate[:-1]])))
