"""The figure of a run: from the file to a page or a slide.

The dataset holds everything that is drawn: the panels that its scene chose (attribute ``atmosbox_panels``), the
variables that these panels show, the headline numbers and the provenance. A figure can therefore be drawn without the
scene and without the engine, and drawing it twice gives the same bytes.

Read in this order: `unit` (from SI to the units of a graph), `curve` and `plane` (from a file to numbers),
`stroke`, `draw`, `disc_marker`, `skewt` and `energy` (from numbers to curves), `tick`, `caption` and `number_card`
(text), `theme` (sizes and colours), `tilt` and `pen` (one panel), `place` and `layout` (all panels), `comparison`
(several runs in one figure), `varied`, `field`, `coexistence_figure` and `sweep_figure` (many runs),
`tradeoff_choice`, `direct_label` and `tradeoff_figure` (speed against accuracy), `camera`, `box_picture`,
`atmosphere_picture` and `box_figure` (the molecules in their box, the parcel in its atmosphere), `figure_file` (PNG,
SVG, PDF).
"""

import sys

from atmosbox.callable_room import CallableRoom
from atmosbox.plot.box_figure import figure_with_box
from atmosbox.plot.figure_file import FORMATS, save
from atmosbox.plot.layout import figure
from atmosbox.plot.theme import THEMES

__all__ = ["FORMATS", "THEMES", "figure", "figure_with_box", "save"]

sys.modules[__name__].__class__ = CallableRoom  # atmosbox.plot(run) draws it
