"""Comparison of runs: which of their settings differ, and by how much their headline numbers differ.

Read in this order: `change` (the settings that differ, and a label for each run), `difference` (the headline numbers of
all runs, with their differences from the first run and the standard errors), `figure` (one figure of all runs).
"""

from atmosbox.plot.compare.change import Change, Naming, naming
from atmosbox.plot.compare.difference import Compared, Measured, compared
from atmosbox.plot.compare.figure import save

__all__ = ["Change", "Compared", "Measured", "Naming", "compared", "naming", "save"]
