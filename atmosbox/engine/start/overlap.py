"""Which molecules overlap, and how they are moved apart; molecules make room for drops."""

import math
from collections import namedtuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.pair import nearest_along
from atmosbox.engine.core.random import RandomNumbers, uniform

Array = NDArray[np.float64]
_GAP = 1e-6
"""Gap that is left between two that were pushed apart, as a fraction of their distance in contact."""


class Spheres(namedtuple("Spheres", "x size radius low high turn inverse order moved moves")):
    """Molecules that are to be placed.

    ``x : (molecule, axis)`` are their centres, ``size : (molecule,)`` their radii, ``radius : (molecule,)`` the same
    while they grow, ``low`` and ``high : (molecule, axis)`` the lowest and highest coordinates that each centre may
    have [length]; ``turn : (axis,)`` is the side of the box along a periodic axis, 0 along any other, ``inverse :
    (axis,)`` its inverse, or 0. ``order : (molecule,)`` are the molecules from the largest to the smallest. ``moved``
    and ``moves : (molecule,)`` tell which were pushed in the last round, and in this.
    """


class Bins(namedtuple("Bins", "number origin size head follower")):
    """The bins in which neighbours are searched; each is wider than any pair in contact.

    ``number``, ``origin``, ``size : (axis,)``: number of bins, lowest coordinate and extent of all bins; ``head :
    (bin,)`` a molecule in each bin, ``follower : (molecule,)`` the next one in the same bin, -1 for none.
    """


def spheres_of(diameter: Array, sides: Array, periodic: tuple[bool, bool, bool], planar: bool) -> Spheres:
    """Return spheres, all at the origin, for a box with these sides [length]; ``planar`` if all lie in one plane."""
    n = diameter.size
    turn = sides * np.array(periodic)
    low = np.where(periodic, 0.0, 1.0)[None, :] * 0.5 * diameter[:, None]
    high = sides[None, :] - low
    if planar:
        low[:, 1] = high[:, 1] = 0.5 * sides[1]
        turn[1] = 0.0
    inverse = np.where(turn > 0.0, 1.0 / np.where(turn > 0.0, turn, 1.0), 0.0)
    order = np.argsort(-diameter, kind="stable")
    size, moved, moves = 0.5 * diameter, np.zeros(n, np.bool_), np.zeros(n, np.bool_)
    return Spheres(np.zeros((n, 3)), size, size.copy(), low, high, turn, inverse, order, moved, moves)


def bins_of(spheres: Spheres) -> Bins:
    """Return empty bins, not many more than there are molecules."""
    n = spheres.size.size
    widest = 2.0 * float(spheres.size.max()) * (1.0 + 2.0 * _GAP)
    most = max(math.isqrt(2 * n), 4)
    turns = spheres.turn > 0.0
    origin = np.where(turns, 0.0, spheres.low.min(axis=0))
    size = np.where(turns, spheres.turn, np.maximum(spheres.high.max(axis=0) - origin, 1e-300))
    number = np.full(3, most) if widest == 0.0 else np.minimum(size / widest, float(most)).astype(np.int64)
    number = np.clip(number, 1, None)
    number[turns & (number < 3)] = 1
    while math.prod(number.tolist()) > 4 * n + 64:
        number[np.argmax(number)] = max(1, int(number.max()) // 2)
        number[turns & (number < 3)] = 1
    return Bins(number, origin, size, np.full(math.prod(number.tolist()), -1), np.full(n, -1))


@kernel
def _bin_along(u, axis, bins):
    """Return the number along an axis of the bin at a coordinate, which may be beyond an end."""
    number = bins.number[axis]
    return math.floor((u - bins.origin[axis]) / bins.size[axis] * number) if number > 1 else 0


@kernel
def _bin_of(i, spheres, bins):
    """Return the bin of molecule i."""
    x, number = spheres.x, bins.number
    a = min(max(_bin_along(x[i, 0], 0, bins), 0), number[0] - 1)
    b = min(max(_bin_along(x[i, 1], 1, bins), 0), number[1] - 1)
    c = min(max(_bin_along(x[i, 2], 2, bins), 0), number[2] - 1)
    return (a * number[1] + b) * number[2] + c


@kernel
def enter(i, spheres, bins):
    """Enter molecule i into its bin."""
    k = _bin_of(i, spheres, bins)
    bins.follower[i] = bins.head[k]
    bins.head[k] = i


@kernel
def leave(i, spheres, bins):
    """Remove molecule i from its bin."""
    k = _bin_of(i, spheres, bins)
    j = bins.head[k]
    if j == i:
        bins.head[k] = bins.follower[i]
        return
    while bins.follower[j] != i:
        j = bins.follower[j]
    bins.follower[j] = bins.follower[i]


@kernel
def _bins_along(u, reach, axis, turn, bins):
    """Return the first and the last bin along an axis within ``reach`` of a coordinate; they may be beyond an end."""
    low, high = _bin_along(u - reach, axis, bins), _bin_along(u + reach, axis, bins)
    if turn[axis] > 0.0:
        return low, high
    return max(low, 0), min(high, bins.number[axis] - 1)


@kernel
def _distance_squared(x, y, z, j, spheres):
    """Return the square of the distance from a point to the centre of molecule j, or its nearest image."""
    turn, inverse = spheres.turn, spheres.inverse
    dx = nearest_along(x - spheres.x[j, 0], turn[0], inverse[0])
    dy = nearest_along(y - spheres.x[j, 1], turn[1], inverse[1])
    dz = nearest_along(z - spheres.x[j, 2], turn[2], inverse[2])
    return dx * dx + dy * dy + dz * dz


@kernel
def is_free(i, x, y, z, spheres, bins):
    """Return whether molecule i would overlap no other one at a point."""
    radius, number = spheres.radius, bins.number
    reach = radius[i] + radius[spheres.order[0]]
    low_x, high_x = _bins_along(x, reach, 0, spheres.turn, bins)
    low_y, high_y = _bins_along(y, reach, 1, spheres.turn, bins)
    low_z, high_z = _bins_along(z, reach, 2, spheres.turn, bins)
    for a in range(low_x, high_x + 1):
        for b in range(low_y, high_y + 1):
            for c in range(low_z, high_z + 1):
                j = bins.head[((a % number[0]) * number[1] + b % number[1]) * number[2] + c % number[2]]
                while j >= 0:
                    touching = radius[i] + radius[j]
                    if j != i and _distance_squared(x, y, z, j, spheres) < touching * touching:
                        return False
                    j = bins.follower[j]
    return True


@kernel
def _push_pair(i, j, spheres):
    """Push two molecules apart if they overlap; return whether they did."""
    x, radius, low, high = spheres.x, spheres.radius, spheres.low, spheres.high
    turn, inverse = spheres.turn, spheres.inverse
    dx = nearest_along(x[j, 0] - x[i, 0], turn[0], inverse[0])
    dy = nearest_along(x[j, 1] - x[i, 1], turn[1], inverse[1])
    dz = nearest_along(x[j, 2] - x[i, 2], turn[2], inverse[2])
    touching = radius[i] + radius[j]
    square = dx * dx + dy * dy + dz * dz
    apart = touching * (1.0 + 0.5 * _GAP)
    if square >= apart * apart:
        return 0
    distance = math.sqrt(square)
    wanted = touching * (1.0 + _GAP)
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


@kernel
def push(spheres, bins, rounds):
    """Push overlapping molecules apart along their lines of centres in at most so many rounds.

    Returns the number of pairs that were pushed in the last round, 0 as soon as no molecules overlap; then all are in
    their bins. After the first round only pairs of which one has just moved are tested, so late rounds cost little.
    """
    x, moved, moves, number = spheres.x, spheres.moved, spheres.moves, bins.number
    n, reach = spheres.radius.size, 2.0 * spheres.radius[spheres.order[0]] * (1.0 + _GAP)
    pushed = 0
    moved[:] = True
    for _ in range(rounds):
        pushed = 0
        bins.head[:] = -1
        moves[:] = False
        for i in range(n):
            enter(i, spheres, bins)
        for i in range(n):
            if not moved[i]:
                continue
            low_x, high_x = _bins_along(x[i, 0], reach, 0, spheres.turn, bins)
            low_y, high_y = _bins_along(x[i, 1], reach, 1, spheres.turn, bins)
            low_z, high_z = _bins_along(x[i, 2], reach, 2, spheres.turn, bins)
            for a in range(low_x, high_x + 1):
                for b in range(low_y, high_y + 1):
                    for c in range(low_z, high_z + 1):
                        j = bins.head[((a % number[0]) * number[1] + b % number[1]) * number[2] + c % number[2]]
                        while j >= 0:
                            if j != i and (j > i or not moved[j]):
                                pushed += _push_pair(i, j, spheres)
                            j = bins.follower[j]
        if pushed == 0:
            break
        for i in range(n):
            moved[i] = moves[i]
    return pushed


@kernel
def _distance(place, i, x, y, z):
    """Return the distance of a point from the centre of molecule i, or of drop i [length]."""
    dx, dy, dz = place[i, 0] - x, place[i, 1] - y, place[i, 2] - z
    return math.sqrt(dx * dx + dy * dy + dz * dz)


@kernel
def _is_reached(x, y, z, centre, reach):
    """Return whether a point lies within the reach of a drop."""
    found = False
    for k in range(reach.size):
        found |= _distance(centre, k, x, y, z) < reach[k]
    return found


@kernel
def _is_taken(i, x, y, z, place):
    """Return whether molecule i would overlap another one at a point."""
    found = False
    for j in range(place.shape[0]):
        found |= j != i and _distance(place, j, x, y, z) <= 1.0
    return found


@kernel(entry=True)
def clear(place, centre, reach, side, state):
    """Give new positions to molecules within reach of a drop: see `clear_of_drops`; ``state : (1,)`` is advanced."""
    for i in range(place.shape[0]):
        x, y, z = place[i, 0], place[i, 1], place[i, 2]
        if not _is_reached(x, y, z, centre, reach):
            continue
        while True:
            x = 0.5 + (side - 1.0) * uniform(state)
            y = 0.5 + (side - 1.0) * uniform(state)
            z = 0.5 + (side - 1.0) * uniform(state)
            if not (_is_reached(x, y, z, centre, reach) or _is_taken(i, x, y, z, place)):
                break
        place[i, 0], place[i, 1], place[i, 2] = x, y, z


def clear_of_drops(position: Array, centre: ArrayLike, reach: ArrayLike, side: float, rng: RandomNumbers) -> Array:
    """Return positions of molecules of diameter 1 between walls; those within reach of a drop are drawn again.

    Parameters
    ----------
    position : (molecule, axis)
        Centres of molecules that do not overlap [length].
    centre : (drop, axis)
        Centres of the drops [length].
    reach : (drop,)
        Distance from the centre of each drop within which no centre of a molecule may be [length].
    side
        Side of the box, a cube [length].
    rng
        Random numbers.

    Examples
    --------
    >>> pair = np.array([[2.0, 2.0, 2.0], [5.0, 5.0, 5.0]])
    >>> pair = clear_of_drops(pair, [[3.0, 3.0, 3.0]], [2.0], 8.0, RandomNumbers(1))
    >>> bool(np.linalg.norm(pair[0] - 3.0) > 2.0), pair[1].tolist()
    (True, [5.0, 5.0, 5.0])
    """
    place = np.array(position, np.float64)
    clear(place, np.array(centre, np.float64), np.array(reach, np.float64), float(side), rng.state)
    return place
