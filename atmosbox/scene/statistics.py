"""Means with their standard errors."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray


class BlockAverage(NamedTuple):
    """A mean and its standard error."""

    mean: NDArray[np.float64]
    """Mean of the values."""
    standard_error: NDArray[np.float64]
    """Standard deviation that the mean would show if the run were repeated."""


def block_average(values: ArrayLike, blocks: int = 20, memory: float = 0.0) -> BlockAverage:
    r"""Return the mean of a series and its standard error, from the means of blocks.

    Values that follow each other closely in time are not independent, and an error bar that takes them as independent
    is too small. The means of blocks much longer than the correlation time of the gas, ten mean free times, are
    independent: the standard error is their standard deviation over the square root of their number. Where a
    correlation decays as :math:`e^{-t/\tau}`, the means of blocks of a length L not much longer than that scatter too
    little. The variance of a mean over a time t is :math:`f(t) / t`, :math:`f = 1 - (1 - e^{-t/\tau}) \tau / t`, and so
    the square of the error of n blocks is divided by :math:`[n f(L) / f(nL) - 1] / (n - 1)`.

    Parameters
    ----------
    values : (time, ...)
        Series along the first axis; further axes, such as layers, are kept.
    blocks
        Number of blocks [1].
    memory
        Correlation time :math:`\tau` in values, where theory gives it; 0 for independent blocks [1].

    Raises
    ------
    ValueError
        If there are fewer than 2 blocks, or fewer values than blocks.

    Notes
    -----
    If the values do not divide evenly the first few are left out. The standard error of n blocks is itself
    uncertain by :math:`1/\sqrt{2(n - 1)}`, 16 % for 20.

    References
    ----------
    .. [1] Flyvbjerg, H., Petersen, H. G. (1989), doi:10.1063/1.457480.

    Examples
    --------
    Of a hundred tosses of a coin, half are heads, give or take 5:

    >>> tosses = np.random.default_rng(1).integers(0, 2, size=100)
    >>> mean, error = block_average(tosses)
    >>> print(f"{mean:.2f} +- {error:.2f}")
    0.50 +- 0.05
    """
    series = _divisible(values, blocks)
    length = series.shape[0] // blocks
    means = series[-blocks * length :].reshape(blocks, length, *series.shape[1:]).mean(axis=1)
    error = means.std(axis=0, ddof=1) / np.sqrt(blocks)
    if memory > 0.0:
        # the blocks scatter about the mean of this run, not about the true mean
        lengths = length / memory * np.array([1.0, blocks])
        one, all_of_them = 1.0 + np.expm1(-lengths) / lengths
        # in a run much shorter than the correlation time the digits of this difference would cancel
        shown = (blocks * one / all_of_them - 1.0) / (blocks - 1.0) if lengths[1] > 1e-4 else lengths[0] / 3.0
        error = error / np.sqrt(shown)
    return BlockAverage(means.mean(axis=0), error)


def _divisible(values: ArrayLike, blocks: int) -> NDArray[np.float64]:
    """Return a series as an array, or raise ``ValueError`` unless it can be divided into ``blocks`` blocks."""
    series = np.asarray(values, dtype=np.float64)
    if blocks < 2:
        raise ValueError(f"blocks = {blocks} must be at least 2: the error is read from their scatter.")
    if series.ndim == 0 or series.shape[0] < blocks:
        found = series.shape[0] if series.ndim else 1
        raise ValueError(f"{found} values cannot be divided into {blocks} blocks.")
    return series


LONG = 5.0
"""Least length of a block in correlation times, where these are known."""
MOST_BLOCKS = 100


def overlapping_average(values: ArrayLike, blocks: int = 20, memory: float | None = None) -> BlockAverage:
    r"""Return the mean of a series and its standard error, from blocks of two lengths.

    The variance of the mean that blocks of a length L show is too small by a share that is proportional to 1/L [1]_.
    That of blocks of half the length is too small by twice as much, and so :math:`2 V(L) - V(L/2)` is free of that
    error. All overlapping blocks count, not only those that lie side by side.

    Parameters
    ----------
    values : (time, ...)
        Series along the first axis, at least twice as many values as blocks; further axes are kept.
    blocks
        Number of the longer blocks that fill the series [1].
    memory
        Correlation time in values, where theory gives it: then as many blocks are made as have five correlation times
        each, at most 100, if these are more than ``blocks``. With more blocks the error itself scatters less, and a
        correct run appears four standard errors off less often.

    Raises
    ------
    ValueError
        If there are fewer than 2 blocks, or fewer than twice as many values.

    Notes
    -----
    The error is itself uncertain by 20 % for 20 blocks. If the difference happens to be small, a quarter of V(L) is
    taken instead. With blocks of five correlation times or more the error is right within 2 %, with plain blocks within
    11 %.

    References
    ----------
    .. [1] Vats, D., Flegal, J. M. (2022), Lugsail lag windows, doi:10.1093/biomet/asab049.

    Examples
    --------
    A series in which each value is 0.9 of the one before plus noise has a mean that scatters by 10 / sqrt(n):

    >>> noise = np.random.default_rng(1).normal(size=4001)
    >>> series = [0.0]
    >>> for each in noise:
    ...     series.append(0.9 * series[-1] + each)
    >>> bool(0.7 < overlapping_average(series).standard_error * len(series) ** 0.5 / 10 < 1.3)
    True
    """
    series = _divisible(values, blocks)
    _divisible(values, 2 * blocks)
    n = series.shape[0]
    if memory is not None:
        blocks = max(blocks, min(MOST_BLOCKS, n // 2, int(n / max(LONG * memory, 1.0))))
    mean = series.mean(axis=0)
    sums = np.concatenate([np.zeros((1, *series.shape[1:])), np.cumsum(series - mean, axis=0)])

    def variance(length: int) -> NDArray[np.float64]:
        # variance of the mean of all values: blocks are weighted by length, corrected for each block's part in that
        # mean
        squares = np.sum((sums[length:] - sums[:-length]) ** 2, axis=0) / length
        return np.asarray(squares / ((n - length) * (n - length + 1)))

    half = n // (2 * blocks)
    whole = variance(2 * half)
    return BlockAverage(mean, np.sqrt(np.maximum(2.0 * whole - variance(half), 0.25 * whole)))


def average_beside(values: ArrayLike, slow: ArrayLike, memory: float, blocks: int = 20) -> BlockAverage:
    r"""Return the mean of a series, part of which follows a slow variable, and its standard error.

    For example, the energy E of a column changes only as heat passes through the floor; the temperature of each layer
    follows E and has fast noise of its own. So a value is :math:`b E + r`, with b from the regression; the error of the
    mean of E follows from its known correlation time, and r is not correlated from block to block.

    Parameters
    ----------
    values : (time, ...)
        Series along the first axis, at least twice as many values as blocks; further axes are kept.
    slow : (time,)
        The slow variable.
    memory
        Correlation time of the slow variable, in values [1].
    blocks
        As in `overlapping_average`.

    Examples
    --------
    >>> rng = np.random.default_rng(2)
    >>> quick, slow = rng.normal(size=400), np.sin(np.arange(400) / 30.0)
    >>> mean, error = average_beside(quick + slow, slow, 30.0)
    >>> bool(error > overlapping_average(quick).standard_error)
    True
    """
    series, changing = np.asarray(values, np.float64), np.asarray(slow, np.float64)
    apart = changing - changing.mean()
    size = float(apart @ apart)
    if not size > 1e-20 * float(changing @ changing):  # it is constant
        return overlapping_average(series, blocks)
    slope = np.tensordot(apart, series, axes=(0, 0)) / size
    quick = overlapping_average(series - np.multiply.outer(apart, slope), blocks)
    error = np.hypot(slope * block_average(changing, blocks, memory).standard_error, quick.standard_error)
    return BlockAverage(quick.mean, error)


START = 3.0
"""Least size of a fluctuation whose growth is measured, in units of its noise at rest."""


def growth_per_step(values: ArrayLike, noise: float, decay: float) -> BlockAverage:
    r"""Return how fast an unstable fluctuation grows from value to value, as a logarithm, and its standard error.

    It is the slope of the logarithm from where the fluctuation exceeds its noise at rest :math:`\sigma` three times for
    good. Noise still drives it then: of :math:`da = s a\,dt` plus noise that keeps the variance :math:`\sigma^2`
    against a decay at the rate :math:`\gamma`, the logarithm of the whole growth varies by :math:`\gamma / 9 s`.

    Parameters
    ----------
    values : (time,)
        A single mode with its sign, at equal intervals, up to where it stops to grow as an exponential.
    noise
        Standard deviation of the mode in air at rest.
    decay
        Rate at which the mode decays in air at rest without buoyancy [1/interval].

    Examples
    --------
    >>> found = growth_per_step(1.1 ** np.arange(60.0), 1.0, 0.1)
    >>> bool(abs(found.mean - np.log(1.1)) < 1e-12)
    True
    """
    size = np.abs(np.asarray(values, np.float64))
    small = np.flatnonzero(size < START * noise)
    grown = np.log(size[small[-1] + 1 if len(small) else 0 :])
    if len(grown) < 4:
        return BlockAverage(np.array(np.nan), np.array(np.nan))
    slope = float(np.polyfit(np.arange(len(grown)), grown, 1)[0])
    error = np.sqrt(max(decay, 0.0) * abs(slope)) / START / max(float(grown[-1] - grown[0]), 1e-9)
    return BlockAverage(np.array(slope), np.array(error))
