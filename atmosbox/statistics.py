"""Means with honest error bars, and the critical values of the tests of a distribution."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import special


class BlockAverage(NamedTuple):
    """A mean and how far it may be off."""

    mean: NDArray[np.float64]
    """Mean of the values."""
    standard_error: NDArray[np.float64]
    """Standard deviation that the mean would show if the run were repeated."""


def block_average(values: ArrayLike, blocks: int = 20) -> BlockAverage:
    r"""Return the mean of a series and its standard error, from the means of blocks.

    Values that follow each other closely in time are not independent, and taking them for such makes an error
    bar too small. The means of blocks much longer than the memory of the gas, ten mean free times, are: the
    standard error is their standard deviation over the square root of their number.

    Parameters
    ----------
    values : (time, ...)
        Series along the first axis; further axes, such as layers, are kept.
    blocks
        Number of blocks [1].

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
    series = np.asarray(values, dtype=np.float64)
    if blocks < 2:
        raise ValueError(f"blocks = {blocks} must be at least 2: the error is read from their scatter.")
    if series.ndim == 0 or series.shape[0] < blocks:
        found = series.shape[0] if series.ndim else 1
        raise ValueError(f"{found} values cannot be divided into {blocks} blocks.")
    length = series.shape[0] // blocks
    means = series[-blocks * length :].reshape(blocks, length, *series.shape[1:]).mean(axis=1)
    error = means.std(axis=0, ddof=1) / np.sqrt(blocks)
    return BlockAverage(means.mean(axis=0), error)


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
    critical: NDArray[np.float64] = special.kolmogi(np.asarray(level, dtype=np.float64)) / np.sqrt(
        np.asarray(samples, dtype=np.float64)
    )
    return critical
