"""The pictures of a film: the box on the left, its graphs on the right, the clock over them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from atmosbox.errors import FileError
from atmosbox.film.film_box import Box, box, has_discs
from atmosbox.film.graph import Graph, GraphPainter, chosen
from atmosbox.film.plane_box import Table
from atmosbox.film.running import Running
from atmosbox.film.stage import Stage, legend
from atmosbox.plot.caption import footer, number
from atmosbox.plot.layout import explanation, panels_of
from atmosbox.plot.place import blank, put_panels, settle
from atmosbox.plot.plane import discs
from atmosbox.plot.plate import Pen
from atmosbox.plot.theme import FAINT, Theme
from atmosbox.plot.tick import put_ticks
from atmosbox.plot.unit import convert, spelled
from atmosbox.scene.panels import Panel

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Sheet"]

_FLICKER = 0.15  # molecules that move farther between two pictures, in sides of the box, are not seen to move
_SECONDS_IN = {"s": 1.0, "us": 1e-6, "ns": 1e-9, "ps": 1e-12}
_BAR = 0.6  # length of the colour bar, in widths of the box

Floats = NDArray[np.float64]


class Sheet:
    """A page on which the frames of a run are drawn, one after the other.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run.
    look : Theme
        How large; `plot.theme.style` must be in force while the sheet is made and used.
    graphs : bool
        Whether the graphs are filmed without the box.
    frames : ndarray of int, optional
        The frames that will be drawn, of which the caption speaks; all if nothing is said.

    Raises
    ------
    FileError
        If the run has nothing to film.

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.scene.panels import Line, to_json
    >>> from atmosbox.plot.theme import THEMES
    >>> air = Panel("line", "Temperature", (Line("elapsed_time", "t", "air"),), "time", "temperature")
    >>> dataset = xr.Dataset(
    ...     {"t": ("elapsed_time", [288.0, 290.0], {"units": "K"})},
    ...     coords={"elapsed_time": ("elapsed_time", [0.0, 1.0], {"units": "ns"})},
    ...     attrs={"atmosbox_panels": to_json([air])},
    ... )
    >>> Sheet(dataset, THEMES["notes"], graphs=True).picture(1).shape[2]
    3
    """

    def __init__(
        self, dataset: xr.Dataset, look: Theme, *, graphs: bool = False, frames: NDArray[np.int64] | None = None
    ) -> None:
        self.dataset, self.look = dataset, look
        count = dataset.sizes.get("elapsed_time", 0)
        if count == 0:
            raise FileError("The file has no frame to film: the run was stopped before its first one; run it again.")
        self.frames = np.arange(count) if frames is None else frames
        self.running = Running(dataset)
        panels = chosen(dataset, panels_of(dataset), self.running)
        self.box: Box | None = None
        self.discs = discs(dataset, "m") if has_discs(dataset) and not graphs else None
        if not graphs and self.discs is None:
            self.box = box(dataset)
        if graphs and not panels:
            raise FileError(
                "The file has no graph that grows with time: run the scene again with --save-molecules, and film it "
                "without --graphs."
            )
        self.share = 0.0 if graphs else _share(panels)
        self.figure = blank(look.wide, look)
        self.pen = Pen(self.figure)
        self.width, self.height = (72.0 * float(size) for size in self.figure.get_size_inches())  # pt
        bottom = self._write_small(panels)
        top = self._write_title()
        room = (self.share, bottom, 1.0 - self.share, (1.0 if self.share else top) - bottom)
        self.graphs = self._set_graphs(panels, room)
        self.stage: Stage | Table | None = None if graphs else self._set_stage(bottom, top)
        self.clock = self.figure.text(self.place[0], self.place[1], "", fontsize=look.title, va="top", animated=True)
        self.background = None

    def picture(self, frame: int) -> NDArray[np.uint8]:
        """Return the picture of a frame, (height, width, 3)."""
        canvas = self.figure.canvas
        artists: list[Artist] = [] if self.stage is None else self.stage.artists(frame)
        for graph in self.graphs:
            artists += graph.artists(frame)
        self.clock.set_text(self._clock(frame))
        if self.background is None:
            canvas.draw()
            self.background = canvas.copy_from_bbox(self.figure.bbox)  # type: ignore[attr-defined]
        canvas.restore_region(self.background)  # type: ignore[attr-defined]
        for artist in [*artists, self.clock]:
            artist.draw(canvas.get_renderer())  # type: ignore[attr-defined]
        return np.asarray(canvas.buffer_rgba())[:, :, :3].copy()  # type: ignore[attr-defined]

    def _write_small(self, panels: tuple[Panel, ...]) -> float:
        """Write the small type at the foot of the page, and return where it ends above, in parts of the page."""
        look = self.look
        words = [footer(self.dataset), *([] if self.box is None else legend(self.box)), *self._apart()]
        words += ["thick rims: the heavy half"] if self.discs is not None and self.discs.heavy.any() else []
        small = " · ".join(words) + explanation(self.dataset, panels)
        small = self.pen.wrap(small, 0.98 * (self.width - look.text), look.small)
        text = self.figure.text(
            look.text / 2 / self.width, 0.4 * look.text / self.height, small, fontsize=look.small, color=FAINT,
            va="bottom", linespacing=1.15,
        )  # fmt: skip
        text.set_in_layout(False)
        return (self.pen.height(text) + 0.8 * look.text) / self.height

    def _apart(self) -> list[str]:
        """Return what a viewer must know of molecules that are somewhere else in every picture."""
        if self.box is None or self.frames.size < 2:
            return []
        time = self.dataset["elapsed_time"]
        between = float(np.median(np.diff(time.values[self.frames])))
        fast = float(np.nanmean(self.box.speed)) * _SECONDS_IN[str(time.attrs.get("units", "s"))]
        flown = convert(fast * between, "m", self.box.unit)
        if flown < _FLICKER * self.box.side.max():
            return []
        far = f"{float(f'{flown:.2g}'):g}\u00a0{spelled(self.box.unit)}"
        apart = f"{float(f'{between:.2g}'):g}\u00a0{time.attrs.get('units', '')}"
        return [f"a picture every {apart}, in which a molecule flies {far}"]

    def _write_title(self) -> float:
        """Write the title over box and clock, remember where the clock stands, and return what is left below."""
        look = self.look
        left, top = look.text / 2 / self.width, 1.0 - 0.5 * look.text / self.height
        room = (self.share or 1.0) * self.width - look.text
        size = 1.25 * look.title
        title = self.pen.wrap(str(self.dataset.attrs.get("title", "")), room, size, "bold")
        text = self.figure.text(left, top, title, fontsize=size, weight="bold", va="top")
        text.set_in_layout(False)
        below = top - (self.pen.height(text) + 0.45 * look.text) / self.height
        self.place = (left, below)
        lines = len(self._clock(0).splitlines())
        return below - (1.3 * lines * look.title + 0.4 * look.text) / self.height

    def _set_graphs(self, panels: tuple[Panel, ...], room: tuple[float, float, float, float]) -> list[Graph]:
        """Put the panels into their part of the page."""
        engine = self.figure.get_layout_engine()
        assert isinstance(engine, ConstrainedLayoutEngine)
        if not panels:
            self.figure.set_layout_engine("none")
            return []
        engine.set(rect=room)
        painter = GraphPainter(self.dataset, self.look, self.running)
        plates = put_panels(self.figure, panels, self.look, painter, [[] for _ in panels])
        settle(self.pen, plates, replace(self.look, grows=False))
        return [Graph(plate.axes, plate.panel, self.dataset, self.look, self.running) for plate in plates]

    def _clock(self, frame: int) -> str:
        """Return the time of a frame, and how much is liquid."""
        time = self.dataset["elapsed_time"].values
        apart = float(time[-1] - time[0]) / max(len(time) - 1, 1)
        decimals = max(0, -math.floor(math.log10(apart))) if apart > 0.0 else 2
        text = f"t = {time[frame]:.{decimals}f} {self.dataset['elapsed_time'].attrs.get('units', '')}"
        if self.box is not None and self.box.liquid is not None:
            held, all_of_it = int(self.box.liquid[frame]), int(np.count_nonzero(self.dataset["species"].values == 1))
            text += f"\nliquid: {held} of {all_of_it} molecules of water"
        return text

    def _set_stage(self, bottom: float, top: float) -> Stage | Table:
        """Make the axes of the box with its colour bar below, and put the molecules into them."""
        look = self.look
        left, right = look.text / self.width, self.share - 0.6 * look.text / self.width
        bar = 3.4 * look.text / self.height  # with its numbers and its label
        spot = (left, bottom + bar + 1.4 * look.text / self.height, right - left)
        axes = self.figure.add_axes((*spot, top - spot[1]))
        stage: Stage | Table
        if self.discs is not None:
            stage = Table(axes, self.discs, look)
            speed_unit = self.discs.speed_unit
            axes.set_xlabel(f"{float(self.discs.box[1, 0] - self.discs.box[0, 0]):g} m")
        else:
            assert self.box is not None
            stage = Stage(axes, self.box, look)
            speed_unit = str(self.dataset["molecule_speed"].attrs.get("units", "m s-1"))
            self._write_sides(axes, stage)
        wide = _BAR * (right - left)
        cax = self.figure.add_axes((left + (right - left - wide) / 2, bottom + 0.75 * bar, wide, 0.2 * bar))
        log = isinstance(stage.norm, LogNorm)
        mappable = ScalarMappable(stage.norm, stage.colours)
        scale = self.figure.colorbar(mappable, cax=cax, orientation="horizontal", extend="both" if log else "max")
        scale.set_label(f"speed ({spelled(speed_unit)})", labelpad=0.1 * look.text)
        if log:
            put_ticks(cax.xaxis, log=True, length=wide * self.width, size=look.text)
        else:
            scale.locator = MaxNLocator(4)
        cax.tick_params(pad=0.15 * look.text)
        return stage

    def _write_sides(self, axes: Axes, stage: Stage) -> None:
        """Write how wide the box is, and how high unless that changes."""
        side, view = stage.largest, stage.view
        assert self.box is not None
        front, _ = view.project(np.array([[side[0] / 2, 0.0, 0.0], [0.0, 0.0, side[2] / 2]]))
        size = self.look.small
        axes.annotate(
            f"{number(side[0])} {spelled(self.box.unit)}", front[0], (0.0, -0.4 * size), textcoords="offset points",
            ha="center", va="top", fontsize=size, color=FAINT, annotation_clip=False,
        )  # fmt: skip
        if "piston" not in self.box.walls and not math.isclose(side[0], side[2], rel_tol=0.01):
            axes.annotate(
                f"{number(side[2])} {spelled(self.box.unit)}", front[1], (-0.3 * size, 0.0),
                textcoords="offset points", ha="right", va="center", fontsize=size, color=FAINT, rotation=90.0,
                annotation_clip=False,
            )  # fmt: skip


def _share(panels: tuple[Panel, ...]) -> float:
    """Return how much of the width the box has beside its graphs."""
    if not panels:
        return 1.0
    beside = sum(panel.kind in ("profile", "skewt") for panel in panels)
    return 0.34 if beside > 1 else 0.42
