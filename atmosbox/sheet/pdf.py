"""A sheet as PDF: parts that belong together stay on one page, and the same sheet gives the same bytes."""

import functools
import io
import itertools
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from markdown_it.tree import SyntaxTreeNode
from reportlab.graphics.shapes import Drawing, Line, PolyLine, String
from reportlab.lib.colors import Color
from reportlab.lib.styles import ParagraphStyle as Style
from reportlab.pdfbase import pdfmetrics
from reportlab.pdfbase.ttfonts import TTFont
from reportlab.platypus import Flowable, HRFlowable, KeepTogether, Paragraph, SimpleDocTemplate, Spacer, Table

from atmosbox.sheet.marks import PARSER, TYPED, as_paragraph, axes, blocks, inside, rows
from atmosbox.sheet.worksheet import Worksheet

MM = 72.0 / 25.4
PAPERS = {"a4": (210.0 * MM, 297.0 * MM), "letter": (612.0, 792.0)}
"""Width and height of the papers [points]."""
MARGIN = 17.0 * MM
FOOT = 16.0 * MM
PADDING = 6.0
"""Free space at the left and the right side of a page's frame [points]."""
ROOM = (1.0, 0.95, 0.9, 0.85, 0.8)
"""Factors on the usual room to write; they are tried in this order until the sheet fits on two pages."""
MOST_PAGES = 2
BODY, BOLD, SLANTED = "DejaVuSans", "DejaVuSans-Bold", "DejaVuSans-Oblique"
WRITING = 7.0 * MM
"""Distance between the lines to write on."""
ROW = 6.1 * MM
"""Height of a line of the table that is to be filled in."""
AXES = 34.0 * MM
LONG = 100
"""Number of characters of answers to tick that fit side by side."""
GREY = 0.45
SHARES = (0.43, 0.06, 0.24, 0.15, 0.12)
"""Widths of the columns of the table, in units of the width of the text."""


class Printed(NamedTuple):
    """A sheet on paper."""

    content: bytes
    """The bytes of the file."""
    pages: int
    """The number of its pages."""


def pdf(sheet: Worksheet, paper: str = "a4") -> Printed:
    """Return a sheet as PDF, on one of the `PAPERS`.

    The fonts are embedded, so that every character is shown on every computer and can be searched for. The file
    contains neither a date nor a random number.

    >>> from atmosbox.sheet import worksheet
    >>> pdf(worksheet("lifting-dry")).pages
    2
    """
    load_fonts()
    for room in ROOM:
        printed = _laid_out(sheet, paper, room, MOST_PAGES)
        if printed.pages <= MOST_PAGES:
            break
    return printed if printed.pages == MOST_PAGES else _laid_out(sheet, paper, room, printed.pages)


@functools.cache
def load_fonts() -> None:
    """Register the fonts that come with matplotlib."""
    import matplotlib

    folder = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
    for name in (BODY, BOLD, SLANTED, TYPED):
        pdfmetrics.registerFont(TTFont(name, folder / f"{name}.ttf"))
    pdfmetrics.registerFontFamily(BODY, normal=BODY, bold=BOLD, italic=SLANTED, boldItalic=BOLD)


def _laid_out(sheet: Worksheet, paper: str, room: float, pages: int) -> Printed:
    """Return a sheet with a factor on the usual room to write; the foot of each page gives the number of pages."""
    width, height = PAPERS[paper]
    stream = io.BytesIO()
    title = sheet.title + (f" {sheet.said('Answers')}" if sheet.answers else "")
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

    story = _Layout(width - 2.0 * (MARGIN + PADDING), room, sheet.said).story(sheet, title)
    document.build(story, onFirstPage=foot, onLaterPages=foot)
    return Printed(stream.getvalue(), document.page)


def _padding(**sizes: float) -> list[tuple[Any, ...]]:
    """Return the free space at the sides of all cells of a table [points]."""
    return [(f"{side}PADDING", (0, 0), (-1, -1), size) for side, size in sizes.items()]


class _Layout:
    """Converts the Markdown of a sheet to the elements that reportlab lays out (flowables).

    ``width`` is that of the text [points]; ``room`` the height of lines to write on, empty axes and rows of the table,
    in units of their usual height; ``said`` translates an English text of the layout.
    """

    def __init__(self, width: float, room: float, said: Callable[[str], str]) -> None:
        self.width, self.room, self.said = width, room, said
        self.body = Style("body", fontName=BODY, fontSize=9.0, leading=11.9, spaceAfter=3.0)
        self.heading = Style("heading", self.body, fontName=BOLD, fontSize=10.5, leading=13.0, spaceBefore=7.0)
        self.title = Style("title", self.body, fontName=BOLD, fontSize=16.0, leading=19.0, spaceAfter=1.0)
        self.small = Style("small", self.body, fontSize=7.6, leading=9.8)
        self.typed = Style("typed", self.body, fontSize=7.8, leading=10.2, leftIndent=14.0)
        self.answer = Style("answer", self.body, fontSize=8.4, leading=11.0, leftIndent=14.0)
        self.cell = Style("cell", self.body, fontSize=8.2, leading=10.0, spaceAfter=0.0)
        self.middle = Style("middle", self.cell, alignment=1)
        self.right = Style("right", self.small, alignment=2)

    def line(self, line: SyntaxTreeNode, style: Any) -> Flowable:
        """Return a line of text in a style."""
        return Paragraph(as_paragraph(line, style.fontSize), style)

    def marked(self, text: str, style: Any) -> Flowable:
        """Return a text with marks in a style."""
        return self.line(SyntaxTreeNode(PARSER.parseInline(text)), style)

    def table(
        self, rows: Sequence[Sequence[Any]], widths: Sequence[float], style: Sequence[Any], **more: Any
    ) -> Flowable:
        """Return a table; the widths of its columns are shares of the width of the text."""
        return Table(rows, colWidths=[share * self.width for share in widths], style=style, **more)

    def story(self, sheet: Worksheet, title: str) -> list[Flowable]:
        """Return the elements of the whole sheet; headings and paragraphs that begin in bold stay with the next one."""
        said = self.said
        blank = f"{said('Name')}: ___________________   {said('Date')}: __________"
        name, share = (said("for the lecturer"), 0.8) if sheet.answers else (blank, 0.62)
        head = self.table(
            [[self.marked(title, self.title), self.marked(name, self.right)]],
            (share, 1.0 - share),
            [("VALIGN", (0, 0), (-1, -1), "BOTTOM"), ("LEFTPADDING", (0, 0), (0, 0), 0.0),
             ("RIGHTPADDING", (-1, 0), (-1, 0), 0.0), ("LINEBELOW", (0, 0), (-1, -1), 0.8, (0, 0, 0))],
        )  # fmt: skip
        about = self.marked(f"`{'' if sheet.lab else 'atmosbox run '}{sheet.scene}` · {sheet.about}", self.small)
        parts: list[list[Flowable]] = []
        headed = False
        for kind, flowable in self.blocks(sheet.text):
            if kind == "heading" or (kind == "begin" and not headed) or not parts:
                parts.append([])
            headed = kind == "heading"
            parts[-1].append(flowable)
        return [head, Spacer(1.0, 3.0), about, *map(KeepTogether, parts)]

    def blocks(self, text: str) -> Iterator[tuple[str, Flowable]]:
        """Yield the elements after the head of the sheet, each with its kind.

        A "heading", the "begin" of a part that stays on one page, or "on" for an element that continues a part.
        """
        small, pitch = False, self.room * WRITING
        whole = blocks(text)
        begins = next(place for place, block in enumerate(whole) if block.tag == "h2")
        for block in whole[begins:]:
            lines = inside(block)
            match block.type:
                case "heading":
                    small = lines[0].content == self.said("Measure")
                    yield "heading", self.line(lines[0], self.heading)
                case "paragraph":
                    kind = "begin" if lines[0].content.startswith("**") else "on"
                    yield kind, self.line(lines[0], self.small if small else self.body)
                case "blockquote":
                    yield "on", self.barred(lines)
                case "bullet_list":
                    yield "on", self.choices([line.content for line in lines])
                case "fence" if block.info == "axes":
                    yield "on", self.axes(*axes(block))
                case "fence":
                    yield "on", self.marked(f"`{block.content.strip()}`", self.typed)
                case "hr":
                    yield "on", HRFlowable("100%", 0.4, color=(GREY,) * 3, spaceBefore=pitch, spaceAfter=4.0)
                case "table":
                    yield "begin", self.measurements(rows(block))

    def barred(self, lines: Sequence[SyntaxTreeNode]) -> Flowable:
        """Return an answer, with a vertical bar beside it."""
        style = [("LINEBEFORE", (0, 0), (0, -1), 1.6, (0.0, 0.447, 0.698)), *_padding(TOP=0.5, BOTTOM=0.5, LEFT=0.0)]
        return self.table([[[self.line(line, self.answer) for line in lines]]], (1.0,), style, spaceAfter=4.0)

    def choices(self, items: Sequence[str]) -> Flowable:
        """Return boxes to tick, side by side as far as there is room."""
        texts = [item.replace("[ ]", "☐", 1).replace("[x]", "☑", 1) for item in items]
        columns = max(min(len(texts), LONG // max(map(len, texts))), 1)
        columns = 2 if columns == 3 and len(texts) == 4 else columns
        cells: list[Any] = [self.marked(text, self.cell) for text in texts] + [""] * (-len(texts) % columns)
        rows = [cells[first : first + columns] for first in range(0, len(cells), columns)]
        return self.table(rows, [1.0 / columns] * columns, _padding(TOP=1.0, BOTTOM=2.0, LEFT=14.0), spaceAfter=3.0)

    def measurements(self, cells: Sequence[Sequence[SyntaxTreeNode]]) -> Flowable:
        """Return the table; a formula is below its quantity, and the lines of one quantity stay together."""
        (what, _, *names), *lines = [[as_paragraph(cell, self.cell.fontSize) for cell in row] for row in cells]
        said = self.said
        headed = said("quantity, with its formula") if what == said("quantity") else said("graph, and which curve")
        rows = [[Paragraph(f"<b>{name}</b>", self.cell) for name in (headed, *names)]]
        style: list[Any] = [
            ("GRID", (0, 0), (-1, -1), 0.4, (GREY,) * 3),
            ("VALIGN", (0, 0), (-1, -1), "MIDDLE"),
            *_padding(TOP=1.5, BOTTOM=2.0, LEFT=4.0, RIGHT=3.0),
        ]
        tops = [number for number, (label, *_) in enumerate(lines, 1) if label] + [len(lines) + 1]
        for top, below in itertools.pairwise(tops):
            # reportlab never breaks a page within a span
            style += [("SPAN", (0, top), (0, below - 1)), ("LINEABOVE", (0, top), (-1, top), 1.0, (0, 0, 0))]
        for label, formula, run, value, *others in lines:
            named = f'{label}<br/><font size="7.6">{formula}</font>' if formula else label
            styles = [self.cell, self.cell, self.middle if value == "±" else self.cell, self.cell, self.cell]
            rows.append(list(map(Paragraph, (named, run, value, *others), styles)))
        height = self.room * ROW if any(value == "±" for _, _, _, value, *_ in lines) else None
        heights = [None, *[height] * len(lines)]
        return self.table(rows, SHARES, style, rowHeights=heights, repeatRows=1, spaceBefore=2.0, spaceAfter=5.0)

    def axes(self, x: str, y: str) -> Flowable:
        """Return empty axes with a pale grid."""
        drawing = Drawing(self.width, self.room * AXES)
        left, right, low, high = 14.0, 0.72 * self.width, 14.0, self.room * AXES - 14.0
        pale = {"strokeWidth": 0.3, "strokeColor": Color(0.85, 0.85, 0.85)}
        for part in range(1, 9):
            at, up = left + part * (right - left) / 8.0, low + part * (high - low) / 8.0
            drawing.add(Line(at, low, at, high, **pale))
            drawing.add(Line(left, up, right, up, **pale))
        drawing.add(PolyLine((left, high + 6.0, left, low, right + 8.0, low), strokeWidth=0.9))
        drawing.add(String(left + 6.0, high + 3.0, y, fontName=BODY, fontSize=7.6))
        drawing.add(String(right + 8.0, low - 10.0, x, fontName=BODY, fontSize=7.6, textAnchor="end"))
        return drawing
