"""The film of a run: its molecules in their box, beside the scene's graphs, which grow with the clock.

Everything comes from the file: places and speeds of the molecules, the box and its walls, which a run keeps when it
is asked to (``--save-molecules``), and the panels of its scene. Without molecules the graphs alone can be filmed.

The room `plot` draws the box (`plot.box_picture`) and the graphs; here is what a film adds. Read in this order: `pace`
(which frames, how fast), `running` and `graph` (graphs that grow), `film_sheet` (where everything stands), `encoder`
and `film_file` (GIF and MP4).
"""

from atmosbox.film.film_file import FORMATS, save
from atmosbox.film.film_sheet import Sheet
from atmosbox.film.pace import Pace, pace

__all__ = ["FORMATS", "Pace", "Sheet", "pace", "save"]
