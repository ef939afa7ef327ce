"""What a sheet consists of, from the top of its first page to the end, before it is paper or text."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

__all__ = ["Answer", "Axes", "Blank", "Block", "Choices", "Commands", "Heading", "Kept", "Line", "Measurements", "Text"]


@dataclass(frozen=True)
class Heading:
    """The heading of a part."""

    text: str


@dataclass(frozen=True)
class Text:
    """A paragraph; one that is small is a remark."""

    text: str
    small: bool = False


@dataclass(frozen=True)
class Answer:
    """A paragraph of the lecturer's."""

    text: str


@dataclass(frozen=True)
class Commands:
    """Lines to type, below a word on what they do."""

    letter: str
    title: str
    lines: tuple[str, ...]


@dataclass(frozen=True)
class Choices:
    """Answers to tick."""

    items: tuple[str, ...]


@dataclass(frozen=True)
class Axes:
    """Empty axes to draw into."""

    x: str
    y: str


@dataclass(frozen=True)
class Blank:
    """Empty lines to write on."""

    lines: int


@dataclass(frozen=True)
class Line:
    """What one run says of a quantity; empty texts are to be filled in."""

    run: str
    measured: str = ""
    theory: str = ""
    misfit: str = ""


@dataclass(frozen=True)
class Measurements:
    """The table: of each quantity its name, its formula and a line for each run."""

    rows: tuple[tuple[str, str, tuple[Line, ...]], ...]


@dataclass(frozen=True)
class Kept:
    """What stays together on a page."""

    blocks: tuple[Block, ...]


Block: TypeAlias = Heading | Text | Answer | Commands | Choices | Axes | Blank | Measurements | Kept
