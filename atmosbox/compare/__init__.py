"""Runs side by side: what differs in how they were made, and by how much their numbers differ.

Read in this order: `change` (which settings are not the same, and what to call each run by), `number` (the headline
numbers of all, with the difference of each from the first and its standard error), `file` (one figure of all).
"""

from atmosbox.compare.change import Change, Naming, naming
from atmosbox.compare.file import save
from atmosbox.compare.number import Compared, Measured, compared

__all__ = ["Change", "Compared", "Measured", "Naming", "compared", "naming", "save"]
