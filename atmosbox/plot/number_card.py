"""The headline numbers of a run in large type at the top of its figure: measured value, textbook, difference."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.text import Text
from matplotlib.transforms import ScaledTranslation

from atmosbox.plot.caption import Reading
from atmosbox.plot.pen import Pen
from atmosbox.plot.theme import DARK, FAINT, Theme

__all__ = ["put_numbers"]

_LARGE = 1.6  # size of the number, in units of the title's size
_NARROWEST = 14.0  # least width of a card, in units of the type size
_LEADING = 1.2  # distance from line to line, in units of the type size


def put_numbers(pen: Pen, readings: Sequence[Reading], look: Theme, below: float) -> float:
    """Write numbers as cards in one row, or in several rows on a narrow page; return the height of all cards [pt].

    Parameters
    ----------
    pen : Pen
        The pen of the page.
    readings : sequence of Reading
        The headline numbers. Without any, nothing is drawn and the height is 0.
    look : Theme
        The theme: sizes of type, lines and markers.
    below : float
        Distance from the upper end of the page to the cards [pt].

    Examples
    --------
    >>> from matplotlib.backends.backend_agg import FigureCanvasAgg
    >>> from matplotlib.figure import Figure
    >>> from atmosbox.plot.theme import THEMES
    >>> drawing = Figure(figsize=(7.2, 4.5))
    >>> _ = FigureCanvasAgg(drawing)
    >>> cape = Reading("CAPE", "2270", "± 30 J/kg", "parcel theory 2290 J/kg", "difference −20 J/kg")
    >>> 40.0 < put_numbers(Pen(drawing), [cape], THEMES["notes"], 0.0) < 60.0
    True
    """
    if not readings:
        return 0.0
    width = 72.0 * pen.figure.get_figwidth() - look.text
    columns = min(len(readings), max(1, int(width / (_NARROWEST * look.text))))
    each, top = width / columns, below
    for first in range(0, len(readings), columns):
        row = readings[first : first + columns]
        top += max(
            _put_card(pen, reading, look, 0.5 * look.text + place * each, top, each - look.text)
            for place, reading in enumerate(row)
        )
    return top - below


def _put_card(pen: Pen, reading: Reading, look: Theme, left: float, top: float, width: float) -> float:
    """Write one number, its name and the textbook's value; return the height of this card [pt]."""
    large, line = _LARGE * look.title, _LEADING * look.text
    base = top + 0.95 * large
    _write(pen, reading.number, left, base, large, DARK, bold=True)
    after = left + pen.width(reading.number, large, "bold") + 0.4 * look.text
    _write(pen, reading.error, after, base, look.text, DARK)
    base += 0.25 * large
    beside = ", ".join(part for part in (reading.theory, reading.difference) if part)
    for words, colour in ((reading.label, DARK), (beside, FAINT)):
        for text in pen.wrap(words, width, look.text).split("\n") if words else ():
            base += line
            _write(pen, text, left, base, look.text, colour)
    return base + 0.6 * line - top


def _write(pen: Pen, words: str, left: float, base: float, size: float, colour: str, *, bold: bool = False) -> Text:
    """Write a line of text at a distance from the left and from the upper end of the page [pt].

    The line keeps this distance from the upper end if the page grows later.
    """
    figure = pen.figure
    place = figure.transFigure + ScaledTranslation(left / 72.0, -base / 72.0, figure.dpi_scale_trans)
    text = figure.text(0.0, 1.0, words, transform=place, size=size, color=colour, va="baseline")
    text.set_fontweight("bold" if bold else "normal")
    text.set_in_layout(False)
    return text
