"""The molecules of a planar scene: the box with its discs, drawn to size and coloured by their speed."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import Normalize, to_rgb
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from atmosbox.plot.curve import read
from atmosbox.plot.theme import DARK, FAINT, FIELD_COLOURS, Theme
from atmosbox.plot.units import convert, spelled
from atmosbox.scene.panels import Panel

_FAST = 5.0
"""Discs more than this many times as fast as the median disc have the colour of the fastest."""


class Discs(NamedTuple):
    """The discs of a planar scene: their position and speed in every frame, their diameter and mass."""

    place: NDArray[np.float64]
    """Positions, (frame, molecule, 2), in the unit of length that is shown."""
    speed: NDArray[np.float64]
    """Speeds, (frame, molecule), in the unit ``speed_unit``."""
    diameter: NDArray[np.float64]
    """Diameters, (molecule,), in the unit of length that is shown."""
    mass: NDArray[np.float64]
    """Masses, (molecule,), in the unit of the file."""
    box: NDArray[np.float64]
    """The lower and the upper corner of the box, (2, 2), in the unit of length that is shown."""
    speed_unit: str
    """The unit of the speeds, that of the file."""

    @property
    def heavy(self) -> NDArray[np.bool_]:
        """Which discs belong to the heavier half; none if all masses are equal."""
        heavy = np.zeros(self.mass.size, dtype=bool)
        if self.mass.size and self.mass.min() < self.mass.max():
            heavy[np.argsort(self.mass, kind="stable")[self.mass.size // 2 :]] = True
        return heavy


def discs(dataset: xr.Dataset, unit: str) -> Discs:
    """Return the discs of a planar scene.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run, as `draw_discs` takes it.
    unit : str
        The unit of length to show.

    Returns
    -------
    Discs
        The discs.

    Raises
    ------
    FileError
        If the file lacks one of the variables.

    Examples
    --------
    >>> import xarray as xr
    >>> discs(xr.Dataset(), "m")
    Traceback (most recent call last):
    atmosbox.errors.FileError: The file has no variable 'disc_position', which its figure needs: run the scene again \
with this version of atmosbox.
    """
    position, velocity = (
        read(dataset, name).transpose("elapsed_time", "molecule", "axis") for name in ("disc_position", "disc_velocity")
    )
    plane = _plane(position.values)
    places = convert(position.values[:, :, plane], str(position.attrs.get("units", "m")), unit, name="disc_position")
    diameter = read(dataset, "disc_diameter")
    sizes = convert(diameter.values, str(diameter.attrs.get("units", "m")), unit, name="disc_diameter")
    length = read(dataset, "box_length")
    ends = convert(length.values, str(length.attrs.get("units", "m")), unit, name="box_length")
    return Discs(
        places,
        np.linalg.norm(velocity.values, axis=2),
        sizes,
        read(dataset, "disc_mass").values,
        np.stack((np.zeros(2), ends[plane] if ends.ndim else np.full(2, ends))),
        str(velocity.attrs.get("units", "m s-1")),
    )


def axis_names(dataset: xr.Dataset) -> tuple[str, str]:
    """Return the names of the two axes of a planar scene.

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


def colour_scale(speed: NDArray[np.float64]) -> Normalize:
    """Return the colour scale of speeds, from zero to a round number that few exceed.

    Parameters
    ----------
    speed : ndarray
        All speeds that are to be shown, in any shape and unit.

    Returns
    -------
    matplotlib.colors.Normalize
        The scale.

    Examples
    --------
    >>> colour_scale(np.linspace(0.0, 900.0, 100)).vmax
    1000.0
    """
    moving = speed[speed > 0.0]
    high = min(np.percentile(moving, 97), _FAST * np.median(moving)) if moving.size else 1.0
    return Normalize(0.0, float(MaxNLocator(4).tick_values(0.0, high)[-1]))


def _plane(position: NDArray[np.float64]) -> list[int]:
    """Return the two axes along which the positions (time, molecule, axis) spread most, in order."""
    spread = np.nanmax(position, axis=(0, 1)) - np.nanmin(position, axis=(0, 1))
    return sorted(int(axis) for axis in np.argsort(-spread, kind="stable")[:2])


# Greatest number of frames of a trail, and of segments of all trails. A molecule has no trail if its median step from
# frame to frame is longer than this share of the box.
_TRAIL_FRAMES = 12
_MOST_SEGMENTS = 6000
_LONGEST_STEP = 0.1


def draw_discs(axes: Axes, panel: Panel, dataset: xr.Dataset, theme: Theme) -> list[tuple[tuple[Artist, ...], str]]:
    """Draw the last frame of a planar scene: the box, the discs, and their trails.

    Parameters
    ----------
    panel : Panel
        A panel of the kind ``discs``; its ``x_unit`` is the unit of length, nm where it is empty.
    dataset : xarray.Dataset
        The run, with ``disc_position`` and ``disc_velocity`` (elapsed_time, molecule, axis),
        ``disc_diameter`` and ``disc_mass`` (molecule). The box reaches from 0 to ``box_length``, one number
        or one for each axis.

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
    ...         "box_length": ((), 4e-9, {"units": "m"}),
    ...     }
    ... )
    >>> axes = Figure().add_subplot()
    >>> [label for _, label in draw_discs(axes, Panel("discs", "The box"), dataset, THEMES["notes"])]
    ['light half', 'heavy half: 4 × the mass']
    """
    found = discs(dataset, panel.x_unit or "nm")
    trail = trails(found.place, found.box, theme)
    if trail is not None:
        axes.add_collection(trail)
    drawn = put_discs(axes, found, theme)
    bar = axes.figure.colorbar(drawn, cax=axes.inset_axes((1.04, 0.1, 0.03, 0.8)), extend="max", ticks=MaxNLocator(4))
    bar.set_label(f"speed ({spelled(found.speed_unit)})")
    return _entries(found.heavy, found.mass, theme)


def put_discs(axes: Axes, found: Discs, theme: Theme) -> EllipseCollection:
    """Draw the discs of the last frame in their box.

    Parameters
    ----------
    found : Discs
        The discs.

    Returns
    -------
    matplotlib.collections.EllipseCollection
        The discs, coloured by their speed.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from atmosbox.plot.theme import THEMES
    >>> one = Discs(np.ones((1, 1, 2)), np.ones((1, 1)), np.ones(1), np.ones(1), np.array([[0, 0], [2, 2]]), "m s-1")
    >>> put_discs(Figure().add_subplot(), one, THEMES["notes"]).get_offsets().tolist()
    [[1.0, 1.0]]
    """
    # a rim must not hide the colour of a small disc
    rim = min(0.8, 15.0 * float(np.median(found.diameter) / np.ptp(found.box)))
    drawn = EllipseCollection(
        found.diameter, found.diameter, np.zeros_like(found.diameter), units="xy", offsets=found.place[-1],
        offset_transform=axes.transData, cmap=FIELD_COLOURS, norm=colour_scale(found.speed), edgecolors=DARK,
        linewidths=theme.line * np.where(found.heavy, rim, rim / 3.0), zorder=3.0,
    )  # fmt: skip
    drawn.set_array(found.speed[-1])
    axes.add_collection(drawn)

    axes.set_aspect("equal", adjustable="box", anchor="NW")
    axes.set_xlim(found.box[0, 0], found.box[1, 0])
    axes.set_ylim(found.box[0, 1], found.box[1, 1])
    axes.spines[:].set(visible=True, linewidth=theme.line * 1.2, color=DARK)
    return drawn


def trails(places: NDArray[np.float64], box: NDArray[np.float64], theme: Theme) -> LineCollection | None:
    """Return the trails of discs: their paths in the last frames.

    Parameters
    ----------
    places : ndarray, (frame, molecule, 2)
        Positions of the discs in all frames up to the one that is drawn [length].
    box : ndarray, (2, 2)
        The lower and the upper corner of the box [length].

    Returns
    -------
    matplotlib.collections.LineCollection or None
        The trails, fainter for older frames; None if there is only one frame, or if the steps of all discs are too
        long.

    Examples
    --------
    >>> from atmosbox.plot.theme import THEMES
    >>> trails(np.zeros((1, 5, 2)), np.array([[0.0, 0.0], [1.0, 1.0]]), THEMES["notes"]) is None
    True
    """
    frames = min(_TRAIL_FRAMES, _MOST_SEGMENTS // places.shape[1], len(places) - 1)
    if frames < 1:
        return None
    path = places[-frames - 1 :]
    steps = np.median(np.linalg.norm(np.diff(path, axis=0), axis=2), axis=0)
    path = path[:, steps <= _LONGEST_STEP * float(np.min(box[1] - box[0]))]
    if not path.size:
        return None
    segments = np.stack((path[:-1], path[1:]), axis=2).reshape(-1, 2, 2)
    alpha = np.repeat(np.linspace(0.1, 0.8, frames), path.shape[1])
    colours = np.column_stack((np.tile(to_rgb(FAINT), (alpha.size, 1)), alpha))
    return LineCollection(list(segments), colors=colours, linewidths=theme.line * 0.8, zorder=2.0)


def _ratio(value: float) -> str:
    """Return a ratio as text with two significant digits and without an exponent."""
    return f"{float(f'{value:.2g}'):,.15g}".replace(",", "\u2009" if value >= 1e4 else "")


def _entries(heavy: NDArray[np.bool_], mass: NDArray[np.float64], theme: Theme) -> list[tuple[tuple[Artist, ...], str]]:
    """Return the legend entries of the light and the heavy discs; none if all masses are equal."""
    if not heavy.any():
        return []
    ratio = float(np.median(mass[heavy]) / np.median(mass[~heavy]))

    look: dict[str, Any] = {"ls": "none", "marker": "o", "mfc": "white", "mec": DARK}
    light = Line2D([], [], ms=1.4 * theme.marker, mew=theme.line / 3, **look)
    weighty = Line2D([], [], ms=2.2 * theme.marker, mew=theme.line, **look)
    return [((light,), "light half"), ((weighty,), f"heavy half: {_ratio(ratio)} × the mass")]
