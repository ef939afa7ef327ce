"""The figure of a run: from the file to a page or a slide.

The dataset holds everything that is drawn: the panels that its scene chose (attribute ``atmosbox_panels``), the
variables that these panels show, the headline numbers and the provenance. A figure can therefore be drawn without the
scene and without the engine, and drawing it twice gives the same bytes.

Read in this order: `units` (from SI to the units of a graph), `curve` (from a file to numbers), `theme` (sizes and
colours), `draw`, `discs`, `skewt`, `atmosphere_picture`, `box_picture` (from numbers to curves and pictures), `tick`,
`caption` (text), `layout` (a page of panels), `run_figure` (the figure of a run), `compare` (several runs in one
figure), `sweep_figure`, `coexistence_figure` (many runs), `tradeoff_figure` (speed against accuracy) and `figure_file`
(PNG, SVG, PDF).
"""

import sys

from atmosbox.callable_room import CallableRoom
from atmosbox.plot.figure_file import FORMATS, save
from atmosbox.plot.run_figure import figure, figure_with_box
from atmosbox.plot.theme import THEMES

__all__ = ["FORMATS", "THEMES", "figure", "figure_with_box", "save"]

sys.modules[__name__].__class__ = CallableRoom  # atmosbox.plot(run) draws it
