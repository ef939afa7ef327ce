"""The few marks that the words of a sheet may have: raised, lowered, leaning, bold and typed."""

from __future__ import annotations

import re
from xml.sax.saxutils import escape

__all__ = ["as_markdown", "as_paragraph"]

_TYPED = re.compile(r"`([^`]+)`")
_MARKS = (
    (re.compile(r"\^\(([^()]*)\)"), "sup", 0.38),
    (re.compile(r"_\(([^()]*)\)"), "sub", 0.16),
)
"""The mark, its tag, and how far it rises or falls in the size of the type."""
SMALLER = 0.72
LONGEST = 60
"""What is typed and not longer stands on one line [characters]."""
_BOLD = re.compile(r"\*\*([^*]+)\*\*")
_LEANING = re.compile(r"\*([^*\s][^*]*)\*")


def _pieces(text: str) -> list[tuple[bool, str]]:
    """Return a text in pieces, each with whether it is typed on a keyboard, as what stands in backquotes is."""
    return [(number % 2 == 1, piece) for number, piece in enumerate(_TYPED.split(text)) if piece]


def as_markdown(text: str, *, cell: bool = False) -> str:
    r"""Return a text in Markdown.

    Parameters
    ----------
    text
        The text: ``^(2/7)`` is raised, ``_(0)`` lowered, ``*leaning*`` leans, ``**bold**`` is
        bold, and backquotes mean what is typed.
    cell
        Whether it stands in a table, where an upright line must be masked.

    Examples
    --------
    >>> as_markdown("T ~ p^(2/7), *not* a < b: `plot`")
    'T \\~ p<sup>2/7</sup>, *not* a &lt; b: `plot`'
    """
    made = []
    for typed, piece in _pieces(text):
        if typed:
            made.append(f"`{piece}`")
            continue
        plain = escape(piece).replace("~", "\\~").replace("|", "\\|")
        for mark, tag, _ in _MARKS:
            plain = mark.sub(rf"<{tag}>\1</{tag}>", plain)
        made.append(plain)
    found = "".join(made)
    return found.replace("\n", " ") if cell else found


def as_paragraph(text: str, typed: str, leaning: str, size: float) -> str:
    """Return a text as a paragraph of a PDF.

    Parameters
    ----------
    text
        The text, marked as for `as_markdown`.
    typed, leaning
        The names of the fonts for what is typed and for what leans.
    size
        The size of the type [points].

    Examples
    --------
    >>> as_paragraph("p^(2/7) and `plot`", "Mono", "Slanted", 10.0)
    'p<sup rise="3.8" size="7.2">2/7</sup> and <font face="Mono">plot</font>'
    """
    made = []
    for is_typed, piece in _pieces(text):
        plain = escape(piece)
        if is_typed:
            plain = plain if len(piece) > LONGEST else plain.replace(" ", "\u00a0")
            made.append(f'<font face="{typed}">{plain}</font>')
            continue
        for mark, tag, rise in _MARKS:
            shape = f'rise="{rise * size:.1f}" size="{SMALLER * size:.1f}"'
            plain = mark.sub(rf"<{tag} {shape}>\1</{tag}>", plain)
        plain = _BOLD.sub(r"<b>\1</b>", plain)
        made.append(_LEANING.sub(rf'<font face="{leaning}">\1</font>', plain))
    return "".join(made)
