"""Where molecules stand at the start: scattered at random, or on a lattice.

What cannot be packed is refused within a second, with the reason.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine._jit import kernel
from atmosbox.engine.refusal import PackingError, RefusedError

__all__ = ["lattice_positions", "packing_fraction", "random_positions"]

Array = NDArray[np.float64]
_DENSEST = math.pi / math.sqrt(18.0)
_DENSEST_PLANE = math.pi / math.sqrt(12.0)
_GAP = 1e-6
_ROUNDS = 8
_PATIENCE = 100
_DENSEST_RANDOM = 0.56
_DENSEST_RANDOM_PLANE = 0.74


def packing_fraction(length: Sequence[float], diameter: ArrayLike, *, planar: bool = False) -> float:
    """Return the part of the box, or of the plane box's area, that the molecules fill.

    Parameters
    ----------
    length
        The three sides of the box [length].
    diameter : (molecule,)
        Diameters [length].
    planar
        Whether the molecules are discs in the plane of x and z.

    Returns
    -------
    float
        Between 0 and 1, dimensionless.

    Examples
    --------
    >>> round(packing_fraction((10, 10, 10), np.ones(191)), 3)
    0.1
    """
    sigma = np.asarray(diameter, np.float64)
    if planar:
        return float(np.sum(math.pi / 4.0 * sigma**2)) / (length[0] * length[2])
    return float(np.sum(math.pi / 6.0 * sigma**3)) / math.prod(length)


def random_positions(
    length: Sequence[float],
    diameter: ArrayLike,
    rng: np.random.Generator,
    *,
    periodic: tuple[bool, bool, bool] = (False, False, False),
    planar: bool = False,
    top: float | None = None,
    scale_height: float | None = None,
) -> Array:
    """Scatter molecules at random, then push apart those that overlap.

    Parameters
    ----------
    length
        The three sides of the box [length].
    diameter : (molecule,)
        Diameters [length]; there are as many molecules as numbers here.
    rng
        Random numbers.
    periodic
        Which axes are periodic.
    planar
        Whether all centres lie in the plane y = half the box.
    top
        Only heights below this one are used [length]; the whole box by default.
    scale_height
        Thins the molecules with height as an isothermal atmosphere does [length].

    Returns
    -------
    (molecule, axis) ndarray
        Centres [length].

    Raises
    ------
    PackingError
        If they do not fit; regular lattices reach higher packing fractions.

    Notes
    -----
    Overlapping pairs are moved apart along their line of centres by what they overlap, again and again.
    That reaches packing fractions of 0.56, where trying random places one by one ends at 0.38
    (in a plane 0.74 and 0.55).

    Examples
    --------
    >>> where = random_positions((5, 5, 5), np.ones(20), np.random.default_rng(1))
    >>> float(where.min()) >= 0.5, where.shape
    (True, (20, 3))
    """
    sigma = np.atleast_1d(np.asarray(diameter, np.float64))
    n = sigma.size
    sides = np.array(length, np.float64)
    if top is not None:
        if not 0.0 < top <= sides[2]:
            raise RefusedError(f"top = {top:.6g} is outside the box: give a height between 0 and {sides[2]:.6g}")
        sides[2] = top
    _refuse_impossible(sides, sigma, periodic, planar)
    low = np.where(periodic, 0.0, 1.0)[None, :] * 0.5 * sigma[:, None]
    high = sides[None, :] - low
    x = low + rng.random((n, 3)) * (high - low)
    if scale_height is not None and math.isfinite(scale_height):
        reach = high[:, 2] - low[:, 2]
        x[:, 2] = low[:, 2] - scale_height * np.log1p(rng.random(n) * np.expm1(-reach / scale_height))
    if planar:
        x[:, 1] = low[:, 1] = high[:, 1] = 0.5 * sides[1]
    turn = sides * np.array(periodic)
    if n < 2 or sigma.max() == 0.0:
        return x
    phi = packing_fraction(list(sides), sigma, planar=planar)
    if np.ptp(sigma) == 0.0 and phi > (_DENSEST_RANDOM_PLANE if planar else _DENSEST_RANDOM):
        raise _too_dense(n, sides, sigma, planar)
    for _ in range(_PATIENCE):
        if _push_apart(x, 0.5 * sigma, low, high, turn, _ROUNDS, _GAP) == 0:
            return x
    raise _too_dense(n, sides, sigma, planar)


def lattice_positions(
    length: Sequence[float],
    diameter: ArrayLike,
    *,
    periodic: tuple[bool, bool, bool] = (False, False, False),
    planar: bool = False,
    rng: np.random.Generator | None = None,
) -> Array:
    """Place molecules on a face-centred lattice (in a plane, a centred rectangular one) that fills the box.

    Parameters
    ----------
    length, diameter, periodic, planar
        As in `random_positions`.
    rng
        Chooses the sites where there are more of them than molecules; the first ones are taken without it.

    Returns
    -------
    (molecule, axis) ndarray
        Centres [length].

    Raises
    ------
    PackingError
        If no such lattice holds the molecules.

    Examples
    --------
    A cube of 4 unit cells a side at the packing fraction where hard spheres have long been a crystal:

    >>> sites = lattice_positions((6.0, 6.0, 6.0), np.ones(256), periodic=(True, True, True))
    >>> sites.shape, round(packing_fraction((6, 6, 6), np.ones(256)), 2)
    ((256, 3), 0.62)
    """
    sigma = np.atleast_1d(np.asarray(diameter, np.float64))
    n = sigma.size
    sides = np.array(length, np.float64)
    _refuse_impossible(sides, sigma, periodic, planar)
    if n == 0:
        return np.zeros((0, 3))
    biggest = float(sigma.max())
    room = np.where(periodic, sides, sides - biggest)
    best: tuple[float, tuple[int, int, int], Array] | None = None
    axes = [0, 2] if planar else [0, 1, 2]
    ideal = (2.0 * n / math.prod(max(float(room[a]), 0.3 * biggest) for a in axes)) ** (1.0 / len(axes))
    stretch = {0: 3.0 ** (0.25), 2: 3.0 ** (-0.25)} if planar else {}
    choices = []
    for axis in range(3):
        if axis not in axes:
            choices.append([1])
            continue
        middle = int(room[axis] * ideal * stretch.get(axis, 1.0))
        options = [g for g in range(max(middle - 3, 1), middle + 5) if not periodic[axis] or (g > 0 and g % 2 == 0)]
        choices.append(options or [2])
    for gx in choices[0]:
        for gy in choices[1]:
            for gz in choices[2]:
                if -(-gx * gy * gz // 2) < n:
                    continue
                grid = (gx, gy, gz)
                step = np.array([room[a] / (g if periodic[a] else max(g - 1, 1)) for a, g in enumerate(grid)])
                many = [a for a in axes if grid[a] > 1]
                gaps = [2.0 * step[a] for a in many if grid[a] > 2]
                gaps += [math.hypot(step[a], step[b]) for k, a in enumerate(many) for b in many[k + 1 :]]
                if planar and len(many) == 2:
                    gaps = [math.hypot(step[0], step[2]), *[2.0 * step[a] for a in many if grid[a] > 2]]
                gap = min(gaps, default=math.inf)
                if best is None or gap > best[0]:
                    best = (gap, grid, step)
    if best is None or best[0] < biggest * (1.0 - 1e-12):
        phi = packing_fraction(list(sides), sigma, planar=planar)
        raise PackingError(
            f"no lattice in this box holds {n} molecules of diameter up to {biggest:.4g} (they fill {phi:.3g} of the "
            "space): take fewer or smaller molecules, or a larger box"
        )
    _, grid, step = best
    index = np.stack(np.meshgrid(*[np.arange(g) for g in grid], indexing="ij"), axis=-1).reshape(-1, 3)
    sites = index[index.sum(axis=1) % 2 == 0] * step + np.where(periodic, 0.25 * step, 0.5 * biggest)
    if planar:
        sites[:, 1] = 0.5 * sides[1]
    chosen = np.arange(n) if rng is None else np.sort(rng.choice(len(sites), n, replace=False))
    return np.asarray(sites[chosen], np.float64)


def _too_dense(n: int, sides: Array, sigma: Array, planar: bool) -> PackingError:
    """Return the refusal of what only a lattice could hold."""
    phi = packing_fraction(list(sides), sigma, planar=planar)
    return PackingError(
        f"{n} molecules fill {phi:.3g} of the space, too much for a random start: "
        "take fewer or smaller molecules, a larger box, or a lattice start"
    )


def _refuse_impossible(sides: Array, sigma: Array, periodic: tuple[bool, bool, bool], planar: bool) -> None:
    """Refuse what geometry alone forbids."""
    if not (np.isfinite(sides).all() and (sides > 0.0).all()):
        raise RefusedError(f"length = {sides.tolist()}: give three sides, each above 0")
    if not (np.isfinite(sigma).all() and (sigma >= 0.0).all()):
        raise RefusedError("diameters must be finite and 0 or above")
    if sigma.size == 0:
        return
    biggest = float(sigma.max())
    for axis in range(3):
        if not periodic[axis] and sides[axis] < biggest:
            raise PackingError(
                f"a molecule of diameter {biggest:.6g} does not fit into a box of side {sides[axis]:.6g}"
            )
    phi = packing_fraction(list(sides), sigma, planar=planar)
    densest = _DENSEST_PLANE if planar else _DENSEST
    if (phi > densest * (1.0 + 1e-9) and np.ptp(sigma) == 0.0) or phi >= 1.0:
        raise PackingError(
            f"{sigma.size} molecules would fill {phi:.3g} of the space, and no packing of spheres fills more than "
            f"{densest:.3g}: take fewer or smaller molecules, or a larger box"
        )


@kernel
def _push_pair(x, radius, low, high, turn, gap, moves, i, j):
    """Push two molecules apart if they overlap; return whether they did."""
    dx = x[j, 0] - x[i, 0]
    dy = x[j, 1] - x[i, 1]
    dz = x[j, 2] - x[i, 2]
    if turn[0] > 0.0:
        dx -= turn[0] * np.rint(dx / turn[0])
    if turn[1] > 0.0:
        dy -= turn[1] * np.rint(dy / turn[1])
    if turn[2] > 0.0:
        dz -= turn[2] * np.rint(dz / turn[2])
    touching = radius[i] + radius[j]
    square = dx * dx + dy * dy + dz * dz
    if square >= (touching * (1.0 + 0.5 * gap)) ** 2:
        return 0
    distance = math.sqrt(square)
    wanted = touching * (1.0 + gap)
    if distance < 1e-9 * wanted:
        dx, dy, dz, distance = wanted * 1e-3, 0.0, wanted * 1e-3, wanted * 1.5e-3
    # a little more than needed, the larger sphere moving less
    push = 1.05 * (wanted - distance) / distance
    share = radius[j] ** 3 / (radius[i] ** 3 + radius[j] ** 3)
    for axis in range(3):
        d = dx if axis == 0 else (dy if axis == 1 else dz)
        x[i, axis] -= share * push * d
        x[j, axis] += (1.0 - share) * push * d
        for k in (i, j):
            if turn[axis] > 0.0:
                x[k, axis] -= turn[axis] * math.floor(x[k, axis] / turn[axis])
            else:
                x[k, axis] = min(max(x[k, axis], low[k, axis]), high[k, axis])
    moves[i] = True
    moves[j] = True
    return 1


@kernel(entry=True, allocates=True)
def _push_apart(x, radius, low, high, turn, rounds, gap):
    """Push overlapping molecules apart, some rounds; return how many pairs were pushed in the last one.

    Only pairs of which one has just moved are looked at again, so that late rounds cost little.
    """
    n = radius.size
    widest = 2.0 * radius.max() * (1.0 + gap)
    number = np.ones(3, np.int64)
    origin = np.zeros(3)
    size = np.ones(3)
    most = max(int((2.0 * n) ** 0.5), 4)
    for axis in range(3):
        if turn[axis] > 0.0:
            size[axis] = turn[axis]
        else:
            origin[axis] = low[:, axis].min()
            size[axis] = max(high[:, axis].max() - origin[axis], 1e-300)
        number[axis] = max(1, min(int(size[axis] / widest), most))
        if turn[axis] > 0.0 and number[axis] < 3:
            number[axis] = 1
    while number[0] * number[1] * number[2] > 4 * n + 64:
        number[np.argmax(number)] = max(1, number.max() // 2)
        for axis in range(3):
            if turn[axis] > 0.0 and number[axis] < 3:
                number[axis] = 1
    head = np.empty(number[0] * number[1] * number[2], np.int64)
    follower = np.empty(n, np.int64)
    place = np.empty((n, 3), np.int64)
    moved = np.ones(n, np.bool_)
    moves = np.zeros(n, np.bool_)
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
                                pushed += _push_pair(x, radius, low, high, turn, gap, moves, i, j)
                            j = follower[j]
        if pushed == 0:
            break
        moved[:] = moves
    return pushed
