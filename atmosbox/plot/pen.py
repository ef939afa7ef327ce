"""The width of text as matplotlib draws it, and line breaks at a given width."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties

__all__ = ["Pen"]

_FIXED = "\u00a0"  # a space that no line breaks at


@dataclass
class Pen:
    r"""Measures text and breaks it into lines of any width; matplotlib itself wraps at the edge of the figure only.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure to write on; its canvas must be one of Agg.

    Examples
    --------
    >>> from matplotlib.backends.backend_agg import FigureCanvasAgg
    >>> drawing = Figure()
    >>> _ = FigureCanvasAgg(drawing)
    >>> Pen(drawing).wrap("lapse rate = 9.8 ± 0.1 K km⁻¹ (of the parcel)", 90.0, 8.0).split("\n")
    ['lapse rate', '= 9.8 ± 0.1 K km⁻¹ (of the parcel)']
    """

    figure: Figure
    known: dict[tuple[str, float, str], float] = field(default_factory=dict, repr=False)
    """Widths that were already measured [pt]."""

    def width(self, text: str, size: float, weight: str = "normal") -> float:
        """Return the width of a line of text [pt]."""
        asked = text, size, weight
        if asked not in self.known:  # a page is laid out several times
            renderer = self.figure.canvas.get_renderer()  # type: ignore[attr-defined]
            font = FontProperties(size=size, weight=weight)
            width, _, _ = renderer.get_text_width_height_descent(text, font, ismath=False)
            self.known[asked] = float(width) * 72 / self.figure.dpi
        return self.known[asked]

    def wrap(self, text: str, width: float, size: float, weight: str = "normal") -> str:
        """Return text broken into lines of at most a width [pt].

        Lines do not break within short brackets, after a minus sign or within what follows "=". A single word that is
        wider stays whole.
        """
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
        """Return the height of an artist as it is drawn [pt]."""
        return float(artist.get_window_extent().height) * 72 / self.figure.dpi
