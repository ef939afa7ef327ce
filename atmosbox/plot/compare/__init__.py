"""Comparison of runs: which of their settings differ, and by how much their headline numbers differ.

Read in this order: `difference` (the settings that differ with a label for each run, and the headline numbers of all
runs with their differences from the first run and the standard errors), `figure` (one figure of all runs).
"""

from atmosbox.plot.compare.difference import Change, Compared, Measured, Naming, compared, naming
from atmosbox.plot.compare.figure import save

__all__ = ["Change", "Compared", "Measured", "Naming", "compared", "naming", "save"]
