"""The figure of a run: from the file to a page or a slide.

The dataset holds everything that is drawn: the panels of its scene, their variables, the headline numbers and the
provenance. A figure needs neither the scene nor the engine, and drawing it twice gives the same bytes. From numbers to
file: `curve`, `theme`, `draw` and the pictures, `tick`, `caption`, `layout`, the figures, `figure_file`.
"""

import sys

from atmosbox.callable_room import CallableRoom
from atmosbox.plot.figure_file import FORMATS, save
from atmosbox.plot.run_figure import figure, figure_with_box
from atmosbox.plot.theme import THEMES

__all__ = ["FORMATS", "THEMES", "figure", "figure_with_box", "save"]

sys.modules[__name__].__class__ = CallableRoom  # atmosbox.plot(run) draws it
