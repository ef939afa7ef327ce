"""The pictures of a film: which frames it shows; the box on the left, the graphs on the right, the clock above."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import FileError, Option, SettingError
from atmosbox.file.molecules import Molecules
from atmosbox.film.graph import Graph, Running, chosen, drawer
from atmosbox.plot.box_picture import BoxPicture, box_picture, instant
from atmosbox.plot.caption import footer
from atmosbox.plot.curve import convert, spelled
from atmosbox.plot.discs import DiscPicture, colour_bar
from atmosbox.plot.layout import TextMeasure, blank, put_footer, put_heading, put_panels, settle
from atmosbox.plot.run_figure import explanation, panels_of
from atmosbox.plot.theme import Theme
from atmosbox.scene.conversion import to_si

if TYPE_CHECKING:
    import xarray as xr

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
    """The frames of a run that a film shows, (picture,), and how many are shown a second.

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
        Pictures a second; by default 10, or 20 if ``smooth``. A run of few frames is shown with fewer if only
        ``seconds`` is given.
    seconds : float, optional
        Duration of the film [s]; by default 12, or less if the run has too few frames.
    smooth : bool
        Whether molecules move little from one frame to the next.
    along : ndarray of float, (frame,), optional
        A quantity that increases by even steps from picture to picture, for instance the logarithm of time; by default
        the index of the frame.

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
    index = np.arange(frames, dtype=np.float64)
    place = index if along is None else along
    wanted = np.linspace(place[-1], place[0], number)[::-1]
    return Pace(np.interp(wanted, place, index).round().astype(np.int64), rate)


_APART = 0.15  # if molecules fly farther than this between two pictures, in sides of the box, the footer says so
_BAR = 0.6  # length of the colour bar, in widths of the box


class Sheet:
    """A page on which the frames of a run are drawn, one after the other.

    Parameters
    ----------
    look : Theme
        The theme; the context `plot.theme.style` must be active while the sheet is made and used.
    held : Molecules, optional
        The molecules of the run; without them only the graphs are filmed.
    frames : ndarray of int, optional
        The frames that will be drawn, by default all; the footer gives the time between them.

    Raises
    ------
    FileError
        If the run has nothing to film.
    """

    def __init__(
        self, dataset: xr.Dataset, look: Theme, held: Molecules | None = None, frames: NDArray[np.int64] | None = None
    ) -> None:
        self.dataset, self.look, self.held = dataset, look, held
        running = Running(dataset)
        panels = chosen(dataset, panels_of(dataset), running)
        if held is None and not panels:
            again, alone = Option("save_molecules", True), Option("graphs")
            fix = ("run the scene again with ", again, ", and film it without ", alone)
            raise FileError("The file has no graph that grows with time", *fix)
        # The share of the width that the box has beside its graphs.
        beside = sum(panel.kind in ("profile", "skewt") for panel in panels)
        share = 0.0 if held is None else 1.0 if not panels else 0.34 if beside > 1 else 0.42
        self.figure = blank(look.wide, look)
        measure = TextMeasure(self.figure)
        wide, high = (72.0 * float(size) for size in self.figure.get_size_inches())  # pt
        self.stage = None if held is None else box_picture(self.figure.add_axes((0, 0, 1, 1)), dataset, held, look)
        # The footer below all tells a viewer how far molecules fly between two pictures if that is far.
        words = [footer(dataset)]
        if self.stage is not None:
            words += self.stage.legend() + self._jumps(self.stage, slice(None) if frames is None else frames)
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

    def _jumps(self, stage: BoxPicture | DiscPicture, frames: NDArray[np.int64] | slice) -> list[str]:
        """Return a phrase on the distance that a molecule flies between two pictures, if that is far."""
        held, times = stage.held, stage.held.time[frames]
        if held.discs or times.size < 2:
            return []
        unit = str(self.dataset["elapsed_time"].attrs.get("units", "s"))
        apart = float(np.median(np.diff(times)))
        flown = float(np.nanmean(held.speed)) * apart * to_si(1.0, unit)
        if flown < _APART * held.side.max():
            return []
        every, far = (f"{float(f'{each:.2g}'):g}" for each in (apart, convert(flown, "m", stage.unit)))
        return [f"a picture every {every}\u00a0{unit}, in which a molecule flies {far}\u00a0{spelled(stage.unit)}"]
