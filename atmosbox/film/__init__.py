"""The film of a run: the molecules in their box, and beside it the graphs of the scene, which grow with time.

The file of a run holds everything that is drawn: the positions and speeds of the molecules, the box and its walls (if
the run was made with ``--save-molecules``), and the panels of the scene. Without molecules only the graphs are filmed.

The room `plot` draws the box (`plot.box_picture`) and the graphs; this room adds what only a film needs. Read in this
order: `graph` (graphs that grow), `film_sheet` (which frames, how fast, and the layout of a picture) and `film_file`
(GIF and MP4).
"""

from atmosbox.film.film_file import FORMATS, save
from atmosbox.film.film_sheet import Pace, Sheet, pace

__all__ = ["FORMATS", "Pace", "Sheet", "pace", "save"]
