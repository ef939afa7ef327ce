"""A sheet as a file: the same sheet gives the same bytes, and a file appears only when it is complete."""

from __future__ import annotations

import os
from pathlib import Path

from atmosbox.file.output_path import named, write_whole
from atmosbox.sheet.html import html
from atmosbox.sheet.pdf import check_paper, load_fonts, pdf
from atmosbox.sheet.worksheet import Worksheet

__all__ = ["FORMATS", "check", "save"]

FORMATS = ("pdf", "html", "md")


def check(path: str | os.PathLike[str], format: str | None = None, *, paper: str = "a4", force: bool = False) -> Path:
    """Return the path of the file of a sheet, or refuse it before time is spent on a run.

    Parameters
    ----------
    path : str or path-like
        The file. Its suffix gives the format; if ``format`` is given, a missing suffix is added.
    format : {"pdf", "html", "md"}, optional
        The format, by default that of the suffix.
    paper : {"a4", "letter"}
        The paper of a PDF.
    force : bool
        Whether a file of that name may be replaced.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    FileError
        If the file exists, its folder does not, or reportlab, which writes PDF, is not installed.
    SettingError
        If the format or the paper is unknown.

    Examples
    --------
    >>> check("sheet.docx")
    Traceback (most recent call last):
    atmosbox.errors.SettingError: format = docx is unknown: give a file name or format of pdf, html or md.
    """
    path, kind = named(path, format, FORMATS, force=force, what="sheet")
    check_paper(paper)
    if kind == "pdf":
        load_fonts()
    return path


def save(
    sheet: Worksheet,
    path: str | os.PathLike[str],
    format: str | None = None,
    *,
    paper: str = "a4",
    force: bool = False,
) -> Path:
    """Write a sheet into a file.

    Parameters
    ----------
    sheet : Worksheet
        The sheet, from `worksheet`.
    path, format, paper, force
        See `check`.

    Returns
    -------
    pathlib.Path
        The file that was written.

    Raises
    ------
    FileError
        If the file exists already or cannot be written, or reportlab is not installed.
    SettingError
        If the format or the paper is unknown.

    Examples
    --------
    >>> from atmosbox.sheet import worksheet
    >>> save(worksheet("lifting-dry"), "no/sheet.md")
    Traceback (most recent call last):
    atmosbox.errors.FileError: The folder no does not exist: type mkdir -p no first.
    """
    path = check(path, format, paper=paper, force=force)
    match path.suffix.lower():
        case ".pdf":
            content = pdf(sheet, paper).content
        case ".html":
            content = html(sheet).encode("utf-8")
        case _:
            content = sheet.text.encode("utf-8")
    write_whole(path, content)
    return path
