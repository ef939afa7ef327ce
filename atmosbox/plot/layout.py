"""Where everything stands: panels in columns, a title over them and the provenance under them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from numpy.typing import NDArray

from atmosbox.errors import FileError
from atmosbox.panels import Panel, from_json
from atmosbox.plot.caption import footer, headlines
from atmosbox.plot.curve import curve, read, unit_of
from atmosbox.plot.disc import axis_names
from atmosbox.plot.draw import draw, hollow_points
from atmosbox.plot.plate import Pen, Plate
from atmosbox.plot.skewt import BACKGROUND, draw_skewt, levels
from atmosbox.plot.theme import FAINT, Theme, find, style

if TYPE_CHECKING:
    import xarray as xr

_TALL = ("profile", "discs", "skewt")
_WIDTHS = {"profile": 1.0, "line": 1.35, "histogram": 1.35, "discs": 1.6, "skewt": 2.0}
_TEXT_LINES = 6  # over the axes, for which a page has room; it grows for more
_ROUNDS = 6  # at most, of placing and measuring, until the texts and the axes agree about the room they have
_AT_REST = 0.5  # by so much they may still move [pixel]


def figure(dataset: xr.Dataset, theme: str = "notes") -> Figure:
    """Draw the figure of a run.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run as atmosbox returns or saves it, in SI units; it is not changed. Its attribute
        ``atmosbox_panels`` says what to draw.
    theme : {"notes", "slides"}
        A figure for a page, or one for a screen of 16:9 with large type.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, which belongs to no window; a notebook shows it.

    Raises
    ------
    FileError
        If the dataset carries no panels or lacks a variable that they show.
    SettingError
        If there is no such theme.

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.panels import Line, to_json
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
    panels = _panels(dataset)
    with style(look):
        space = look.text / 144  # inch
        engine = ConstrainedLayoutEngine(w_pad=space, h_pad=space / 1.5, wspace=0.02, hspace=0.03)
        drawing = Figure(figsize=look.wide if len(panels) > 1 else look.narrow, layout=engine)
        FigureCanvasAgg(drawing)
        pen, height = Pen(drawing), drawing.get_figheight()
        plates = _plates(drawing, dataset, panels, look)
        _frame(pen, dataset, panels, look)
        places = _place(drawing)
        for _ in range(_ROUNDS):
            texts = _write(pen, plates)
            if look.grows:
                drawing.set_figheight(height + max(0.0, texts - _TEXT_LINES * look.text) / 72)
            before, places = places, _place(drawing)
            if np.allclose(places, before, rtol=0.0, atol=_AT_REST):
                break
        drawing.set_layout_engine("none")
    return drawing


def _plates(drawing: Figure, dataset: xr.Dataset, panels: tuple[Panel, ...], look: Theme) -> list[Plate]:
    """Draw every panel at its place."""
    columns = _columns(panels)
    widths = [_WIDTHS[panels[column[0]].kind] for column in columns]
    grid = drawing.add_gridspec(max(map(len, columns)), len(columns), width_ratios=widths)
    sentences = headlines(dataset, panels)
    plates: list[Plate] = []
    for place, column in enumerate(columns):
        shared = len(column) > 1 and _same_abscissa(*(panels[index] for index in column))
        for row, index in enumerate(column):
            panel, spot = panels[index], grid[row if len(column) > 1 else slice(None), place]
            if panel.kind == "skewt":
                axes, entries = draw_skewt(drawing, spot, panel, dataset, look)
            else:
                axes = drawing.add_subplot(spot, sharex=plates[-1].axes if shared and row else None)
                entries = draw(axes, panel, dataset, look)
            x, y = _labels(dataset, panel)
            labels = (("", x[1]) if shared and not row else x, y)
            marked = levels(dataset, panel)
            plates.append(Plate(axes, panel, look, row, place, entries, sentences[index], labels, marked))
        drawing.align_ylabels([plate.axes for plate in plates if plate.column == place])
    return plates


def _frame(pen: Pen, dataset: xr.Dataset, panels: tuple[Panel, ...], look: Theme) -> None:
    """Write what stands over and under all panels."""
    width = 72 * pen.figure.get_figwidth()
    left = look.text / 2 / width
    has_errors = any(line.error for panel in panels for line in panel.lines)
    has_hollow = any(
        hollow_points(curve(dataset, panel, line)).any()
        for panel in panels
        for line in panel.lines
        if line.role == "data" and panel.kind != "histogram"
    )
    small = footer(dataset) + (" · bars and bands: ± 1 standard error" if has_errors else "")
    small += ", hollow: not known" if has_hollow else ""
    small += f" · {BACKGROUND}" if any(panel.kind == "skewt" for panel in panels) else ""
    # Type that is hinted for a screen may be narrower than in print.
    small = pen.wrap(small, 0.98 * (width - look.text), look.small)
    pen.figure.supxlabel(small, x=left, ha="left", fontsize=look.small, color=FAINT)
    if look.heading and dataset.attrs.get("title"):
        size = 1.3 * look.title
        heading = pen.wrap(str(dataset.attrs["title"]), width - look.text, size, "bold")
        pen.figure.suptitle(heading, x=left, ha="left", fontsize=size, weight="bold")


def _write(pen: Pen, plates: list[Plate]) -> float:
    """Write around the axes, and return the height of all texts over them [pt].

    The texts of a column begin together, the titles of a row stand equally high, and its legends of equally many
    entries have equally many columns.
    """
    inks = [plate.label(pen) for plate in plates]
    edges = {
        column: min(ink for ink, plate in zip(inks, plates, strict=True) if plate.column == column)
        for column in {plate.column for plate in plates}
    }
    for plate in plates:
        plate.fit(pen, edges[plate.column])
    for plate in plates:
        alike = [o for o in plates if (o.row, len(o.entries)) == (plate.row, len(plate.entries))]
        plate.columns = min(other.columns for other in alike)
    heights = [plate.write(pen) for plate in plates]
    tops = {
        row: max(height for height, plate in zip(heights, plates, strict=True) if plate.row == row)
        for row in {plate.row for plate in plates}
    }
    for plate in plates:
        plate.crown(pen, tops[plate.row])
    return sum(tops.values())


def _place(drawing: Figure) -> NDArray[np.float64]:
    """Give the axes the room that the texts leave, and return where they stand [pixel]."""
    engine = drawing.get_layout_engine()
    assert engine is not None
    engine.execute(drawing)
    for axes in drawing.axes:
        axes.apply_aspect()
    return np.array([axes.get_window_extent().extents for axes in drawing.axes])


def _panels(dataset: xr.Dataset) -> tuple[Panel, ...]:
    if "atmosbox_panels" not in dataset.attrs:
        raise FileError("The file does not say what its figure shows: it was not written by atmosbox run.")
    try:
        panels = from_json(dataset.attrs["atmosbox_panels"])
    except ValueError as error:
        raise FileError(f"The file does not say what its figure shows, because {error}") from error
    if not panels:
        raise FileError("The file has no figure: its scene names no panels.")
    return panels


def _columns(panels: tuple[Panel, ...]) -> list[list[int]]:
    """Return which panels stand in which column: profiles and boxes alone, graphs against time in pairs."""
    columns: list[list[int]] = []
    for index, panel in enumerate(panels):
        paired = bool(columns) and len(columns[-1]) == 1 and panels[columns[-1][0]].kind not in _TALL
        if paired and panel.kind not in _TALL:
            columns[-1].append(index)
        else:
            columns.append([index])
    return columns


def _same_abscissa(upper: Panel, lower: Panel) -> bool:
    """Tell whether two panels over each other can be read on one horizontal axis."""
    if upper.kind != "line" or lower.kind != "line":
        return False
    names = {line.x for panel in (upper, lower) for line in panel.lines}
    axes = {(panel.x_label, panel.x_unit, panel.x_scale, panel.x_invert) for panel in (upper, lower)}
    return len(names) == len(axes) == 1


def _labels(dataset: xr.Dataset, panel: Panel) -> tuple[tuple[str, str], tuple[str, str]]:
    """Return what the two axes show, and in which units."""
    if panel.kind == "discs":
        first, second = axis_names(dataset)
        return (panel.x_label or first, panel.x_unit or "nm"), (panel.y_label or second, panel.x_unit or "nm")
    line = panel.lines[0]
    names = [read(dataset, name).attrs.get("long_name", name.replace("_", " ")) for name in (line.x, line.y)]
    return (
        (panel.x_label or str(names[0]), unit_of(dataset, panel, "x")),
        (panel.y_label or str(names[1]), unit_of(dataset, panel, "y")),
    )
