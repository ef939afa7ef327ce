"""Worksheets: what a lecturer hands out with a scene, as PDF and as Markdown, and the same with the answers.

The words of a sheet stand beside its scene, in ``my_scene.sheet.toml``; a scene without gets a sheet made from its
card and its headlines.

Read in this order: `text` (the words, read from their file) with `sums`, `number_text` and `marks` (what may stand
in them), `sheet_run` (the runs), `generic` (the words of any scene), `worksheet` (words and runs put together as
Markdown, by the template ``sheet.md.jinja``), `pdf` (that Markdown on paper), `sheet_file` (a file that appears
whole).
"""

from atmosbox.sheet.pdf import PAPERS
from atmosbox.sheet.sheet_file import FORMATS, check, save
from atmosbox.sheet.worksheet import Worksheet, worksheet

__all__ = ["FORMATS", "PAPERS", "Worksheet", "check", "save", "worksheet"]
