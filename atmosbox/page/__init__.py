"""The HTML page that shows a box: its molecules in three dimensions, and its graphs at the same time of the run.

A saved run becomes one HTML file that opens from disk without a network (`save`). The page of `atmosbox.lab`, in which
the engine itself runs, is made of the same parts (`lab_page`). Both use the same data: a *stage* that describes the run
once, and *frames* with the positions at each moment.

Read in this order: `stage` (what is shown), `panel` (the graphs), `frame` (one moment as bytes), `saved_run` (from a
dataset to all of these, and the file), `word` (the sentences), `controls` and `lesson` (what only a box that runs has),
`document` (the HTML). The folder ``web`` holds the page's own scripts, ``vendor`` the two libraries that draw the page,
and the one that makes QR codes.
"""

from atmosbox.page.document import lab_page, view_page
from atmosbox.page.saved_run import save
from atmosbox.page.stage import NEIGHBOURS, ROUND, Box, Stage, round_up, stage

__all__ = ["NEIGHBOURS", "ROUND", "Box", "Stage", "lab_page", "round_up", "save", "stage", "view_page"]
