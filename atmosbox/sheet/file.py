"""A sheet as a file: the same sheet gives the same bytes, and a file appears only when it is whole."""

from __future__ import annotations

import errno
import os
import uuid
from pathlib import Path

from atmosbox.errors import DiskFullError, FileError, SettingError
from atmosbox.sheet.markdown import markdown
from atmosbox.sheet.pdf import check_paper, load_fonts, pdf
from atmosbox.sheet.worksheet import Worksheet

__all__ = ["FORMATS", "check", "save"]

FORMATS = ("pdf", "md")


def check(path: str | os.PathLike[str], format: str | None = None, *, paper: str = "a4", force: bool = False) -> Path:
    """Return the file that a sheet is to be written to, or refuse it before a run is spent on it.

    Parameters
    ----------
    path : str or path-like
        The file. Its suffix says the format; where ``format`` says it, a suffix that is missing is added.
    format : {"pdf", "md"}, optional
        The format.
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
        If the file exists, its folder does not, or reportlab is missing, which writes PDF.
    SettingError
        If the format or the paper is unknown.

    Examples
    --------
    >>> check("sheet.docx")
    Traceback (most recent call last):
    atmosbox.errors.SettingError: format = docx is unknown: give a file name or --format of pdf or md.
    """
    path = Path(path)
    suffix = path.suffix[1:].lower()
    kind = suffix if format is None else format.lower().lstrip(".")
    if kind not in FORMATS:
        problem = "is unknown" if kind else "is not given"
        raise SettingError("format", kind or None, problem, "give a file name or --format of pdf or md")
    if suffix in FORMATS and suffix != kind:
        raise SettingError("format", kind, f"does not go with the file name {path.name}", "leave one of the two out")
    path = path if suffix == kind else path.with_name(f"{path.name}.{kind}")
    check_paper(paper)
    if kind == "pdf":
        load_fonts()
    if path.is_dir():
        raise FileError(f"{path} is a folder: name the file of the sheet, {path / f'sheet.{kind}'} for instance.")
    if not path.parent.is_dir():
        raise FileError(f"The folder {path.parent} for the sheet does not exist: make it first, or name another one.")
    if path.exists() and not force:
        raise FileError(f"{path} exists already: add --force to replace it, or name another file.")
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
        From `worksheet`.
    path, format, paper, force
        As `check` takes them.

    Returns
    -------
    pathlib.Path
        The file that was written.

    Raises
    ------
    FileError
        If the file is in the way or cannot be written.
    SettingError
        If the format or the paper is unknown.

    Examples
    --------
    >>> from atmosbox.sheet import worksheet
    >>> save(worksheet("lifting-dry"), "no/sheet.md")
    Traceback (most recent call last):
    atmosbox.errors.FileError: The folder no for the sheet does not exist: make it first, or name another one.
    """
    path = check(path, format, paper=paper, force=force)
    content = markdown(sheet).encode("utf-8") if path.suffix.lower() == ".md" else pdf(sheet, paper).content
    part = path.with_name(f".{path.name}.{uuid.uuid4().hex}.part")
    try:
        with part.open("xb") as stream:
            stream.write(content)
        os.replace(part, path)
    except OSError as error:
        part.unlink(missing_ok=True)
        if error.errno == errno.ENOSPC:
            raise DiskFullError(f"The disk is full, and {path} was not written: make room and try again.") from error
        raise FileError(f"{path} cannot be written ({error.strerror}): name a file in another folder.") from error
    return path
