"""Which frames of a run a film shows, and how many a second."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import Option, SettingError

__all__ = ["Pace", "pace"]

SECONDS = 12.0
"""Default duration of a film [s]; it is shorter for a run of few frames."""
SMOOTH, APART = 20.0, 10.0
"""Default pictures a second if molecules move little from frame to frame, and if they move far."""
FASTEST, LONGEST = 50.0, 3600.0
"""Greatest number of pictures a second, and greatest duration of a film [s]."""
MOST = 5000
"""Greatest number of pictures of a film."""


@dataclass(frozen=True)
class Pace:
    """The frames of a run that a film shows, and how many a second.

    Parameters
    ----------
    frames : ndarray of int, (picture,)
        The frames of the run, in order.
    fps : float
        Pictures a second.

    Examples
    --------
    >>> Pace(np.arange(40), 10.0).seconds
    4.0
    """

    frames: NDArray[np.int64]
    fps: float

    @property
    def seconds(self) -> float:
        """Duration of the film [s]."""
        return self.frames.size / self.fps


def pace(
    frames: int,
    *,
    fps: float | None = None,
    seconds: float | None = None,
    smooth: bool = False,
    along: NDArray[np.float64] | None = None,
) -> Pace:
    """Choose evenly spaced frames of a run, including the last one, for a film of the wanted duration.

    Parameters
    ----------
    frames : int
        Number of frames of the run.
    fps : float, optional
        Pictures a second; by default 10, or 20 if ``smooth``.
    seconds : float, optional
        Duration of the film [s]; by default 12, or less if the run has too few frames.
    smooth : bool
        Whether molecules move little from one frame to the next.
    along : ndarray of float, (frame,), optional
        A quantity that increases by even steps from picture to picture, for instance the logarithm of time; by default
        the index of the frame.

    Returns
    -------
    Pace
        The frames. If ``seconds`` is given and ``fps`` is not, a run of few frames is shown with fewer pictures a
        second.

    Raises
    ------
    SettingError
        If ``fps`` or ``seconds`` is outside its range, or the film would have too many pictures.

    Examples
    --------
    >>> pace(1000).frames.size, pace(40).seconds, pace(40, seconds=8.0).fps
    (120, 4.0, 5.0)

    Along the logarithm of time, half of the pictures show the first of two decades:

    >>> early = pace(100, seconds=2.0, along=np.log(np.arange(1.0, 101.0))).frames < 10
    >>> float(early.mean())
    0.5
    """
    if fps is not None and not 0.1 <= fps <= FASTEST:
        raise SettingError("fps", fps, f"is not between 0.1 and {FASTEST:g} pictures a second", Option("fps", 10))
    if seconds is not None and not 0.1 <= seconds <= LONGEST:
        raise SettingError("seconds", seconds, f"is not between 0.1 and {LONGEST:g} seconds", Option("seconds", 12))
    rate = fps or (SMOOTH if smooth else APART)
    if seconds is not None and fps is None:
        rate = min(rate, max(frames / seconds, 0.1))
    number = min(frames, max(1, round(rate * (seconds or SECONDS))))
    if number > MOST:
        problem = f"at {rate:g} pictures a second are {number} pictures, more than the {MOST} that a film may have"
        raise SettingError("seconds", seconds, problem, Option("seconds", math.floor(MOST / rate)), " or less")
    if along is not None and frames > 1:
        wanted = np.linspace(along[0], along[-1], number)
        return Pace(np.interp(wanted, along, np.arange(frames)).round().astype(np.int64), rate)
    return Pace(np.linspace(frames - 1, 0, number).round().astype(np.int64)[::-1], rate)
