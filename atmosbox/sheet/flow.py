"""From the blocks of a sheet to what reportlab lays out: paragraphs, tables, and drawings of lines and axes."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from atmosbox.sheet.block import Answer, Axes, Blank, Block, Choices, Commands, Heading, Kept, Measurements, Text
from atmosbox.sheet.markup import as_paragraph
from atmosbox.sheet.worksheet import Worksheet

if TYPE_CHECKING:
    from reportlab.platypus import Flowable

__all__ = ["BODY", "BOLD", "GREY", "MM", "SLANTED", "TYPED", "Flow"]

MM = 72.0 / 25.4
BODY, BOLD, SLANTED, TYPED = "DejaVuSans", "DejaVuSans-Bold", "DejaVuSans-Oblique", "DejaVuSansMono"
SIZE, FORMULA = 9.0, 7.6
WRITING = 7.0 * MM
"""Distance of the lines to write on."""
ROW = 6.1 * MM
"""Height of a line of the table that is to be filled in."""
AXES_HEIGHT = 34.0 * MM
LONG = 100
"""How many characters of answers to tick stand beside each other."""
GREY = 0.45
BLUE = (0.0, 0.447, 0.698)
SHARES = (0.43, 0.06, 0.24, 0.15, 0.12)
"""Widths of the columns of the table, in that of the text."""


class Flow:
    """Turns blocks into what reportlab lays out.

    Parameters
    ----------
    width
        Width of the text [points].
    room
        How high lines to write on, empty axes and rows of the table are, in their usual height.
    """

    def __init__(self, width: float, room: float) -> None:
        from reportlab.lib.styles import ParagraphStyle

        self.width = width
        self.room = room
        self.body = ParagraphStyle("body", fontName=BODY, fontSize=SIZE, leading=1.32 * SIZE, spaceAfter=3.0)
        self.heading = ParagraphStyle(
            "heading", self.body, fontName=BOLD, fontSize=10.5, leading=13.0, spaceBefore=7.0, keepWithNext=1
        )  # fmt: skip
        self.title = ParagraphStyle("title", self.body, fontName=BOLD, fontSize=16.0, leading=19.0, spaceAfter=1.0)
        self.small = ParagraphStyle("small", self.body, fontSize=7.6, leading=9.8)
        self.typed = ParagraphStyle("typed", self.body, fontName=TYPED, fontSize=7.8, leading=10.2, leftIndent=14.0)
        self.answer = ParagraphStyle(
            "answer", self.body, fontSize=8.4, leading=11.0, leftIndent=14.0, borderPadding=(0.0, 0.0, 0.0, 6.0)
        )
        self.cell = ParagraphStyle("cell", self.body, fontSize=8.2, leading=10.0, spaceAfter=0.0)
        self.middle = ParagraphStyle("middle", self.cell, alignment=1)
        self.right = ParagraphStyle("right", self.small, alignment=2)

    def paragraph(self, text: str, style: Any) -> Flowable:
        """Return a paragraph in a style."""
        from reportlab.platypus import Paragraph

        return Paragraph(as_paragraph(text, TYPED, SLANTED, style.fontSize), style)

    def story(self, sheet: Worksheet, title: str) -> list[Flowable]:
        """Return the whole sheet."""
        from reportlab.platypus import Spacer, Table

        name = "for the lecturer" if sheet.answers else "Name: ___________________   Date: __________"
        share = 0.8 if sheet.answers else 0.62
        head = Table(
            [[self.paragraph(title, self.title), self.paragraph(name, self.right)]],
            colWidths=(share * self.width, (1.0 - share) * self.width),
            style=[("VALIGN", (0, 0), (-1, -1), "BOTTOM"), ("LEFTPADDING", (0, 0), (0, 0), 0.0),
                   ("RIGHTPADDING", (-1, 0), (-1, 0), 0.0), ("LINEBELOW", (0, 0), (-1, -1), 0.8, (0, 0, 0))],
        )  # fmt: skip
        about = self.paragraph(f"`atmosbox run {sheet.scene}` · {sheet.about}", self.small)
        return [head, Spacer(1.0, 3.0), about, *(each for block in sheet.blocks for each in self.flow(block))]

    def flow(self, block: Block) -> Iterator[Flowable]:
        """Yield what a block becomes."""
        from reportlab.platypus import KeepTogether

        match block:
            case Kept(blocks):
                yield KeepTogether([each for inner in blocks for each in self.flow(inner)])
            case Heading(text):
                yield self.paragraph(text, self.heading)
            case Text(text, small):
                yield self.paragraph(text, self.small if small else self.body)
            case Answer(text):
                yield self.barred(text)
            case Commands(letter, title, lines):
                word = self.paragraph(f"**{letter}**, {title}:", self.body)
                yield KeepTogether([word, *(self.paragraph(f"`{line}`", self.typed) for line in lines)])
            case Choices(items):
                yield self.choices(items)
            case Axes(x, y):
                yield _drawn(self.width, self.room * AXES_HEIGHT, functools.partial(_draw_axes, x=x, y=y))
            case Blank(lines):
                yield _drawn(self.width, lines * self.room * WRITING + 3.0, functools.partial(_draw_lines, lines=lines))
            case Measurements():
                yield self.table(block)

    def barred(self, text: str) -> Flowable:
        """Return an answer, with a bar beside it."""
        from reportlab.platypus import Table

        return Table(
            [[self.paragraph(text, self.answer)]],
            colWidths=(self.width,),
            style=[("LINEBEFORE", (0, 0), (0, -1), 1.6, BLUE), ("TOPPADDING", (0, 0), (-1, -1), 0.5),
                   ("BOTTOMPADDING", (0, 0), (-1, -1), 0.5), ("LEFTPADDING", (0, 0), (-1, -1), 0.0)],
            spaceAfter=4.0,
        )  # fmt: skip

    def choices(self, items: tuple[str, ...]) -> Flowable:
        """Return boxes to tick, beside each other as far as there is room."""
        from reportlab.platypus import Table

        cells: list[Any] = [self.paragraph(f"☐ {item}", self.cell) for item in items]
        columns = max(min(len(cells), LONG // max(len(item) + 2 for item in items)), 1)
        columns = 2 if columns == 3 and len(cells) == 4 else columns
        cells += [""] * (-len(cells) % columns)
        rows = [cells[first : first + columns] for first in range(0, len(cells), columns)]
        return Table(
            rows,
            colWidths=[self.width / len(rows[0])] * len(rows[0]),
            style=[("TOPPADDING", (0, 0), (-1, -1), 1.0), ("BOTTOMPADDING", (0, 0), (-1, -1), 2.0),
                   ("LEFTPADDING", (0, 0), (-1, -1), 14.0)],
            spaceAfter=3.0,
        )  # fmt: skip

    def named(self, label: str, formula: str) -> Flowable:
        """Return the name of a quantity with its formula below it."""
        from reportlab.platypus import Paragraph

        text = as_paragraph(label, TYPED, SLANTED, self.cell.fontSize)
        formula = as_paragraph(formula, TYPED, SLANTED, FORMULA)
        below = f'<br/><font size="{FORMULA}">{formula}</font>' if formula else ""
        return Paragraph(text + below, self.cell)

    def table(self, block: Measurements) -> Flowable:
        """Return the table; the lines of one quantity stay together."""
        from reportlab.platypus import Table

        names = ("quantity, with its formula", "run", "measured ± error", "theory", "misfit / error")
        rows = [[self.paragraph(f"**{name}**", self.cell) for name in names]]
        style: list[Any] = [
            ("GRID", (0, 0), (-1, -1), 0.4, (GREY, GREY, GREY)),
            ("VALIGN", (0, 0), (-1, -1), "MIDDLE"),
            ("TOPPADDING", (0, 0), (-1, -1), 1.5),
            ("BOTTOMPADDING", (0, 0), (-1, -1), 2.0),
            ("LEFTPADDING", (0, 0), (-1, -1), 4.0),
            ("RIGHTPADDING", (0, 0), (-1, -1), 3.0),
        ]
        empty = True
        for label, formula, lines in block.rows:
            top = len(rows)
            name = self.named(label, formula)
            for line in lines:
                empty = not line.measured
                cells = (line.run, line.theory, line.misfit)
                run, *rest = (self.paragraph(cell, self.cell) for cell in cells)
                rows.append(
                    [name, run, self.paragraph(line.measured or "±", self.middle if empty else self.cell), *rest]
                )
            # reportlab never breaks a page within a span
            style += [("SPAN", (0, top), (0, len(rows) - 1)), ("LINEABOVE", (0, top), (-1, top), 1.0, (0, 0, 0))]
        height = self.room * ROW if empty else None
        return Table(
            rows,
            colWidths=[share * self.width for share in SHARES],
            rowHeights=[None, *[height] * (len(rows) - 1)],
            style=style,
            repeatRows=1,
            spaceBefore=2.0,
            spaceAfter=5.0,
        )


def _drawn(width: float, height: float, draw: Callable[[Any, float, float], None]) -> Flowable:
    """Return a drawing of a size that a function draws on the canvas."""
    from reportlab.platypus import Flowable

    class Drawn(Flowable):  # type: ignore[misc, unused-ignore]
        def __init__(self) -> None:
            super().__init__()
            self.width, self.height = width, height

        def draw(self) -> None:
            draw(self.canv, width, height)

    return Drawn()


def _draw_lines(canvas: Any, width: float, height: float, lines: int) -> None:
    """Draw lines to write on."""
    canvas.setLineWidth(0.4)
    canvas.setStrokeGray(GREY)
    for number in range(lines):
        below = 3.0 + number * (height - 3.0) / lines
        canvas.line(14.0, below, width, below)


def _draw_axes(canvas: Any, width: float, height: float, x: str, y: str) -> None:
    """Draw empty axes with a pale grid."""
    left, right, low, high = 14.0, 0.72 * width, 14.0, height - 14.0
    canvas.setFont(BODY, 7.6)
    canvas.setLineWidth(0.3)
    canvas.setStrokeGray(0.85)
    for part in range(1, 9):
        at = left + part * (right - left) / 8.0
        canvas.line(at, low, at, high)
    for part in range(1, 5):
        at = low + part * (high - low) / 4.0
        canvas.line(left, at, right, at)
    canvas.setStrokeGray(0.0)
    canvas.setFillGray(0.0)
    canvas.setLineWidth(0.9)
    for tip in ((right + 8.0, low), (left, high + 6.0)):
        canvas.line(left, low, *tip)
    canvas.line(right + 8.0, low, right + 4.0, low + 2.0)
    canvas.line(right + 8.0, low, right + 4.0, low - 2.0)
    canvas.line(left, high + 6.0, left - 2.0, high + 2.0)
    canvas.line(left, high + 6.0, left + 2.0, high + 2.0)
    canvas.drawString(left + 6.0, high + 3.0, y)
    canvas.drawRightString(right + 8.0, low - 10.0, x)
