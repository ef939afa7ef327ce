"""Positions of the molecules at the start, on a lattice: for packing fractions too high for random positions."""

import itertools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.elementary import root
from atmosbox.engine.core.packing import packing_fraction, refuse_impossible
from atmosbox.engine.core.random import Source
from atmosbox.engine.core.refusal import PackingError

Array = NDArray[np.float64]


def lattice_positions(
    length: Sequence[float],
    diameter: ArrayLike,
    *,
    periodic: tuple[bool, bool, bool] = (False, False, False),
    planar: bool = False,
    rng: Source | None = None,
) -> Array:
    """Place molecules on a face-centred lattice (in a plane, a centred rectangular one) that fills the box.

    Parameters
    ----------
    length, diameter, periodic, planar
        As in `atmosbox.engine.start.scatter.random_positions`.
    rng
        Random numbers that choose the sites if there are more sites than molecules; without it the first are taken.

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
    A cube of 4 unit cells a side, at a packing fraction at which hard spheres are a crystal:

    >>> sites = lattice_positions((6.0, 6.0, 6.0), np.ones(256), periodic=(True, True, True))
    >>> sites.shape, round(packing_fraction((6, 6, 6), np.ones(256)), 2)
    ((256, 3), 0.62)
    """
    sigma = np.atleast_1d(np.asarray(diameter, np.float64))
    n = sigma.size
    sides = np.array(length, np.float64)
    refuse_impossible(sides, sigma, periodic, planar)
    if n == 0:
        return np.zeros((0, 3))
    biggest = float(sigma.max())
    room = np.where(periodic, sides, sides - biggest)
    best: tuple[float, tuple[int, ...], Array] | None = None
    axes = [0, 2] if planar else [0, 1, 2]
    ideal = float(root(2.0 * n / math.prod(max(float(room[a]), 0.3 * biggest) for a in axes), len(axes)))
    wide = math.sqrt(math.sqrt(3.0))
    stretch = {0: wide, 2: 1.0 / wide} if planar else {}
    choices = []
    for axis in range(3):
        if axis not in axes:
            choices.append([1])
            continue
        middle = int(room[axis] * ideal * stretch.get(axis, 1.0))
        options = [g for g in range(max(middle - 3, 1), middle + 5) if not periodic[axis] or (g > 0 and g % 2 == 0)]
        choices.append(options or [2])
    for grid in itertools.product(*choices):
        if -(-math.prod(grid) // 2) < n:
            continue
        step = np.array([room[a] / (g if periodic[a] else max(g - 1, 1)) for a, g in enumerate(grid)])
        many = [a for a in axes if grid[a] > 1]
        gaps = [2.0 * step[a] for a in many if grid[a] > 2]
        gaps += [math.sqrt(step[a] * step[a] + step[b] * step[b]) for a, b in itertools.combinations(many, 2)]
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
    chosen = np.arange(n) if rng is None else np.sort(np.argsort(rng.random(len(sites)), kind="stable")[:n])
    return np.asarray(sites[chosen], np.float64)
