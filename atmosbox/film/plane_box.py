"""The discs of a flat scene in their box, seen from above."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from atmosbox.plot.disc_marker import put_discs, trails
from atmosbox.plot.plane import Discs
from atmosbox.plot.theme import Theme

__all__ = ["Table"]


class Table:
    """The discs of a flat scene in axes.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    discs : Discs
        What to draw.
    look : Theme
        How large.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from atmosbox.plot.theme import THEMES
    >>> one = Discs(np.ones((1, 1, 2)), np.ones((1, 1)), np.ones(1), np.ones(1), np.array([[0, 0], [2, 2]]), "m s-1")
    >>> len(Table(Figure().add_subplot(), one, THEMES["notes"]).artists(0))
    1
    """

    def __init__(self, axes: Axes, discs: Discs, look: Theme) -> None:
        self.axes, self.found, self.look = axes, discs, look
        self.discs = put_discs(axes, discs, look)
        self.discs.set_animated(True)
        axes.set_anchor("C")
        axes.set_xticks([])
        axes.set_yticks([])
        self.norm, self.colours = self.discs.norm, self.discs.cmap
        self.trail: Artist | None = None

    def artists(self, frame: int) -> list[Artist]:
        """Return what is to be drawn of a frame, from the back to the front."""
        if self.trail is not None:
            self.trail.remove()
        trail = trails(self.found.place[: frame + 1], self.found.box, self.look)
        if trail is not None:
            self.axes.add_collection(trail, autolim=False)
            trail.set_animated(True)
        self.trail = trail
        self.discs.set_offsets(self.found.place[frame])
        self.discs.set_array(self.found.speed[frame])
        return [self.discs] if trail is None else [trail, self.discs]

    @property
    def step(self) -> float:
        """How far a disc typically is from where it was in the frame before, in sides of the box."""
        if len(self.found.place) < 2:
            return 1.0
        moved = np.linalg.norm(np.diff(self.found.place, axis=0), axis=2)
        return float(np.median(moved) / np.max(self.found.box[1] - self.found.box[0]))
