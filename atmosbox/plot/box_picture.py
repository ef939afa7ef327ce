"""The box of a saved run in perspective: walls, piston, molecules and drops; or the discs of a planar scene."""

from __future__ import annotations

import math
from typing import Any

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.colors import Normalize, to_rgba
from matplotlib.path import Path
from matplotlib.transforms import IdentityTransform
from numpy.typing import NDArray

from atmosbox.file.molecules import Molecules
from atmosbox.plot.curve import spelled
from atmosbox.plot.discs import DiscPicture, colour_scale
from atmosbox.plot.theme import DARK, FAINT, FIELD_COLOURS, OKABE_ITO, PALE, Theme
from atmosbox.theory.constants import DRY_AIR

Floats = NDArray[np.float64]

# Angles of the camera to the side and upward [rad], and its distance in units of the longest side of the box.
_TURN, _TILT, _DISTANCE = math.radians(24.0), math.radians(16.0), 4.5
# Indices of the four corners of each wall: x low, x high, y low, y high, z low, z high; and of the ends of each edge.
_FACES = ([0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5])
_EDGES = tuple([a, b] for a in range(8) for b in range(a + 1, 8) if (a ^ b).bit_count() == 1)
_BEHIND = (0, 3, 4)  # walls behind the molecules, seen from the camera
_NAMES = ("left wall", "right wall", "front wall", "back wall", "floor", "ceiling")

_MOST = 4000  # molecules that are drawn
_UNITS = {"nm": 1e-9, "um": 1e-6, "mm": 1e-3, "m": 1.0, "km": 1e3}
_NEIGHBOURS = 12.0  # upper end of the colour scale where colours show the number of neighbours
_SMALLEST = 0.18  # least diameter of a molecule in the picture, in spacings of a lattice of all drawn molecules
# Ratio of the drawn diameter to that of a molecule of air: below the first, the footer says "drawn to size"; from the
# second on, it gives the drawn diameter and not the ratio.
_TO_SIZE, _MANY_TIMES = 1.05, 1000.0

_, _ORANGE, _SKY, _, _, _, _VERMILLION, _ = OKABE_ITO
_WARM, _COLD, _DROP = to_rgba(_ORANGE, 0.32), to_rgba(_SKY, 0.32), to_rgba(_SKY, 0.9)
_WALL, _LID = to_rgba("#efefef"), to_rgba("#8c8c8c", 0.35)


def corners(side: Floats) -> Floats:
    """Return the eight corners of a box, (8, 3); z varies fastest from one corner to the next."""
    return np.array([[a, b, c] for a in (0.0, side[0]) for b in (0.0, side[1]) for c in (0.0, side[2])])


def project(position: Floats, side: Floats) -> tuple[Floats, Floats]:
    """Return positions in the picture (n, 2), and how large a unit of length is seen at each of them (n,).

    The camera looks at the middle of a box with these sides, a little from the side and from above. A nearer length is
    seen larger, and the wall y = 0 is in front:

    >>> _, scale = project(np.array([[0.5, 0.0, 0.5], [0.5, 1.0, 0.5]]), np.ones(3))
    >>> bool(scale[0] > scale[1])
    True
    """
    x, y, z = (np.asarray(position, dtype=np.float64) - side / 2).T
    away = y * math.cos(_TURN) - x * math.sin(_TURN)
    right = x * math.cos(_TURN) + y * math.sin(_TURN)
    up, depth = z * math.cos(_TILT) + away * math.sin(_TILT), away * math.cos(_TILT) - z * math.sin(_TILT)
    distance = _DISTANCE * float(side.max())
    scale = distance / (distance + depth)
    return np.column_stack((right, up)) * scale[:, None], scale


def box_picture(axes: Axes, dataset: xr.Dataset, held: Molecules, look: Theme) -> BoxPicture | DiscPicture:
    """Prepare axes for the box of a run; the method `show` of the result then draws any frame."""
    if not held.discs:
        return BoxPicture(axes, held, look)
    picture = DiscPicture(axes, held, look)
    axes.set_anchor("C")
    axes.set(xticks=[], yticks=[], xlabel=f"{picture.box[0]:g} {picture.unit}")
    return picture


class BoxPicture:
    """The box and its molecules in perspective; of more than 4000 only 4000 are drawn, at even steps of their index."""

    def __init__(self, axes: Axes, held: Molecules, look: Theme) -> None:
        self.axes, self.held, self.look = axes, held, look
        count, widest = held.position.shape[1], float(held.side.max())
        self.shown = np.unique(np.linspace(0, count - 1, min(count, _MOST)).round().astype(int))
        self.unit, self.metre = next((each for each in _UNITS.items() if widest < 1e3 * each[1]), ("km", 1e3))
        drawn = np.maximum(held.diameter[self.shown], _SMALLEST * widest / max(self.shown.size, 100) ** (1.0 / 3.0))
        self.diameter = drawn / self.metre
        self.water = np.zeros(self.shown.size, bool) if held.water is None else held.water[self.shown]
        self.largest = held.side[np.argmax(held.side[:, 2])] / self.metre
        self.tinted = held.speed if held.neighbours is None else held.neighbours
        self.norm = Normalize(0.0, _NEIGHBOURS)
        if held.neighbours is None:
            self.norm = colour_scale(held.speed[:, self.shown].astype(np.float64))
        axes.set_axis_off()
        if "piston" in held.walls:  # upright edges of the largest box, up to which the piston may rise
            ends = project(corners(self.largest), self.largest)[0]
            upright = [ends[[low, low + 1]] for low in (0, 2, 4, 6)]
            axes.add_collection(LineCollection(upright, colors=PALE, linewidths=look.line / 2), autolim=False)
        self._write_sides()
        edges: dict[str, Any] = {"linewidths": look.line / 1.5, "colors": FAINT}
        self.back, self.lid = PolyCollection([], linewidths=0.0), PolyCollection([], linewidths=0.0, facecolor=_LID)
        self.far, self.near = LineCollection([], **edges), LineCollection([], **edges)
        self.molecules = PathCollection(
            [Path.unit_circle()], sizes=[1.0], offsets=np.zeros((0, 2)), offset_transform=axes.transData
        )
        self.molecules.set_transform(IdentityTransform())
        for order, artist in enumerate((self.back, self.far, self.molecules, self.lid, self.near)):
            artist.set_zorder(1.0 + order / 10.0)
            axes.add_artist(artist)

    def _fit(self) -> None:
        """Set the limits so that the largest box fills the axes, with one scale for both directions."""
        seen, _ = project(corners(self.largest), self.largest)
        low, high, frame = seen.min(axis=0), seen.max(axis=0), self.axes.get_window_extent()
        pixel = 1.02 * max((high[0] - low[0]) / frame.width, (high[1] - low[1]) / frame.height)  # [unit]
        (x, y), width, height = (low + high) / 2, pixel * frame.width, pixel * frame.height
        self.axes.set(xlim=(x - width / 2, x + width / 2), ylim=(y - height / 2, y + height / 2))
        self.points = 72.0 / self.axes.figure.dpi / pixel  # size of a unit of length in the middle of the box [pt]

    def _write_sides(self) -> None:
        """Write the width of the box, and its height if that differs from the width and no piston changes it."""
        (x, _, z), size = self.largest, self.look.small
        below, beside = project(np.array([[x / 2, 0.0, 0.0], [0.0, 0.0, z / 2]]), self.largest)[0]
        look: dict[str, Any] = {"textcoords": "offset points", "fontsize": size, "color": FAINT}
        look["annotation_clip"] = False
        text = f"{x:.3g} {spelled(self.unit)}"
        self.axes.annotate(text, below, (0.0, -0.4 * size), ha="center", va="top", **look)
        if "piston" not in self.held.walls and not math.isclose(x, z, rel_tol=0.01):
            text = f"{z:.3g} {spelled(self.unit)}"
            self.axes.annotate(text, beside, (-0.3 * size, 0.0), ha="right", va="center", rotation=90.0, **look)

    def show(self, frame: int) -> None:
        """Draw a frame: walls and edges, molecules and drops, the most distant first."""
        self._fit()
        held, look, walls = self.held, self.look, self.held.walls
        seen, _ = project(corners(held.side[frame] / self.metre), self.largest)
        self.back.set_verts([seen[_FACES[wall]] for wall in _BEHIND])
        self.back.set_facecolor([self._tint(frame, wall) for wall in _BEHIND])
        self.lid.set_verts([seen[_FACES[5]]] if walls[5] == "piston" else [])
        meeting = [[wall for wall in range(6) if {*ends} <= {*_FACES[wall]}] for ends in _EDGES]
        for collection, behind in ((self.far, True), (self.near, False)):
            here = [k for k, pair in enumerate(meeting) if any(wall in _BEHIND for wall in pair) == behind]
            dashed = [all(walls[wall] == "periodic" for wall in meeting[k]) for k in here]
            collection.set_segments([seen[_EDGES[k]] for k in here])
            collection.set_linestyle([(0.0, (3.0, 2.0)) if each else "solid" for each in dashed])

        position, tinted = held.position[frame, self.shown] / self.metre, self.tinted[frame, self.shown]
        here = np.isfinite(position[:, 0])
        drops = np.zeros((0, 4)) if held.drops is None else held.drops[frame] / self.metre
        drops = drops[np.isfinite(drops).all(axis=1)]
        wide = np.concatenate([self.diameter[here], 2.0 * drops[:, 3]])
        colours = matplotlib.colormaps[FIELD_COLOURS](self.norm(tinted[here]))
        fill = np.concatenate([colours, np.tile(_DROP, (len(drops), 1))])
        water = np.concatenate([self.water[here], np.ones(len(drops), bool)])
        in_picture, scale = project(np.concatenate([position[here], drops[:, :3]]), self.largest)
        order = np.argsort(scale, kind="stable")
        points, water = (wide * scale * self.points)[order], water[order]
        self.molecules.set_offsets(in_picture[order])
        self.molecules.set_sizes((points / 2) ** 2, dpi=self.axes.figure.dpi)
        self.molecules.set_facecolor([*fill[order]])
        self.molecules.set_edgecolor([*np.where(water[:, None], to_rgba(_VERMILLION), to_rgba(DARK, 0.75))])
        self.molecules.set_linewidth(np.where(water, 0.9, 0.35) * np.minimum(look.line, points / 3.0))

    def _tint(self, frame: int, wall: int) -> tuple[float, float, float, float]:
        """Return the colour of a wall: orange for a warm heat bath, blue for the colder of two."""
        law, baths = self.held.walls[wall], self.held.wall_temperature[frame]
        if law != "heat_bath":
            return {"pool": to_rgba(_SKY, 0.55), "periodic": (1.0, 1.0, 1.0, 0.0)}.get(law, _WALL)
        return _COLD if baths[wall] < 0.5 * (np.nanmin(baths) + np.nanmax(baths)) else _WARM

    def legend(self) -> list[str]:
        """Return the phrases of the footer about molecules, walls and drops."""
        held, count = self.held, self.held.position.shape[1]
        some = "" if self.shown.size == count else f"{self.shown.size} of {count} "
        told = {
            "blue floor: water": "pool" in held.walls,
            "grey lid: piston": "piston" in held.walls,
            "dashed: periodic sides": "periodic" in held.walls,
            "red rims: water": self.water.any(),
            "blue balls: drops": held.drops is not None and held.drops.shape[1],
        }
        return [some + self._exaggeration(), *self._baths(), *(words for words, is_there in told.items() if is_there)]

    def _exaggeration(self) -> str:
        """Return a phrase that says how large the molecules are drawn."""
        wide = float(np.median(self.diameter)) * self.metre
        times = wide / DRY_AIR.diameter
        if times < _TO_SIZE:
            return "molecules drawn to size"
        if times < _MANY_TIMES:
            return f"molecules drawn {times:.2g} times as wide as those of air"
        return f"molecules drawn {float(f'{wide:.2g}'):g} m wide"

    def _baths(self) -> list[str]:
        """Return phrases that give the constant temperature of each heat bath, or the one at the start."""
        warm = self.held.wall_temperature
        baths = [wall for wall in range(6) if self.held.walls[wall] == "heat_bath"]
        steady = not baths or np.ptp(warm[:, baths], axis=0).max() < 0.5
        groups: dict[str, list[str]] = {}
        for wall in baths:
            colour = "blue" if self._tint(0, wall) == _COLD else "orange"
            degrees = f"{float(warm[0, wall]) - 273.15:.0f}\u00a0°C".replace("-", "−")
            said = f"{colour}: {{}} {'kept at' if steady else 'at first'} {degrees}"
            groups.setdefault(said, []).append(_NAMES[wall])
        return [said.format("all walls" if len(names) == 6 else " and ".join(names)) for said, names in groups.items()]


def instant(dataset: xr.Dataset, held: Molecules | None, frame: int) -> str:
    """Return the time of a frame and, in a scene with liquid, a second line with the number of liquid molecules."""
    time = dataset["elapsed_time"].values
    apart = float(np.ptp(time)) / max(len(time) - 1, 1)
    decimals = max(0, -math.floor(math.log10(apart))) if apart > 0.0 else 2
    text = f"t = {time[frame]:.{decimals}f} {dataset['elapsed_time'].attrs.get('units', '')}"
    if held is None or held.liquid is None or held.water is None:
        return text
    return f"{text}\nliquid: {int(held.liquid[frame])} of {np.count_nonzero(held.water)} molecules of water"
