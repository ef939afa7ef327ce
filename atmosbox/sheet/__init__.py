"""Worksheets that a lecturer hands out with a scene: as PDF, web page or Markdown, with and without the answers.

The text of a sheet is in a file beside its scene, ``my_scene.sheet.toml``; for a scene without such a file, a sheet is
made from its model card and its headlines.

Read in this order: `text` (the text, read from its file) with `sums` and `marks` (which sums and marks a text may
contain, and how numbers are printed), `sheet_run` (the runs), `worksheet` (text and runs together as Markdown, by the
template ``sheet.md.jinja``, and the text for any scene), `pdf` and `html` (the Markdown on paper and as a web page),
`sheet_file` (the file).
"""

from atmosbox.sheet.pdf import PAPERS
from atmosbox.sheet.sheet_file import FORMATS, check, save
from atmosbox.sheet.worksheet import Worksheet, worksheet

__all__ = ["FORMATS", "PAPERS", "Worksheet", "check", "save", "worksheet"]
