"""The molecules themselves: a flat box with its discs, true to size, coloured by their speed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import LogNorm, Normalize, to_rgb
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from atmosbox.panels import Panel
from atmosbox.plot.curve import read
from atmosbox.plot.theme import DARK, FAINT, FIELD_COLOURS, Theme
from atmosbox.plot.tick import put_ticks
from atmosbox.plot.unit import convert, spelled

if TYPE_CHECKING:
    import xarray as xr

# The colours are logarithmic where the fastest discs are so many times as fast as the median.
_WIDE_SPREAD = 10.0
# The rim of a heavy disc is at most so wide, in diameters; the box is about so high, in heights of the figure.
_BROADEST_RIM, _BOX_HEIGHT = 0.12, 0.6
# A trail goes so many frames back. It is left out where a molecule crosses much of the box between two frames.
_TRAIL_FRAMES = 12
_MOST_SEGMENTS = 6000
_LONGEST_STEP = 0.1


def draw_discs(axes: Axes, panel: Panel, dataset: xr.Dataset, theme: Theme) -> list[tuple[tuple[Artist, ...], str]]:
    """Draw the last frame of a flat scene: box, discs, and where they come from.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Where to draw.
    panel : Panel
        A panel of the kind ``discs``; its ``x_unit`` is the unit of length, nm where it is empty.
    dataset : xarray.Dataset
        The run, with ``disc_position`` and ``disc_velocity`` (elapsed_time, molecule, axis),
        ``disc_diameter`` and ``disc_mass`` (molecule). The box reaches from 0 to ``box_length``, one number
        or one for each axis; without that variable it is as large as the room that the discs have taken.
    theme : Theme
        How large.

    Returns
    -------
    list of tuple
        The entries of the legend: none, or the light and the heavy discs.

    Raises
    ------
    FileError
        If the file lacks one of the variables.

    Examples
    --------
    >>> import xarray as xr
    >>> from matplotlib.figure import Figure
    >>> from atmosbox.plot.theme import THEMES
    >>> place = (("elapsed_time", "molecule", "axis"), [[[1e-9, 2e-9], [3e-9, 1e-9]]], {"units": "m"})
    >>> size = ("molecule", [4e-10, 8e-10], {"units": "m"})
    >>> dataset = xr.Dataset(
    ...     {
    ...         "disc_position": place,
    ...         "disc_velocity": (*place[:2], {"units": "m s-1"}),
    ...         "disc_diameter": size,
    ...         "disc_mass": ("molecule", [1.0, 4.0], {"units": "kg"}),
    ...     }
    ... )
    >>> axes = Figure().add_subplot()
    >>> [label for _, label in draw_discs(axes, Panel("discs", "The box"), dataset, THEMES["notes"])]
    ['light half', 'heavy half: 4 × the mass']
    """
    unit = panel.x_unit or "nm"
    position, velocity = (
        read(dataset, name).transpose("elapsed_time", "molecule", "axis") for name in ("disc_position", "disc_velocity")
    )
    plane = _plane(position.values)
    places = convert(position.values[:, :, plane], str(position.attrs.get("units", "m")), unit, name="disc_position")
    diameter = read(dataset, "disc_diameter")
    sizes = convert(diameter.values, str(diameter.attrs.get("units", "m")), unit, name="disc_diameter")
    box = _box(dataset, places, sizes, plane, unit)
    mass = read(dataset, "disc_mass").values
    heavy = _heavy_half(mass)

    _draw_trails(axes, places, float(np.min(box[1] - box[0])), theme)
    speed = np.linalg.norm(velocity.values, axis=2)
    norm = _colour_scale(speed)
    discs = EllipseCollection(
        sizes,
        sizes,
        np.zeros_like(sizes),
        units="xy",
        offsets=places[-1],
        offset_transform=axes.transData,
        cmap=FIELD_COLOURS,
        norm=norm,
        edgecolors=DARK,
        linewidths=np.minimum(_rims(axes, sizes, box), theme.line) * np.where(heavy, 1.0, 1.0 / 3.0),
        zorder=3.0,
    )
    discs.set_array(speed[-1])
    axes.add_collection(discs)

    axes.set_aspect("equal", adjustable="box", anchor="NW")
    axes.set_xlim(box[0, 0], box[1, 0])
    axes.set_ylim(box[0, 1], box[1, 1])
    axes.spines[:].set(visible=True, linewidth=theme.line * 1.2, color=DARK)
    log = isinstance(norm, LogNorm)
    bar = axes.figure.colorbar(discs, cax=axes.inset_axes((1.04, 0.1, 0.03, 0.8)), extend="both" if log else "max")
    bar.set_label(f"speed ({spelled(str(velocity.attrs.get('units', 'm s-1')))})")
    if log:
        put_ticks(bar.ax.yaxis, log=True, length=10.0 * theme.text, size=theme.text)
    else:
        bar.locator = MaxNLocator(4)
    return _entries(heavy, mass, theme)


def axis_names(dataset: xr.Dataset) -> tuple[str, str]:
    """Return the names of the two axes of a flat scene.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run.

    Returns
    -------
    tuple of str
        The two axes along which the molecules move.

    Raises
    ------
    FileError
        If the file holds no positions of discs.

    Examples
    --------
    >>> import xarray as xr
    >>> places = [[[0.0, 7.0, 1.0], [1.0, 7.0, 0.0]]]
    >>> axis_names(xr.Dataset({"disc_position": (("elapsed_time", "molecule", "axis"), places)}))
    ('x', 'z')
    """
    position = read(dataset, "disc_position").transpose("elapsed_time", "molecule", "axis")
    first, second = _plane(position.values)
    return "xyz"[first], "xyz"[second]


def _plane(position: NDArray[np.float64]) -> list[int]:
    """Return the two axes along which the positions (time, molecule, axis) spread most, in order."""
    spread = np.nanmax(position, axis=(0, 1)) - np.nanmin(position, axis=(0, 1))
    return sorted(int(axis) for axis in np.argsort(-spread, kind="stable")[:2])


def _box(
    dataset: xr.Dataset, places: NDArray[np.float64], sizes: NDArray[np.float64], plane: list[int], unit: str
) -> NDArray[np.float64]:
    """Return the lower and the upper corner of the box."""
    if "box_length" in dataset.variables:
        length = read(dataset, "box_length")
        ends = convert(length.values, str(length.attrs.get("units", "m")), unit, name="box_length")
        return np.stack((np.zeros(2), ends[plane] if ends.ndim else np.full(2, ends)))
    radius = sizes[None, :, None] / 2
    return np.stack((np.nanmin(places - radius, axis=(0, 1)), np.nanmax(places + radius, axis=(0, 1))))


def _draw_trails(axes: Axes, places: NDArray[np.float64], box: float, theme: Theme) -> None:
    frames = min(_TRAIL_FRAMES, _MOST_SEGMENTS // places.shape[1], len(places) - 1)
    if frames < 1:
        return
    path = places[-frames - 1 :]
    steps = np.median(np.linalg.norm(np.diff(path, axis=0), axis=2), axis=0)
    path = path[:, steps <= _LONGEST_STEP * box]
    if not path.size:
        return
    segments = np.stack((path[:-1], path[1:]), axis=2).reshape(-1, 2, 2)
    alpha = np.repeat(np.linspace(0.1, 0.8, frames), path.shape[1])
    colours = np.column_stack((np.tile(to_rgb(FAINT), (alpha.size, 1)), alpha))
    axes.add_collection(LineCollection(list(segments), colors=colours, linewidths=theme.line * 0.8, zorder=2.0))


def _colour_scale(speed: NDArray[np.float64]) -> Normalize:
    """Return the scale of the colours: from zero, or logarithmic where most discs are far slower than the fastest."""
    moving = speed[speed > 0.0]
    if not moving.size:
        return Normalize(0.0, 1.0)
    low, middle, high = (float(value) for value in np.percentile(moving, (3, 50, 97)))
    if high > _WIDE_SPREAD * middle:
        return LogNorm(low, high)
    return Normalize(0.0, float(MaxNLocator(4).tick_values(0.0, high)[-1]))


def _heavy_half(mass: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Tell which discs are of the heavier half; none if all are alike."""
    heavy = np.zeros(mass.size, dtype=bool)
    if mass.size and mass.min() < mass.max():
        heavy[np.argsort(mass, kind="stable")[mass.size // 2 :]] = True
    return heavy


def _rims(axes: Axes, sizes: NDArray[np.float64], box: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how broad rims may be [pt], lest they hide the colours of small discs."""
    drawing = axes.get_figure(root=True)
    height = 72.0 * drawing.get_figheight() if drawing else 0.0
    return _BROADEST_RIM * _BOX_HEIGHT * height * sizes / float(np.max(box[1] - box[0]))


def _ratio(value: float) -> str:
    """Return a ratio in two digits and without exponent."""
    return f"{float(f'{value:.2g}'):,.15g}".replace(",", "\u2009" if value >= 1e4 else "")


def _entries(heavy: NDArray[np.bool_], mass: NDArray[np.float64], theme: Theme) -> list[tuple[tuple[Artist, ...], str]]:
    """Return what the legend says of two kinds of discs, nothing if they are all alike."""
    if not heavy.any():
        return []
    ratio = float(np.median(mass[heavy]) / np.median(mass[~heavy]))

    def disc(scale: float, width: float) -> Line2D:
        return Line2D(
            [], [], linestyle="none", marker="o", markersize=theme.marker * scale, markerfacecolor="white",
            markeredgecolor=DARK, markeredgewidth=width,
        )  # fmt: skip

    return [
        ((disc(1.4, theme.line / 3),), "light half"),
        ((disc(2.2, theme.line),), f"heavy half: {_ratio(ratio)} × the mass"),
    ]
