"""The public functions of `atmosbox`, which scripts and notebooks call.

Read in this order: `run_dataset` (a dataset that prints its results first, and progress in a notebook), `measurement`
(`scenes`, `run`, `resume`, `open`, `sweep`), `drawing` (`plot`, `compare`, `show`). Large libraries are imported when a
function needs them.
"""

from atmosbox.interface.drawing import Comparison, InlinePage, compare, plot, show
from atmosbox.interface.measurement import Printed, open, resume, run, scenes, sweep

__all__ = ["Comparison", "InlinePage", "Printed", "compare", "open", "plot", "resume", "run", "scenes", "show", "sweep"]
