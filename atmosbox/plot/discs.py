"""The discs of a planar scene in their box, drawn to size and coloured by their speed; and the colour bar of a box."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import Normalize, to_rgb
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from atmosbox.file.molecules import Molecules, molecules
from atmosbox.plot.curve import convert, spelled
from atmosbox.plot.theme import DARK, FAINT, FIELD_COLOURS, Theme
from atmosbox.scene.panels import Panel

_FAST = 5.0
"""Molecules more than this many times as fast as the median one have the colour of the fastest."""
# Greatest number of frames of a trail, and of segments of all trails. A disc has no trail if its median step from
# frame to frame is longer than this share of the box.
_TRAIL_FRAMES, _MOST_SEGMENTS, _LONGEST_STEP = 12, 6000, 0.1


def colour_scale(speed: NDArray[np.floating]) -> Normalize:
    """Return the colour scale of speeds, from zero to a round number that few exceed."""
    moving = speed[speed > 0.0]
    high = min(np.percentile(moving, 97), _FAST * np.median(moving)) if moving.size else 1.0
    return Normalize(0.0, float(MaxNLocator(4).tick_values(0.0, high)[-1]))


def colour_bar(axes: Axes, norm: Normalize, look: Theme, *, counted: bool = False, upright: bool = True) -> None:
    """Fill axes with the colour bar of molecules: of their speed, or of their number of neighbours if ``counted``."""
    way = "vertical" if upright else "horizontal"
    colours = ScalarMappable(norm, FIELD_COLOURS)
    bar = axes.figure.colorbar(colours, cax=axes, extend="max", ticks=MaxNLocator(4), orientation=way)
    said = "neighbours" if counted else f"speed ({spelled('m s-1')})"
    bar.set_label(said, labelpad=(0.5 if upright else 0.1) * look.text)
    axes.tick_params(pad=0.15 * look.text)


class DiscPicture:
    """The discs of a planar scene in their box, seen at right angles to their plane."""

    def __init__(self, axes: Axes, held: Molecules, look: Theme, unit: str = "m") -> None:
        self.axes, self.held, self.look, self.unit = axes, held, look, unit
        self.place = convert(held.position[:, :, ::2], "m", unit)
        self.box = convert(held.side[-1, ::2], "m", unit)
        self.heavy = np.zeros(held.mass.size, dtype=bool)
        if held.mass.size and held.mass.min() < held.mass.max():
            self.heavy[np.argsort(held.mass, kind="stable")[held.mass.size // 2 :]] = True
        wide = convert(held.diameter, "m", unit)
        rim = min(0.8, 15.0 * float(np.median(wide) / self.box.max()))  # it must not hide the colour of a small disc
        self.norm = colour_scale(held.speed)
        self.trail = LineCollection([], linewidths=look.line * 0.8, zorder=2.0)
        self.discs = EllipseCollection(
            wide, wide, np.zeros_like(wide), units="xy", offsets=self.place[-1], offset_transform=axes.transData,
            cmap=FIELD_COLOURS, norm=self.norm, edgecolors=DARK, zorder=3.0,
            linewidths=look.line * np.where(self.heavy, rim, rim / 3.0),
        )  # fmt: skip
        axes.add_collection(self.discs)
        axes.add_artist(self.trail)
        axes.set_aspect("equal", adjustable="box", anchor="NW")
        axes.set(xlim=(0.0, self.box[0]), ylim=(0.0, self.box[1]))
        axes.spines[:].set(visible=True, linewidth=look.line * 1.2, color=DARK)

    def show(self, frame: int) -> None:
        """Draw a frame: the discs, and their paths in the frames before, fainter for older ones."""
        self.discs.set_offsets(self.place[frame])
        self.discs.set_array(self.held.speed[frame])
        frames = min(_TRAIL_FRAMES, _MOST_SEGMENTS // self.place.shape[1], frame)
        path = self.place[frame - frames : frame + 1]
        if frames < 1:
            return self.trail.set_segments([])
        steps = np.median(np.linalg.norm(np.diff(path, axis=0), axis=2), axis=0)
        path = path[:, steps <= _LONGEST_STEP * float(self.box.min())]
        segments = np.stack((path[:-1], path[1:]), axis=2).reshape(-1, 2, 2)
        alpha = np.repeat(np.linspace(0.1, 0.8, frames), path.shape[1])
        colours = np.column_stack((np.tile(to_rgb(FAINT), (alpha.size, 1)), alpha))
        self.trail.set(segments=list(segments), color=colours)

    def legend(self) -> list[str]:
        """Return the phrases of the footer about the discs."""
        return ["thick rims: the heavy half"] if self.heavy.any() else []


def draw_discs(axes: Axes, panel: Panel, dataset: xr.Dataset, theme: Theme) -> list[tuple[tuple[Artist, ...], str]]:
    """Draw the last frame of a planar scene; return the legend entries of light and heavy discs, if there are both."""
    held = molecules(dataset)
    picture = DiscPicture(axes, held, theme, panel.x_unit or "nm")
    picture.show(len(held.time) - 1)
    colour_bar(axes.inset_axes((1.04, 0.1, 0.03, 0.8)), picture.norm, theme)
    if not picture.heavy.any():
        return []
    ratio = float(np.median(held.mass[picture.heavy]) / np.median(held.mass[~picture.heavy]))
    look: dict[str, Any] = {"ls": "none", "marker": "o", "mfc": "white", "mec": DARK}
    light = Line2D([], [], ms=1.4 * theme.marker, mew=theme.line / 3, **look)
    heavy = Line2D([], [], ms=2.2 * theme.marker, mew=theme.line, **look)
    return [((light,), "light half"), ((heavy,), f"heavy half: {float(f'{ratio:.2g}'):.15g} × the mass")]
