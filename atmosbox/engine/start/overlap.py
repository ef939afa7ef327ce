"""Overlapping molecules are pushed apart along their line of centres, until none overlap."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.pair import nearest_along

__all__ = ["push_apart"]

Array = NDArray[np.float64]


class _Spheres(NamedTuple):
    """The data of `push_apart`; ``moved``, ``moves : (molecule,)`` which were pushed in the last round, and in this."""

    x: Any
    radius: Any
    low: Any
    high: Any
    turn: Any
    moved: Any
    moves: Any


class _Bins(NamedTuple):
    """The bins in which neighbours are searched.

    ``number``, ``origin``, ``size : (axis,)``: number of bins, lowest coordinate and extent of all bins; ``head :
    (bin,)`` a molecule in each bin, ``follower : (molecule,)`` the next one in the same bin, -1 for none;
    ``place : (molecule, axis)`` the bin of each molecule.
    """

    number: Any
    origin: Any
    size: Any
    head: Any
    follower: Any
    place: Any


def _bins(radius: Array, low: Array, high: Array, turn: Array, gap: float) -> _Bins:
    """Return bins that are wider than any pair in contact, and not many more than there are molecules."""
    n = radius.size
    widest = 2.0 * float(radius.max()) * (1.0 + gap)
    most = max(math.isqrt(2 * n), 4)
    turns = turn > 0.0
    origin = np.where(turns, 0.0, low.min(axis=0))
    size = np.where(turns, turn, np.maximum(high.max(axis=0) - origin, 1e-300))
    number = np.clip(np.minimum(size / widest, float(most)).astype(np.int64), 1, None)
    number[turns & (number < 3)] = 1
    while math.prod(number.tolist()) > 4 * n + 64:
        number[np.argmax(number)] = max(1, int(number.max()) // 2)
        number[turns & (number < 3)] = 1
    place = np.zeros((n, 3), np.int64)
    return _Bins(number, origin, size, np.zeros(math.prod(number.tolist()), np.int64), np.zeros(n, np.int64), place)


@kernel
def _push_pair(i, j, gap, spheres):
    """Push two molecules apart if they overlap; return whether they did."""
    x, radius, low, high, turn = spheres.x, spheres.radius, spheres.low, spheres.high, spheres.turn
    dx = nearest_along(x[j, 0] - x[i, 0], turn[0], 1.0 / turn[0] if turn[0] > 0.0 else 0.0)
    dy = nearest_along(x[j, 1] - x[i, 1], turn[1], 1.0 / turn[1] if turn[1] > 0.0 else 0.0)
    dz = nearest_along(x[j, 2] - x[i, 2], turn[2], 1.0 / turn[2] if turn[2] > 0.0 else 0.0)
    touching = radius[i] + radius[j]
    square = dx * dx + dy * dy + dz * dz
    apart = touching * (1.0 + 0.5 * gap)
    if square >= apart * apart:
        return 0
    distance = math.sqrt(square)
    wanted = touching * (1.0 + gap)
    if distance < 1e-9 * wanted:
        dx, dy, dz, distance = wanted * 1e-3, 0.0, wanted * 1e-3, wanted * 1.5e-3
    # a little more than needed; the larger sphere moves less
    push = 1.05 * (wanted - distance) / distance
    other, own = radius[j] * radius[j] * radius[j], radius[i] * radius[i] * radius[i]
    share = other / (own + other)
    for axis in range(3):
        d = dx if axis == 0 else (dy if axis == 1 else dz)
        x[i, axis] -= share * push * d
        x[j, axis] += (1.0 - share) * push * d
        for k in (i, j):
            if turn[axis] > 0.0:
                x[k, axis] -= turn[axis] * math.floor(x[k, axis] / turn[axis])
            else:
                x[k, axis] = min(max(x[k, axis], low[k, axis]), high[k, axis])
    spheres.moves[i] = True
    spheres.moves[j] = True
    return 1


def push_apart(x: Array, radius: Array, low: Array, high: Array, turn: Array, rounds: int, gap: float) -> int:
    """Push overlapping molecules apart in several rounds; return how many pairs were pushed in the last one.

    Parameters
    ----------
    x : (molecule, axis)
        Centres, which are moved [length].
    radius : (molecule,)
        Radii [length].
    low, high : (molecule, axis)
        Lowest and highest coordinates that each centre may have [length].
    turn : (axis,)
        Side of the box along a periodic axis, 0 along any other [length].
    rounds
        Largest number of rounds over all pairs.
    gap
        Gap that is left between two that were pushed, as a fraction of their distance in contact.

    Returns
    -------
    int
        0 as soon as no molecules overlap.

    Notes
    -----
    After the first round only pairs of which one has just moved are tested, so that late rounds cost little.

    Examples
    --------
    >>> x = np.array([[1.0, 1.0, 1.0], [1.5, 1.0, 1.0]])
    >>> low, high = np.full((2, 3), 0.5), np.full((2, 3), 3.5)
    >>> push_apart(x, np.full(2, 0.5), low, high, np.zeros(3), 8, 1e-6)
    0
    >>> bool(x[1, 0] - x[0, 0] > 1.0)
    True
    """
    moved, moves = np.ones(radius.size, np.bool_), np.zeros(radius.size, np.bool_)
    return int(
        _push(_Spheres(x, radius, low, high, turn, moved, moves), _bins(radius, low, high, turn, gap), rounds, gap)
    )


@kernel(entry=True)
def _push(spheres, bins, rounds, gap):
    """Push overlapping molecules apart: see `push_apart`."""
    x, turn, moved, moves = spheres.x, spheres.turn, spheres.moved, spheres.moves
    number, origin, size = bins.number, bins.origin, bins.size
    head, follower, place = bins.head, bins.follower, bins.place
    n = spheres.radius.size
    pushed = 0
    for _ in range(rounds):
        pushed = 0
        head[:] = -1
        moves[:] = False
        for i in range(n):
            for axis in range(3):
                k = int((x[i, axis] - origin[axis]) / size[axis] * number[axis])
                place[i, axis] = min(max(k, 0), number[axis] - 1)
            c = (place[i, 0] * number[1] + place[i, 1]) * number[2] + place[i, 2]
            follower[i] = head[c]
            head[c] = i
        for i in range(n):
            if not moved[i]:
                continue
            for a in range(-1, 2):
                p = place[i, 0] + a
                if turn[0] > 0.0 and number[0] > 1:
                    p = p % number[0]
                if p < 0 or p >= number[0]:
                    continue
                for b in range(-1, 2):
                    q = place[i, 1] + b
                    if turn[1] > 0.0 and number[1] > 1:
                        q = q % number[1]
                    if q < 0 or q >= number[1]:
                        continue
                    for c in range(-1, 2):
                        r = place[i, 2] + c
                        if turn[2] > 0.0 and number[2] > 1:
                            r = r % number[2]
                        if r < 0 or r >= number[2]:
                            continue
                        j = head[(p * number[1] + q) * number[2] + r]
                        while j >= 0:
                            if j != i and (j > i or not moved[j]):
                                pushed += _push_pair(i, j, gap, spheres)
                            j = follower[j]
        if pushed == 0:
            break
        for i in range(n):
            moved[i] = moves[i]
    return pushed
