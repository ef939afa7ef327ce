"""The figure of a run: from the file to a page or a slide.

Everything comes from the dataset itself: the panels that its scene asked for (attribute ``atmosbox_panels``),
the variables they name, the headline numbers and the provenance. A figure can therefore be drawn wherever the
file is, without the scene and without the engine, and drawing it twice gives the same bytes.

Read in this order: `unit` (from SI to what a meteorologist reads), `curve` and `plane` (from a file to numbers),
`stroke`, `draw`, `disc_marker`, `skewt` and `energy` (numbers to ink), `tick`, `caption` and `number_card` (what is
written), `theme` (how large), `tilt` and `pen` (one panel), `place` and `layout` (all of them), `comparison`
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
