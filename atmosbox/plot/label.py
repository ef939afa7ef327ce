"""Words beside marks: each where it covers no other, or left out."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox
from numpy.typing import NDArray

__all__ = ["put_beside"]

_HALO = withStroke(linewidth=1.5, foreground="white", alpha=0.8)


def put_beside(
    drawing: Figure, axes: Axes, labels: Sequence[Annotation], marks: NDArray[np.float64], gap: float
) -> None:
    """Put each label above, below, right or left of its mark, where it stays in the axes and covers no other.

    A place where it covers no mark is better than one where it does; lines under it fade. What finds no place is
    taken away: what is said first has the first choice.

    Parameters
    ----------
    drawing : matplotlib.figure.Figure
        The figure, in which everything else has its place.
    axes : matplotlib.axes.Axes
        The panel.
    labels : sequence of matplotlib.text.Annotation
        The words, each with an offset from its mark in points.
    marks : (mark, 2) ndarray
        Where marks are [data].
    gap : float
        How far from its mark a label stands [points].

    Examples
    --------
    >>> drawing = Figure(figsize=(2.0, 2.0), dpi=100)
    >>> axes = drawing.subplots()
    >>> words = [axes.annotate("here", (0.5, 0.5), (0, 0), textcoords="offset points") for _ in range(6)]
    >>> put_beside(drawing, axes, words, np.array([[0.5, 0.5]]), 4.0)
    >>> [each.get_verticalalignment() for each in axes.texts]
    ['bottom', 'top']
    """
    drawing.draw_without_rendering()
    frame = axes.get_window_extent()
    points = axes.transData.transform(marks[np.isfinite(marks).all(axis=1)])
    places = ((0.0, gap, "center", "bottom"), (0.0, -gap, "center", "top"), (1.4 * gap, 0.0, "left", "center"),
              (-1.4 * gap, 0.0, "right", "center"))  # fmt: skip
    taken: list[Bbox] = []
    for label in labels:
        best: tuple[int, int] | None = None
        for choice, (dx, dy, across, up) in enumerate(places):
            _move(label, dx, dy, across, up)
            box = label.get_window_extent()
            if not _within(box, frame) or any(box.overlaps(other) for other in taken):
                continue
            covered = int(np.sum((points > (box.x0, box.y0)).all(axis=1) & (points < (box.x1, box.y1)).all(axis=1)))
            if best is None or (covered, choice) < best:
                best = covered, choice
        if best is None:
            label.remove()
            continue
        _move(label, *places[best[1]])
        label.set_path_effects([_HALO])
        taken.append(label.get_window_extent())


def _move(label: Annotation, dx: float, dy: float, across: str, up: str) -> None:
    label.set_position((dx, dy))
    label.set(ha=across, va=up)


def _within(box: Bbox, frame: Bbox) -> bool:
    corners: Iterable[bool] = (box.x0 >= frame.x0, box.x1 <= frame.x1, box.y0 >= frame.y0, box.y1 <= frame.y1)
    return all(corners)
