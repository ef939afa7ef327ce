"""The page that shows a box: its molecules in three dimensions, and its graphs on the same clock.

A run becomes one HTML file that opens from disk without a network (`save`); a box that is running is shown by the
same page, fed through a socket (`live_page`), or, if it runs in the page itself, by a worker (`lab_page`). All use the
same data: a *stage* that says once what there is to see, and *frames* that say where everything is.

Read in this order: `page_box` and `page_stage` (what is shown), `page_panel` (its graphs), `page_liquid` and
`frame` (one moment as bytes), `thinning` (what a large run leaves out), `saved_run` (from a dataset to all of
these), `word` (the sentences), `document` (the HTML) and `page_file`. The folder ``web`` holds the page's own
scripts, ``vendor`` the two libraries that it draws with.
"""

from atmosbox.page.document import lab_page, live_page, view_page
from atmosbox.page.page_box import Box
from atmosbox.page.page_file import save
from atmosbox.page.page_stage import NEIGHBOURS, Stage, round_up, stage

__all__ = ["NEIGHBOURS", "Box", "Stage", "lab_page", "live_page", "round_up", "save", "stage", "view_page"]
