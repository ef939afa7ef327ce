"""The box of a saved run in perspective: walls, piston, molecules and drops; or the discs of a planar scene."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.colors import Normalize, to_rgba
from matplotlib.figure import Figure
from matplotlib.path import Path
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import IdentityTransform
from numpy.typing import NDArray

from atmosbox.file.molecules import Molecules
from atmosbox.plot.caption import number
from atmosbox.plot.discs import colour_scale, discs, put_discs, trails
from atmosbox.plot.theme import DARK, FAINT, FIELD_COLOURS, OKABE_ITO, PALE, Theme
from atmosbox.plot.units import spelled
from atmosbox.theory.constants import DRY_AIR

_TURN, _TILT = math.radians(24.0), math.radians(16.0)  # angles of the camera to the side and upward
_DISTANCE = 4.5  # of the camera from the middle of the box, in units of the longest side of the box

Floats = NDArray[np.float64]

FACES = (
    (0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5),
)  # fmt: skip
"""Indices of the four corners of each wall: x low, x high, y low, y high, z low, z high."""
EDGES = tuple((a, b) for a in range(8) for b in range(a + 1, 8) if bin(a ^ b).count("1") == 1)
"""Indices of the two corners at the ends of each edge."""


def corners(side: Floats) -> Floats:
    """Return the eight corners of a box, (8, 3); z varies fastest from one corner to the next.

    Examples
    --------
    >>> corners(np.array([2.0, 1.0, 1.0]))[4].tolist()
    [2.0, 0.0, 0.0]
    """
    return np.array([[a, b, c] for a in (0.0, side[0]) for b in (0.0, side[1]) for c in (0.0, side[2])])


@dataclass(frozen=True)
class Camera:
    """A camera that looks at the middle of a box, a little from the side and from above.

    Parameters
    ----------
    side : ndarray, (3,)
        Side lengths of the largest box that the camera must see, in any unit of length.

    Examples
    --------
    A nearer length is seen larger, and the wall y = 0 is in front:

    >>> camera = Camera(np.ones(3))
    >>> _, scale = camera.project(np.array([[0.5, 0.0, 0.5], [0.5, 1.0, 0.5]]))
    >>> bool(scale[0] > scale[1])
    True
    """

    side: Floats

    def project(self, position: Floats) -> tuple[Floats, Floats]:
        """Return positions in the picture (n, 2), and how large a unit of length is seen at each of them (n,)."""
        place = np.asarray(position, dtype=np.float64) - self.side / 2
        turn, tilt = (math.cos(_TURN), math.sin(_TURN)), (math.cos(_TILT), math.sin(_TILT))
        right = place[:, 0] * turn[0] + place[:, 1] * turn[1]
        away = place[:, 1] * turn[0] - place[:, 0] * turn[1]
        up = place[:, 2] * tilt[0] + away * tilt[1]
        depth = away * tilt[0] - place[:, 2] * tilt[1]
        distance = _DISTANCE * float(self.side.max())
        scale = distance / (distance + depth)
        return np.column_stack((right, up)) * scale[:, None], scale

    def behind(self, wall: int) -> bool:
        """Tell whether a wall is behind the molecules, seen from the camera."""
        return wall in (0, 3, 4)

    def limits(self, side: Floats) -> tuple[Floats, Floats]:
        """Return the lower left and the upper right corner of the picture of a box."""
        seen, _ = self.project(corners(side))
        return seen.min(axis=0), seen.max(axis=0)


_MOST = 4000  # molecules that are drawn
_UNITS = {"nm": 1e-9, "um": 1e-6, "mm": 1e-3, "m": 1.0, "km": 1e3}
_NEIGHBOURS = 12.0  # upper end of the colour scale where colours show the number of neighbours
_SMALLEST = 0.18  # least diameter of a molecule in the picture, in spacings of a lattice of all drawn molecules
# Ratio of the drawn diameter to that of a molecule of air: below the first, the footer says "drawn to size"; from the
# second on, it gives the drawn diameter and not the ratio.
_TO_SIZE, _MANY_TIMES = 1.05, 1000.0

_, _ORANGE, _SKY, _, _, _BLUE, _VERMILLION, _ = OKABE_ITO
_WALL, _POOL, _WARM, _COLD = (to_rgba("#efefef"), to_rgba(_SKY, 0.55), to_rgba(_ORANGE, 0.32), to_rgba(_SKY, 0.32))
_LID = to_rgba("#8c8c8c", 0.35)
_DROP = to_rgba(_SKY, 0.9)
_NAMES = ("left wall", "right wall", "front wall", "back wall", "floor", "ceiling")


def box_picture(axes: Axes, dataset: xr.Dataset, held: Molecules, look: Theme) -> BoxPicture | PlanarPicture:
    """Prepare axes for the box of a run; the method `artists` of the result then draws any frame.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        The axes, whose position does not change.
    held : Molecules
        Its molecules.
    """
    return PlanarPicture(axes, dataset, look) if held.discs else BoxPicture(axes, held, look)


class BoxPicture:
    r"""The box and its molecules, in perspective.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        The axes, whose position does not change.
    held : Molecules
        The molecules of the run. Of more than 4000 only 4000 are drawn, at even steps of their index.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from atmosbox.plot.theme import THEMES
    >>> one, speed = np.full((1, 1, 3), 1.5e-8), np.full((1, 1), 500.0)
    >>> side, walls = np.full((1, 3), 3e-8), ("periodic",) * 4 + ("heat_bath", "specular")
    >>> warm = np.array([[np.nan] * 4 + [288.15, np.nan]])
    >>> air = Molecules(
    ...     False, np.zeros(1), one, speed, np.ones(1), np.full(1, 4e-10), None, side, walls, warm, False, False
    ... )
    >>> picture = BoxPicture(Figure().add_axes((0.0, 0.0, 1.0, 1.0)), air, THEMES["notes"])
    >>> [type(artist).__name__ for artist in picture.artists(0)]
    ['PolyCollection', 'LineCollection', 'PathCollection', 'PolyCollection', 'LineCollection']
    >>> picture.legend()[1:]
    ['orange: floor kept at 15\xa0°C', 'dashed: periodic sides']
    """

    speed_unit = "m s-1"

    def __init__(self, axes: Axes, held: Molecules, look: Theme) -> None:
        self.axes, self.held, self.look = axes, held, look
        count, widest = held.position.shape[1], float(held.side.max())
        self.shown = np.unique(np.linspace(0, count - 1, min(count, _MOST)).round().astype(int))
        self.unit, self.metre = next((each for each in _UNITS.items() if widest < 1e3 * each[1]), ("km", 1e3))
        drawn = np.maximum(held.diameter[self.shown], _SMALLEST * widest / max(self.shown.size, 100) ** (1.0 / 3.0))
        self.diameter = drawn / self.metre
        self.water = np.zeros(self.shown.size, bool) if held.water is None else held.water[self.shown]
        self.largest = held.side[np.argmax(held.side[:, 2])] / self.metre
        self.camera = Camera(self.largest)
        self.tinted = held.speed if held.neighbours is None else held.neighbours
        speed = held.speed[:, self.shown]
        self.norm = colour_scale(speed[np.isfinite(speed)].astype(np.float64))
        if held.neighbours is not None:
            self.norm = Normalize(0.0, _NEIGHBOURS)
        self.colours = matplotlib.colormaps[FIELD_COLOURS]
        self.fit()
        if "piston" in held.walls:  # upright edges of the largest box, up to which the piston may rise
            ends = self.camera.project(corners(self.largest))[0]
            upright = [ends[[low, low + 1]] for low in (0, 2, 4, 6)]
            axes.add_collection(LineCollection(upright, colors=PALE, linewidths=look.line / 2), autolim=False)
        self._write_sides()
        edges: dict[str, Any] = {"linewidths": look.line / 1.5, "colors": FAINT}
        self.back = PolyCollection([], linewidths=0.0)
        self.far = LineCollection([], **edges)
        self.molecules = PathCollection(
            [Path.unit_circle()], sizes=[1.0], offsets=np.zeros((0, 2)), offset_transform=axes.transData
        )
        self.molecules.set_transform(IdentityTransform())
        self.lid = PolyCollection([], linewidths=0.0)
        self.near = LineCollection([], **edges)
        self.all: tuple[Artist, ...] = (self.back, self.far, self.molecules, self.lid, self.near)
        for order, artist in enumerate(self.all):
            artist.set_zorder(1.0 + order / 10.0)
            axes.add_artist(artist)

    def artists(self, frame: int) -> list[Artist]:
        """Return the artists of a frame, from the back to the front."""
        seen = self.camera.project(corners(self.held.side[frame] / self.metre))[0]
        self._put_walls(frame, seen)
        self._put_molecules(frame)
        self.lid.set_verts([seen[list(FACES[5])]] if self.held.walls[5] == "piston" else [])
        self.lid.set_facecolor(_LID)
        return [*self.all]

    def legend(self) -> list[str]:
        """Return the phrases of the footer about molecules, walls and drops."""
        held, shown, count = self.held, self.shown.size, self.held.position.shape[1]
        words = [("" if shown == count else f"{shown} of {count} ") + self._exaggeration(), *self._baths()]
        words += ["blue floor: water"] if "pool" in held.walls else []
        words += ["grey lid: piston"] if "piston" in held.walls else []
        words += ["dashed: periodic sides"] if "periodic" in held.walls else []
        words += ["red rims: water"] if self.water.any() else []
        return words + (["blue balls: drops"] if held.drops is not None and held.drops.shape[1] else [])

    def fit(self) -> None:
        """Set the limits so that the largest box fills the axes, with one scale for both directions."""
        low, high = self.camera.limits(self.largest)
        frame = self.axes.get_window_extent()
        pixel = 1.02 * max((high[0] - low[0]) / frame.width, (high[1] - low[1]) / frame.height)  # [unit]
        (x, y), width, height = (low + high) / 2, pixel * frame.width, pixel * frame.height
        self.axes.set(xlim=(x - width / 2, x + width / 2), ylim=(y - height / 2, y + height / 2))
        self.axes.set_axis_off()
        self.points = 72.0 / self.axes.figure.dpi / pixel  # size of a unit of length in the middle of the box [pt]

    def _write_sides(self) -> None:
        """Write the width of the box, and its height if that differs from the width and no piston changes it."""
        (x, _, z), size = self.largest, self.look.small
        below, beside = self.camera.project(np.array([[x / 2, 0.0, 0.0], [0.0, 0.0, z / 2]]))[0]
        look: dict[str, Any] = {"textcoords": "offset points", "fontsize": size, "color": FAINT}
        look["annotation_clip"] = False
        text = f"{number(x)} {spelled(self.unit)}"
        self.axes.annotate(text, below, (0.0, -0.4 * size), ha="center", va="top", **look)
        if "piston" not in self.held.walls and not math.isclose(x, z, rel_tol=0.01):
            text = f"{number(z)} {spelled(self.unit)}"
            self.axes.annotate(text, beside, (-0.3 * size, 0.0), ha="right", va="center", rotation=90.0, **look)

    def _put_walls(self, frame: int, seen: NDArray[np.float64]) -> None:
        """Place the walls behind the molecules, and the edges behind them and in front of them."""
        walls = [wall for wall in range(6) if self.camera.behind(wall)]
        self.back.set_verts([seen[list(FACES[wall])] for wall in walls])
        self.back.set_facecolor([self._tint(frame, wall) for wall in walls])
        split: tuple[list[Any], list[Any]] = ([], [])
        for a, b in EDGES:
            meeting = [wall for wall in range(6) if {a, b} <= set(FACES[wall])]
            dashed = all(self.held.walls[wall] == "periodic" for wall in meeting)
            in_front = not any(self.camera.behind(wall) for wall in meeting)
            split[in_front].append((seen[[a, b]], (0.0, (3.0, 2.0)) if dashed else "solid"))
        for collection, edges in zip((self.far, self.near), split, strict=True):
            collection.set_segments([ends for ends, _ in edges])
            collection.set_linestyle([dashes for _, dashes in edges])

    def _put_molecules(self, frame: int) -> None:
        """Place molecules and drops, the most distant first."""
        held, look = self.held, self.look
        position, speed = held.position[frame, self.shown] / self.metre, self.tinted[frame, self.shown]
        here = np.isfinite(position[:, 0])
        drops = np.zeros((0, 4)) if held.drops is None else held.drops[frame] / self.metre
        drops = drops[np.isfinite(drops).all(axis=1)]
        wide = np.concatenate([self.diameter[here], 2.0 * drops[:, 3]])
        fill = np.concatenate([self.colours(self.norm(speed[here])), np.tile(_DROP, (len(drops), 1))])
        water = np.concatenate([self.water[here], np.ones(len(drops), bool)])
        in_picture, scale = self.camera.project(np.concatenate([position[here], drops[:, :3]]))
        order = np.argsort(scale, kind="stable")
        points = (wide * scale * self.points)[order]
        rim = np.where(water[order], 0.9, 0.35) * look.line * np.minimum(1.0, points / (3.0 * look.line))
        self.molecules.set_offsets(in_picture[order])
        self.molecules.set_sizes((points / 2) ** 2, dpi=self.axes.figure.dpi)
        self.molecules.set_facecolor([*fill[order]])
        self.molecules.set_edgecolor([*np.where(water[order, None], to_rgba(_VERMILLION), to_rgba(DARK, 0.75))])
        self.molecules.set_linewidth(rim)

    def _tint(self, frame: int, wall: int) -> tuple[float, float, float, float]:
        """Return the colour of a wall: orange for a warm heat bath, blue for the colder of two."""
        law, baths = self.held.walls[wall], self.held.wall_temperature[frame]
        if law != "heat_bath":
            return {"pool": _POOL, "periodic": (1.0, 1.0, 1.0, 0.0)}.get(law, _WALL)
        return _COLD if baths[wall] < 0.5 * (np.nanmin(baths) + np.nanmax(baths)) else _WARM

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
        groups: dict[str, list[str]] = {}
        steady = not baths or np.ptp(warm[:, baths], axis=0).max() < 0.5
        for wall in baths:
            colour = "blue" if self._tint(0, wall) == _COLD else "orange"
            degrees = f"{float(warm[0, wall]) - 273.15:.0f}\u00a0°C".replace("-", "−")
            said = f"{'kept at' if steady else 'at first'} {degrees}"
            groups.setdefault(f"{colour}: {{}} {said}", []).append(_NAMES[wall])
        return [said.format("all walls" if len(names) == 6 else " and ".join(names)) for said, names in groups.items()]


class PlanarPicture:
    """The discs of a planar scene in their box, seen at right angles to their plane."""

    unit = "m"

    def __init__(self, axes: Axes, dataset: xr.Dataset, look: Theme) -> None:
        self.axes, self.look, self.found = axes, look, discs(dataset, self.unit)
        self.discs = put_discs(axes, self.found, look)
        axes.set_anchor("C")
        axes.set(xticks=[], yticks=[], xlabel=f"{float(np.ptp(self.found.box[:, 0])):g} {self.unit}")
        self.norm, self.colours, self.speed_unit = self.discs.norm, self.discs.cmap, self.found.speed_unit
        self.trail: Artist | None = None

    def fit(self) -> None:
        """Do nothing: the axes have equal scales already."""

    def artists(self, frame: int) -> list[Artist]:
        """Return the artists of a frame, from the back to the front."""
        if self.trail is not None:
            self.trail.remove()
        self.trail = trails(self.found.place[: frame + 1], self.found.box, self.look)
        self.discs.set_offsets(self.found.place[frame])
        self.discs.set_array(self.found.speed[frame])
        if self.trail is None:
            return [self.discs]
        self.axes.add_artist(self.trail)
        return [self.trail, self.discs]

    def legend(self) -> list[str]:
        """Return the phrases of the footer about the discs."""
        return ["thick rims: the heavy half"] if self.found.heavy.any() else []


def instant(dataset: xr.Dataset, held: Molecules | None, frame: int) -> str:
    """Return the time of a frame and, in a scene with liquid, a second line with the number of liquid molecules.

    Parameters
    ----------
    held : Molecules or None
        Its molecules, if the file holds them.
    frame : int
        The frame.
    """
    time = dataset["elapsed_time"].values
    apart = float(np.ptp(time)) / max(len(time) - 1, 1)
    decimals = max(0, -math.floor(math.log10(apart))) if apart > 0.0 else 2
    text = f"t = {time[frame]:.{decimals}f} {dataset['elapsed_time'].attrs.get('units', '')}"
    if held is None or held.liquid is None or held.water is None:
        return text
    return f"{text}\nliquid: {int(held.liquid[frame])} of {np.count_nonzero(held.water)} molecules of water"


def speed_bar(
    figure: Figure, picture: BoxPicture | PlanarPicture, spot: tuple[float, float, float, float], look: Theme
) -> None:
    """Draw the colour bar of the molecules: speed, or number of neighbours.

    Parameters
    ----------
    picture : BoxPicture or PlanarPicture
        The molecules.
    spot : tuple of float
        Left, bottom, width and height of the colour bar, as shares of the figure; the bar is vertical if it is higher
        than wide.
    """
    axes = figure.add_axes(spot)
    upright = spot[3] * figure.get_figheight() > spot[2] * figure.get_figwidth()
    scale = figure.colorbar(
        ScalarMappable(picture.norm, picture.colours), cax=axes, extend="max", ticks=MaxNLocator(4),
        orientation="vertical" if upright else "horizontal",
    )  # fmt: skip
    counted = isinstance(picture, BoxPicture) and picture.held.neighbours is not None
    said = "neighbours" if counted else f"speed ({spelled(picture.speed_unit)})"
    scale.set_label(said, labelpad=(0.5 if upright else 0.1) * look.text)
    axes.tick_params(pad=0.15 * look.text)
