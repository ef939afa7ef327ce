"""What a script or a notebook calls: the functions of `atmosbox` itself.

Read in this order: `wording` (refusals in the words of Python), `notebook` (whether there is one, and how it shows
progress), `run_dataset` (a dataset that begins with its numbers), `measurement` (`run`, `resume`, `open`), `grid`
(`sweep`), `drawing` (`plot`, `compare`), `inline_page` (`show`), `catalogue` (`scenes`). Whatever is heavy is imported
when a function needs it.
"""

from atmosbox.interface.catalogue import Printed, scenes
from atmosbox.interface.drawing import Comparison, compare, plot
from atmosbox.interface.grid import sweep
from atmosbox.interface.inline_page import InlinePage, show
from atmosbox.interface.measurement import open, resume, run

__all__ = ["Comparison", "InlinePage", "Printed", "compare", "open", "plot", "resume", "run", "scenes", "show", "sweep"]
