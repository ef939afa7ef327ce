"""Sizes and colours of figures, in two themes: one for a page of notes, one for a slide."""

from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any

import matplotlib
import matplotlib.style

from atmosbox.errors import SettingError, either

OKABE_ITO = ("#000000", "#e69f00", "#56b4e9", "#009e73", "#f0e442", "#0072b2", "#d55e00", "#cc79a7")
"""Okabe and Ito's colours, which people who do not see the difference between red and green can tell apart."""

_BLACK, _ORANGE, _SKY, _GREEN, _YELLOW, _BLUE, _VERMILLION, _PURPLE = OKABE_ITO
DARK = "#1a1a1a"
FAINT = "#595959"

# Each curve differs from the others by colour and by a second cue, so that a print in grey can be read.
DATA_COLOURS = (_BLUE, _VERMILLION, _PURPLE, _SKY, _GREEN, _ORANGE)
DATA_MARKERS = ("o", "s", "^", "D", "v", "P")
# Dashes of the measured curves of one run where runs are compared: there the colour tells which run it is.
DATA_DASHES = ("solid", (0.0, (1.0, 1.0)), (0.0, (4.0, 1.0, 1.0, 1.0)))
# A reference curve lies under the others: where curves coincide, dashed ones on top let it be seen.
REFERENCE_COLOURS = (_ORANGE, _SKY)
_THEORY_DASHES = ((0.0, (5.0, 2.0)), (0.0, (1.2, 1.2)), (0.0, (9.0, 2.0, 2.0, 2.0, 2.0, 2.0)))
CURVES: dict[str, tuple[tuple[str, ...], tuple[Any, ...], float]] = {
    "data": (DATA_COLOURS, ("solid",), 1.6),
    "theory": ((DARK, "#5a5a5a", "#808080"), _THEORY_DASHES, 0.8),
    "environment": ((_GREEN, _PURPLE), ((0.0, (7.0, 2.0, 1.5, 2.0)), (0.0, (1.5, 1.5))), 1.0),
    "reference": (REFERENCE_COLOURS, ("solid",), 1.7),
}
"""Colours and dashes of the curves of each role, and their width in units of the theme's."""
FIELD_COLOURS = "viridis"
AGREES = _GREEN
# Areas differ by colour and by hatching; the background lines of a diagram are paler than any curve.
AREAS: dict[str, dict[str, Any]] = {
    name: {"facecolor": colour, "hatch": hatch, "edgecolor": FAINT, "linewidth": 0.0, "alpha": 0.7}
    for name, colour, hatch in (("CAPE", _ORANGE, "////"), ("CIN", _SKY, "\\\\\\\\"))
}
PALE = "#c4c4c4"


@dataclass(frozen=True)
class Theme:
    """Sizes of one kind of figure.

    ``narrow`` and ``wide`` are width and height of a figure with one panel and with several [inch]; the sizes of type,
    lines and markers are in points, and ``small`` is the type of the footer. A figure that ``grows`` becomes higher if
    there is much text above its panels: a page allows it, a slide does not.
    """

    name: str
    narrow: tuple[float, float]
    wide: tuple[float, float]
    text: float
    title: float
    small: float
    line: float
    marker: float
    dots_per_inch: float
    grows: bool


THEMES = {
    "notes": Theme("notes", (3.5, 3.5), (7.2, 4.5), 8.5, 9.5, 8.0, 1.2, 3.5, 150.0, grows=True),
    "slides": Theme("slides", (40 / 3, 7.5), (40 / 3, 7.5), 16.0, 18.0, 12.0, 2.4, 7.0, 96.0, grows=False),
}


def find(name: str) -> Theme:
    """Return the theme of a name, "notes" or "slides"."""
    if name not in THEMES:
        raise SettingError("theme", name, "is not a theme", *either("theme", THEMES))
    return THEMES[name]


def style(theme: Theme) -> AbstractContextManager[None]:
    """Return a context in which matplotlib draws in a theme, whatever the user's own settings are."""
    settings: dict[str, Any] = {
        "font.size": theme.text, "axes.titlesize": theme.title, "axes.labelsize": theme.text,
        "legend.fontsize": theme.text, "legend.frameon": False,
        "axes.linewidth": theme.line / 2, "axes.spines.top": False, "axes.spines.right": False,
        "axes.edgecolor": FAINT, "axes.labelcolor": DARK, "axes.axisbelow": True, "text.color": DARK,
        "lines.linewidth": theme.line, "lines.markersize": theme.marker, "lines.solid_capstyle": "butt",
        "grid.color": "#d9d9d9", "grid.linewidth": theme.line / 3, "hatch.linewidth": theme.line / 3,
        "axes.formatter.useoffset": False, "axes.formatter.limits": (-9, 9),
        "figure.dpi": theme.dots_per_inch,
        "svg.hashsalt": "atmosbox", "svg.fonttype": "path", "pdf.fonttype": 42,
    }  # fmt: skip
    for axis in ("xtick", "ytick"):
        settings |= {f"{axis}.labelsize": theme.text, f"{axis}.color": FAINT, f"{axis}.labelcolor": DARK}
        settings |= {f"{axis}.minor.size": 0.15 * theme.text, f"{axis}.major.size": 0.35 * theme.text}
    return matplotlib.style.context(["default", settings], after_reset=True)
