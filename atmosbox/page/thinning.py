"""What a page leaves out of a large run, so that it can still be mailed and a school's computer can draw it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["MOST", "Share", "chosen", "share"]

MOST = 5000
"""So many molecules are drawn at most: a computer that draws without a graphics card keeps up with them."""

_ROOM = 850_000  # molecules times frames, which make a page of 10 MB
_ENOUGH = 240  # frames, before which molecules are left out

Indices = NDArray[np.intp]


class Share(NamedTuple):
    """How many molecules and frames of a run a page holds."""

    molecules: int
    frames: int


def share(molecules: int, frames: int, runs: int = 1) -> Share:
    """Return how much of a run fits into a page.

    Parameters
    ----------
    molecules, frames : int
        How many the run has.
    runs : int
        How many runs share the page.

    Returns
    -------
    Share
        How many are kept. First molecules beyond `MOST` are left out, then frames, down to 240, then molecules
        again.

    Examples
    --------
    >>> share(800, 400), share(10_000, 240), share(200, 100_000)
    (Share(molecules=800, frames=400), Share(molecules=3541, frames=240), Share(molecules=200, frames=4250))
    """
    room = _ROOM // runs
    kept = max(1, min(molecules, MOST, room // max(1, min(frames, _ENOUGH))))
    return Share(kept, max(1, min(frames, room // kept)))


def chosen(count: int, most: int, water: NDArray[np.bool_] | None = None) -> Indices:
    """Return which molecules are drawn, evenly spaced in the list of all.

    Parameters
    ----------
    count : int
        How many there are.
    most : int
        How many may be drawn.
    water : (molecule,), optional
        Which are water; as long as these are no more than half of those drawn, all of them are drawn.

    Returns
    -------
    ndarray of int
        Their indices, rising.

    Examples
    --------
    >>> chosen(6, 3).tolist(), chosen(6, 3, np.arange(6) == 5).tolist()
    ([0, 2, 5], [0, 4, 5])
    """
    if count <= most:
        return np.arange(count)
    if water is None or not water.any():
        return _even(count, most)
    wet, dry = np.flatnonzero(water), np.flatnonzero(~water)
    kept = max(min(len(wet), most // 2), most - len(dry))
    parts = (wet[_even(len(wet), kept)], dry[_even(len(dry), most - kept)])
    return np.sort(np.concatenate(parts))


def _even(count: int, most: int) -> Indices:
    """Return so many of the numbers below a count, evenly spaced."""
    if count <= most:
        return np.arange(count)
    return np.unique(np.rint(np.linspace(0, count - 1, most)).astype(np.intp))
