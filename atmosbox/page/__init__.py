"""The HTML page that shows a box: its molecules in three dimensions, and its graphs at the same time of the run.

A saved run becomes one HTML file that opens from disk without a network (`save`); the page of `atmosbox.lab`, in which
the engine itself runs, is made of the same parts (`lab_page`). Both use a *stage* that describes the run once, and
*frames* with the positions at each moment. The folder ``web`` holds the page's own scripts; ``vendor`` the two
libraries that draw the page, and the one that makes QR codes.
"""

from atmosbox.page.document import lab_page, view_page
from atmosbox.page.saved_run import save
from atmosbox.page.stage import NEIGHBOURS, ROUND, Stage, round_up, stage

__all__ = ["NEIGHBOURS", "ROUND", "Stage", "lab_page", "round_up", "save", "stage", "view_page"]
