"""The layout of a page: headline numbers above panels in columns, each panel below its title, its note and its legend.

Matplotlib's constrained layout finds the room for all parts. This file adds what matplotlib leaves to the user: lines
of text that break at the end of a panel, as many columns of a legend as fit, titles of a row at the same height, and a
page that grows with its text.
"""

import re
from collections.abc import Callable, Sequence
from itertools import chain
from typing import Any, NamedTuple

import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.gridspec import SubplotSpec
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.text import Text
from matplotlib.transforms import ScaledTranslation, offset_copy

from atmosbox.plot.caption import Reading, axis_labels
from atmosbox.plot.curve import labelled
from atmosbox.plot.draw import Entry
from atmosbox.plot.skewt import fit_skewt
from atmosbox.plot.theme import DARK, FAINT, Theme, style
from atmosbox.plot.tick import put_ticks
from atmosbox.scene.panels import Panel

_FIXED = "\u00a0"  # a space that no line breaks at


class TextMeasure:
    """Measures text and breaks it into lines of any width; matplotlib itself wraps at the edge of the figure only.

    The canvas of the figure must be one of Agg.
    """

    def __init__(self, figure: Figure) -> None:
        self.figure, self._known = figure, dict[tuple[str, float, str], float]()

    def width(self, text: str, size: float, weight: str = "normal") -> float:
        """Return the width of a line of text [pt]."""
        asked = text, size, weight
        if asked not in self._known:  # a page is laid out several times
            renderer = self.figure.canvas.get_renderer()  # type: ignore[attr-defined]
            font = FontProperties(size=size, weight=weight)
            width, _, _ = renderer.get_text_width_height_descent(text, font, ismath=False)
            self._known[asked] = float(width) * 72 / self.figure.dpi
        return self._known[asked]

    def wrap(self, text: str, width: float, size: float, weight: str = "normal") -> str:
        """Return text broken into lines of at most a width [pt].

        Lines do not break within short brackets, after a minus sign, before °C or within what follows "=". A single
        word that is wider stays whole.
        """
        text = re.sub(r"\([^()]{1,24}\)|− | °C|= .*", lambda part: part[0].replace(" ", _FIXED), text)
        lines: list[str] = []
        for word in text.split(" "):
            longer = f"{lines[-1]} {word}" if lines else word
            if lines and self.width(longer, size, weight) <= width:
                lines[-1] = longer
            else:
                lines.append(word)
        return "\n".join(lines).replace(_FIXED, " ")

    def write(self, words: str, left: float, down: float, **look: Any) -> Text:
        """Write text at a distance from the left and the upper end of the page [pt], which it keeps if the page grows.

        The panels make no room for it.
        """
        place = ScaledTranslation(left / 72.0, -down / 72.0, self.figure.dpi_scale_trans)
        text = self.figure.text(0.0, 1.0, words, transform=self.figure.transFigure + place, **look)
        text.set_in_layout(False)
        return text

    def height(self, artist: Artist) -> float:
        """Return the height of an artist as it is drawn [pt]."""
        return float(artist.get_window_extent().height) * 72 / self.figure.dpi


_LARGE = 1.6  # size of the number, in units of the title's size
_NARROWEST = 14.0  # least width of a card, in units of the type size
_LEADING = 1.2  # distance from line to line, in units of the type size


def put_numbers(measure: TextMeasure, readings: Sequence[Reading], look: Theme, below: float) -> float:
    """Write numbers as cards in rows, ``below`` the upper end of the page [pt]; return the height of all cards [pt]."""
    width = 72.0 * measure.figure.get_figwidth() - look.text
    columns = max(1, min(len(readings), int(width / (_NARROWEST * look.text))))
    each, large, top = width / columns, _LARGE * look.title, below

    for first in range(0, len(readings), columns):
        lowest = top
        for place, reading in enumerate(readings[first : first + columns]):
            left, base = 0.5 * look.text + place * each, top + 0.95 * large
            measure.write(reading.number, left, base, size=large, weight="bold")
            after = left + measure.width(reading.number, large, "bold") + 0.4 * look.text
            measure.write(reading.error, after, base)
            beside = ", ".join(part for part in (reading.theory, reading.difference) if part)
            base += 0.25 * large
            for words, colour in ((reading.label, DARK), (beside, FAINT)):
                for line in measure.wrap(words, each - look.text, look.text).split("\n") if words else ():
                    base += _LEADING * look.text
                    measure.write(line, left, base, color=colour)
            lowest = max(lowest, base)
        top = lowest + 0.6 * _LEADING * look.text
    return top - below


_TALL = ("profile", "discs", "skewt", "atmosphere")
_WIDTHS = {"profile": 1.0, "line": 1.35, "histogram": 1.35, "discs": 1.5, "skewt": 2.0, "atmosphere": 1.1}
_TEXT_LINES = 6  # lines above the axes for which a page has room; it grows for more
_ROUNDS = 3  # of layout and text: the text needs room, and the room decides where lines break
# Length of the line samples in a legend, their distance from the text, and the gaps between axes, legend and note, all
# in units of the type size.
_HANDLE, _HANDLE_GAP, _GAP = 2.3, 0.5, 0.45

Draw = Callable[[Figure, SubplotSpec, Panel, Axes | None], tuple[Axes, list[Entry]]]
"""Draws a panel at its place and returns its axes and legend entries; it shares the abscissa of the axes above, if any.
"""


class Graph(NamedTuple):
    """A panel on the page."""

    axes: Axes
    """Its axes, with the curves drawn."""
    panel: Panel
    """The panel that they show."""
    entries: list[Entry]
    """The entries of its legend."""
    labels: tuple[tuple[str, str], tuple[str, str]]
    """Label and unit of the two axes; the label of an abscissa that the panel below shows is empty."""
    row: int
    column: int


_BELOW_PICTURES = 0.75  # height of the graphs below pictures, in heights of graphs alone
_SMALLEST = 0.6  # least size of a label that is too long for its axis, in units of the type size


def page(
    panels: tuple[Panel, ...], look: Theme, dataset: xr.Dataset, draw: Draw, readings: Sequence[list[Reading]],
    small: str, height: float = 0.0, put: Callable[[TextMeasure, float], None] | None = None, heading: str = "",
) -> Figure:  # fmt: skip
    """Return a page of panels, with a heading and numbers in large type above them and small type below them.

    The dataset gives the heading, unless one is given, and the labels of the axes. ``put`` draws pictures above the
    panels, of this height [pt], given the page and their distance from its upper end [pt].
    """
    with style(look):
        drawing = blank(look.wide if len(panels) > 1 or height else look.narrow, look)
        measure = TextMeasure(drawing)
        above = put_heading(measure, heading or str(dataset.attrs.get("title", "")), 1.3 * look.title, look)
        above += put_numbers(measure, list(chain(*readings)), look, above)
        if look.grows:
            graphs_height = drawing.get_figheight() * (_BELOW_PICTURES if height else 1.0)
            drawing.set_figheight(graphs_height + (above + height) / 72)
        graphs = put_panels(drawing, panels, look, dataset, draw) if panels else []
        put_footer(measure, small, look)
        settle(measure, graphs, look, above + height)
        if put is not None:
            put(measure, above)
    return drawing


def blank(size: tuple[float, float], look: Theme) -> Figure:
    """Return an empty page of this size [inch], whose panels make room for the text around them."""
    space = look.text / 144  # inch
    engine = ConstrainedLayoutEngine(w_pad=space, h_pad=space / 1.5, wspace=0.02, hspace=0.03)
    drawing = Figure(figsize=size, layout=engine)
    FigureCanvasAgg(drawing)
    return drawing


def put_panels(drawing: Figure, panels: tuple[Panel, ...], look: Theme, dataset: xr.Dataset, draw: Draw) -> list[Graph]:
    """Draw every panel at its place on the page; `settle` writes the text around them."""
    columns = _columns(panels)
    widths = [_WIDTHS[panels[column[0]].kind] for column in columns]
    grid = drawing.add_gridspec(max(map(len, columns)), len(columns), width_ratios=widths)
    graphs: list[Graph] = []
    for place, column in enumerate(columns):
        shared = len(column) > 1 and _same_abscissa(*(panels[index] for index in column))
        for row, index in enumerate(column):
            panel, spot = panels[index], grid[row if len(column) > 1 else slice(None), place]
            axes, entries = draw(drawing, spot, panel, graphs[-1].axes if shared and row else None)
            x, y = axis_labels(dataset, panel)
            labels = (("", x[1]) if shared and not row else x, y)
            graphs.append(Graph(axes, panel, entries, labels, row, place))
        drawing.align_ylabels([graph.axes for graph in graphs if graph.column == place])
    return graphs


def put_footer(measure: TextMeasure, small: str, look: Theme) -> float:
    """Write the small type below all panels; return the height that it takes [pt]."""
    width = 72 * measure.figure.get_figwidth()
    # Type that is fitted to the pixels of a screen may be narrower than in print.
    small = measure.wrap(small, 0.98 * (width - look.text), look.small)
    text = measure.figure.supxlabel(small, x=look.text / 2 / width, ha="left", fontsize=look.small, color=FAINT)
    return measure.height(text) + look.text


def put_heading(measure: TextMeasure, heading: str, size: float, look: Theme, share: float = 1.0) -> float:
    """Write a heading at the top of a page, over a share of its width; return the height that it takes [pt]."""
    if not heading:
        return 0.0
    heading = measure.wrap(heading, share * 72 * measure.figure.get_figwidth() - look.text, size, "bold")
    text = measure.write(heading, look.text / 2, look.text / 2, size=size, weight="bold", va="top")
    return measure.height(text) + look.text


def settle(measure: TextMeasure, graphs: list[Graph], look: Theme, top: float = 0.0) -> None:
    """Write titles, notes, legends and labels around the panels, in lines that are as long as a panel is wide.

    ``top`` is the height above all panels that is already in use [pt].
    """
    drawing = measure.figure
    engine, height = drawing.get_layout_engine(), drawing.get_figheight()
    assert engine is not None
    for _ in range(_ROUNDS):
        if top:
            engine.set(rect=(0.0, 0.0, 1.0, 1.0 - top / 72 / drawing.get_figheight()))  # type: ignore[call-arg]
        engine.execute(drawing)
        for graph in graphs:
            graph.axes.apply_aspect()
            _write_labels(measure, graph, look)
        # The texts of a column have the same left edge, and the titles of a row have the same height.
        ink = [graph.axes.yaxis.get_tightbbox().x0 for graph in graphs]  # type: ignore[union-attr]
        edge = {p.column: min(x for x, o in zip(ink, graphs, strict=True) if o.column == p.column) for p in graphs}
        heights = [_write_legend(measure, graph, edge[graph.column], look) for graph in graphs]
        tops = {p.row: max(h for h, o in zip(heights, graphs, strict=True) if o.row == p.row) for p in graphs}
        for graph in graphs:
            _write_title(measure, graph, edge[graph.column], tops[graph.row], look)
        if look.grows:
            drawing.set_figheight(height + max(0.0, sum(tops.values()) - _TEXT_LINES * look.text) / 72)
    engine.execute(drawing)


def _write_labels(measure: TextMeasure, graph: Graph, look: Theme) -> None:
    """Write ticks and labels for the present size of the axes."""
    axes, panel, size = graph.axes, graph.panel, look.text
    extent, point = axes.get_window_extent(), measure.figure.dpi / 72
    width, height = extent.width / point, extent.height / point
    (x_label, x_unit), (y_label, y_unit) = graph.labels
    power = 0
    if panel.kind == "skewt":
        fit_skewt(axes, width, height, size)
    elif panel.kind != "atmosphere":  # its horizontal axis has no scale
        power = put_ticks(axes.xaxis, width, size, pressure=x_unit == "hPa")
    if x_label:
        axes.set_xlabel(measure.wrap(labelled(x_label, x_unit, power) if x_unit else x_label, width, size))
    else:
        axes.tick_params(axis="x", labelbottom=False)
    power = put_ticks(axes.yaxis, height, size, pressure=y_unit == "hPa")
    # The label may extend beyond both ends of the axis into the gaps that are there anyhow. A line that is still too
    # long is written smaller, so that it does not run into the legend.
    room = height + 0.8 * size
    label = measure.wrap(labelled(y_label, y_unit, power), room, size)
    longest = max(measure.width(line, size) for line in label.split("\n")) if label else room
    axes.set_ylabel(label, size=size * min(1.0, max(room / max(longest, 1e-9), _SMALLEST)))


def _write_legend(measure: TextMeasure, graph: Graph, edge: float, look: Theme) -> float:
    """Put the legend above the axes, with the note as its title; return the height of both together [pt]."""
    axes, size, note = graph.axes, look.text, graph.panel.note
    extent, point = axes.get_window_extent(), measure.figure.dpi / 72
    room, height = (extent.x1 - edge) / point, _GAP * size
    told = len(graph.entries) > 1 or any(line.role != "data" for line in graph.panel.lines)
    if not told and not note:
        return height
    place = offset_copy(axes.transAxes, measure.figure, (edge - extent.x0) / point, height, units="points")
    entries = graph.entries if told else []
    labels = [measure.wrap(label, room - (_HANDLE + _HANDLE_GAP) * size, size) for _, label in entries]
    for number in range(max(len(labels), 1), 0, -1):
        legend = axes.legend(
            [artists if len(artists) > 1 else artists[0] for artists, _ in entries], labels,
            title=measure.wrap(note, room, size) if note else None, title_fontsize=size, alignment="left",
            loc="lower left", bbox_to_anchor=(0.0, 1.0), bbox_transform=place, ncols=number, borderpad=0.0,
            borderaxespad=0.0, handlelength=_HANDLE, handletextpad=_HANDLE_GAP, columnspacing=1.1, labelspacing=0.25,
        )  # fmt: skip
        if legend.get_window_extent().width <= room * point:
            break
    for line in legend.get_lines():
        line.set_linewidth(max(line.get_linewidth(), look.line))
    return height + measure.height(legend) + _GAP * size


def _write_title(measure: TextMeasure, graph: Graph, edge: float, height: float, look: Theme) -> None:
    """Write the title at a height above the axes [pt]."""
    extent, point = graph.axes.get_window_extent(), measure.figure.dpi / 72
    title = measure.wrap(graph.panel.title, (extent.x1 - edge) / point, look.title, "bold")
    left = (edge - extent.x0) / extent.width
    # With y given, matplotlib does not look for ticks that the title would have to avoid.
    graph.axes.set_title(title, loc="left", x=left, y=1.0, pad=height, fontsize=look.title, weight="bold")


def on_slide(panels: tuple[Panel, ...]) -> tuple[Panel, ...]:
    """Return the panels for which a slide has room: the first of each column, of two columns."""
    return tuple(panels[column[0]] for column in _columns(panels)[:2])


def _columns(panels: tuple[Panel, ...]) -> list[list[int]]:
    """Return the indices of the panels of each column: tall panels alone, other graphs in pairs."""
    if len(panels) == 2:
        return [[0], [1]]
    columns: list[list[int]] = []
    for index in range(len(panels)):
        column = [*columns[-1], index] if columns else []
        if len(column) == 2 and all(panels[place].kind not in _TALL for place in column):
            columns[-1] = column
        else:
            columns.append([index])
    return columns


def _same_abscissa(upper: Panel, lower: Panel) -> bool:
    """Tell whether two panels, one above the other, can share a horizontal axis."""
    names = {(panel.kind, line.x) for panel in (upper, lower) for line in panel.lines}
    axes = {(panel.x_label, panel.x_unit, panel.x_scale, panel.x_invert) for panel in (upper, lower)}
    return upper.kind == "line" and len(names) == len(axes) == 1
