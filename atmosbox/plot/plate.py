"""A panel on the page: title, numbers and legend over it, clear of the data, and labels beside its axes."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties

from atmosbox.plot.draw import Entry
from atmosbox.plot.theme import Theme
from atmosbox.plot.tick import put_ticks
from atmosbox.plot.tilt import fit_skewt
from atmosbox.plot.unit import labelled
from atmosbox.scene.panels import Panel

_FIXED = "\u00a0"  # a space that no line breaks at
# The lines of a legend, their distance from the words and that between columns, in sizes of the type.
_HANDLE, _HANDLE_GAP, _BETWEEN = 2.3, 0.5, 1.1


@dataclass
class Pen:
    r"""Measures text as it will be drawn, and breaks it into lines.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure to write on, which has a canvas of Agg.

    Examples
    --------
    >>> from matplotlib.backends.backend_agg import FigureCanvasAgg
    >>> drawing = Figure()
    >>> _ = FigureCanvasAgg(drawing)
    >>> Pen(drawing).wrap("lapse rate = 9.8 ± 0.1 K km⁻¹ (of the parcel)", 90.0, 8.0).split("\n")
    ['lapse rate', '= 9.8 ± 0.1 K km⁻¹ (of the parcel)']
    """

    figure: Figure

    def width(self, text: str, size: float, weight: str = "normal") -> float:
        """Return the width of a line of text [pt]."""
        renderer = self.figure.canvas.get_renderer()  # type: ignore[attr-defined]
        font = FontProperties(size=size, weight=weight)
        width, _, _ = renderer.get_text_width_height_descent(text, font, ismath=False)
        return float(width) * 72 / self.figure.dpi

    def wrap(self, text: str, width: float, size: float, weight: str = "normal") -> str:
        """Return text in lines of at most a width [pt]; neither a unit nor what follows "=" is torn apart."""
        text = re.sub(r"\([^()]{1,24}\)|− |= .*", lambda part: part[0].replace(" ", _FIXED), text)
        lines: list[str] = []
        for word in text.split(" "):
            longer = f"{lines[-1]} {word}" if lines else word
            if lines and self.width(longer, size, weight) <= width:
                lines[-1] = longer
            else:
                lines.append(word)
        return "\n".join(lines).replace(_FIXED, " ")

    def height(self, artist: Artist) -> float:
        """Return the height of something drawn [pt]."""
        return float(artist.get_window_extent().height) * 72 / self.figure.dpi


@dataclass
class Plate:
    """A panel on the page, written anew whenever the room that it has changes.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        The axes, with the curves drawn.
    panel : Panel
        The panel.
    theme : Theme
        How large.
    row, column : int
        Where it stands.
    entries : list
        The entries of its legend.
    sentences : list of str
        The numbers that stand under its title.
    labels : tuple
        What the two axes show and in which unit: ((label, unit), (label, unit)). An empty label belongs to an
        axis that is labelled in the panel below.
    levels : dict
        The pressures that are marked in a skew-T, by what they are called [hPa].
    """

    axes: Axes
    panel: Panel
    theme: Theme
    row: int
    column: int
    entries: list[Entry]
    sentences: list[str]
    labels: tuple[tuple[str, str], tuple[str, str]]
    levels: dict[str, float] = field(default_factory=dict)
    left: float = 0.0  # where the text begins, relative to the axes [pt]
    room: float = 0.0  # how wide the text may be [pt]
    columns: int = 0  # of the legend; 0 before it is first written
    written: list[Artist] = field(default_factory=list)

    def label(self, pen: Pen) -> float:
        """Write ticks and labels for the room that the axes have, and return where the ink begins [pixel]."""
        for artist in self.written:
            artist.remove()
        self.written = []
        axes, panel, size = self.axes, self.panel, self.theme.text
        width, height = self._size(pen)
        (x_label, x_unit), (y_label, y_unit) = self.labels
        if panel.kind == "skewt":
            power = 0
            self.written += fit_skewt(axes, self.levels, width, height, size)
        else:
            log = panel.x_scale == "log"
            power = put_ticks(axes.xaxis, log=log, length=width, size=size, pressure=x_unit == "hPa")
        if x_label:
            axes.set_xlabel(pen.wrap(labelled(x_label, x_unit, power), width, size))
        else:
            axes.tick_params(axis="x", labelbottom=False)
        log = panel.y_scale == "log"
        power = put_ticks(axes.yaxis, log=log, length=height, size=size, pressure=y_unit == "hPa")
        # The label may reach over both ends of the axis into the gap that is there anyhow.
        axes.set_ylabel(pen.wrap(labelled(y_label, y_unit, power), height + 0.8 * size, size))
        outer = axes.get_tightbbox() or axes.get_window_extent()
        return float(outer.x0)

    def fit(self, pen: Pen, edge: float) -> None:
        """Let the texts begin at ``edge`` [pixel], end where the axes end, and fit the legend between.

        A legend that once had to become narrower stays so: else it and the axes would never agree.
        """
        frame = self.axes.get_window_extent()
        self.left = (edge - frame.x0) * 72 / pen.figure.dpi
        self.room = (frame.x1 - edge) * 72 / pen.figure.dpi
        columns = self._fitting_columns(pen)
        self.columns = min(columns, self.columns or columns)

    def write(self, pen: Pen) -> float:
        """Write the legend, and return how much room it and the sentences need above the axes [pt]."""
        gap = height = 0.45 * self.theme.text
        if len(self.entries) > 1 or any(line.role != "data" for line in self.panel.lines):
            height += pen.height(self._write_legend(pen, gap)) + gap
        if self._subtitle(pen):
            measured = self._write_text(self._subtitle(pen), 0.0, self.theme.text)
            height += pen.height(measured) + gap
            self.written.remove(measured)
            measured.remove()
        return height

    def crown(self, pen: Pen, height: float) -> None:
        """Write the title at a height over the axes [pt], and under it the sentences."""
        title = pen.wrap(self.panel.title, self.room, self.theme.title, "bold")
        self._write_text(title, height, self.theme.title, weight="bold", anchor="baseline")
        if self._subtitle(pen):
            below = height - 0.45 * self.theme.text
            self._write_text(self._subtitle(pen), below, self.theme.text, anchor="top")

    def _subtitle(self, pen: Pen) -> str:
        lines = [self.panel.note, *self.sentences]
        return "\n".join(pen.wrap(line, self.room, self.theme.text) for line in lines if line)

    def _size(self, pen: Pen) -> tuple[float, float]:
        """Return width and height of the axes [pt]."""
        frame = self.axes.get_window_extent()
        return frame.width * 72 / pen.figure.dpi, frame.height * 72 / pen.figure.dpi

    def _legend_labels(self, pen: Pen) -> list[str]:
        size = self.theme.text
        return [pen.wrap(label, self.room - (_HANDLE + _HANDLE_GAP) * size, size) for _, label in self.entries]

    def _fitting_columns(self, pen: Pen) -> int:
        """Return in how many columns there is room for the legend."""
        size = self.theme.text
        labels = self._legend_labels(pen)
        lengths = [max(pen.width(line, size) for line in label.split("\n")) for label in labels]
        for columns in range(len(labels), 1, -1):
            rows = -(-len(labels) // columns)
            parts = [lengths[start : start + rows] for start in range(0, len(labels), rows)]
            taken = sum((_HANDLE + _HANDLE_GAP) * size + max(part) for part in parts) + (columns - 1) * _BETWEEN * size
            if len(parts) == columns and taken <= self.room:
                return columns
        return 1

    def _write_legend(self, pen: Pen, gap: float) -> Artist:
        """Put the legend on the upper edge of the axes."""
        width, height = self._size(pen)
        legend = self.axes.legend(
            [artists if len(artists) > 1 else artists[0] for artists, _ in self.entries],
            self._legend_labels(pen),
            loc="lower left",
            bbox_to_anchor=(self.left / width, 1 + gap / height),
            ncols=self.columns,
            borderpad=0.0,
            borderaxespad=0.0,
            handlelength=_HANDLE,
            handletextpad=_HANDLE_GAP,
            columnspacing=_BETWEEN,
            labelspacing=0.25,
        )
        for line in legend.get_lines():
            line.set_linewidth(max(line.get_linewidth(), self.theme.line))
        self.written.append(legend)
        return legend

    def _write_text(
        self, text: str, height: float, size: float, *, weight: str = "normal", anchor: str = "bottom"
    ) -> Artist:
        written = self.axes.annotate(
            text,
            (0.0, 1.0),
            (self.left, height),
            xycoords="axes fraction",
            textcoords="offset points",
            ha="left",
            va=anchor,
            size=size,
            weight=weight,
            linespacing=1.2,
            annotation_clip=False,
        )
        self.written.append(written)
        return written
