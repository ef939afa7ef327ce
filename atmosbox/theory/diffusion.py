"""Two gases that mix: the mutual diffusion coefficient, how their difference decays, and the entropy that it makes."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray

__all__ = [
    "diffusivity_error",
    "mixed_share",
    "mixing_decay_rate",
    "mixing_entropy",
    "mutual_diffusivity",
]

_ALIKE = 1.018954  # D of one kind of molecules over the first approximation, to all orders
_MODES = 400


def mutual_diffusivity(
    number_density: float, diameter: float, mass: tuple[float, float], kT: float, *, contact: float = 1.0
) -> float:
    r"""Return the mutual diffusion coefficient of two gases of equally large hard spheres, half of each.

    .. math:: D = \frac{3}{8 n \sigma^2 g} \sqrt{\frac{kT}{2 \pi \mu}}\, f, \qquad \mu = \frac{m_1 m_2}{m_1 + m_2}

    with the second approximation of Chapman and Enskog for f [1]_, and Enskog's contact value g for spheres that
    exclude volume. Of molecules that differ by a label alone it is self-diffusion, where f is known to all orders,
    1.018954 [2]_.

    Parameters
    ----------
    number_density
        Of both gases together [1/length^3].
    diameter
        Of all molecules [length].
    mass
        Of a molecule of each gas [mass].
    kT
        Temperature [energy].
    contact
        The contact value g; 1 for a thin gas.

    Returns
    -------
    float
        The coefficient [length^2/time].

    References
    ----------
    .. [1] Marrero, T. R., Mason, E. A. (1972), doi:10.1063/1.3253094, for rigid spheres.
    .. [2] Chapman, S., Cowling, T. G. (1970), The Mathematical Theory of Non-uniform Gases.

    Examples
    --------
    >>> round(mutual_diffusivity(1.0, 1.0, (1.0, 1.0), 1.0), 6)
    0.215581
    """
    first, second = mass
    reduced = first * second / (first + second)
    factor = _ALIKE if first == second else _second_approximation(first, second)
    return 0.375 / (number_density * diameter**2 * contact) * math.sqrt(kT / (2.0 * math.pi * reduced)) * factor


def diffusivity_error(mass: tuple[float, float]) -> float:
    """Return by what share `mutual_diffusivity` may be off, for it ends with the second approximation.

    All that would follow adds less than the second adds to the first. Of molecules alike it is known to all orders.

    Examples
    --------
    >>> diffusivity_error((1.0, 1.0)), round(diffusivity_error((1.0, 10.0)), 3)
    (0.0, 0.053)

    Of masses that are almost alike the second approximation is 59/58 of the first:

    >>> round(diffusivity_error((1.0, 1.0 + 1e-9)) * 58.0, 6)
    1.0
    """
    return 0.0 if mass[0] == mass[1] else _second_approximation(*mass) - 1.0


def _second_approximation(first: float, second: float) -> float:
    """Return D over its first approximation, for half of each gas and spheres of one size."""
    total = first + second

    def own(one: float, other: float) -> tuple[float, float]:
        wide = math.sqrt(2.0 * other / total)
        numerator = 2.0 * one**2 / (other * total) * wide
        return numerator, 2.0 / (other * total) * wide * (1.3 * one**2 + 3.0 * other**2 + 1.6 * one * other)

    unlike, product = ((first - second) / total) ** 2, 4.0 * first * second / total**2
    (p1, q1), (p2, q2) = own(first, second), own(second, first)
    p12 = 15.0 * unlike + 2.0 * product
    q12 = 13.0 * unlike + 8.6 * product + 1.6 * total / math.sqrt(first * second)
    return 1.0 / (1.0 - 0.1 * (p1 + p2 + p12) / (q1 + q2 + q12))


def mixing_decay_rate(diffusivity: float, length: float) -> float:
    r"""Return how fast the slowest mode between two walls decays, :math:`D (\pi / L)^2` [1/time].

    Parameters
    ----------
    diffusivity
        The mutual diffusion coefficient [length^2/time].
    length
        Distance of the walls, as far as the centres of molecules reach [length].

    Examples
    --------
    >>> round(mixing_decay_rate(1.0, math.pi), 12)
    1.0
    """
    return diffusivity * (math.pi / length) ** 2


def mixed_share(edges: ArrayLike, passed: ArrayLike) -> FloatArray:
    r"""Return the share of the gas that began in the left half, as a mean over each bin.

    .. math:: c(x, t) = \frac12 + \sum_{j\ \mathrm{odd}} \frac{2}{j \pi} \sin\frac{j \pi}{2}
              \cos\frac{j \pi x}{L}\, e^{-j^2 \Gamma t}

    Parameters
    ----------
    edges : (bin + 1,)
        Bounds of the bins, in lengths of the box.
    passed : (time,) or float
        Time times the decay rate of the slowest mode.

    Returns
    -------
    array (time, bin) or (bin,)
        The share.

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


def mixing_entropy(share: ArrayLike) -> FloatArray:
    r"""Return the entropy of mixing per molecule, in units of k: the mean of :math:`-c \ln c - (1-c) \ln (1-c)`.

    Parameters
    ----------
    share : (..., bin)
        Share of one gas in bins that hold equally many molecules.

    Examples
    --------
    Two gases that are mixed, half of each, have ln 2:

    >>> round(float(mixing_entropy([0.5, 0.5])), 4), float(mixing_entropy([1.0, 0.0]))
    (0.6931, 0.0)
    """
    c = np.asarray(share, np.float64)
    both = np.stack([c, 1.0 - c])
    parts = np.where(both > 0.0, -both * np.log(np.where(both > 0.0, both, 1.0)), 0.0)
    return np.asarray(parts.sum(axis=0).mean(axis=-1))
