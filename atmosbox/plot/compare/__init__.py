"""Runs side by side: what differs in how they were made, and by how much their numbers differ.

Read in this order: `change` (which settings are not the same, and what to call each run by), `difference` (the headline
numbers of all, with the difference of each from the first and its standard error), `compared_file` (one figure of
all).
"""

from atmosbox.plot.compare.change import Change, Naming, naming
from atmosbox.plot.compare.compared_file import save
from atmosbox.plot.compare.difference import Compared, Measured, compared

__all__ = ["Change", "Compared", "Measured", "Naming", "compared", "naming", "save"]
