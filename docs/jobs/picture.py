"""The cells of the engine, drawn."""

import itertools

import numpy as np
from jobs.drawing import BLUE, VERMILLION, axes_of, save
from jobs.registry import Findings, job
from matplotlib.patches import Circle, Rectangle

from atmosbox.plot.theme import DARK, FAINT


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
