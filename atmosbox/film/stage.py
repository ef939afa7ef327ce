"""The box with its molecules, as a camera in front of it sees them."""

from __future__ import annotations

from typing import Any

import matplotlib
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.colors import Normalize, to_rgba
from matplotlib.path import Path
from matplotlib.transforms import IdentityTransform
from numpy.typing import NDArray

from atmosbox.film.camera import EDGES, FACES, View, corners
from atmosbox.film.film_box import Box
from atmosbox.plot.plane import colour_scale
from atmosbox.plot.theme import DARK, FAINT, FIELD_COLOURS, PALE, Theme

__all__ = ["Stage", "legend"]

_, _ORANGE, _SKY, _, _, _BLUE, _VERMILLION, _ = matplotlib.color_sequences["okabe_ito"]
_WALL, _POOL, _WARM, _COLD = (to_rgba("#efefef"), to_rgba(_SKY, 0.55), to_rgba(_ORANGE, 0.32), to_rgba(_SKY, 0.32))
_LID = to_rgba("#8c8c8c", 0.35)
_DROP = to_rgba(_SKY, 0.9)
_ROUND = Path.unit_circle()
_NAMES = ("left wall", "right wall", "front wall", "back wall", "floor", "ceiling")


class Stage:
    """The box and its molecules in axes.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw; they stay where they are.
    box : Box
        What to draw.
    look : Theme
        How large.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from atmosbox.plot.theme import THEMES
    >>> still = Box(np.full((1, 1, 3), 15.0), np.full((1, 1), 500.0), np.ones(1), np.zeros(1, bool),
    ...             np.full((1, 3), 30.0), ("specular",) * 6, np.full((1, 6), np.nan), np.zeros((1, 0, 4)), None,
    ...             "nm", 2.7, 1)
    >>> stage = Stage(Figure().add_axes((0.0, 0.0, 1.0, 1.0)), still, THEMES["notes"])
    >>> [type(artist).__name__ for artist in stage.artists(0)]
    ['PolyCollection', 'LineCollection', 'PathCollection', 'PolyCollection', 'LineCollection']
    """

    def __init__(self, axes: Axes, box: Box, look: Theme) -> None:
        self.axes, self.box, self.look = axes, box, look
        self.largest = box.side[np.argmax(box.side[:, 2])]
        self.view = View(self.largest)
        self.norm: Normalize = colour_scale(box.speed[np.isfinite(box.speed)].astype(np.float64))
        self.colours = matplotlib.colormaps[FIELD_COLOURS]
        low, high = self.view.limits(self.largest)
        self._fit(low, high)
        if "piston" in box.walls:  # the room that the piston may yet give
            edge = [(a, a + 1) for a in (0, 2, 4, 6)]
            ends = self.view.project(corners(self.largest))[0]
            axes.add_collection(
                LineCollection([ends[list(pair)] for pair in edge], colors=PALE, linewidths=look.line / 2)
            )
        edges: dict[str, Any] = {"linewidths": look.line / 1.5, "colors": FAINT}
        self.back = PolyCollection([], linewidths=0.0)
        self.far = LineCollection([], **edges)
        self.molecules = PathCollection(
            [_ROUND], sizes=[1.0], offsets=np.zeros((0, 2)), offset_transform=axes.transData
        )
        self.molecules.set_transform(IdentityTransform())
        self.lid = PolyCollection([], linewidths=0.0)
        self.near = LineCollection([], **edges)
        for artist in self._all:
            axes.add_collection(artist, autolim=False)
            artist.set_animated(True)

    @property
    def _all(self) -> tuple[PolyCollection | LineCollection | PathCollection, ...]:
        return self.back, self.far, self.molecules, self.lid, self.near

    def _fit(self, low: NDArray[np.float64], high: NDArray[np.float64]) -> None:
        """Let the largest box fill the axes, alike in both directions."""
        frame = self.axes.get_window_extent()
        dpi = self.axes.figure.dpi
        room = 1.02 * max((high[0] - low[0]) / frame.width, (high[1] - low[1]) / frame.height)  # of a pixel [unit]
        middle = (low + high) / 2
        self.axes.set_xlim(middle[0] - room * frame.width / 2, middle[0] + room * frame.width / 2)
        self.axes.set_ylim(middle[1] - room * frame.height / 2, middle[1] + room * frame.height / 2)
        self.axes.set_axis_off()
        self.points = 72.0 / dpi / room  # points on the page of a unit of length in the middle of the box

    def artists(self, frame: int) -> list[Artist]:
        """Return what is to be drawn of a frame, from the back to the front."""
        box, seen = self.box, self.view.project(corners(self.box.side[frame]))[0]
        self._put_walls(frame, seen)
        self._put_molecules(frame)
        lid = [seen[list(FACES[5])]] if box.walls[5] == "piston" else []
        self.lid.set_verts(lid)
        self.lid.set_facecolor([_LID] * len(lid))
        return [*self._all]

    def _put_walls(self, frame: int, seen: NDArray[np.float64]) -> None:
        """Place the walls behind the molecules, and the edges behind and before them."""
        walls = [wall for wall in range(6) if self.view.far(wall)]
        self.back.set_verts([seen[list(FACES[wall])] for wall in walls])
        self.back.set_facecolor([_tint(self.box, frame, wall) for wall in walls])
        behind: list[tuple[Any, Any]] = []
        before: list[tuple[Any, Any]] = []
        for a, b in EDGES:
            meeting = [wall for wall in range(6) if {a, b} <= set(FACES[wall])]
            dashed = all(self.box.walls[wall] == "periodic" for wall in meeting)
            edge = (seen[[a, b]], (0.0, (3.0, 2.0)) if dashed else "solid")
            (behind if any(self.view.far(wall) for wall in meeting) else before).append(edge)
        for collection, edges in ((self.far, behind), (self.near, before)):
            collection.set_segments([ends for ends, _ in edges])
            collection.set_linestyle([dashes for _, dashes in edges])

    def _put_molecules(self, frame: int) -> None:
        """Place molecules and drops, what is behind first."""
        box, drops = self.box, self.box.drops[frame]
        here = np.isfinite(box.position[frame, :, 0])
        drops = drops[np.isfinite(drops).all(axis=1)]
        places = np.concatenate([box.position[frame, here], drops[:, :3]])
        wide = np.concatenate([box.diameter[here], 2.0 * drops[:, 3]])
        fill = np.concatenate([self.colours(self.norm(box.speed[frame, here])), np.tile(_DROP, (len(drops), 1))])
        water = np.concatenate([box.water[here], np.ones(len(drops), bool)])
        on_page, scale = self.view.project(places)
        order = np.argsort(scale, kind="stable")
        points = (wide * scale * self.points)[order]
        rim = np.where(water[order], 0.9, 0.35) * self.look.line * np.minimum(1.0, points / (3.0 * self.look.line))
        self.molecules.set_offsets(on_page[order])
        self.molecules.set_sizes((points / 2) ** 2, dpi=self.axes.figure.dpi)
        self.molecules.set_facecolor([*fill[order]])
        self.molecules.set_edgecolor([*np.where(water[order, None], to_rgba(_VERMILLION), to_rgba(DARK, 0.75))])
        self.molecules.set_linewidth(rim)


def _tint(box: Box, frame: int, wall: int) -> tuple[float, float, float, float]:
    """Return the colour of a wall: orange where a heat bath keeps it warm, blue where it is the coldest of several."""
    if box.walls[wall] == "pool":
        return _POOL
    if box.walls[wall] != "heat_bath":
        return (1.0, 1.0, 1.0, 0.0) if box.walls[wall] == "periodic" else _WALL
    baths = box.wall_temperature[frame]
    return _COLD if baths[wall] < 0.5 * (np.nanmin(baths) + np.nanmax(baths)) else _WARM


def legend(box: Box) -> list[str]:
    r"""Return what small type says of walls, molecules and drops.

    Parameters
    ----------
    box : Box
        What is drawn.

    Returns
    -------
    list of str
        A few words for each thing.

    Examples
    --------
    >>> still = Box(np.zeros((1, 1, 3)), np.zeros((1, 1)), np.ones(1), np.zeros(1, bool), np.full((1, 3), 30.0),
    ...             ("periodic",) * 4 + ("heat_bath", "specular"), np.array([[np.nan] * 4 + [288.15, np.nan]]),
    ...             np.zeros((1, 0, 4)), None, "nm", 2.7, 1)
    >>> legend(still)
    ['molecules drawn 2.7 times as wide as those of air', 'orange: floor kept at 15\xa0°C', 'dashed: periodic sides']
    """
    shown = box.position.shape[1]
    few = "" if shown == box.molecules else f"{shown} of {box.molecules} "
    words = [f"{few}{box.exaggeration}"]
    words += _baths(box)
    words += ["blue floor: water"] if "pool" in box.walls else []
    words += ["grey lid: piston"] if "piston" in box.walls else []
    words += ["dashed: periodic sides"] if "periodic" in box.walls else []
    words += ["red rims: water"] if box.water.any() else []
    return words + (["blue balls: drops"] if box.drops.shape[1] else [])


def _baths(box: Box) -> list[str]:
    """Return what the heat baths are kept at, at the start."""
    baths = [wall for wall in range(6) if box.walls[wall] == "heat_bath"]
    groups: dict[tuple[str, int], list[str]] = {}
    for wall in baths:
        colour = "blue" if _tint(box, 0, wall) == _COLD else "orange"
        groups.setdefault((colour, round(float(box.wall_temperature[0, wall]) - 273.15)), []).append(_NAMES[wall])
    steady = np.ptp(box.wall_temperature[:, baths], axis=0).max() < 0.5 if baths else True
    kept = "kept at" if steady else "at first"
    return [
        f"{colour}: {'all walls' if len(names) == 6 else ' and '.join(names)} {kept} {degrees}\u00a0°C".replace(
            "-", "−"
        )
        for (colour, degrees), names in groups.items()
    ]
