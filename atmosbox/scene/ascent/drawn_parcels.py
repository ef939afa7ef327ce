r"""How far a parcel is expected to be from its adiabat, on average and by chance: a thousand parcels drawn at random.

The model differs from a cloud of kilometres: the ascent takes nanoseconds, and a cloud consists of few molecules. Both
make errors of known size. Each parcel drawn follows the equations below, and is measured as the parcel of molecules is:
the mean of all is the theory, their scatter is the standard error. (A single run cannot tell its error: an entropy that
it has gained by chance stays to the end.) Rates are per mean free time at the start; the entropy S is that of the whole
parcel, in k; e is the rate of expansion.

**Vapour and heat** on their way to the liquid: the deviation x of `near_equilibrium` relaxes as :math:`\dot x = -L G x`
plus noise, towards :math:`-(L G)^{-1} \dot x_0`, with the rate :math:`\dot x_0` at which the cloud grows in theory.

**Entropy.** An infinitely slow parcel keeps S. Three processes change it.

* **Friction**: :math:`D e^2 \tau N`, with D as in `atmosbox.theory.DISSIPATION`. A molecule carries momentum of the
  flow until it collides or, sooner, hits a droplet.
* **Condensation**: the fluxes :math:`\dot x_0` need the forces :math:`L^{-1} \dot x_0`, and produce the entropy
  :math:`\dot x_0^T L^{-1} \dot x_0`.
* **Droplets** flow with the air, :math:`v_z = e z`, and molecules that hit them push them up and down. The mean work of
  these pushes is zero; its mean square per hit is :math:`\tfrac89 m e^2 h^2 / kT`, that is :math:`e^2 \langle z^2
  \rangle = e^2 h^2 / 3` times the mean square :math:`\tfrac83 m kT` of a push. This is the largest source of scatter:
  by itself it leaves the air at 300 hPa two or three tenths of a kelvin warmer or colder.

By the fluctuation-dissipation theorem the variance of S grows at twice the rate at which friction and condensation
produce S, and by the pushes.

**Rain.** Of the liquid that the cloud holds at a moment, with its fluctuation, the surplus falls out molecule by
molecule, and what has fallen does not come back. The cloud also lacks each molecule that warming turns into vapour,
:math:`v_S = v (1 + v/N) \lambda / C_p` for a unit of entropy. Water R that is missing would have changed its entropy
with the temperature, :math:`dS = c_l R \, d \ln T`.

**Temperature.** At a given pressure a cloud is warmer by :math:`T S / C_p`, whatever has rained. Where the cloud has
evaporated, a molecule that is missing needed no latent heat: the air is warmer by :math:`T \, [S + (\lambda - \ln f) R]
/ C_p`, with the relative humidity f and the heat capacity of clear air.

Left out is what is small compared with the scatter of a run: the energy of the flow (0.005 K in the scene lifting-moist
as it comes); the work that the piston extracts from fluctuations as it gives way to them (0.01 K, 0.14 K with 2000
molecules); and with the engine ``exact`` the volume of the molecules (0.09 K at 300 hPa).
"""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.ascent.near_equilibrium import Cloud
from atmosbox.scene.ascent.way import MoistAscent

Array = NDArray[np.float64]
NUMBER = 1000
"""Number of parcels drawn: their scatter is known to 2 %."""
_SEED = 20
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
    condensing = np.einsum("ti,tij,tj->t", cloud.change, np.linalg.inv(cloud.yields), cloud.change)
    pushes = 8.0 / 9.0 * (e * cloud.height) ** 2 * cloud.hits
    return Gain(friction, condensing, 2.0 * (friction + condensing) + pushes)


def gathered(rate: Array, moment: Array) -> Array:
    """Return the integral of a rate up to each moment, from the start at zero."""
    steps = np.diff(moment, prepend=0.0)
    return np.cumsum(steps * 0.5 * (rate + np.concatenate([rate[:1], rate[:-1]])))


def drift(cloud: Cloud) -> Array:
    """Return how much warmer a parcel is than its adiabat on average if it does not rain, as a share of T."""
    gain = entropy_gain(cloud)
    entropy = gathered(gain.friction + gain.condensing, cloud.moment)
    heat = np.where(cloud.liquid > 0.0, cloud.cloudy_heat, cloud.clear_heat)
    return np.asarray(entropy / heat + cloud.clusters() - np.einsum("ti,ti->t", cloud.seen(), cloud.behind))


class Parcels(NamedTuple):
    """Differences of parcels from that of theory: means of frames, (parcel, frame)."""

    warmth: Array
    """Difference of the temperature, as a share of it."""
    density_warmth: Array
    """The same of the density temperature, which depends on vapour and liquid, too."""
    vapour: Array
    """Molecules of vapour."""
    rain: Array
    """Molecules that have rained."""
    theory: Array
    """Molecules of vapour in theory's parcel, (frame,)."""


def draw(ascent: MoistAscent, pressure: Array, frames: int, samples: int, *, ideal: bool) -> Parcels:
    """Return parcels at pressures of the environment in the middle of each recorded frame : (frame,) [Pa]."""
    return _draw(ascent, tuple(pressure.tolist()), frames, samples, ideal)


def along_frames(ascent: MoistAscent, pressure: Array, frames: int, samples: int, *, ideal: bool) -> Cloud:
    """Return theory's parcel at each sample of the frames that have been recorded; see `draw`."""
    logs = np.log(pressure)
    middle = (np.arange(len(logs)) + 0.5) / frames
    last = 1.5 * logs[-1] - 0.5 * logs[-2] if len(logs) > 1 else logs[-1]
    where = np.concatenate([[0.0], middle, [len(logs) / frames]])
    share = np.arange(1, len(logs) * samples + 1) / (frames * samples)
    met = np.interp(share, where, np.concatenate([[np.log(ascent.pressure)], logs, [last]]))
    return Cloud(ascent, np.exp(met), share, ideal=ideal)


@functools.lru_cache(maxsize=2)
def _draw(ascent: MoistAscent, pressure: tuple[float, ...], frames: int, samples: int, ideal: bool) -> Parcels:
    """Return the parcels of `draw`, which instruments and headlines of a run both need."""
    cloud = along_frames(ascent, np.array(pressure), frames, samples, ideal=ideal)
    x, entropy, rain = walk(cloud)
    # vapour that clear air lacks for saturation: air cools while that vapour evaporates into it
    lacks = cloud.vapour * (1.0 / cloud.humidity - 1.0) * cloud.clear_heat / cloud.cloudy_heat
    wet = rain + cloud.dries * entropy <= cloud.liquid - lacks if cloud.rains else cloud.liquid > 0.0
    x = x - cloud.behind
    behind_it = cloud.latent - np.log(cloud.humidity)
    warmth = np.where(wet, entropy / cloud.cloudy_heat, (entropy + behind_it * rain) / cloud.clear_heat)
    # at a higher temperature more water is vapour, and water that has rained has no weight in the parcel
    carried = law.WATER_MASS_RATIO / (cloud.air + law.WATER_MASS_RATIO * (cloud.vapour + cloud.liquid))
    dries = np.where(wet, cloud.dries * entropy, -rain)
    # deviation from theory's vapour at the pressure that the gas then has
    gone = np.array([1.0, 0.0])
    vapour = -gone - cloud.vapour_slope[:, None] * (cloud.warms - gone / cloud.gas[:, None])

    def of_frames(values: Array) -> Array:
        return np.asarray(values.reshape(-1, len(pressure), samples).mean(axis=2))

    def seen(weight: Array) -> Array:
        return np.asarray(np.einsum("pti,ti->pt", x, weight))

    return Parcels(
        of_frames(warmth + cloud.clusters() + seen(cloud.seen())),
        of_frames(
            warmth + dries / cloud.gas + carried * rain + cloud.clusters(density=True) + seen(cloud.seen(density=True))
        ),
        of_frames(dries - cloud.clustered + seen(vapour)),
        of_frames(rain),
        of_frames(cloud.vapour)[0],
    )


def walk(cloud: Cloud) -> tuple[Array, Array, Array]:
    """Return the fluctuation x, the entropy and the rain of parcels, beyond theory's: (parcel, moment, 2 or nothing).

    The noise is made free of a mean, so that the means of parcels are exact where the equations are linear.
    """
    steps = np.diff(cloud.moment, prepend=0.0)
    gain = entropy_gain(cloud)
    gains = np.diff(gathered(gain.friction + gain.condensing, cloud.moment), prepend=0.0)
    scatters = np.sqrt(np.diff(gathered(gain.variance, cloud.moment), prepend=0.0))
    warms = law.LIQUID_HEAT_CAPACITY * np.diff(np.log(cloud.temperature), prepend=np.log(cloud.temperature[0]))
    # y = x in units in which its variance is one
    root = np.linalg.cholesky(cloud.resists)
    rate, mode = np.linalg.eigh(np.einsum("tji,tjk,tkl->til", root, cloud.yields, root))
    keeps = np.exp(-rate * steps[:, None])
    keep, stir = (np.einsum("tik,tk,tjk->tij", mode, each, mode) for each in (keeps, np.sqrt(1.0 - keeps**2)))
    out = np.linalg.inv(root)
    falls = -np.expm1(-cloud.rains * steps)
    surplus = cloud.liquid - cloud.keeps
    expected = np.diff(cloud.rained, prepend=0.0)
    rng = np.random.default_rng(_SEED)
    noise = rng.standard_normal((3, len(steps) + 1, NUMBER))
    noise -= noise.mean(axis=2, keepdims=True)
    y, entropy, rain = noise[:2, -1].T, np.zeros(NUMBER), np.zeros(NUMBER)
    found = np.empty((4, len(steps), NUMBER))
    for k in range(len(steps)):
        y = y @ keep[k] + noise[:2, k].T @ stir[k]
        x = y @ out[k]
        entropy = entropy + gains[k] + scatters[k] * noise[2, k] + warms[k] * rain
        if cloud.rains:
            held = surplus[k] + expected[k] - rain - cloud.dries[k] * entropy + x[:, 0]
            rain = rain + rng.poisson(falls[k] * np.maximum(held, 0.0)) - expected[k]
        found[:, k] = *x.T, entropy, rain
    found = found.swapaxes(1, 2)
    return np.moveaxis(found[:2], 0, 2), found[2], found[3]


@functools.lru_cache(maxsize=8)
def planned_cloud(ascent: MoistAscent, *, ideal: bool = False) -> Cloud:
    """Return theory's parcel along the planned ascent."""
    shares, path = ascent.planned
    return Cloud(ascent, np.array(ascent.route), shares, ideal=ideal, path=path)


def least_cloud(ascent: MoistAscent) -> float:
    """Return how much liquid a cloud must hold before it rains, so that fluctuations alone make no rain [kg kg-1].

    This is three standard deviations of the liquid: what a cluster loses as rain does not come back.
    """
    if not ascent.vapour:
        return 0.0
    cloud = planned_cloud(ascent)
    scatter = cloud.liquid_scatter[int(np.argmin(cloud.pressure))]
    return float(law.WATER_MASS_RATIO * 3.0 * scatter / cloud.air)


def comparable(ascent: MoistAscent) -> bool:
    """Tell whether theory can predict how much it rains: not if fluctuations alone make rain."""
    return not ascent.rains or ascent.most_liquid >= least_cloud(ascent)
