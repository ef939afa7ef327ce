"""The figure of a run: its panels, its title and its provenance on one page; with its box above them if wanted."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec

from atmosbox.errors import Command, FileError, Option
from atmosbox.file.molecules import Molecules, molecules
from atmosbox.plot.box_picture import box_picture, instant
from atmosbox.plot.caption import footer, headlines
from atmosbox.plot.curve import curve
from atmosbox.plot.discs import colour_bar
from atmosbox.plot.draw import Curves, Entry, draw, draw_lines, hollow_points
from atmosbox.plot.flow_picture import flow_height, put_flow
from atmosbox.plot.layout import Draw, TextMeasure, on_slide, page
from atmosbox.plot.skewt import BACKGROUND, draw_skewt
from atmosbox.plot.theme import Theme, find, style
from atmosbox.scene.panels import Line, Panel, from_json


def figure(dataset: xr.Dataset, theme: str = "notes") -> Figure:
    """Draw the figure of a run; it opens no window, and a notebook shows it.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run as atmosbox returns or saves it, in SI units. Its attribute ``atmosbox_panels`` lists the panels.
    theme : {"notes", "slides"}
        A figure for a page; or one for a screen of 16:9 with large type, which has the first graph of each of two
        columns.

    Raises
    ------
    FileError
        If the dataset carries no panels or lacks a variable that they show.
    SettingError
        If there is no such theme.

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.scene.panels import Line, to_json
    >>> air = Line("elapsed_time", "air_temperature", "air")
    >>> panel = Panel("line", "Temperature", (air,), "time", "temperature", y_unit="degC")
    >>> dataset = xr.Dataset(
    ...     {"air_temperature": ("elapsed_time", [288.0, 290.0], {"units": "K"})},
    ...     coords={"elapsed_time": ("elapsed_time", [0.0, 1.0], {"units": "ns"})},
    ...     attrs={"atmosbox_panels": to_json([panel])},
    ... )
    >>> axes = figure(dataset).axes[0]
    >>> axes.get_xlabel(), axes.get_ylabel()
    ('time (ns)', 'temperature (°C)')
    """
    look = find(theme)
    panels = panels_of(dataset) if look.grows else on_slide(panels_of(dataset))
    small = footer(dataset) + explanation(dataset, panels)
    height = flow_height(dataset, look)
    # a slide has no room for numbers above pictures of the wind
    readings = headlines(dataset, panels) if look.grows or not height else []
    put = partial(put_flow, dataset, look) if height else None
    return page(panels, look, dataset, painter([dataset], look), readings, small, height, put)


def painter(runs: Sequence[xr.Dataset], look: Theme, curves: Curves | None = None) -> Draw:
    """Return the function that draws a panel of one run, or of several whose curves the function ``curves`` draws."""
    several = curves or partial(draw_lines, runs[0])

    def draw_panel(drawing: Figure, spot: SubplotSpec, panel: Panel, above: Axes | None) -> tuple[Axes, list[Entry]]:
        if panel.kind == "skewt":
            return draw_skewt(drawing, spot, panel, runs, look, several)
        axes = drawing.add_subplot(spot, sharex=above)
        return axes, draw(axes, panel, runs, look, several)

    return draw_panel


def explanation(dataset: xr.Dataset, panels: tuple[Panel, ...]) -> str:
    """Return the text of the footer that explains error bars, hollow points and the background of a skew-T."""
    lines = [(panel, line) for panel in panels for line in panel.lines]
    points = [each for each in lines if each[1].role == "data" and each[0].kind != "histogram"]
    along = " and ".join(dict.fromkeys(panel.x_label or "x" for panel in panels if panel.averages))
    small = f" · against {along}: averages of frames, ± 1 standard deviation of single frames" if along else ""
    if any(line.error for _, line in lines):
        small += f" · {'other ' if along else ''}bars and bands: ± 1 standard error"
        small += ", hollow: not known" * any(hollow_points(curve(dataset, *each)).any() for each in points)
    return small + (f" · {BACKGROUND}" if any(panel.kind == "skewt" for panel in panels) else "")


def panels_of(dataset: xr.Dataset) -> tuple[Panel, ...]:
    """Return the panels that a run lists, without the theory curves of headlines that it did not measure.

    Of a run that was stopped, only panels and curves are returned for which it has measured enough.
    """
    if "atmosbox_panels" not in dataset.attrs:
        raise FileError("The file does not say what its figure shows: atmosbox did not write it.")
    try:
        panels = from_json(dataset.attrs["atmosbox_panels"])
    except ValueError as error:
        raise FileError(f"The file does not say what its figure shows, because {error}") from error
    if not panels:
        raise FileError("The file has no figure: its scene names no panels.")
    if dataset.attrs.get("atmosbox_status", "complete") != "complete":
        panels = tuple(begun for panel in panels if (begun := _begun(dataset, panel)) is not None)
        if not panels:
            raise FileError(
                "The run was stopped too early for a figure", "let it go on with ", Command("run", (Option("resume"),))
            )
    return tuple(replace(panel, lines=_found(dataset, panel)) for panel in panels)


def _begun(dataset: xr.Dataset, panel: Panel) -> Panel | None:
    """Return a panel of a run that was stopped, with the curves that it has; None if none of them is measured."""
    lines = tuple(line for line in panel.lines if holds(dataset, line.variables))
    if any(line.role == "data" for line in lines):
        return replace(panel, lines=lines)
    return panel if not panel.lines and holds(dataset, panel.variables) else None


def holds(dataset: xr.Dataset, names: tuple[str, ...]) -> bool:
    """Tell whether a file has all of some variables, or the variables of which these are parts."""
    return all(name.partition("[")[0] in dataset.variables for name in names)


def _found(dataset: xr.Dataset, panel: Panel) -> tuple[Line, ...]:
    """Return the lines of a panel without theory that is not known.

    That is the theory of a missing headline, such as a cloud base that was not found, or theory that is known nowhere,
    such as the growth of rolls of discs.
    """
    missing = {f"{name}_theory" for name in panel.headlines if name not in dataset}
    told = [line.y for line in panel.lines if line.role == "theory" and line.y in dataset]
    missing |= {name for name in told if not dataset[name].notnull().any()}
    return tuple(line for line in panel.lines if missing.isdisjoint(line.variables))


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

    Raises
    ------
    FileError
        If the file holds no molecules, no panels, or lacks a variable that they show.
    SettingError
        If there is no such theme.
    """
    look, held = find(theme), molecules(dataset)
    panels = tuple(panel for panel in panels_of(dataset) if panel.kind != "discs")
    readings = headlines(dataset, panels)
    if not look.grows:  # a slide has no room for more below the boxes
        panels = panels[: 2 if all(panel.kind == "profile" for panel in panels[:2]) else 1]
    with style(look):
        legend = box_picture(Figure().add_subplot(), dataset, held, look).legend()
    small = " · ".join([footer(dataset), *legend]) + explanation(dataset, panels)
    height = 72.0 * (_HIGH * look.wide[0] if look.grows else _HIGH_ON_SCREEN * look.wide[1])
    put = partial(_put_boxes, dataset, held, look, height)
    return page(panels, look, dataset, painter([dataset], look), readings, small, height, put)


def _put_boxes(
    dataset: xr.Dataset, held: Molecules, look: Theme, height: float, measure: TextMeasure, down: float
) -> None:
    """Draw the box at each instant with its time above it, and the colour bar to the right of all boxes.

    ``down`` is the distance of this row from the upper end of the page, and ``height`` its height [pt].
    """
    drawing = measure.figure
    wide, high = (72.0 * float(size) for size in drawing.get_size_inches())
    each = (1.0 - _BAR) / len(_INSTANTS)
    frames = [round(part * (len(held.time) - 1)) for part in _INSTANTS]
    said = [instant(dataset, held, frame) for frame in frames]
    lines = max(text.count("\n") for text in said) + 1
    bottom = 1.0 - (down + height - 2.2 * look.small) / high
    tall = (height - 2.2 * look.small - (1.35 * lines + 0.8) * look.text) / high
    for place, (frame, text) in enumerate(zip(frames, said, strict=True)):
        measure.write(text, (place + 0.5) * each * wide, down + look.text / 2, ha="center", va="top")
        axes = drawing.add_axes(((place + 0.05) * each, bottom, 0.9 * each, tall))
        picture = box_picture(axes, dataset, held, look)
        picture.show(frame)
    bar = drawing.add_axes((1.0 - _BAR + 0.01, bottom, 0.012, 0.9 * tall))
    colour_bar(bar, picture.norm, look, counted=held.neighbours is not None)
