"""The figure of a run with its box: the molecules at the start, half-way and at the end, and below them the panels."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from atmosbox.file.molecules import Molecules, molecules
from atmosbox.plot.box_picture import BoxPicture, PlanarPicture, box_picture, instant, speed_bar
from atmosbox.plot.caption import footer, headlines
from atmosbox.plot.curve import curve, unit_of
from atmosbox.plot.layout import explanation, painter, panels_of
from atmosbox.plot.number_card import put_numbers
from atmosbox.plot.pen import Pen
from atmosbox.plot.place import blank, put_footer, put_heading, put_panels, settle
from atmosbox.plot.theme import Theme, find, style
from atmosbox.plot.unit import spelled

__all__ = ["figure_with_box"]

_INSTANTS = (0.0, 0.5, 1.0)  # as shares of the duration of the run
_BAR = 0.105  # width of the colour bar with its numbers, in widths of the page
_HIGH = 0.36  # height of the boxes, in widths of the page
_HIGH_ON_SCREEN = 0.4  # height of the boxes, in heights of a page that cannot grow


def figure_with_box(dataset: xr.Dataset, theme: str = "notes") -> Figure:
    """Draw the box of a run at the start, half-way and at the end, and below it the panels of its scene.

    A slide has room for the first panel only, or for two profiles.

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
    atmosbox.errors.FileError: The run holds no molecules: type atmosbox.run("lifting-dry", save_molecules=True).
    """
    look, held = find(theme), molecules(dataset)
    panels = tuple(panel for panel in panels_of(dataset) if panel.kind != "discs")
    readings = [reading for each in headlines(dataset, panels) for reading in each]
    if not look.grows:  # a slide has no room for more below the boxes
        panels = panels[: 2 if all(panel.kind == "profile" for panel in panels[:2]) else 1]
    with style(look):
        wide, high = (72.0 * size for size in look.wide)  # pt
        boxes = _HIGH * wide if look.grows else _HIGH_ON_SCREEN * high
        drawing = blank(look.wide, look)
        pen = Pen(drawing)
        top = put_heading(pen, str(dataset.attrs.get("title", "")) if look.heading else "", look)
        top += put_numbers(pen, readings, look, top)
        if look.grows:
            drawing.set_figheight((high + top + boxes) / 72.0)
        each = (1.0 - _BAR) / len(_INSTANTS)
        spots = [(place * each, 0.5, 0.96 * each, 0.1) for place in range(len(_INSTANTS))]
        pictures = [box_picture(drawing.add_axes(spot), dataset, held, look) for spot in spots]
        plates = put_panels(drawing, panels, look, dataset, painter(dataset, look))
        words = " · ".join([footer(dataset), *pictures[0].legend()])
        put_footer(pen, words + explanation(dataset, panels), look)
        settle(pen, plates, look, top + boxes)
        _put_boxes(pen, dataset, held, pictures, (top, top + boxes), look)
    return drawing


def _put_boxes(
    pen: Pen,
    dataset: xr.Dataset,
    held: Molecules,
    pictures: list[BoxPicture | PlanarPicture],
    room: tuple[float, float],
    look: Theme,
) -> None:
    """Draw the box at each instant with its time above it, and the colour bar to the right of all boxes.

    ``room`` gives the distances of the upper and of the lower end of this row from the upper end of the page [pt].
    """
    high = 72.0 * float(pen.figure.get_figheight())
    each, top = (1.0 - _BAR) / len(pictures), 1.0 - (room[0] + 0.5 * look.text) / high
    frames = [round(part * (len(held.time) - 1)) for part in _INSTANTS]
    said = [_said(dataset, held, moment) for moment in frames]
    lines = max(text.count("\n") for text in said) + 1
    bottom = 1.0 - (room[1] - 2.2 * look.small) / high
    below = top - (1.35 * lines + 0.3) * look.text / high
    for place, (picture, moment, text) in enumerate(zip(pictures, frames, said, strict=True)):
        left = place * each
        pen.figure.text(left + each / 2, top, text, fontsize=look.text, ha="center", va="top").set_in_layout(False)
        picture.axes.set_position((left + 0.05 * each, bottom, 0.9 * each, below - bottom))
        picture.fit()
        picture.artists(moment)
    speed_bar(pen.figure, pictures[0], (1.0 - _BAR + 0.01, bottom, 0.012, 0.9 * (below - bottom)), look)


def _said(dataset: xr.Dataset, held: Molecules, moment: int) -> str:
    """Return the time of a frame and, if a panel shows a profile measured frame by frame, its values in the frame."""
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
