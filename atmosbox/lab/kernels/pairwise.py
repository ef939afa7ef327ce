"""Sums as numpy computes them: by halves, their halves and so on, so that rounding errors grow with the logarithm.

A start in Python sums with numpy; the same start in a page must round in the same way. A test compares the two.
"""

from atmosbox.engine.core.jit import kernel

_PIECE, _LANES = 128, 8


@kernel(plain=True)
def _lanes(values, first, last, number):
    """Return the sum of some lanes side by side, by halves; a lane is every eighth value."""
    if number > 1:
        half = number // 2
        return _lanes(values, first, last, half) + _lanes(values, first + half, last, half)
    total = values[first]
    for k in range(first + _LANES, last, _LANES):
        total += values[k]
    return total


@kernel(plain=True)
def pairwise_sum(values, first, number):
    """Return the sum of ``number`` values from ``first`` on: of at most 128 in eight lanes and a rest, else by halves.

    >>> import numpy as np
    >>> float(pairwise_sum(np.arange(1000.0), 0, 1000))
    499500.0
    """
    if number > _PIECE:
        half = number // 2
        half -= half % _LANES
        return pairwise_sum(values, first, half) + pairwise_sum(values, first + half, number - half)
    total, last = -0.0, first + number - number % _LANES
    if last > first:
        total = _lanes(values, first, last, _LANES)
    for k in range(last, first + number):
        total += values[k]
    return total
