"""The graphs beside the box: measured curves and averages grow with time, theory is shown from the start."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from atmosbox.plot.atmosphere_picture import ascent_of, draw_atmosphere, draw_ground, draw_way
from atmosbox.plot.curve import Curve, curve, series
from atmosbox.plot.draw import MEASURED, Entry, draw_line, draw_steps, from_start
from atmosbox.plot.layout import Draw
from atmosbox.plot.run_figure import painter
from atmosbox.plot.skewt import SHADE_ORDER, slender
from atmosbox.plot.theme import DARK, DATA_COLOURS, Theme
from atmosbox.scene.panels import Line, Panel

if TYPE_CHECKING:
    import xarray as xr

_SPEEDS = 6000  # number of speeds that is enough for a histogram
_LAYERED = ("number_density", "air_density", "layer_pressure", "layer_temperature")
_FEW = {"layer_temperature": 20.0, "number_density": 2.0}  # least number of molecules counted in a layer, for a value

Floats = NDArray[np.float64]


class Running:
    """Averages up to a frame of variables that the file holds only for the whole run, computed from its molecules.

    A histogram of speeds is that of the last frames; these are few, so that a change is seen. The value of a layer is
    the mean over all frames so far. Number and temperature are scaled so that the value at the end is the one of the
    whole run, which was measured in more samples than the file has frames.
    """

    def __init__(self, dataset: xr.Dataset) -> None:
        self.dataset = dataset
        names: list[str] = []
        if {"molecule_speed", "speed_bnds", "speed_probability_density"} <= set(dataset.variables):
            self.bins = np.append(dataset["speed_bnds"].values[:, 0], dataset["speed_bnds"].values[-1, 1])
            self.speed = dataset["molecule_speed"].transpose("elapsed_time", "molecule").values
            self.frames = max(1, -(-_SPEEDS // self.speed.shape[1]))
            names.append("speed_probability_density")
        if "molecule_position" in dataset.variables and "height_bnds" in dataset.variables:
            names += [name for name in _LAYERED if name in dataset.variables]
            self._sum_layers()
        self.names = tuple(names)

    def _sum_layers(self) -> None:
        """Sum the molecules and the squares of their speeds in every layer, up to every frame."""
        data = self.dataset
        bounds = np.append(data["height_bnds"].values[:, 0], data["height_bnds"].values[-1, 1])
        height = data["molecule_position"].transpose("elapsed_time", "molecule", "axis").values[:, :, 2]
        square = data["molecule_speed"].transpose("elapsed_time", "molecule").values.astype(np.float64) ** 2
        so_far = np.arange(1.0, len(height) + 1.0)[:, None]
        count = [np.histogram(each, bounds)[0] for each in height]
        energy = [np.histogram(each, bounds, weights=held)[0] for each, held in zip(height, square, strict=True)]
        self.count, self.square = (np.cumsum(each, axis=0) / so_far for each in (count, energy))

    def at(self, frame: int) -> xr.Dataset:
        """Return the dataset with the averages up to a frame in place of those of the whole run."""
        held = self.dataset
        return held.assign({name: held[name].copy(data=self.values(name, frame)) for name in self.names})

    def values(self, name: str, frame: int) -> Floats:
        """Return one average up to a frame, in the unit of the file; NaN in layers with too few molecules."""
        if name == "speed_probability_density":
            seen = self.speed[max(0, frame + 1 - self.frames) : frame + 1]
            seen = seen[np.isfinite(seen)]
            share: Floats = np.histogram(seen, self.bins)[0] / max(seen.size, 1) / np.diff(self.bins)
            return share
        with np.errstate(invalid="ignore", divide="ignore"):
            number = self.count[frame] / self.count[-1]
            energy = self.square[frame] / self.square[-1]
            ratio = {"layer_temperature": energy / number, "layer_pressure": energy}.get(name, number)
        few = _FEW["layer_temperature" if name in ("layer_temperature", "layer_pressure") else "number_density"]
        return np.where(self.count[frame] * (frame + 1) >= few, ratio * self.dataset[name].values, np.nan)


_HEADROOM = 1.08  # upper end of the axis of a histogram, in units of its highest step


def _grows(dataset: xr.Dataset, line: Line, running: Running) -> bool:
    """Tell whether a curve grows during the run: a measured function of time, or an average that `Running` has."""
    names = [name.partition("[")[0] for name in (line.x, line.y)]
    in_time = any("elapsed_time" in dataset[name].dims for name in names if name in dataset.variables)
    return line.role == "data" and (in_time or any(name in running.names for name in names))


def chosen(dataset: xr.Dataset, panels: tuple[Panel, ...], running: Running) -> tuple[Panel, ...]:
    """Return the panels to film: a skew-T alone, or at most two panels that grow, if possible of two kinds."""
    growing = [panel for panel in panels if any(_grows(dataset, line, running) for line in panel.lines)]
    if not growing:
        return ()
    first, *rest = growing
    if first.kind == "skewt":
        return (first,)
    others = [panel for panel in rest if panel.kind != first.kind and panel.kind != "skewt"]
    others += [panel for panel in rest if panel.kind == first.kind]
    return tuple(panel for panel in panels if panel in (first, *others[:1]))


def drawer(dataset: xr.Dataset, look: Theme) -> Draw:
    """Return the function that draws a panel with the curves of the whole run; `Graph` then removes what grows."""
    whole = painter([dataset], look)

    def draw(drawing: Figure, spot: SubplotSpec, panel: Panel, above: Axes | None) -> tuple[Axes, list[Entry]]:
        if panel.kind != "atmosphere":
            return whole(drawing, spot, panel, above)
        axes = drawing.add_subplot(spot)
        draw_ground(axes, ascent_of(dataset), look)
        return axes, draw_atmosphere(Figure().add_subplot(), dataset, look)

    return draw


class Graph:
    """The curves of one panel up to a frame; the function of `drawer` has drawn the axes before."""

    def __init__(self, axes: Axes, panel: Panel, dataset: xr.Dataset, look: Theme, running: Running) -> None:
        self.axes, self.panel, self.dataset, self.running = axes, panel, dataset, running
        self.look = slender(look) if panel.kind == "skewt" else look
        axes.set_autoscale_on(False)
        self.drawn: list[Artist] = [each for each in axes.get_children() if each.get_zorder() in MEASURED]
        self.way = ascent_of(dataset) if panel.kind == "atmosphere" else None
        self.lines = [line for line in panel.lines if line.role == "data"]
        self.curves = {line: curve(dataset, panel, line) for line in self.lines if line.y not in running.names}
        in_time = panel.kind == "line" and all(line.x == "elapsed_time" for line in self.lines)
        self.time = series(dataset, "elapsed_time", panel.x_unit if in_time else "")
        self.cursor = axes.axvline(self.time[0], color=DARK, linewidth=look.line / 2, zorder=5.0)
        self.cursor.set_visible(in_time)
        # CAPE and CIN are shaded up to the level that the parcel has reached
        self.shades = [each for each in axes.collections if panel.kind == "skewt" and each.get_zorder() == SHADE_ORDER]
        if panel.kind == "histogram":  # its steps may be higher during the run than at the end
            count = len(self.time)
            for frame in range(0, count, max(1, count // 60)):
                so_far = running.at(frame)
                tops = [float(np.nanmax(curve(so_far, panel, line).y)) for line in self.lines]
                axes.set_ylim(top=max(axes.get_ylim()[1], _HEADROOM * max(tops)))

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
            so_far = self.running.at(frame)
            for index, line in enumerate(self.lines):
                self._draw_curve(line, index, frame, so_far)
        self.drawn = [artist for artist in self.axes.get_children() if artist not in before]
        self.cursor.set_xdata([self.time[frame]] * 2)
        for shade in self.shades:
            shade.set_clip_path(self._below(frame))

    def _draw_curve(self, line: Line, index: int, frame: int, so_far: xr.Dataset) -> None:
        """Draw a measured curve up to a frame, and a dot at its last point if it has one value for each frame."""
        if self.panel.kind == "histogram":
            draw_steps(self.axes, self.panel, replace(line, error=None), so_far, self.look, index)
            return
        if line not in self.curves:
            values = curve(so_far, self.panel, replace(line, error=None))
            draw_line(self.axes, self.panel, line, values, self.look, index)
            return
        x, y, error = self.curves[line]
        in_time = _grows(self.dataset, line, self.running)
        each = in_time and x.size == self.time.size
        past = np.arange(x.size) <= frame if each else x <= (self.time[frame] if in_time else np.inf)
        values = Curve(np.where(past, x, np.nan), np.where(past, y, np.nan), error)
        draw_line(self.axes, self.panel, line, from_start(self.panel, line, values), self.look, index)
        if each:
            dot: dict[str, Any] = {"mfc": DATA_COLOURS[index % len(DATA_COLOURS)], "mec": "white", "zorder": 6.0}
            self.axes.plot(x[frame], y[frame], "o", ms=1.5 * self.look.marker, **dot)

    def _below(self, frame: int) -> Rectangle:
        """Return the part of the axes below the point that the first curve has reached in a frame."""
        up = self.curves[self.lines[0]].y[frame]
        top = self.axes.transAxes.inverted().transform(self.axes.transData.transform((self.axes.get_xlim()[0], up)))[1]
        return Rectangle((0.0, 0.0), 1.0, float(top), transform=self.axes.transAxes)
