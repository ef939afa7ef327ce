"""The figure of a run under its box: the molecules at the start, half-way and at the end, then the scene's panels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from atmosbox.file.molecules import Molecules, molecules
from atmosbox.plot.box_picture import BoxPicture, PlanarPicture, box_picture, instant, speed_bar
from atmosbox.plot.caption import footer, headlines
from atmosbox.plot.curve import curve, unit_of
from atmosbox.plot.layout import explanation, painter, panels_of
from atmosbox.plot.pen import Pen
from atmosbox.plot.place import blank, frame, put_panels, settle
from atmosbox.plot.theme import Theme, find, style
from atmosbox.plot.unit import spelled

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["figure_with_box"]

_INSTANTS = (0.0, 0.5, 1.0)  # in parts of the run
_BAR = 0.105  # width of the colour bar with its numbers, in widths of the page
_HIGH = 0.36  # of the boxes, in widths of the page
_HIGH_ON_SCREEN = 0.5  # of the boxes, in heights of a page that cannot grow


def figure_with_box(dataset: xr.Dataset, theme: str = "notes") -> Figure:
    """Draw the box of a run at its start, half-way and at its end, and below it the panels of its scene.

    A slide has room for the first panel alone, or for two profiles, and not for its numbers.

    Parameters
    ----------
    dataset : xarray.Dataset
        A run with ``--save-molecules``, or one of a planar scene.
    theme : {"notes", "slides"}
        A figure for a page, or one for a screen of 16:9 with large type.

    Returns
    -------
    matplotlib.figure.Figure
        The figure.

    Raises
    ------
    FileError
        If the file holds no molecules, no panels, or lacks a variable that they show.
    SettingError
        If there is no such theme.

    Examples
    --------
    >>> import xarray as xr
    >>> figure_with_box(xr.Dataset(attrs={"atmosbox_parameters": '{"scene": "lifting-dry"}'}))
    Traceback (most recent call last):
    atmosbox.errors.FileError: The run holds no molecules: type atmosbox run lifting-dry --save-molecules.
    """
    look, held = find(theme), molecules(dataset)
    panels = tuple(panel for panel in panels_of(dataset) if panel.kind != "discs")
    sentences = headlines(dataset, panels)
    if not look.grows:  # a slide has no room for more below the boxes
        panels = panels[: 2 if all(panel.kind == "profile" for panel in panels[:2]) else 1]
        sentences = [[] for _ in panels]
    with style(look):
        wide, high = look.wide
        boxes = _HIGH * wide if look.grows else _HIGH_ON_SCREEN * high
        high += boxes if look.grows else 0.0
        share = boxes / high
        drawing = blank((wide, high), look, (0.0, 0.0, 1.0, 1.0 - share))
        pen = Pen(drawing)
        pictures = []
        for place in range(len(_INSTANTS)):
            spot = (
                place * (1.0 - _BAR) / len(_INSTANTS),
                1.0 - share,
                0.96 * (1.0 - _BAR) / len(_INSTANTS),
                0.5 * share,
            )
            pictures.append(box_picture(drawing.add_axes(spot), dataset, held, look))
        plates = put_panels(drawing, panels, look, dataset, painter(dataset, look), sentences)
        words = " · ".join([footer(dataset), *pictures[0].legend()])
        frame(pen, words + explanation(dataset, panels), "", look)
        settle(pen, plates, look)
        _put_boxes(pen, dataset, held, pictures, share, look)
    return drawing


def _put_boxes(
    pen: Pen,
    dataset: xr.Dataset,
    held: Molecules,
    pictures: list[BoxPicture | PlanarPicture],
    share: float,
    look: Theme,
) -> None:
    """Draw the box at its instants over the panels, each under its time, and what the colours mean beside them."""
    wide, high = (72.0 * float(size) for size in pen.figure.get_size_inches())  # pt
    each, top = (1.0 - _BAR) / len(pictures), 1.0 - 0.5 * look.text / high
    if look.heading:
        title = str(dataset.attrs.get("title", ""))
        heading = pen.figure.text(
            0.5 * look.text / wide, top, title, fontsize=1.3 * look.title, weight="bold", va="top"
        )
        top -= (pen.height(heading) + 0.6 * look.text) / high
    frames = [round(part * (len(held.time) - 1)) for part in _INSTANTS]
    said = [_said(dataset, held, moment) for moment in frames]
    lines = max(text.count("\n") for text in said) + 1
    bottom = 1.0 - share + 2.2 * look.small / high
    below = top - (1.35 * lines + 0.3) * look.text / high
    for place, (picture, moment, text) in enumerate(zip(pictures, frames, said, strict=True)):
        left = place * each
        pen.figure.text(left + each / 2, top, text, fontsize=look.text, ha="center", va="top")
        picture.axes.set_position((left + 0.05 * each, bottom, 0.9 * each, below - bottom))
        picture.fit()
        picture.artists(moment)
    speed_bar(pen.figure, pictures[0], (1.0 - _BAR + 0.01, bottom, 0.012, 0.9 * (below - bottom)), look)


def _said(dataset: xr.Dataset, held: Molecules, moment: int) -> str:
    """Return the time of a frame and, where a profile is measured on the way, its values there."""
    time = instant(dataset, held, moment)
    for panel in panels_of(dataset):
        for line in panel.lines:
            in_time = all(name in dataset and dataset[name].dims == ("elapsed_time",) for name in (line.x, line.y))
            if panel.kind not in ("profile", "skewt") or line.role != "data" or line.minus or not in_time:
                continue
            x, y, _ = curve(dataset, panel, line)
            if x.size == len(held.time) and np.isfinite(x[moment] + y[moment]):
                units = [spelled(unit_of(dataset, panel, axis)) for axis in "xy"]
                state = [f"{value:.{int(abs(value) < 100.0)}f}" for value in (x[moment], y[moment])]
                return f"{time}\n{state[0]} {units[0]},  {state[1]} {units[1]}".replace("-", "−")
    return time
