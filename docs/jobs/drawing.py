"""How the figures of these pages look: the type and colours of those that atmosbox draws itself."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from jobs.registry import Findings
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from atmosbox.plot.theme import DATA_COLOURS, FAINT, THEMES, style

DOTS_PER_INCH = 130
BLUE, VERMILLION = DATA_COLOURS[0], DATA_COLOURS[1]


@contextmanager
def sheet(size: tuple[float, float]) -> Iterator[Figure]:
    """Return an empty figure of a size [inch], to be filled within the context."""
    import matplotlib

    with (
        style(THEMES["notes"]),
        matplotlib.rc_context(
            {
                "font.size": 11,
                "axes.titlesize": 12.5,
                "axes.titleweight": "bold",
                "axes.titlelocation": "left",
                "axes.labelsize": 11,
                "xtick.labelsize": 10.5,
                "ytick.labelsize": 10.5,
                "legend.fontsize": 10.5,
                "lines.linewidth": 1.8,
                "lines.markersize": 6,
                "axes.grid": True,
            }
        ),
    ):
        drawing = Figure(figsize=size, layout="constrained")
        FigureCanvasAgg(drawing)
        drawing.get_layout_engine().set(w_pad=0.08, h_pad=0.06, wspace=0.04)
        yield drawing


@contextmanager
def axes_of(number: int, size: tuple[float, float], widths: Any = None) -> Iterator[tuple[Figure, Any]]:
    """Return a figure with some axes side by side."""
    with sheet(size) as drawing:
        axes = drawing.subplots(1, number, squeeze=False, width_ratios=widths)[0]
        for each in axes:
            each.set_prop_cycle(color=DATA_COLOURS)
        yield drawing, axes


def explain(drawing: Figure, text: str = "bars: ± 1 standard error") -> None:
    """Write a line below a figure that says what its error bars and bands are."""
    drawing.supxlabel(text, x=0.01, horizontalalignment="left", fontsize=9, color=FAINT)


def save(found: Findings, drawing: Figure, name: str, dots_per_inch: float = DOTS_PER_INCH) -> None:
    """Write a figure."""
    found.figure(drawing, name, dots_per_inch)
