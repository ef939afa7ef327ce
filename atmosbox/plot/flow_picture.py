"""Air that turns over: its temperature in colours and its wind as arrows, at instants above the panels."""

import math

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from atmosbox.plot.curve import convert, spelled
from atmosbox.plot.layout import TextMeasure
from atmosbox.plot.theme import DARK, Theme
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR

_COLOURS = "inferno"  # dark is cold, light is warm, in print too
_SHARE = 1 / 15  # of the frames, of which a picture shows the mean
_BAR = 0.125  # width of the colour bar with its numbers, in widths of the page
_SLOWEST = 0.15  # least speed of the longest arrow, in units of the thermal speed of a molecule
_ARROWS = 7  # greatest number of arrows along a box
_AROUND = 4.8  # height of titles and numbers around the boxes, in units of the type size
_TALLEST = 0.3  # height of the boxes, in widths of the page or in heights of a screen


def instants(dataset: xr.Dataset) -> dict[str, tuple[int, int]]:
    """Return the first and the last frame of each of two pictures by its title.

    ``mean_wind_speed`` is given only if there is more wind than chance.

    >>> frames = ("elapsed_time", np.zeros(60))
    >>> instants(xr.Dataset({"roll_speed": frames, "mean_wind_speed": 20.0}))
    {'start': (0, 4), 'warm air rises': (56, 60)}
    """
    frames = dataset.sizes["elapsed_time"]
    part = max(1, round(_SHARE * frames))
    moves = float(dataset.get("mean_wind_speed", math.nan)) > 0.0
    return {"start": (0, part), "warm air rises" if moves else "end": (frames - part, frames)}


def flow_height(dataset: xr.Dataset, look: Theme) -> float:
    """Return the height of the pictures with their titles [pt]; 0 if the run has no fields of the air."""
    if "upward_wind" not in dataset:
        return 0.0
    wide, high = (72.0 * size for size in look.wide)
    across, up = (float(np.ptp(dataset[f"{name}_bnds"].values)) for name in ("distance", "height"))
    each = 0.9 * (1.0 - _BAR) * wide / len(instants(dataset)) * up / across
    return min(each, _TALLEST * (wide if look.grows else high)) + _AROUND * look.text


def put_flow(dataset: xr.Dataset, look: Theme, measure: TextMeasure, top: float) -> None:
    """Draw the pictures in a row, below a distance from the upper end of the page [pt]."""
    drawing, box = measure.figure, flow_height(dataset, look) - _AROUND * look.text
    wide, high = (72.0 * float(size) for size in drawing.get_size_inches())
    bounds = [dataset[f"{name}_bnds"].values / 1000.0 for name in ("distance", "height")]
    edges = [np.append(each[:, 0], each[-1, 1]) for each in bounds]
    told = instants(dataset)
    each = (1.0 - _BAR) * wide / len(told)
    width = min(0.9 * each, box * float(np.ptp(edges[0]) / np.ptp(edges[1])))
    base = 1.0 - (top + 1.5 * look.text + box) / high
    pictures = [_means(dataset, *span) for span in told.values()]
    both = xr.concat(pictures, "picture")
    norm = Normalize(float(both.warm.min()), float(both.warm.max()))
    # arrows of air at rest are short: a share of the speed of molecules is the least length of the longest
    thermal = math.sqrt(BOLTZMANN * (float(both.warm.mean()) + 273.15) / DRY_AIR.molecule_mass)
    speeds = np.hypot(both.horizontal_wind, both.upward_wind).quantile(0.98, ("height", "distance"))
    fastest = max(_SLOWEST * thermal, float(speeds.max()))
    time = convert(dataset["elapsed_time_bnds"].values, str(dataset["elapsed_time"].attrs.get("units", "s")), "min")
    for place, ((words, span), picture) in enumerate(zip(told.items(), pictures, strict=True)):
        left = 4.2 * look.text + place * (each - 1.2 / len(told) * look.text) + 0.5 * (0.9 * each - width)
        axes = drawing.add_axes((left / wide, base, width / wide, box / high), in_layout=False)
        _draw(axes, edges, picture, norm, fastest, look)
        first, last = time[span[0], 0], time[span[1] - 1, 1]
        digits = 0 if last - first >= 1.0 else 1
        heading = f"{first:.{digits}f}–{last:.{digits}f} min: {words}"
        axes.set_title(heading, loc="left", fontsize=look.title, weight="bold", pad=3.0)
        axes.set_ylabel("" if place else "height (km)")
        axes.tick_params(labelleft=not place)
        axes.set_xlabel("width (km)", labelpad=1.0)
    key = f"longest arrow\n{fastest:.0f} m/s"
    measure.write(key, wide, top + 2.0 * look.text + box, ha="right", va="top", fontsize=look.small)
    left = (4.2 * look.text + (1.0 - _BAR) * wide - 1.2 * look.text) / wide
    holder = drawing.add_axes((left, base, 0.012, box / high), in_layout=False)
    bar = drawing.colorbar(ScalarMappable(norm, _COLOURS), cax=holder, ticks=MaxNLocator(4))
    holder.set_title(spelled("degC"), fontsize=look.text, pad=3.0)
    holder.tick_params(labelsize=look.small)
    bar.outline.set_visible(False)


def _means(dataset: xr.Dataset, first: int, last: int) -> xr.Dataset:
    """Return temperature ``warm`` [degC], wind and upward wind of each cell, as means over some frames."""
    cells = dataset[["cell_temperature", "horizontal_wind", "upward_wind"]].isel(elapsed_time=slice(first, last))
    mean = cells.mean("elapsed_time").transpose("height", "distance")
    return mean.fillna(mean.mean()).assign(warm=lambda each: each.cell_temperature - 273.15)


def _draw(
    axes: Axes, edges: list[NDArray[np.float64]], picture: xr.Dataset, norm: Normalize, fastest: float, look: Theme
) -> None:
    """Draw the air at one instant; arrows stand for the mean of as many cells as make them few enough."""
    axes.pcolormesh(*edges, picture.warm, cmap=_COLOURS, norm=norm, rasterized=True)
    by = math.ceil(picture.sizes["distance"] / _ARROWS)
    if picture.sizes["height"] >= by:
        part = picture.coarsen(height=by, distance=by, boundary="trim").mean()
        x, y = part.distance.values / 1000.0, part.height.values / 1000.0
        longest = float(x[1] - x[0]) if len(x) > 1 else float(np.ptp(edges[0]))
        axes.quiver(
            x, y, part.horizontal_wind, part.upward_wind, color="white", edgecolor=DARK, linewidth=0.15 * look.line,
            angles="xy", scale_units="xy", scale=max(fastest, 1e-30) / longest, width=0.009, pivot="middle",
        )  # fmt: skip
    axes.set(xlim=edges[0][[0, -1]], ylim=edges[1][[0, -1]])
    axes.locator_params("x", nbins=4)
    axes.locator_params("y", nbins=3)
    axes.tick_params(labelsize=look.small, length=2.0)
