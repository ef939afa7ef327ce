"""What is left out of the page of a large run, so that it can be sent by e-mail and a school's computer can draw it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["MOST", "Share", "chosen", "share"]

MOST = 5000
"""Greatest number of molecules that are drawn; a computer without a graphics card is fast enough for this number."""

_ROOM = 850_000  # molecules times frames of a page of 10 MB
_ENOUGH = 240  # frames; a page with fewer would rather leave out molecules

Indices = NDArray[np.intp]


class Share(NamedTuple):
    """Numbers of molecules and frames of a run that a page holds."""

    molecules: int
    frames: int


def share(molecules: int, frames: int, runs: int = 1) -> Share:
    """Return how many molecules and frames of a run fit into a page.

    Parameters
    ----------
    molecules, frames : int
        Numbers of molecules and frames of the run.
    runs : int
        Number of runs on the page.

    Returns
    -------
    Share
        The numbers that are kept. First, molecules beyond `MOST` are left out, then frames, down to 240, then more
        molecules.

    Examples
    --------
    >>> share(800, 400), share(10_000, 240), share(200, 100_000)
    (Share(molecules=800, frames=400), Share(molecules=3541, frames=240), Share(molecules=200, frames=4250))
    """
    room = _ROOM // runs
    kept = max(1, min(molecules, MOST, room // max(1, min(frames, _ENOUGH))))
    return Share(kept, max(1, min(frames, room // kept)))


def chosen(count: int, most: int, water: NDArray[np.bool_] | None = None) -> Indices:
    """Return which molecules are drawn, evenly spaced in the list of all molecules.

    Parameters
    ----------
    count : int
        Number of molecules.
    most : int
        Greatest number of molecules that are drawn.
    water : (molecule,), optional
        Whether each molecule is water. All molecules of water are drawn if they are at most half of ``most``.

    Returns
    -------
    ndarray of int
        Indices of the molecules that are drawn, in ascending order.

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
    """Return at most ``most`` of the whole numbers below ``count``, evenly spaced."""
    if count <= most:
        return np.arange(count)
    return np.unique(np.rint(np.linspace(0, count - 1, most)).astype(np.intp))
