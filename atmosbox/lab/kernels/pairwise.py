"""Sums as numpy computes them: by halves, their halves and so on, so that rounding errors grow with the logarithm.

A start in Python sums with numpy; the same start in a page must round in the same way. A test compares the two.
"""

from atmosbox.engine.core.jit import kernel

DEPTH = 64
"""Largest number of pieces that wait at once: more than any number of molecules can be halved."""
_PIECE, _LANES = 128, 8


@kernel
def _piece(values, first, number):
    """Return the sum of at most 128 numbers: eight partial sums side by side, and the rest."""
    if number < _LANES:
        total = -0.0
        for k in range(first, first + number):
            total += values[k]
        return total
    a, b, c, d = values[first], values[first + 1], values[first + 2], values[first + 3]
    e, f, g, h = values[first + 4], values[first + 5], values[first + 6], values[first + 7]
    whole = number - number % _LANES
    for k in range(first + _LANES, first + whole, _LANES):
        a += values[k]
        b += values[k + 1]
        c += values[k + 2]
        d += values[k + 3]
        e += values[k + 4]
        f += values[k + 5]
        g += values[k + 6]
        h += values[k + 7]
    total = ((a + b) + (c + d)) + ((e + f) + (g + h))
    for k in range(first + whole, first + number):
        total += values[k]
    return total


@kernel
def pairwise_sum(values, number, waiting, partial):
    """Return the sum of the first ``number`` values.

    Parameters
    ----------
    values : (at least number,)
        The numbers.
    number
        Number of values to sum.
    waiting : (DEPTH, 2), partial : (DEPTH,)
        Scratch: start and length of the pieces that are still to be summed, and the sums of others.

    Examples
    --------
    >>> import numpy as np
    >>> float(pairwise_sum(np.arange(1000.0), 1000, np.zeros((DEPTH, 2), np.int64), np.zeros(DEPTH)))
    499500.0
    """
    todo, sums = 1, 0
    waiting[0, 0], waiting[0, 1] = 0, number
    while todo > 0:
        todo -= 1
        first, many = waiting[todo, 0], waiting[todo, 1]
        if many < 0:  # both halves are summed
            sums -= 1
            partial[sums - 1] = partial[sums - 1] + partial[sums]
        elif many <= _PIECE:
            partial[sums] = _piece(values, first, many)
            sums += 1
        else:
            half = many // 2
            half -= half % _LANES
            waiting[todo, 0], waiting[todo, 1] = 0, -1
            waiting[todo + 1, 0], waiting[todo + 1, 1] = first + half, many - half
            waiting[todo + 2, 0], waiting[todo + 2, 1] = first, half
            todo += 3
    return partial[0]
