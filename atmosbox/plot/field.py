"""A sweep of two settings: each headline as a coloured field, with contours of the theory."""

from __future__ import annotations

import math
import textwrap
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from atmosbox.plot.caption import footer
from atmosbox.plot.theme import DARK, FAINT, Theme, style
from atmosbox.plot.unit import convert, labelled
from atmosbox.plot.varied import Varied

__all__ = ["draw_fields"]

_SHORT = 32
"""Greatest length of an axis label beside a field [characters]."""


def draw_fields(swept: Varied, names: tuple[str, ...], look: Theme) -> Figure:
    """Draw headlines against two settings, each as a field with dashed contours of the theory.

    Parameters
    ----------
    swept : Varied
        The sweep.
    names : tuple of str
        Names of the headlines.
    look : Theme
        The theme: sizes of type, lines and markers.

    Returns
    -------
    matplotlib.figure.Figure
        The figure.

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.plot.theme import THEMES
    >>> data = xr.Dataset({"z": (("b", "a"), np.eye(2))}, {"a": [1.0, 2.0], "b": [3.0, 4.0]})
    >>> drawing = draw_fields(Varied(data, "a", "b", ("z",), 1), ("z",), THEMES["notes"])
    >>> drawing.axes[0].get_xlabel(), drawing.axes[0].get_ylabel()
    ('a', 'b')
    """
    columns = min(2, len(names))
    with style(look):
        width, height = look.wide if len(names) > 1 else look.narrow
        height *= 1.25 if look.grows and len(names) > 2 else 1.0
        drawing = Figure(figsize=(width, height), layout="constrained")
        FigureCanvasAgg(drawing)
        grid = drawing.subplots(math.ceil(len(names) / columns), columns, squeeze=False).ravel()
        for axes in grid[len(names) :]:
            axes.remove()
        for axes, name in zip(grid, names, strict=False):
            _draw(drawing, axes, swept, name, look)
        small = footer(swept.dataset) + " · dashed: theory at the points, joined"
        text = "\n".join(textwrap.wrap(small, int(1.75 * 72 * width / look.small)))
        drawing.supxlabel(text, x=0.01, ha="left", fontsize=look.small, color=FAINT)
        if look.heading:
            title = str(swept.dataset.attrs.get("title", ""))
            drawing.suptitle(title, x=0.01, ha="left", fontsize=1.3 * look.title, weight="bold")
    return drawing


def _draw(drawing: Figure, axes: Any, swept: Varied, name: str, look: Theme) -> None:
    """Draw one field."""
    across, other = swept.across, str(swept.other)
    field = swept.dataset[name].transpose(other, across)
    unit = str(field.attrs.get("units", "1"))
    shown = str(field.attrs.get("display_units", "")) or unit
    x, y = swept.places(across), swept.places(other)
    values = convert(field.values, unit, shown, name=name)
    largest = float(np.nanmax(np.abs(values)))
    power = 0 if largest == 0.0 or 1e-2 <= largest < 1e5 else math.floor(math.log10(largest))
    mesh = axes.pcolormesh(
        x, y, np.ma.masked_invalid(values / 10.0**power), cmap="cividis", shading="nearest", rasterized=True
    )
    bar = drawing.colorbar(mesh, ax=axes)
    label = str(field.attrs.get("long_name", name))
    bar.set_label(labelled(label, shown, power))
    bar.outline.set_visible(False)
    if swept.theory(name) is not None:
        answer = swept.dataset[f"{name}_theory"].transpose(other, across).values
        _contour(axes, x, y, convert(answer, unit, shown, name=name) / 10.0**power, look)
    for dim, axis, set_label, set_scale in (
        (across, axes.xaxis, axes.set_xlabel, axes.set_xscale),
        (other, axes.yaxis, axes.set_ylabel, axes.set_yscale),
    ):
        text = swept.label(dim, _SHORT)
        set_label(labelled(text, swept.units(dim)[1]) if swept.numeric(dim) else text)
        if not swept.numeric(dim):
            axis.set_ticks(swept.places(dim), labels=swept.words(dim))
        elif swept.geometric(dim):
            set_scale("log")
    axes.set_title(label[:1].upper() + label[1:], loc="left", fontsize=look.title, weight="bold", color=DARK)


def _contour(axes: Any, x: Any, y: Any, answer: Any, look: Theme) -> None:
    """Draw dashed contours of the theory, white with a dark edge, so that they are seen on any colour."""
    if not np.ptp(answer[np.isfinite(answer)]) > 0.0:
        return
    lines = axes.contour(x, y, answer, levels=5, colors="white", linestyles="dashed", linewidths=0.8 * look.line)
    edge = [withStroke(linewidth=1.6 * look.line, foreground=DARK)]
    lines.set_path_effects(edge)
    for text in axes.clabel(lines, fontsize=0.9 * look.small):
        text.set_path_effects(edge)
