"""The graphs beside the box: measured curves grow with time, theory is shown from the start."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from atmosbox.film.running import Running
from atmosbox.plot.atmosphere_picture import ascent_of, draw_ground, draw_way
from atmosbox.plot.curve import Curve, curve
from atmosbox.plot.draw import Entry, draw_line, draw_steps
from atmosbox.plot.run_figure import painter
from atmosbox.plot.skewt import SHADE_ORDER, slender
from atmosbox.plot.theme import DARK, DATA_COLOURS, Theme
from atmosbox.plot.units import convert
from atmosbox.scene.panels import Line, Panel

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Graph", "GraphPainter", "chosen"]

_HEADROOM = 1.08  # upper end of the axis of a histogram, in units of its highest step


def _grows(dataset: xr.Dataset, line: Line, running: Running) -> bool:
    """Tell whether a curve grows during the run: a measured function of time, or an average that `Running` has."""
    names = [name.partition("[")[0] for name in (line.x, line.y)]
    in_time = any("elapsed_time" in dataset[name].dims for name in names if name in dataset.variables)
    return line.role == "data" and (in_time or any(name in running.names for name in names))


def chosen(dataset: xr.Dataset, panels: tuple[Panel, ...], running: Running) -> tuple[Panel, ...]:
    """Return the panels to film: panels that grow, if possible of two kinds, and misfits only if there are no others.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run.
    panels : tuple of Panel
        The panels of the figure of the run.
    running : Running
        The averages up to a frame that its molecules give.

    Returns
    -------
    tuple of Panel
        At most two panels, because there is no room for more, or a skew-T alone; none if nothing grows.

    Examples
    --------
    >>> import xarray as xr
    >>> dataset = xr.Dataset({"t": ("elapsed_time", [1.0])}, coords={"elapsed_time": [0.0]})
    >>> warm = Panel("line", "Warm", (Line("elapsed_time", "t", "air"),))
    >>> [panel.title for panel in chosen(dataset, (Panel("discs", "A box"), warm), Running(dataset))]
    ['Warm']
    """
    growing = [panel for panel in panels if any(_grows(dataset, line, running) for line in panel.lines)]
    telling = [panel for panel in growing if not any(line.minus for line in panel.lines)] or growing
    if not telling:
        return ()
    first, *rest = telling
    if first.kind == "skewt":
        return (first,)
    others = [panel for panel in rest if panel.kind != first.kind and panel.kind != "skewt"]
    others += [panel for panel in rest if panel.kind == first.kind]
    picked = (first, *others[:1])
    return tuple(panel for panel in panels if panel in picked)


class GraphPainter:
    """Draws the parts of panels that do not change, with axes whose limits hold all later curves.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run.
    look : Theme
        How large.
    running : Running
        The averages up to a frame that its molecules give.

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.plot.theme import THEMES
    >>> dataset = xr.Dataset({"t": ("elapsed_time", [1.0, 3.0])}, coords={"elapsed_time": [0.0, 9.0]})
    >>> panel = Panel("line", "Warm", (Line("elapsed_time", "t", "air"),))
    >>> drawing = Figure()
    >>> graphs = GraphPainter(dataset, THEMES["notes"], Running(dataset))
    >>> axes, entries = graphs.draw(drawing, drawing.add_gridspec(1, 1)[0, 0], panel, None)
    >>> len(axes.lines), [label for _, label in entries]
    (0, ['air'])
    """

    def __init__(self, dataset: xr.Dataset, look: Theme, running: Running) -> None:
        self.dataset, self.look, self.running = dataset, look, running

    def draw(self, drawing: Figure, spot: SubplotSpec, panel: Panel, above: Axes | None) -> tuple[Axes, list[Entry]]:
        """Draw a panel at its place; it shares the abscissa of the axes above, if any."""
        scratch = Figure(figsize=tuple(drawing.get_size_inches()))
        whole = painter(self.dataset, self.look)
        full, entries = whole(scratch, scratch.add_gridspec(1, 1)[0, 0], panel, None)
        if panel.kind == "atmosphere":
            axes = drawing.add_subplot(spot)
            draw_ground(axes, ascent_of(self.dataset), self.look)
            return axes, entries
        still = tuple(line for line in panel.lines if not _grows(self.dataset, line, self.running))
        if still:
            axes, _ = painter(self.dataset, self.look, still)(drawing, spot, panel, above)
        else:
            axes = drawing.add_subplot(spot, sharex=above, xscale=panel.x_scale, yscale=panel.y_scale)
            axes.grid(visible=True)
        axes.set(xlim=full.get_xlim(), ylim=full.get_ylim())
        if panel.kind == "histogram":  # its steps may be higher during the run than at the end
            count = self.dataset.sizes["elapsed_time"]
            tops = [
                convert(self.running.values(line.y, frame), _unit(self.dataset, line.y), panel.y_unit).max()
                for line in panel.lines
                if line.y in self.running.names
                for frame in range(0, count, max(1, count // 60))
            ]
            axes.set_ylim(top=max(axes.get_ylim()[1], _HEADROOM * max(tops, default=0.0)))
        return axes, entries


class Graph:
    """The curves of one panel up to a frame.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        The axes, on which `GraphPainter` has drawn.
    panel : Panel
        The panel.
    dataset : xarray.Dataset
        The run.
    look : Theme
        How large.
    running : Running
        The averages up to a frame that its molecules give.

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.plot.theme import THEMES
    >>> dataset = xr.Dataset({"t": ("elapsed_time", [1.0, 3.0])}, coords={"elapsed_time": [0.0, 9.0]})
    >>> panel = Panel("line", "Warm", (Line("elapsed_time", "t", "air"),))
    >>> graph = Graph(Figure().add_subplot(), panel, dataset, THEMES["notes"], Running(dataset))
    >>> graph.show(1)
    >>> graph.axes.lines[-1].get_ydata().tolist()
    [3.0]
    """

    def __init__(self, axes: Axes, panel: Panel, dataset: xr.Dataset, look: Theme, running: Running) -> None:
        self.axes, self.panel, self.dataset, self.running = axes, panel, dataset, running
        self.look = slender(look) if panel.kind == "skewt" else look
        axes.set_autoscale_on(False)
        self.way = ascent_of(dataset) if panel.kind == "atmosphere" else None
        measured = [line for line in panel.lines if line.role == "data"]
        self.lines = [(line, measured.index(line)) for line in measured if _grows(dataset, line, running)]
        self.curves = {
            line: curve(dataset, panel, line) for line, _ in self.lines if not {line.x, line.y} & set(running.names)
        }
        time = dataset["elapsed_time"]
        shown = panel.x_unit if panel.kind == "line" and all(line.x == "elapsed_time" for line in measured) else ""
        self.time = convert(time.values, _unit(dataset, "elapsed_time"), shown, name="elapsed_time")
        self.cursor = axes.axvline(self.time[0], color=DARK, linewidth=look.line / 2, zorder=5.0)
        self.cursor.set_visible(panel.kind == "line" and all(line.x == "elapsed_time" for line in measured))
        # CAPE and CIN are shaded up to the level that the parcel has reached
        self.shades = [each for each in axes.collections if panel.kind == "skewt" and each.get_zorder() == SHADE_ORDER]
        self.drawn: list[Artist] = []

    def show(self, frame: int) -> None:
        """Draw the curves up to a frame in place of those that were drawn before."""
        for bars in list(self.axes.containers):
            bars.remove()
        for artist in self.drawn:
            if artist.axes is not None:
                artist.remove()
        before = set(self.axes.get_children())
        if self.way is not None:
            draw_way(self.axes, self.way, frame, np.array([frame]), self.look)
        else:
            self._draw_curves(frame)
        self.drawn = [artist for artist in self.axes.get_children() if artist not in before]
        self.cursor.set_xdata([self.time[frame]] * 2)
        for shade in self.shades:
            shade.set_clip_path(self._below(frame))

    def _draw_curves(self, frame: int) -> None:
        """Draw the measured curves up to a frame."""
        so_far = self.running.at(frame) if len(self.curves) < len(self.lines) else self.dataset
        for line, index in self.lines:
            if line in self.curves:
                self._draw_so_far(line, index, frame)
            elif self.panel.kind == "histogram":
                draw_steps(self.axes, self.panel, replace(line, error=None), so_far, self.look, index)
            else:
                values = curve(so_far, self.panel, replace(line, error=None))
                draw_line(self.axes, self.panel, line, values, self.look, index)

    def _below(self, frame: int) -> Rectangle:
        """Return the part of the axes below the point that the first curve has reached in a frame."""
        up = self.curves[self.lines[0][0]].y[frame]
        top = self.axes.transAxes.inverted().transform(self.axes.transData.transform((self.axes.get_xlim()[0], up)))[1]
        return Rectangle((0.0, 0.0), 1.0, float(top), transform=self.axes.transAxes)

    def _draw_so_far(self, line: Line, index: int, frame: int) -> None:
        """Draw a curve up to a frame, and a dot at its last point."""
        x, y, error = self.curves[line]
        each = x.size == self.time.size
        past = np.arange(x.size) <= frame if each else x <= self.time[frame]
        values = Curve(np.where(past, x, np.nan), np.where(past, y, np.nan), error)
        draw_line(self.axes, self.panel, line, values, self.look, index)
        if each:
            colour = DATA_COLOURS[index % len(DATA_COLOURS)]
            dot = Line2D(x[[frame]], y[[frame]], marker="o", markersize=1.5 * self.look.marker, zorder=6.0)
            dot.set(markerfacecolor=colour, markeredgecolor="white")
            self.axes.add_line(dot)


def _unit(dataset: xr.Dataset, name: str) -> str:
    return str(dataset[name].attrs.get("units", "1"))
