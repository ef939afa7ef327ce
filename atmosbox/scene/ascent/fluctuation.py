r"""How far fluctuations take a parcel from its adiabat, and for how long: the covariance of its frames.

A single run cannot tell this: a random gain of entropy stays to the end, so that neighbouring frames deviate to the
same side. Three parts follow from the molecules.

* **Vapour and heat** that have not yet reached the liquid, or have not yet left it: `near_equilibrium` gives the
  scatter of x and how fast x relaxes, :math:`C(t) = e^{-L G t} G^{-1}`. This part decays within a frame or two.
* **Entropy** that has been gained at random: `random_walk` gives the growth of its variance. At a given pressure it
  shows in the temperature as :math:`\delta T = T \, \delta S / C_p`, where C_p includes the heat of condensation.
* **Rain**, if it rains: rain that has fallen by chance does not evaporate again, see `random_walk`.
"""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.ascent.near_equilibrium import Cloud, cloud_along
from atmosbox.scene.ascent.random_walk import gathered, walk
from atmosbox.scene.ascent.way import MoistAscent

Array = NDArray[np.float64]


def along_frames(ascent: MoistAscent, pressure: Array, frames: int, samples: int, *, ideal: bool) -> Cloud:
    """Return the parcel at each sample of the frames that have been recorded.

    Parameters
    ----------
    ascent
        The ascent.
    pressure : (frame,)
        Pressure of the environment in the middle of each frame [Pa].
    frames, samples
        Number of frames of the whole ascent, and number of samples in each.
    ideal
        Whether molecules have no volume.
    """
    return _along_frames(ascent, tuple(pressure.tolist()), frames, samples, ideal)


@functools.lru_cache(maxsize=2)
def _along_frames(ascent: MoistAscent, pressure: tuple[float, ...], frames: int, samples: int, ideal: bool) -> Cloud:
    """Return the parcel of `along_frames`, which instruments and headlines of a run both need."""
    logs = np.log(pressure)
    middle = (np.arange(len(logs)) + 0.5) / frames
    last = 1.5 * logs[-1] - 0.5 * logs[-2] if len(logs) > 1 else logs[-1]
    where = np.concatenate([[0.0], middle, [len(logs) / frames]])
    share = np.arange(1, len(logs) * samples + 1) / (frames * samples)
    return cloud_along(
        ascent,
        np.exp(np.interp(share, where, np.concatenate([[np.log(ascent.pressure)], logs, [last]]))),
        share,
        ideal=ideal,
    )


def _of_means(covariance: Array, samples: int) -> Array:
    """Return the covariance of the means over ``samples`` neighbours."""
    frames = len(covariance) // samples
    return np.asarray(covariance.reshape(frames, samples, frames, samples).mean(axis=(1, 3)))


def _covariance(cloud: Cloud, seen: Array, cloudy: Array, clear: Array, samples: int) -> Array:
    """Return the covariance of frame means: of x with the weights ``seen``, and of S and R in cloud and clear air."""
    root = np.linalg.cholesky(cloud.resists)
    rate, mode = np.linalg.eigh(np.einsum("tji,tjk,tkl->til", root, cloud.yields, root))
    size = np.einsum("tji,tj->ti", mode, np.linalg.solve(root, seen[:, :, None])[:, :, 0])
    walked = walk(cloud)
    found = walked.shown(cloudy + walked.clear[:, None] * (clear - cloudy))
    for k in range(2):
        age = gathered(rate[:, k], cloud.moment)
        amplitude = np.abs(size[:, k])
        found += np.outer(amplitude, amplitude) * np.exp(-np.abs(age[:, None] - age))
    return _of_means(found, samples)


def temperature_covariance(cloud: Cloud, samples: int, *, density: bool = False) -> Array:
    """Return the covariance of the frame means of parcel minus adiabat, as shares of the temperature.

    Parameters
    ----------
    cloud
        The parcel at each sample.
    samples
        Number of samples in a frame.
    density
        Whether to take the density temperature, which depends on vapour and liquid, too.

    Returns
    -------
    (frame, frame) ndarray
    """
    none = np.zeros_like(cloud.moment)
    cloudy = np.stack([1.0 / cloud.cloudy_heat, none], axis=1)
    clear = np.stack([1.0 / cloud.clear_heat, (cloud.latent - np.log(cloud.humidity)) / cloud.clear_heat], axis=1)
    if density:  # at a higher temperature more water is vapour, and water that has rained has no weight in the parcel
        carried = law.WATER_MASS_RATIO / (cloud.air + law.WATER_MASS_RATIO * (cloud.vapour + cloud.liquid))
        cloudy += np.stack([cloud.dries / cloud.gas, carried], axis=1)
        clear[:, 1] += carried - 1.0 / cloud.gas
    return _covariance(cloud, cloud.seen(density=density), cloudy, clear, samples)


def vapour_covariance(cloud: Cloud, samples: int) -> Array:
    """Return the covariance of the frame means of the number of molecules of vapour, (frame, frame).

    Parameters
    ----------
    cloud
        The parcel at each sample.
    samples
        Number of samples in a frame.
    """
    none = np.zeros_like(cloud.moment)
    gone = np.zeros((len(none), 2))
    gone[:, 0] = -1.0
    # deviation from theory's vapour at the pressure that the gas then has
    pressure = cloud.warms - np.array([1.0, 0.0]) / cloud.gas[:, None]
    seen = gone - cloud.vapour_slope[:, None] * pressure
    return _covariance(
        cloud, seen, np.stack([cloud.dries, none], axis=1), np.stack([none, none - 1.0], axis=1), samples
    )
