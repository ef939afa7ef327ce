"""Means with their standard errors, and the critical values of the tests of a distribution."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray


class BlockAverage(NamedTuple):
    """A mean and how far it may be off."""

    mean: NDArray[np.float64]
    """Mean of the values."""
    standard_error: NDArray[np.float64]
    """Standard deviation that the mean would show if the run were repeated."""


def block_average(values: ArrayLike, blocks: int = 20, memory: float = 0.0) -> BlockAverage:
    r"""Return the mean of a series and its standard error, from the means of blocks.

    Values that follow each other closely in time are not independent, and taking them for such makes an error
    bar too small. The means of blocks much longer than the correlation time of the gas, ten mean free times, are: the
    standard error is their standard deviation over the square root of their number. Where a correlation decays as
    :math:`e^{-t/\tau}`, blocks of a length L not much longer show too little. The variance of a mean over a time
    t is :math:`f(t) / t`, :math:`f = 1 - (1 - e^{-t/\tau}) \tau / t`, and so of n blocks the square of the error is
    divided by :math:`[n f(L) / f(nL) - 1] / (n - 1)`.

    Parameters
    ----------
    values : (time, ...)
        Series along the first axis; further axes, such as layers, are kept.
    blocks
        Number of blocks [1].
    memory
        Correlation time :math:`\tau` in values, where theory gives it; 0 for independent blocks [1].

    Returns
    -------
    BlockAverage
        ``mean`` and ``standard_error``, of the shape of one value.

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
        # the blocks scatter about the mean of this run, not about the true one
        lengths = length / memory * np.array([1.0, blocks])
        one, all_of_them = 1.0 + np.expm1(-lengths) / lengths
        # of a run much shorter than its memory the digits of this would cancel
        shown = (blocks * one / all_of_them - 1.0) / (blocks - 1.0) if lengths[1] > 1e-4 else lengths[0] / 3.0
        error = error / np.sqrt(shown)
    return BlockAverage(means.mean(axis=0), error)


def _divisible(values: ArrayLike, blocks: int) -> NDArray[np.float64]:
    """Return a series as an array, or raise ``ValueError`` unless it can be divided into so many blocks."""
    series = np.asarray(values, dtype=np.float64)
    if blocks < 2:
        raise ValueError(f"blocks = {blocks} must be at least 2: the error is read from their scatter.")
    if series.ndim == 0 or series.shape[0] < blocks:
        found = series.shape[0] if series.ndim else 1
        raise ValueError(f"{found} values cannot be divided into {blocks} blocks.")
    return series


LONG = 5.0
"""How many correlation times a block lasts where these are known."""
MOST_BLOCKS = 100


def overlapping_average(values: ArrayLike, blocks: int = 20, memory: float | None = None) -> BlockAverage:
    r"""Return the mean of a series and its standard error, from blocks of two lengths.

    The variance of the mean that blocks of a length L show is too small by a share that goes as 1/L [1]_. That of
    half as long blocks is too small by twice as much, and so :math:`2 V(L) - V(L/2)` is free of that error. All
    overlapping blocks count, not only those that lie side by side.

    Parameters
    ----------
    values : (time, ...)
        Series along the first axis, at least twice as many values as blocks; further axes are kept.
    blocks
        How many of the longer blocks fill the series [1].
    memory
        Correlation time in values, where theory gives it: up to 100 blocks, five of it long, are then made if they are
        more. The more blocks there are the less the error itself scatters, and the more seldom is a run that is right
        told to be four standard errors off.

    Returns
    -------
    BlockAverage
        ``mean`` of all values and ``standard_error``, of the shape of one value.

    Raises
    ------
    ValueError
        If there are fewer than 2 blocks, or fewer than twice as many values.

    Notes
    -----
    The error is itself uncertain by 20 % for 20 blocks. Where chance makes the difference small, a quarter of V(L) is
    the least. Blocks of five correlation times or more make the error right within 2 %, plain blocks within 11 %.

    References
    ----------
    .. [1] Vats, D., Flegal, J. M. (2022), Lugsail lag windows, doi:10.1093/biomet/asab049.

    Examples
    --------
    A series of which each value keeps 0.9 of the one before has a mean that scatters by 10 / sqrt(n):

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
        # of the mean of all: a block counts by its length, and its own share in that mean is made good
        squares = np.sum((sums[length:] - sums[:-length]) ** 2, axis=0) / length
        found: NDArray[np.float64] = squares / ((n - length) * (n - length + 1))
        return found

    half = n // (2 * blocks)
    whole = variance(2 * half)
    return BlockAverage(mean, np.sqrt(np.maximum(2.0 * whole - variance(half), 0.25 * whole)))


def average_beside(values: ArrayLike, slow: ArrayLike, memory: float, blocks: int = 20) -> BlockAverage:
    r"""Return the mean of a series, part of which follows something slow, and its standard error.

    The energy of a column, say, changes only as heat passes through the floor, and the temperature of each layer
    follows it besides its own quick noise. So a value is :math:`b E + r`, with b from the regression; the error of
    the mean of E is that of its known correlation time, and r is not correlated from block to block.

    Parameters
    ----------
    values : (time, ...)
        Series along the first axis, at least twice as many values as blocks; further axes are kept.
    slow : (time,)
        What changes slowly.
    memory
        Its correlation time, in values [1].
    blocks
        As in `overlapping_average`.

    Returns
    -------
    BlockAverage
        ``mean`` and ``standard_error``, of the shape of one value.

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
    if not size > 1e-20 * float(changing @ changing):  # it does not change at all
        return overlapping_average(series, blocks)
    slope = np.tensordot(apart, series, axes=(0, 0)) / size
    quick = overlapping_average(series - np.multiply.outer(apart, slope), blocks)
    error = np.hypot(slope * block_average(changing, blocks, memory).standard_error, quick.standard_error)
    return BlockAverage(quick.mean, error)


def kolmogorov_smirnov_critical(samples: ArrayLike, level: ArrayLike = 0.01) -> NDArray[np.float64]:
    r"""Return how far a measured distribution may stray from the true one by chance.

    The greatest distance between the two cumulative distributions exceeds this value with a probability of
    ``level``: 1.358, 1.628 and 1.949 over :math:`\sqrt{n}` at 5 %, 1 % and 0.1 %.

    Parameters
    ----------
    samples
        Number n of independent values [1].
    level
        Probability of a false alarm [1].

    Returns
    -------
    ndarray
        Critical distance [1].

    Notes
    -----
    The limit of large n, a little too large, and so on the safe side, for small n.

    References
    ----------
    .. [1] Massey, F. J. (1951), doi:10.1080/01621459.1951.10500769.

    Examples
    --------
    >>> round(float(kolmogorov_smirnov_critical(10_000, 0.01)), 5)
    0.01628
    """
    from scipy import special  # loads slowly

    critical: NDArray[np.float64] = special.kolmogi(np.asarray(level, dtype=np.float64)) / np.sqrt(
        np.asarray(samples, dtype=np.float64)
    )
    return critical


def running_mean(values: ArrayLike, block: int) -> NDArray[np.float64]:
    """Return the mean of each value and its neighbours, as many on either side as there are up to half a block.

    Examples
    --------
    >>> running_mean([0.0, 3.0, 0.0, 3.0], 3)
    array([0., 1., 2., 3.])
    """
    row = np.asarray(values, float)
    sums = np.concatenate([[0.0], np.cumsum(row)])
    place = np.arange(len(row))
    half = np.minimum(np.minimum(place, len(row) - 1 - place), block // 2)
    mean: NDArray[np.float64] = (sums[place + half + 1] - sums[place - half]) / (2 * half + 1)
    return mean
