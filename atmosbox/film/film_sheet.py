"""The pictures of a film: the box on the left, the graphs on the right, the clock above the box."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import FileError, Option
from atmosbox.file.molecules import Molecules
from atmosbox.film.graph import Graph, chosen, drawer
from atmosbox.film.running import Running
from atmosbox.plot.box_picture import box_picture, instant
from atmosbox.plot.caption import footer
from atmosbox.plot.discs import colour_bar
from atmosbox.plot.layout import TextMeasure, blank, put_footer, put_heading, put_panels, settle
from atmosbox.plot.run_figure import explanation, panels_of
from atmosbox.plot.theme import Theme
from atmosbox.plot.units import convert, spelled
from atmosbox.scene.conversion import to_si

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Sheet"]

_APART = 0.15  # if molecules fly farther than this between two pictures, in sides of the box, the footer says so
_BAR = 0.6  # length of the colour bar, in widths of the box


class Sheet:
    """A page on which the frames of a run are drawn, one after the other.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run.
    look : Theme
        The theme: sizes of type, lines and markers. The context `plot.theme.style` must be active while the sheet is
        made and used.
    held : Molecules, optional
        The molecules of the run; without them only the graphs are filmed.
    frames : ndarray of int, optional
        The frames that will be drawn, by default all; the footer gives the time between them.

    Raises
    ------
    FileError
        If the run has nothing to film.

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.scene.panels import Line, Panel, to_json
    >>> from atmosbox.plot.theme import THEMES
    >>> air = Panel("line", "Temperature", (Line("elapsed_time", "t", "air"),), "time", "temperature")
    >>> dataset = xr.Dataset(
    ...     {"t": ("elapsed_time", [288.0, 290.0], {"units": "K"})},
    ...     coords={"elapsed_time": ("elapsed_time", [0.0, 1.0], {"units": "ns"})},
    ...     attrs={"atmosbox_panels": to_json([air])},
    ... )
    >>> Sheet(dataset, THEMES["notes"]).picture(1).shape[2]
    3
    """

    def __init__(
        self, dataset: xr.Dataset, look: Theme, held: Molecules | None = None, frames: NDArray[np.int64] | None = None
    ) -> None:
        self.dataset, self.look, self.held = dataset, look, held
        running = Running(dataset)
        panels = chosen(dataset, panels_of(dataset), running)
        if held is None and not panels:
            raise FileError(
                "The file has no graph that grows with time",
                "run the scene again with ",
                Option("save_molecules", True),
                ", and film it without ",
                Option("graphs"),
            )
        # The share of the width that the box has beside its graphs.
        beside = sum(panel.kind in ("profile", "skewt") for panel in panels)
        share = 0.0 if held is None else 1.0 if not panels else 0.34 if beside > 1 else 0.42
        self.figure = blank(look.wide, look)
        measure = TextMeasure(self.figure)
        wide, high = (72.0 * float(size) for size in self.figure.get_size_inches())  # pt
        self.stage = None if held is None else box_picture(self.figure.add_axes((0, 0, 1, 1)), dataset, held, look)
        # The footer below all tells a viewer how far molecules fly between two pictures if that is far.
        words = [footer(dataset), *([] if self.stage is None else self.stage.legend())]
        words += self._jumps(held, np.arange(dataset.sizes["elapsed_time"]) if frames is None else frames)
        bottom = put_footer(measure, " · ".join(words) + explanation(dataset, panels), look)
        top = put_heading(measure, str(dataset.attrs.get("title", "")), 1.25 * look.title, look, share or 1.0)
        self.clock = measure.write(self._time(0), look.text / 2, top, fontsize=look.title, va="top")
        top += 1.3 * look.title * len(self._time(0).splitlines()) + 0.4 * look.text

        self.graphs: list[Graph] = []
        if panels:
            engine: Any = self.figure.get_layout_engine()
            engine.set(rect=(share, 0.0, 1.0 - share, 1.0 if share else 1.0 - top / high))
            graphs = put_panels(self.figure, panels, look, dataset, drawer(dataset, look))
            settle(measure, graphs, replace(look, grows=False))
            self.graphs = [Graph(graph.axes, graph.panel, dataset, look, running) for graph in graphs]
        self.figure.set_layout_engine("none")
        if self.stage is not None:  # place the box, and below it the colour bar
            left, width = look.text / wide, share - 1.6 * look.text / wide
            bar, bottom = 3.4 * look.text / high, bottom / high  # height of the colour bar with its numbers and label
            foot = bottom + bar + 1.4 * look.text / high
            self.stage.axes.set_position((left, foot, width, 1.0 - top / high - foot))
            spot = (left + (1.0 - _BAR) * width / 2, bottom + 0.75 * bar, _BAR * width, 0.2 * bar)
            counted = held is not None and held.neighbours is not None
            colour_bar(self.figure.add_axes(spot), self.stage.norm, look, counted=counted, upright=False)

    def picture(self, frame: int) -> NDArray[np.uint8]:
        """Return the picture of a frame, (height, width, 3)."""
        if self.stage is not None:
            self.stage.show(frame)
        for graph in self.graphs:
            graph.show(frame)
        self.clock.set_text(self._time(frame))
        canvas: Any = self.figure.canvas
        canvas.draw()
        return np.asarray(canvas.buffer_rgba())[:, :, :3].copy()

    def _time(self, frame: int) -> str:
        return instant(self.dataset, self.held, frame)

    def _jumps(self, held: Molecules | None, frames: NDArray[np.int64]) -> list[str]:
        """Return a phrase on the distance that a molecule flies between two pictures, if that is far."""
        if held is None or held.discs or frames.size < 2:
            return []
        unit = str(self.dataset["elapsed_time"].attrs.get("units", "s"))
        apart = float(np.median(np.diff(held.time[frames])))
        flown = float(np.nanmean(held.speed)) * apart * to_si(1.0, unit)
        if self.stage is None or flown < _APART * held.side.max():
            return []
        far = f"{float(convert(flown, 'm', self.stage.unit)):.2g}"
        far, apart_text = (f"{float(text):g}" for text in (far, f"{apart:.2g}"))
        return [
            f"a picture every {apart_text}\u00a0{unit}, in which a molecule flies {far}\u00a0{spelled(self.stage.unit)}"
        ]
