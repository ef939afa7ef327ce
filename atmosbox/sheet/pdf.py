"""A sheet as PDF: what belongs together stays on a page, and the same sheet gives the same bytes."""

from __future__ import annotations

import functools
import io
from pathlib import Path
from typing import Any, NamedTuple

from atmosbox.errors import FileError, SettingError
from atmosbox.sheet.flow import BODY, BOLD, GREY, MM, SLANTED, TYPED, Flow
from atmosbox.sheet.worksheet import Worksheet

__all__ = ["PAPERS", "Printed", "check_paper", "load_fonts", "pdf"]

PAPERS = {"a4": (210.0 * MM, 297.0 * MM), "letter": (612.0, 792.0)}
"""Width and height of the papers [points]."""
MARGIN = 17.0 * MM
FOOT = 16.0 * MM
PADDING = 6.0
"""What the frame of a page keeps free on either side."""
ROOM = (1.0, 0.95, 0.9, 0.85, 0.8)
"""What is tried of the usual room to write, until the sheet fits on two pages."""
MOST_PAGES = 2


class Printed(NamedTuple):
    """A sheet on paper."""

    content: bytes
    """The bytes of the file."""
    pages: int
    """The number of its pages."""


def check_paper(paper: str) -> None:
    """Refuse a paper that is unknown.

    Raises
    ------
    SettingError
        If the paper is unknown.

    Examples
    --------
    >>> check_paper("a5")
    Traceback (most recent call last):
    atmosbox.errors.SettingError: paper = a5 is unknown: give --paper a4 or --paper letter.
    """
    if paper not in PAPERS:
        raise SettingError("paper", paper, "is unknown", "give --paper a4 or --paper letter")


def pdf(sheet: Worksheet, paper: str = "a4") -> Printed:
    """Return a sheet as PDF.

    Parameters
    ----------
    sheet
        From `worksheet`.
    paper
        One of `PAPERS`.

    Returns
    -------
    Printed
        The bytes, and how many pages they are.

    Raises
    ------
    SettingError
        If the paper is unknown.
    FileError
        If reportlab is not installed.

    Notes
    -----
    The type is embedded, so that every sign is seen everywhere and can be searched for. Neither the date nor chance
    enters the file.

    Examples
    --------
    >>> from atmosbox.sheet import worksheet
    >>> pdf(worksheet("lifting-dry")).pages
    2
    """
    check_paper(paper)
    load_fonts()
    for room in ROOM:
        pages = _laid_out(sheet, paper, room, 0).pages
        if pages <= MOST_PAGES:
            break
    return _laid_out(sheet, paper, room, pages)


@functools.cache
def load_fonts() -> None:
    """Make the fonts known that come with matplotlib.

    Raises
    ------
    FileError
        If reportlab is not installed.

    Examples
    --------
    >>> load_fonts()
    >>> from reportlab.pdfbase import pdfmetrics
    >>> pdfmetrics.stringWidth("±", BODY, 10.0) > 0.0
    True
    """
    try:
        from reportlab.pdfbase import pdfmetrics
        from reportlab.pdfbase.ttfonts import TTFont
    except ImportError as error:
        raise FileError("A sheet as PDF needs reportlab: type pip install reportlab, or give --format md.") from error
    import matplotlib

    folder = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
    for name in (BODY, BOLD, SLANTED, TYPED):
        pdfmetrics.registerFont(TTFont(name, folder / f"{name}.ttf"))
    pdfmetrics.registerFontFamily(BODY, normal=BODY, bold=BOLD, italic=SLANTED, boldItalic=BOLD)


def _laid_out(sheet: Worksheet, paper: str, room: float, pages: int) -> Printed:
    """Return a sheet whose feet say how many pages it has, with so much of the usual room to write."""
    from reportlab.platypus import SimpleDocTemplate

    width, height = PAPERS[paper]
    stream = io.BytesIO()
    title = sheet.title + (": answers" if sheet.answers else "")
    document = SimpleDocTemplate(
        stream, pagesize=(width, height), leftMargin=MARGIN, rightMargin=MARGIN, topMargin=0.85 * MARGIN,
        bottomMargin=FOOT, title=title, author="atmosbox", subject=f"{sheet.scene}: {sheet.about}", creator="atmosbox",
        invariant=1,
    )  # fmt: skip

    def foot(canvas: Any, document: Any) -> None:
        canvas.saveState()
        canvas.setFont(BODY, 7.0)
        canvas.setFillGray(GREY)
        canvas.drawString(MARGIN + PADDING, 0.6 * FOOT, f"atmosbox · {sheet.scene} · {sheet.about}")
        canvas.drawRightString(width - MARGIN - PADDING, 0.6 * FOOT, f"{document.page} / {pages}")
        canvas.restoreState()

    made = Flow(width - 2.0 * (MARGIN + PADDING), room)
    document.build(made.story(sheet, title), onFirstPage=foot, onLaterPages=foot)
    return Printed(stream.getvalue(), document.page)
