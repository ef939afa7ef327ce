"""The film of a run: the molecules in their box, and beside it the graphs of the scene, which grow with time.

The file of a run holds everything that is drawn; without molecules (``--save-molecules``) only the graphs are filmed.
The room `plot` draws box and graphs. This one adds graphs that grow (`graph`), the frames and the layout of a picture
(`film_sheet`), and GIF and MP4 (`film_file`).
"""

from atmosbox.film.film_file import FORMATS, save
from atmosbox.film.film_sheet import Pace, Sheet, pace

__all__ = ["FORMATS", "Pace", "Sheet", "pace", "save"]
