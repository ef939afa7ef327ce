"""Two gases that mix: the mutual diffusion coefficient, the decay of their difference, and the entropy of mixing."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray
from atmosbox.theory.unlike_gases import diffusivity_factor

__all__ = [
    "diffusivity_error",
    "mixed_share",
    "mixed_share_scatter",
    "mixing_decay_rate",
    "mixing_entropy",
    "mutual_diffusivity",
]

_MODES = 400
_TRACE = 1e-6


def mutual_diffusivity(
    number_density: float, diameter: float, mass: tuple[float, float], kT: float, *, contact: float = 1.0
) -> float:
    r"""Return the mutual diffusion coefficient of two gases of hard spheres of one diameter [length^2/time].

    .. math:: D = \frac{3}{8 n \sigma^2 g} \sqrt{\frac{kT}{2 \pi \mu}}\, f, \qquad \mu = \frac{m_1 m_2}{m_1 + m_2}

    with the whole series of Chapman and Enskog for f, `diffusivity_factor`, and Enskog's contact value g for spheres
    with excluded volume (Chapman and Cowling 1970, The Mathematical Theory of Non-uniform Gases). For molecules that
    differ only by a label it is the coefficient of self-diffusion.

    Parameters
    ----------
    number_density, diameter
        Number density of both gases together, half of each [1/length^3], and diameter of all molecules [length].
    mass, kT
        Mass of a molecule of each gas [mass], and temperature [energy].
    contact
        Contact value g; 1 for a thin gas.

    Examples
    --------
    >>> round(mutual_diffusivity(1.0, 1.0, (1.0, 1.0), 1.0), 5)
    0.21558
    """
    first, second = mass
    reduced = first * second / (first + second)
    thin = 0.375 / (number_density * diameter**2) * math.sqrt(kT / (2.0 * math.pi * reduced))
    return thin / contact * diffusivity_factor(mass)


def diffusivity_error(mass: tuple[float, float]) -> float:
    """Return the relative error of `mutual_diffusivity` where the gases are not half and half.

    The coefficient of unlike gases changes with the composition, from a trace of the one to a trace of the other. In a
    box with one gas on each side it is larger on one side and smaller on the other; the two cancel except for this
    error.

    Parameters
    ----------
    mass
        Mass of a molecule of each gas [mass].

    Examples
    --------
    >>> diffusivity_error((1.0, 1.0)), round(diffusivity_error((1.0, 10.0)), 3)
    (0.0, 0.008)
    """
    if mass[0] == mass[1]:
        return 0.0
    traces = 0.5 * sum(diffusivity_factor(mass, share) for share in (_TRACE, 1.0 - _TRACE))
    return abs(traces / diffusivity_factor(mass) - 1.0)


def mixing_decay_rate(diffusivity: float, length: float) -> float:
    r"""Return the rate at which the slowest mode between two walls decays, :math:`D (\pi / L)^2` [1/time].

    Parameters
    ----------
    diffusivity
        The mutual diffusion coefficient [length^2/time].
    length
        Distance between the walls that the centres of molecules can reach [length].

    Examples
    --------
    >>> round(mixing_decay_rate(1.0, math.pi), 12)
    1.0
    """
    return diffusivity * (math.pi / length) ** 2


def mixed_share(edges: ArrayLike, passed: ArrayLike) -> FloatArray:
    r"""Return the share of the gas that began in the left half, as a mean over each bin, (time, bin) or (bin,).

    .. math:: c(x, t) = \frac12 + \sum_{j\ \mathrm{odd}} \frac{2}{j \pi} \sin\frac{j \pi}{2}
              \cos\frac{j \pi x}{L}\, e^{-j^2 \Gamma t}

    Parameters
    ----------
    edges : (bin + 1,)
        Bounds of the bins, in lengths of the box.
    passed : (time,) or float
        Time times the decay rate of the slowest mode.

    Examples
    --------
    >>> mixed_share([0.0, 0.5, 1.0], 0.0).round(3).tolist(), mixed_share([0.0, 0.5, 1.0], 99.0).tolist()
    ([1.0, 0.0], [0.5, 0.5])
    """
    bounds = np.asarray(edges, np.float64)
    time = np.atleast_1d(np.asarray(passed, np.float64))
    odd = np.arange(1, 2 * _MODES, 2, dtype=np.float64)
    height = 2.0 / (odd * math.pi) * np.sin(0.5 * odd * math.pi)
    waves = np.diff(np.sin(math.pi * odd[:, None] * bounds), axis=1) / (math.pi * odd[:, None] * np.diff(bounds))
    share = 0.5 + (np.exp(-np.outer(time, odd**2)) * height) @ waves
    return np.asarray(np.clip(share if np.ndim(passed) else share[0], 0.0, 1.0))


def mixed_share_scatter(bins: int, passed: float) -> FloatArray:
    r"""Return the variance of the share in a bin over that of independent draws, (bin,).

    For n molecules drawn at random a share c would have the variance :math:`c (1 - c) / n`. Three effects change it.
    The number of molecules of each gas is exactly half. The molecules of one bin come from the same region, and two
    molecules that are now near each other cannot have come from the same place. And sound moves both gases together to
    and fro, which shifts the whole profile. With the diffusion equation driven by noise, along the molecules counted
    from the left, :math:`\partial_t c = D c'' + \nabla \cdot \sqrt{2 D c (1 - c) / n}\, \xi`,

    .. math:: N\, \overline{\delta c^2} = \overline{c (1 - c)}\, b + \overline{c' c' K}
              - 2 D \int_0^t \int c'^2(z, s)\, G_b^2(z, t - s)\, dz\, ds

    in one of b bins; :math:`K = \min(z, z') - z z'` is the covariance of the number of molecules up to z, and G the
    distribution of a molecule that started at z.

    Parameters
    ----------
    bins, passed
        Number of equal parts of the box, and time times the decay rate of the slowest mode.

    Examples
    --------
    The shift of the profile adds scatter in the middle; in mixed gases the fixed numbers reduce it by one twentieth:

    >>> mixed_share_scatter(20, 0.1)[[0, 9]].round(2).tolist(), mixed_share_scatter(20, 9.0)[[0, 9]].round(2).tolist()
    ([1.0, 1.18], [0.95, 0.95])
    """
    inside = 40
    z = (np.arange(inside * bins) + 0.5) / (inside * bins)
    wave = np.arange(1, 3 * bins)
    edges = np.sin(math.pi * np.outer(np.arange(bins + 1) / bins, wave)) * bins / (math.pi * wave)
    held, cosines = np.diff(edges, axis=0), np.cos(math.pi * np.outer(wave, z))
    images = np.arange(-6, 7)
    apart, sign = z[:, None] - 0.5 - images, np.where(images % 2 == 0, -1.0, 1.0)

    def steepness(time: float) -> FloatArray:
        width = 2.0 * time / math.pi**2
        return np.asarray((np.exp(-0.5 * apart**2 / width) / math.sqrt(2.0 * math.pi * width)) @ sign)

    nodes, weights = np.polynomial.legendre.leggauss(40)
    lost = np.zeros(bins)
    for u, weight in zip(0.5 * (nodes + 1.0), 0.5 * weights, strict=True):
        time, step = passed * u * u * (3.0 - 2.0 * u), passed * 6.0 * u * (1.0 - u) * weight  # both ends are steep
        spread = 1.0 + 2.0 * (held * np.exp(-(wave**2) * (passed - time))) @ cosines
        lost += 2.0 / math.pi**2 * step * (spread**2 @ steepness(time) ** 2) / z.size
    share = mixed_share(np.linspace(0.0, 1.0, z.size + 1), passed).reshape(bins, inside)
    slope = steepness(passed).reshape(bins, inside)
    inner = z.reshape(bins, inside)
    walk = np.minimum(inner[:, :, None], inner[:, None, :]) - inner[:, :, None] * inner[:, None, :]
    shifted = np.einsum("bi,bj,bij->b", slope, slope, walk) / inside**2
    mean = share.mean(axis=1)
    alone = mean * (1.0 - mean) * bins
    found = (share * (1.0 - share)).mean(axis=1) * bins + shifted - lost
    return np.asarray(np.where(alone > 1e-9, found / np.maximum(alone, 1e-9), 1.0))


def mixing_entropy(share: ArrayLike) -> FloatArray:
    r"""Return the entropy of mixing per molecule, in units of k: the mean of :math:`-c \ln c - (1-c) \ln (1-c)`.

    Parameters
    ----------
    share : (..., bin)
        Share of one gas in bins that hold equally many molecules.

    Examples
    --------
    Two mixed gases, half of each, have ln 2:

    >>> round(float(mixing_entropy([0.5, 0.5])), 4), float(mixing_entropy([1.0, 0.0]))
    (0.6931, 0.0)
    """
    c = np.asarray(share, np.float64)
    both = np.stack([c, 1.0 - c])
    parts = np.where(both > 0.0, -both * np.log(np.where(both > 0.0, both, 1.0)), 0.0)
    return np.asarray(parts.sum(axis=0).mean(axis=-1))
