"""Where everything stands: panels in columns, a title over them and small type under them."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec
from matplotlib.layout_engine import ConstrainedLayoutEngine
from numpy.typing import NDArray

from atmosbox.plot.draw import Entry
from atmosbox.plot.plate import Pen, Plate
from atmosbox.plot.theme import FAINT, Theme
from atmosbox.scene.panels import Panel

_TALL = ("profile", "discs", "skewt")
_WIDTHS = {"profile": 1.0, "line": 1.35, "histogram": 1.35, "discs": 1.6, "skewt": 2.0}
_TEXT_LINES = 6  # over the axes, for which a page has room; it grows for more
_ROUNDS = 6  # at most, of placing and measuring, until the texts and the axes agree about the room they have
_AT_REST = 0.5  # by so much they may still move [pixel]


class Draws(Protocol):
    """What draws the panels of a page."""

    def draw(self, drawing: Figure, spot: SubplotSpec, panel: Panel, above: Axes | None) -> tuple[Axes, list[Entry]]:
        """Draw a panel at its place, along the abscissa of the one above if that is given."""

    def labels(self, panel: Panel) -> tuple[tuple[str, str], tuple[str, str]]:
        """Return what the two axes of a panel show, and in which units."""

    def levels(self, panel: Panel) -> dict[str, float]:
        """Return the pressures that a panel marks [hPa]."""


def blank(size: tuple[float, float], look: Theme, room: tuple[float, float, float, float] = (0, 0, 1, 1)) -> Figure:
    """Return an empty page whose panels make room for what is written around them.

    Parameters
    ----------
    size : tuple of float
        Width and height [inch].
    look : Theme
        How large the type is.
    room : tuple of float
        Left, bottom, width and height of the part that the panels have, in parts of the page.

    Examples
    --------
    >>> from atmosbox.plot.theme import THEMES
    >>> drawing = blank((4.0, 3.0), THEMES["notes"])
    >>> drawing.get_size_inches().tolist()
    [4.0, 3.0]
    """
    space = look.text / 144  # inch
    engine = ConstrainedLayoutEngine(w_pad=space, h_pad=space / 1.5, wspace=0.02, hspace=0.03, rect=room)
    drawing = Figure(figsize=size, layout=engine)
    FigureCanvasAgg(drawing)
    return drawing


def settle(pen: Pen, plates: list[Plate], look: Theme) -> None:
    """Write around the panels and move them, until texts and axes agree about the room they have.

    Parameters
    ----------
    pen : Pen
        The pen of the page.
    plates : list of Plate
        Its panels.
    look : Theme
        How large; a page that grows becomes higher where there is much to say.

    Examples
    --------
    >>> from atmosbox.plot.theme import THEMES
    >>> drawing = blank((4.0, 3.0), THEMES["notes"])
    >>> axes = drawing.add_subplot(drawing.add_gridspec(1, 1)[0, 0])
    >>> settle(Pen(drawing), [], THEMES["notes"])
    >>> type(drawing.get_layout_engine()).__name__
    'PlaceHolderLayoutEngine'
    """
    drawing = pen.figure
    height, places = drawing.get_figheight(), _place(drawing)
    for _ in range(_ROUNDS):
        texts = _write(pen, plates)
        if look.grows:
            drawing.set_figheight(height + max(0.0, texts - _TEXT_LINES * look.text) / 72)
        before, places = places, _place(drawing)
        if np.allclose(places, before, rtol=0.0, atol=_AT_REST):
            break
    drawing.set_layout_engine("none")


def put_panels(
    drawing: Figure, panels: tuple[Panel, ...], look: Theme, painter: Draws, sentences: list[list[str]]
) -> list[Plate]:
    """Draw every panel at its place.

    Parameters
    ----------
    drawing : matplotlib.figure.Figure
        The page.
    panels : tuple of Panel
        What to draw.
    look : Theme
        How large.
    painter : Draws
        What draws them.
    sentences : list of list of str
        For each panel, the numbers that stand under its title.

    Returns
    -------
    list of Plate
        The panels on the page, which `settle` gives their final place.

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.scene.panels import Line
    >>> from atmosbox.plot.layout import Painter
    >>> from atmosbox.plot.theme import THEMES
    >>> dataset = xr.Dataset({"p": ("z", [1e5, 9e4], {"units": "Pa"})}, coords={"z": [0.0, 900.0]})
    >>> panel, look = Panel("profile", "Pressure", (Line("p", "z", "air"),)), THEMES["notes"]
    >>> plates = put_panels(blank((4.0, 3.0), look), (panel, panel), look, Painter(dataset, look), [[], []])
    >>> [(plate.row, plate.column) for plate in plates]
    [(0, 0), (0, 1)]
    """
    columns = _columns(panels)
    widths = [_WIDTHS[panels[column[0]].kind] for column in columns]
    grid = drawing.add_gridspec(max(map(len, columns)), len(columns), width_ratios=widths)
    plates: list[Plate] = []
    for place, column in enumerate(columns):
        shared = len(column) > 1 and _same_abscissa(*(panels[index] for index in column))
        for row, index in enumerate(column):
            panel, spot = panels[index], grid[row if len(column) > 1 else slice(None), place]
            axes, entries = painter.draw(drawing, spot, panel, plates[-1].axes if shared and row else None)
            x, y = painter.labels(panel)
            labels = (("", x[1]) if shared and not row else x, y)
            marked = painter.levels(panel)
            plates.append(Plate(axes, panel, look, row, place, entries, sentences[index], labels, marked))
        drawing.align_ylabels([plate.axes for plate in plates if plate.column == place])
    return plates


def frame(pen: Pen, small: str, heading: str, look: Theme) -> None:
    """Write what stands over and under all panels.

    Parameters
    ----------
    pen : Pen
        The pen of the page.
    small, heading : str
        What is written under and over the panels; an empty heading takes no room.
    look : Theme
        How large.

    Examples
    --------
    >>> from atmosbox.plot.theme import THEMES
    >>> drawing = blank((4.0, 3.0), THEMES["notes"])
    >>> frame(Pen(drawing), "atmosbox", "", THEMES["notes"])
    >>> [text.get_text() for text in drawing.texts]
    ['atmosbox']
    """
    width = 72 * pen.figure.get_figwidth()
    left = look.text / 2 / width
    # Type that is hinted for a screen may be narrower than in print.
    small = pen.wrap(small, 0.98 * (width - look.text), look.small)
    pen.figure.supxlabel(small, x=left, ha="left", fontsize=look.small, color=FAINT)
    if heading:
        size = 1.3 * look.title
        heading = pen.wrap(heading, width - look.text, size, "bold")
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
