"""The HTML page that shows a box: its molecules in three dimensions, and its graphs at the same time of the run.

A saved run becomes one HTML file that opens from disk without a network (`save`). The same page shows a box while it
runs: the frames come through a socket (`live_page`) or, if the box runs in the page itself, from a worker (`lab_page`).
All use the same data: a *stage* that describes the run once, and *frames* with the positions at each moment.

Read in this order: `page_box` and `page_stage` (what is shown), `page_panel` (the graphs), `page_liquid` and
`frame` (one moment as bytes), `thinning` (what is left out of a large run), `saved_run` (from a dataset to all of
these), `word` (the sentences), `document` (the HTML) and `page_file`. The folder ``web`` holds the page's own
scripts, ``vendor`` the two libraries that draw the page.
"""

from atmosbox.page.document import lab_page, live_page, view_page
from atmosbox.page.page_box import Box
from atmosbox.page.page_file import save
from atmosbox.page.page_stage import NEIGHBOURS, ROUND, Stage, round_up, stage

__all__ = ["NEIGHBOURS", "ROUND", "Box", "Stage", "lab_page", "live_page", "round_up", "save", "stage", "view_page"]
