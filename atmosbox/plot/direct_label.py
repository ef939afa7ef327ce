"""Labels beside the curves that they name, placed where they cover little else."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from atmosbox.plot.pen import Pen

__all__ = ["Label", "put_labels"]

Floats = NDArray[np.float64]

_DISTANCES = (1.0, 2.0, 3.5, 5.5, 8.0)
"""Distances from the curve to its label that are tried, in units of the type size."""
_TOUCHES = 1.2
"""A label at a larger distance is joined to its curve by a thin line."""
_WAYS = ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (0.8, 0.8), (0.8, -0.8), (-0.8, 0.8), (-0.8, -0.8))
_DARKER = 0.72
_STEPS = 12
"""Number of points along each segment of a curve that labels avoid."""


class Label(NamedTuple):
    """A label for a curve."""

    words: str
    """The text, with its line breaks."""
    x: Floats
    y: Floats
    colour: str
    bold: bool = False
    clear: float = 0.0
    """Additional distance between the curve and the label, for a curve with a large marker [pt]."""


def put_labels(axes: Axes, labels: Sequence[Label], pen: Pen, size: float) -> None:
    """Write each label at that point of its curve where it covers least of the curves and of other labels.

    The axes must already have their final position: lay the figure out first.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        The axes in which the curves are drawn.
    labels : sequence of Label
        The labels with the points of their curves; they are placed in this order.
    pen : Pen
        The pen of the figure.
    size : float
        Size of the type [pt].

    Examples
    --------
    >>> from matplotlib.backends.backend_agg import FigureCanvasAgg
    >>> from matplotlib.figure import Figure
    >>> drawing = Figure(figsize=(4.0, 3.0))
    >>> _ = FigureCanvasAgg(drawing)
    >>> axes = drawing.subplots()
    >>> up, down = np.array([0.0, 1.0]), np.array([1.0, 0.0])
    >>> put_labels(axes, [Label("rises", up, up, "k"), Label("falls", up, down, "k")], Pen(drawing), 8.0)
    >>> boxes = [text.get_window_extent() for text in axes.texts]
    >>> bool(boxes[0].overlaps(boxes[1]))
    False
    """
    point = pen.figure.dpi / 72.0
    curves = [axes.transData.transform(np.column_stack([label.x, label.y])) for label in labels]
    busy = np.concatenate([_along(curve) for curve in curves]) if curves else np.zeros((0, 2))
    marks = [
        (at, max(label.clear, 0.4 * size) * point) for label, curve in zip(labels, curves, strict=True) for at in curve
    ]
    frame = np.array(axes.bbox.extents) + 0.4 * size * point * np.array([1.0, 1.0, -1.0, -1.0])
    taken: list[Floats] = []
    for label, curve in zip(labels, curves, strict=True):
        lines = label.words.split("\n")
        weight = "bold" if label.bold else "normal"
        wide = max(pen.width(line, size, weight) for line in lines) * point
        high = 1.25 * size * len(lines) * point
        best, least = None, np.inf
        for anchor in curve:
            for distance in _DISTANCES:
                for way in _WAYS:
                    away = (0.7 * distance * size + label.clear) * point
                    centre = anchor + np.array(way) * (0.5 * np.array([wide, high]) + away)
                    box = np.array([*(centre - 0.5 * np.array([wide, high])), *(centre + 0.5 * np.array([wide, high]))])
                    cost = _cost(box, frame, busy, marks, taken) + 0.4 * distance
                    if cost < least:
                        best, least = (anchor, distance, box), cost
        if best is None:
            continue
        anchor, distance, box = best
        taken.append(box)
        left, base = axes.transAxes.inverted().transform(box[:2])
        text = axes.text(
            left, base, label.words, transform=axes.transAxes, size=size, color=_ink(label.colour), weight=weight,
            va="bottom", ha="left", linespacing=1.15, zorder=6,
        )  # fmt: skip
        text.set_in_layout(False)
        if distance > _TOUCHES:
            nearest = np.clip(anchor, box[:2], box[2:])
            leader = np.array([anchor, nearest])
            busy = np.concatenate([busy, _along(leader)])
            ends = axes.transAxes.inverted().transform(leader)
            axes.plot(*ends.T, transform=axes.transAxes, color=label.colour, lw=0.06 * size, alpha=0.6, zorder=5)


def _ink(colour: str) -> tuple[float, float, float]:
    """Return a darker shade of a colour, so that text can be read from the last row of a lecture hall."""
    red, green, blue = (_DARKER * part for part in to_rgb(colour))
    return red, green, blue


def _along(curve: Floats) -> Floats:
    """Return points along the lines that join the points of a curve."""
    if len(curve) < 2:
        return curve
    shares = np.linspace(0.0, 1.0, _STEPS)[:, None]
    return np.concatenate([a + shares * (b - a) for a, b in pairwise(curve)])


def _cost(
    box: Floats, frame: Floats, busy: Floats, marks: Sequence[tuple[Floats, float]], taken: Sequence[Floats]
) -> float:
    """Return the cost of a label in a box [pixel]: it grows where the box leaves the frame or covers other things.

    These are points of curves, marks with a radius, and labels that are already placed.
    """
    over = np.maximum(frame[:2] - box[:2], 0.0).sum() + np.maximum(box[2:] - frame[2:], 0.0).sum()
    covered = ((busy > box[:2]) & (busy < box[2:])).all(axis=1).sum()
    covered += 5 * sum(bool((at > box[:2] - far).all() and (at < box[2:] + far).all()) for at, far in marks)
    hit = sum(bool((box[:2] < other[2:]).all() and (other[:2] < box[2:]).all()) for other in taken)
    return 5.0 * float(over) + 10.0 * float(covered) + 1000.0 * hit
