"""Positions of the molecules at the start, at random: those of a gas in equilibrium.

Molecules too dense for random positions are refused within a second, with the reason.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.elementary import exp, expm1, log1p
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.packing import packing_fraction, refuse_impossible
from atmosbox.engine.core.random import RandomNumbers, Source, uniform
from atmosbox.engine.core.refusal import PackingError, RefusedError
from atmosbox.engine.start.overlap import bins_of, enter, is_free, leave, push, spheres_of

Array = NDArray[np.float64]
SERIES = float(1 << 53)
"""Number of series of random numbers with which molecules may be placed (not as a power: C libraries round powers)."""
_TRIES = 500
"""How many places are drawn for a molecule before the gas is called dense; where it fills 0.3, 1 in 130 is free."""
_ROUNDS = 800
_GROWTH, _MOVES, _STEP = 1.01, 25, 0.1
"""By how much the molecules of a dense gas grow at a time, how often each is moved then, and how far, in diameters."""
_DENSEST_RANDOM = 0.56
_DENSEST_RANDOM_PLANE = 0.74


@kernel
def _drawn(i, spheres, scale_height, state):
    """Return a random position of molecule i, whether or not it is free."""
    low, high = spheres.low, spheres.high
    x = low[i, 0] + uniform(state) * (high[i, 0] - low[i, 0])
    y = low[i, 1] + uniform(state) * (high[i, 1] - low[i, 1])
    share, height = uniform(state), high[i, 2] - low[i, 2]
    if scale_height > 0.0:
        return x, y, low[i, 2] - scale_height * log1p(share * expm1(-height / scale_height))
    return x, y, low[i, 2] + share * height


@kernel(entry=True)
def scatter(spheres, bins, scale_height, state):
    """Place molecules at random where they overlap none, twice; return False as soon as one finds no place at first.

    ``scale_height`` is 0 in a gas that is spread evenly; ``state : (1,)`` is the state of the random numbers.
    """
    x, order = spheres.x, spheres.order
    bins.head[:] = -1
    for k in range(2 * order.size):
        i, again = order[k % order.size], k >= order.size
        found = False
        for _ in range(_TRIES):
            one, two, three = _drawn(i, spheres, scale_height, state)
            found = is_free(i, one, two, three, spheres, bins)
            if found:
                if again:
                    leave(i, spheres, bins)
                x[i, 0], x[i, 1], x[i, 2] = one, two, three
                enter(i, spheres, bins)
                break
        if not (found or again):
            return False
    return True


@kernel
def _beside(i, axis, spheres, state):
    """Return a coordinate of molecule i after a small step along an axis, and whether it may be there."""
    u, low, high, turn = spheres.x[i, axis], spheres.low[i, axis], spheres.high[i, axis], spheres.turn[axis]
    step = _STEP * 2.0 * spheres.radius[i] if high > low else 0.0
    u += step * (2.0 * uniform(state) - 1.0)
    if turn > 0.0:
        u -= turn * math.floor(u / turn)
    return u, low <= u <= high


@kernel
def _settle(spheres, bins, scale_height, state):
    """Move each molecule to places beside its own, again and again, wherever it overlaps none there."""
    x, number = spheres.x, spheres.order.size
    for k in range(_MOVES * number):
        i = k % number
        one, inside_x = _beside(i, 0, spheres, state)
        two, inside_y = _beside(i, 1, spheres, state)
        three, inside_z = _beside(i, 2, spheres, state)
        if not (inside_x and inside_y and inside_z):
            continue
        # upwards only as often as the air thins out
        if scale_height > 0.0 and uniform(state) >= exp(min((x[i, 2] - three) / scale_height, 0.0)):
            continue
        if is_free(i, one, two, three, spheres, bins):
            leave(i, spheres, bins)
            x[i, 0], x[i, 1], x[i, 2] = one, two, three
            enter(i, spheres, bins)


@kernel(entry=True)
def crowd(spheres, bins, scale_height, state):
    """Place the molecules of a gas that is too dense for `scatter`: place smaller ones, and let these grow."""
    radius, size = spheres.radius, spheres.size
    shrunk, growing = 0, False
    while not growing or shrunk > 0:
        shrunk += -1 if growing else 1
        share = 1.0
        for _ in range(shrunk):
            share /= _GROWTH
        for i in range(radius.size):
            radius[i] = share * size[i]
        if not growing:
            growing = scatter(spheres, bins, scale_height, state)
            continue
        if push(spheres, bins, _ROUNDS) > 0:
            for i in range(radius.size):
                radius[i] = size[i]
            return False
        _settle(spheres, bins, scale_height, state)
    return True


def random_positions(
    length: Sequence[float],
    diameter: ArrayLike,
    rng: Source,
    *,
    periodic: tuple[bool, bool, bool] = (False, False, False),
    planar: bool = False,
    top: float | None = None,
    scale_height: float | None = None,
    apart: bool = True,
) -> Array:
    """Return random positions of molecules that do not overlap, as in a gas in equilibrium.

    Parameters
    ----------
    length
        The three sides of the box [length].
    diameter : (molecule,)
        Diameters [length], one for each molecule.
    rng
        Random numbers.
    periodic
        Whether each axis is periodic.
    planar
        Whether all centres lie in the plane y = half the box.
    top
        Only heights below this one are used [length]; the whole box by default.
    scale_height
        If given, the density decreases with height as in an isothermal atmosphere of this scale height [length].
    apart
        Whether molecules must not overlap; without it nothing is compiled, but no engine takes the result.

    Returns
    -------
    (molecule, axis) ndarray
        Centres [length].

    Raises
    ------
    PackingError
        If they do not fit at random; a regular lattice reaches higher packing fractions.

    Notes
    -----
    All arrangements without overlap are equally likely in equilibrium (with ``scale_height``, weighted by exp(-z / H)).
    The molecules, from the largest to the smallest, are placed where they overlap none before them. In that alone
    (random sequential addition) too few pairs are close to each other. So each is then taken out and placed once more,
    which brings the number of close pairs, and with it the collision rate from the first moment on, to that of
    equilibrium within the errors of measurement (1 %, for packing fractions up to 0.3).

    If a molecule finds no place in 500 tries, the gas is dense. Then smaller molecules are placed, which grow to their
    size in steps of 1 %; in each step those that overlap are pushed apart, and each makes 25 small random moves. That
    works up to packing fractions of 0.56 (in a plane 0.74). The collision rate is then too high at the start, by 2 % at
    0.3, 6 % at 0.4 and 80 % at 0.49, close to freezing: let such a gas run for some mean free times first.

    Examples
    --------
    >>> from atmosbox.engine.core.random import RandomNumbers
    >>> where = random_positions((5, 5, 5), np.ones(20), RandomNumbers(1))
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
    refuse_impossible(sides, sigma, periodic, planar)
    spheres = spheres_of(sigma, sides, periodic, planar)
    if n and np.ptp(sigma) == 0.0:
        phi = packing_fraction(list(sides), sigma, planar=planar)
        if phi > (_DENSEST_RANDOM_PLANE if planar else _DENSEST_RANDOM):
            raise _too_dense(n, sides, sigma, planar)
    if n == 0 or not apart:
        rng.random(1)
        return np.asarray(spheres.low + RandomNumbers(0).random((n, 3)) * (spheres.high - spheres.low))
    thinned = float(scale_height) if scale_height is not None and math.isfinite(scale_height) else 0.0
    # a single number begins a series of its own: how many places are tried depends on the molecules
    given = spheres, bins_of(spheres), thinned, (rng.random(1) * SERIES).astype(np.uint64)
    if not (scatter(*given) or crowd(*given)):
        raise _too_dense(n, sides, sigma, planar)
    return np.asarray(spheres.x)


def _too_dense(n: int, sides: Array, sigma: Array, planar: bool) -> PackingError:
    """Return the refusal of a packing fraction that only a lattice could reach."""
    phi = packing_fraction(list(sides), sigma, planar=planar)
    return PackingError(
        f"{n} molecules fill {phi:.3g} of the space, too much for a random start: "
        "take fewer or smaller molecules, a larger box, or a lattice start"
    )
