"""The atmosphere around a lifted parcel: ground or mountains, the parcel on its path, its cloud and its rain."""

from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from atmosbox.plot.curve import read
from atmosbox.plot.theme import DARK, FAINT, OKABE_ITO, Theme

Entry = tuple[tuple[Artist, ...], str]
Floats = NDArray[np.float64]

_, _, _, _, _, _BLUE, _VERMILLION, _ = OKABE_ITO
_SKY = LinearSegmentedColormap.from_list("sky", ("#e4f0f8", "#9cc4e2"))
_GROUND, _ROCK, _CLOUD, _RIM, _CLEAR = "#8aa37b", "#9a8f80", "#ffffff", "#8c97a3", "#cfe3f1"
_FAINTEST_RAIN = 0.02
"""Rain of a frame above which it is drawn, as a share of all rain of the run."""
_DESCENT = 0.1
"""A path that goes down again by more than this share of its range of heights leads over mountains."""
_RADIUS = 0.75
"""Radius of the parcel at the start, in units of the type size."""
_MIDDLE, _CLOUD_MIDDLE = 0.4, 0.53
"""Horizontal position of a vertical path and of its cloud, in widths of the picture."""
_PUFFS = 9
"""Number of puffs across the width of a cloud."""
_GAP = 0.07
"""Height of the parcel above the mountains in the picture, in heights of the picture."""


class Ascent(NamedTuple):
    """The path of a parcel from the file, one value for each frame."""

    time: Floats
    """Elapsed time as a share of the whole run, from 0 to 1."""
    height: Floats
    """Height [km]."""
    temperature: Floats
    """Measured temperature [degC]."""
    pressure: Floats
    """Pressure of the environment at that height [hPa]."""
    liquid: Floats
    """Measured liquid per dry air [kg kg-1]; 0 in a scene without water."""
    haze: Floats
    """Liquid per dry air above which it is a cloud [kg kg-1]; infinite if the file does not tell."""
    rain: Floats
    """Measured rain per dry air from the start up to the frame [kg kg-1]; 0 where none falls."""
    base: float
    """Height of the measured cloud base [km]; NaN where the run measures none above the ground."""

    @property
    def radius(self) -> Floats:
        """Radius of the parcel in units of its radius at the start, from temperature and pressure."""
        volume = (self.temperature + 273.15) / self.pressure
        return np.asarray(np.cbrt(volume / volume[0]))

    @property
    def crosses(self) -> bool:
        """Whether the path leads over mountains: whether it goes down again."""
        highest = int(self.height.argmax())
        return bool(self.height[highest] - self.height[highest:].min() > _DESCENT * np.ptp(self.height))

    @property
    def cloudy(self) -> NDArray[np.bool_]:
        """Whether there is a cloud in each frame: more liquid than chance puts together in air without a cloud."""
        return np.asarray(self.liquid > self.haze)


def ascent_of(dataset: xr.Dataset, start: tuple[float, ...] = (), *, risen: bool = False) -> Ascent:
    """Return the path of the parcel of a run.

    ``start`` is the temperature [degC] and the pressure [hPa] at height 0, if known. With ``risen``, frames above the
    equilibrium level are left out: a parcel does not rise by itself to these.
    """
    time, height, kelvin, pascal = (
        read(dataset, name).values.astype(np.float64)
        for name in ("elapsed_time", "parcel_height", "parcel_temperature", "environment_pressure")
    )
    water = {"cloud_liquid_water_mixing_ratio": 0.0, "largest_haze_mixing_ratio": np.inf, "rain_mixing_ratio": 0.0}
    rows = np.stack([
        time / (time[-1] or 1.0), height / 1e3, kelvin - 273.15, pascal / 1e2,
        *(np.nan_to_num(dataset[name].values) if name in dataset else 0 * time + none for name, none in water.items()),
    ])  # fmt: skip
    base = float(dataset.get("cloud_base", np.inf)) / 1e2
    base = float(np.interp(-np.log(base), -np.log(rows[3]), rows[1])) if base <= rows[3].max() else np.nan
    if risen and "el" in dataset:
        rows = rows[:, ~(rows[3] < float(dataset["el"]) / 1e2)]
    if start:
        rows = np.column_stack([(0.0, 0.0, *start, 0.0, np.inf, 0.0), rows])
    return Ascent._make([*rows, base])


def draw_atmosphere(axes: Axes, dataset: xr.Dataset, theme: Theme, start: tuple[float, ...] = ()) -> list[Entry]:
    """Draw the whole path of a parcel with its temperature at several points; return the legend entries."""
    way = ascent_of(dataset, start, risen=True)
    draw_ground(axes, way, theme)
    if way.crosses:
        rising = np.diff(way.height) >= 0.0
        stations = np.array([0, *np.flatnonzero(np.diff(rising)) + 1, way.height.size - 1])
    else:
        heights = np.linspace(way.height[0], way.height[-1], 5 if theme.grows else 4)  # a slide has less room
        stations = np.unique([int(np.abs(way.height - height).argmin()) for height in heights])
    return draw_way(axes, way, way.height.size - 1, stations, theme)


def draw_ground(axes: Axes, way: Ascent, theme: Theme) -> None:
    """Draw what is the same in all frames: sky, ground or mountains, and path; set the limits of the axes."""
    low, high = min(0.0, float(way.height.min())), max(float(way.height.max()), 1e-3)
    room = high - low
    axes.set(xlim=(0.0, 1.0), ylim=(low - 0.12 * room, high + 0.2 * room))
    axes.set_xticks([])
    axes.spines["bottom"].set_visible(False)
    bottom, top = axes.get_ylim()
    gradient = np.linspace(0.0, 1.0, 64)[:, None]
    axes.imshow(gradient, _SKY, aspect="auto", extent=(0.0, 1.0, bottom, top), origin="lower", zorder=0.0)
    across = _across(way)
    if way.crosses:
        ends = np.concatenate([[0.0], across, [1.0]])
        slope = np.concatenate([way.height[:1], way.height, way.height[-1:]]) - _GAP * room
        axes.fill_between(ends, bottom, slope, color=_ROCK, linewidth=0.0, zorder=2.2)
    else:
        axes.axhspan(bottom, low, color=_GROUND, linewidth=0.0, zorder=1.0)
    axes.plot(across, way.height, color=FAINT, linewidth=theme.line / 2, linestyle=(0.0, (2.0, 2.0)), zorder=3.0)
    axes.set(xlim=(0.0, 1.0), ylim=(bottom, top), autoscale_on=False)


def draw_way(axes: Axes, way: Ascent, until: int, stations: NDArray[np.int64], theme: Theme) -> list[Entry]:
    """Draw the cloud and the rain up to the frame ``until``, and the parcel in some frames; return the legend entries.

    The parcel is drawn in the frames ``stations`` with its temperature and, on a vertical path, its pressure.
    """
    entries: list[Entry] = []
    across, seen = _across(way), way.cloudy & (np.arange(way.height.size) <= until)
    room = float(np.ptp(axes.get_ylim()))
    base = way.base if np.isfinite(way.base) else float(way.height[seen.argmax() if seen.any() else until])
    if seen.any():
        if way.crosses:
            size = 1.4 * np.sqrt(way.liquid[seen] / way.liquid.max())
            _puffs(axes, across[seen], way.height[seen], size, theme)
        else:
            _tower(axes, base, float(way.height[: until + 1].max()), room, theme)
            note: dict[str, Any] = {"size": theme.small, "color": DARK, "zorder": 3.0}
            axes.annotate(
                "cloud base", (0.02, base), (0.0, -0.3 * theme.small), textcoords="offset points", va="top", **note
            )
        entries.append(((Patch(facecolor=_CLOUD, edgecolor=_RIM, linewidth=theme.line),), "cloud"))
    fallen = way.rain[: until + 1]
    if fallen[-1] > 0.0:
        falling = np.flatnonzero(np.diff(fallen) > _FAINTEST_RAIN * way.rain[-1])
        x, above, below = across[falling], way.height[falling], way.height[falling] - _GAP * room
        streaks = np.stack([np.stack([x, above], axis=1), np.stack([x - 0.012, below], axis=1)], axis=1)
        look: dict[str, Any] = {"linewidth": theme.line, "zorder": 2.5}
        axes.add_collection(LineCollection([*streaks], colors=_BLUE, **look), autolim=False)
        entries.append(((Line2D([], [], color=_BLUE, **look),), "rain"))
    spot = axes.get_subplotspec()
    wide = spot is not None and spot.get_gridspec().ncols == 1  # as wide as the page, and low: no room for two lines
    x, y = across[stations], way.height[stations]
    area = np.pi * (_RADIUS * theme.text * way.radius[stations]) ** 2
    colours = [_RIM if cloudy else _CLEAR for cloudy in way.cloudy[stations]]
    axes.scatter(x, y, area, colours, edgecolors=_BLUE, linewidths=theme.line, zorder=4.0)
    if not way.crosses:  # its size at the start, to compare
        axes.scatter(x[1:], y[1:], area[:1], "none", edgecolors=FAINT, linewidths=0.7 * theme.line, zorder=4.1)
    for place, frame in enumerate(stations):
        at, warm = (across[frame], way.height[frame]), f"{way.temperature[frame]:.0f} °C"
        if way.crosses:
            side = 1 if place == 0 and stations.size > 1 else -1 if frame == way.height.size - 1 else 0
            _say(axes, warm, at, (side, 1), theme, bold=True)
        else:
            up = 1.1 if way.height[frame] <= 0.02 * way.height[-1] else 0.0  # not over the ground
            down = 0.0 if wide else 0.55
            _say(axes, warm, at, (1, 0), theme, bold=True, lower=-down - up)
            _say(axes, f"{way.pressure[frame]:.0f} hPa", at, (-1 if wide else 1, 0), theme, lower=down - up)
    parcel = Line2D(
        [], [], linestyle="none", marker="o", markersize=theme.text, markerfacecolor=_CLEAR, markeredgecolor=_BLUE,
        markeredgewidth=theme.line,
    )  # fmt: skip
    return [((parcel,), "parcel"), *entries]


def _across(way: Ascent) -> Floats:
    """Return the horizontal position of the parcel: constant on a vertical path, from end to end over mountains."""
    return 0.055 + 0.89 * way.time if way.crosses else np.full_like(way.time, _MIDDLE)


def _puffs(axes: Axes, x: Floats, y: Floats, size: Floats, theme: Theme) -> list[PathCollection]:
    """Draw a cloud as discs whose radius is in units of the type size: first their common rim, then the white area."""
    area = np.pi * (size * theme.text) ** 2
    rim = axes.scatter(x, y, area, _RIM, linewidths=1.6 * theme.line, edgecolors=_RIM, zorder=1.8)
    return [rim, axes.scatter(x, y, area, _CLOUD, linewidths=0.0, zorder=1.9)]


def _tower(axes: Axes, base: float, top: float, room: float, theme: Theme) -> None:
    """Draw a cloud with a flat base that becomes narrower upward."""
    rows = max(2, round(16.0 * (top - base) / room))
    share, place = np.repeat(np.linspace(0.0, 1.0, rows), _PUFFS), np.tile(np.linspace(-1.0, 1.0, _PUFFS), rows)
    rng = np.random.default_rng(5)  # the same cloud in every picture
    half = 0.36 - 0.06 * share * (top - base) / room
    radius = 1.2 + 0.5 * rng.random(share.size)
    across = _CLOUD_MIDDLE + half * (place + 0.05 * rng.normal(size=share.size))
    above = Rectangle((0.0, base), 1.0, room, transform=axes.transData)
    for puffs in _puffs(axes, across, base + share * (top - base), radius, theme):
        puffs.set_clip_path(above)
    inside = float(half.min())  # half width of a rectangle that fills gaps between the puffs
    gaps = Rectangle((_CLOUD_MIDDLE - inside, base), 2.0 * inside, top - base, color=_CLOUD, linewidth=0.0, zorder=1.95)
    axes.add_patch(gaps)


def _say(
    axes: Axes, words: str, at: tuple[float, float], side: tuple[int, int], theme: Theme, *,
    bold: bool = False, lower: float = 0.0,
) -> None:  # fmt: skip
    """Write a text beside a parcel: to the right for side (1, 0), above for (0, 1), and so on.

    The text is moved down by ``lower`` times the type size.
    """
    right, up = side
    away = 1.6 * _RADIUS * theme.text * (1.0 if up else 1.25)
    axes.annotate(
        words.replace("-", "−"), at, (0.0 if up else away * right, away * up - lower * theme.text),
        textcoords="offset points", ha=("center", "left", "right")[right], va="bottom" if up else "center",
        size=theme.text, weight="bold" if bold else "normal", color=_VERMILLION if bold else DARK, zorder=5.0,
        path_effects=[withStroke(linewidth=2.0 * theme.line, foreground="white", alpha=0.8)],
    )  # fmt: skip
