"""Pictures that no scene draws: the parcel on its way up, and the cells of the engine."""

import itertools

import numpy as np
from jobs.drawing import BLUE, VERMILLION, axes_of, save, sheet
from jobs.registry import Findings, job
from matplotlib.collections import EllipseCollection
from matplotlib.patches import Circle, Rectangle

from atmosbox.plot.theme import DARK, FAINT
from atmosbox.simulation import runner

SLICE = 12e-9
"""Thickness of the slice of the box that is drawn [m]."""


@job("lifting-picture")
def lifting_picture(found: Findings) -> None:
    """Draw the box at three heights, and the temperature all the way."""
    outcome = runner.execute(runner.prepare("lifting-dry", {}, save_molecules=True))
    data = outcome.dataset
    width = float(np.sqrt(data.parcel_volume[0] / data.piston_height[0]))
    frames = (0, data.sizes["elapsed_time"] // 2, data.sizes["elapsed_time"] - 1)
    highest = float(data.piston_height.max())
    with sheet((10.4, 6.9)) as drawing:
        grid = drawing.add_gridspec(2, 6, height_ratios=(1.0, 1.02))
        for k, frame in enumerate(frames):
            axes = drawing.add_subplot(grid[0, 2 * k : 2 * k + 2])
            colours = draw_box(axes, data.isel(elapsed_time=frame), width, highest, outcome)
        bar = drawing.colorbar(colours, ax=drawing.axes, shrink=0.85, pad=0.01, aspect=25, extend="max")
        bar.set_label("speed of a molecule (m s⁻¹)")
        bar.outline.set_visible(False)
        draw_profile(drawing.add_subplot(grid[1, :3]), data)
        draw_misfit(drawing.add_subplot(grid[1, 3:]), data)
        save(found, drawing, "lifting-dry", 115)


def draw_box(axes, now, width: float, highest: float, outcome):
    """Draw a slice of the box, its walls and its piston; return what the colours stand for."""
    nm = 1e9
    place = now.molecule_position.values
    inside = np.abs(place[:, 1] - 0.5 * width) < 0.5 * SLICE
    place, speed = place[inside] * nm, now.molecule_speed.values[inside]
    ceiling, side = float(now.piston_height) * nm, width * nm
    size = np.full(len(place), 1.0)
    discs = EllipseCollection(
        size,
        size,
        np.zeros(len(place)),
        units="xy",
        offsets=place[:, [0, 2]],
        offset_transform=axes.transData,
        cmap="viridis",
        linewidths=0.2,
        edgecolors=DARK,
    )
    discs.set_array(speed)
    discs.set_clim(0.0, 1000.0)
    axes.add_collection(discs)
    axes.plot([0, 0, side, side], [ceiling, 0, 0, ceiling], color=DARK, linewidth=2.2)
    axes.add_patch(Rectangle((-1.0, ceiling), side + 2.0, 3.2, color=FAINT))
    axes.annotate(
        "",
        (0.5 * side, ceiling + 12.5),
        (0.5 * side, ceiling + 3.0),
        arrowprops={"arrowstyle": "-|>", "color": FAINT, "linewidth": 2.0},
    )
    axes.set(xlim=(-3.0, side + 3.0), ylim=(-2.0, highest * nm + 16.0), aspect="equal")
    axes.set_axis_off()
    warmth, hpa = float(now.parcel_temperature) - 273.15, float(now.parcel_pressure) / 100.0
    text = f"{float(now.parcel_height) / 1000.0:.1f} km:  {warmth:.0f} °C,  {hpa:.0f} hPa".replace("-", "−")
    axes.set_title(text, loc="center", fontweight="bold")
    return discs


def draw_profile(axes, data) -> None:
    """Draw temperature against pressure."""
    hpa = data.parcel_pressure / 100.0
    axes.plot(
        data.environment_temperature - 273.15,
        data.environment_pressure / 100.0,
        color="#009e73",
        linestyle=(0, (7, 2, 1.5, 2)),
        label="air around",
    )
    axes.plot(data.parcel_temperature - 273.15, hpa, "o", color=BLUE, label="molecules")
    axes.plot(
        data.adiabat_temperature - 273.15, hpa, "--", color=DARK, label="dry adiabat, $T\\sim p^{\\,2/7}$", zorder=5
    )
    axes.set(yscale="log", xlabel="temperature (°C)", ylabel="pressure (hPa)", title="They cool as air does")
    axes.set_yticks([300, 400, 500, 700, 850, 1000], ["300", "400", "500", "700", "850", "1000"])
    axes.set_yticks([], minor=True)
    axes.set_ylim(1010.0, 290.0)
    axes.legend(loc="upper right")


def draw_misfit(axes, data) -> None:
    """Draw what is between measurement and theory."""
    hpa = data.parcel_pressure / 100.0
    axes.axvline(0.0, linestyle="--", color=DARK)
    axes.errorbar(
        data.parcel_temperature - data.adiabat_temperature, hpa, xerr=data.parcel_temperature_se, fmt="o", color=BLUE
    )
    axes.set(yscale="log", xlabel="molecules less adiabat (K)", title="… to a tenth of a kelvin")
    axes.set_yticks([300, 400, 500, 700, 850, 1000], ["300", "400", "500", "700", "850", "1000"])
    axes.set_yticks([], minor=True)
    axes.set(ylim=(1010.0, 290.0), xlim=(-0.5, 0.5))


@job("cells", quick=True)
def cells(found: Findings) -> None:
    """Draw how molecules belong to cells, and the boundaries that make the slots."""
    radius, edges = 0.22, np.arange(4.0)
    with axes_of(2, (9.6, 4.7), (3.1, 3.58)) as (drawing, (left, right)):
        places = {(0.52, 2.45): 1, (1.05, 1.55): 2, (2.05, 1.1): 4, (1.488, 1.59): 1, (1.55, 0.5): 1, (2.6, 2.5): 1}
        colours = {1: BLUE, 2: VERMILLION, 4: "#cc79a7"}
        for edge in edges:
            left.plot([edge, edge], [0, 3], color=FAINT, linewidth=1.2)
            left.plot([0, 3], [edge, edge], color=FAINT, linewidth=1.2)
        for (x, y), many in places.items():
            left.add_patch(Circle((x, y), radius, facecolor=colours[many], edgecolor=DARK, alpha=0.9))
            left.text(x, y, str(many), ha="center", va="center", color="white", fontweight="bold")
        left.set(title="In how many cells a molecule is", xlim=(-0.05, 3.05), ylim=(-0.05, 3.05), aspect="equal")
        left.set_axis_off()
        draw_slots(right, radius, edges)
        save(found, drawing, "cells")


def draw_slots(axes, radius: float, edges: np.ndarray) -> None:
    """Draw one axis of the box: edges of cells, boundaries of slots, and a molecule that crosses."""
    bounds = [radius, *sorted([*(edges[1:-1] - radius), *(edges[1:-1] + radius)]), edges[-1] - radius]
    high, middle, low = 2.25, 1.05, 0.62
    for k, (left, right) in enumerate(itertools.pairwise(bounds)):
        colour = BLUE if k % 2 == 0 else VERMILLION
        axes.add_patch(Rectangle((left, 0.85), right - left, 0.4, facecolor=colour, alpha=0.3, edgecolor="none"))
        cells_in = f"{k // 2}" if k % 2 == 0 else f"{k // 2}, {k // 2 + 1}"
        for height, text in ((middle, str(k)), (low, cells_in)):
            axes.text(0.5 * (left + right), height, text, ha="center", va="center", color=DARK)
    for edge in edges:
        wall = edge in (edges[0], edges[-1])
        axes.plot(
            [edge, edge], [0.45 if wall else 1.4, 2.95], color=DARK if wall else FAINT, linewidth=3.0 if wall else 1.2
        )
    for x, alpha in ((0.5, 0.3), (1.0 - radius, 0.6), (1.06, 1.0)):
        axes.add_patch(
            Circle((x, high), radius, facecolor=VERMILLION if x > 1.0 else BLUE, edgecolor=DARK, alpha=alpha)
        )
    axes.annotate("", (1.7, high), (1.3, high), arrowprops={"arrowstyle": "-|>", "color": DARK, "linewidth": 1.6})
    axes.plot([1.0 - radius] * 2, [1.25, high], ":", color=DARK, linewidth=1.4)
    axes.text(0.72, 1.66, "here it\nenters\ncell 1", ha="right", va="center", fontsize=10)
    for height, text in ((middle, "slot"), (low, "cells")):
        axes.text(-0.1, height, text, ha="right", va="center")
    axes.set(title="Along each axis: slots of its centre", xlim=(-0.5, 3.08), ylim=(0.02, 3.12), aspect="equal")
    axes.set_axis_off()
