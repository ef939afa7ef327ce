"""A sheet as a file: the same sheet gives the same bytes, and a file appears only when it is complete."""

import os
from pathlib import Path

from atmosbox.errors import SettingError, either
from atmosbox.file.output_path import named, write_whole
from atmosbox.sheet.html import html
from atmosbox.sheet.pdf import PAPERS, pdf
from atmosbox.sheet.worksheet import Worksheet

FORMATS = ("pdf", "html", "md")


def check(path: str | os.PathLike[str], format: str | None = None, *, paper: str = "a4", force: bool = False) -> Path:
    """Return the path of the file of a sheet, or refuse it before time is spent on a run.

    Its suffix gives the format; if ``format`` is given, a missing suffix is added.

    Examples
    --------
    >>> check("sheet.docx")
    Traceback (most recent call last):
    atmosbox.errors.SettingError: format = docx is unknown: give a file name or format of pdf, html or md.
    """
    path, _ = named(path, format, FORMATS, force=force, what="sheet")
    if paper not in PAPERS:
        raise SettingError("paper", paper, "is unknown", *either("paper", tuple(PAPERS)))
    return path


def save(
    sheet: Worksheet, path: str | os.PathLike[str], format: str | None = None, *, paper: str = "a4", force: bool = False
) -> Path:
    """Write a sheet into a file, which `check` has not refused, and return its path.

    Examples
    --------
    >>> from atmosbox.sheet import worksheet
    >>> save(worksheet("lifting-dry"), "no/sheet.md")
    Traceback (most recent call last):
    atmosbox.errors.FileError: The folder no does not exist: type mkdir -p no first.
    """
    path = check(path, format, paper=paper, force=force)
    kind = path.suffix.lower()
    text = html(sheet) if kind == ".html" else sheet.text
    write_whole(path, pdf(sheet, paper).content if kind == ".pdf" else text.encode("utf-8"))
    return path
