"""The marks of a text: those of Markdown within a line, and superscripts and subscripts."""

from collections.abc import Sequence
from xml.sax.saxutils import escape, quoteattr

from markdown_it import MarkdownIt
from markdown_it.tree import SyntaxTreeNode

from atmosbox.errors import ConfigError, shown

PARSER = MarkdownIt("commonmark", {"html": True}).enable("table")
TYPED = "DejaVuSansMono"
LONGEST = 60
"""Typed text of at most this length is not broken into lines [characters]."""
SMALLER = 0.72
"""Size of superscripts and subscripts, in units of the type size."""
_RISE = {"sup": 0.38, "sub": 0.16}
"""Height of a superscript above the line and depth of a subscript below it, in units of the type size."""
_TAGS = {"em_open": "<i>", "em_close": "</i>", "strong_open": "<b>", "strong_close": "</b>", "link_close": "</a>"}
_KNOWN = {"text", "text_special", "softbreak", "code_inline", "link_open", *_TAGS}
_HTML = {"<sub>", "</sub>", "<sup>", "</sup>"}


def check(text: str) -> None:
    """Refuse a text with marks that are not printed: pictures, lists, headings, and all HTML except sub and sup.

    >>> check("p<sup>2/7</sup> is *not* a < b")
    >>> check("<script>alert(1)</script>")
    Traceback (most recent call last):
    atmosbox.errors.ConfigError: the mark <script> is not printed: of HTML write <sub> and <sup> alone
    """
    for token in PARSER.parseInline(text)[0].children or ():
        if token.type == "html_inline" and token.content not in _HTML:
            raise ConfigError(f"the mark {shown(token.content)} is not printed: of HTML write <sub> and <sup> alone")
        if token.type not in _KNOWN and token.type != "html_inline":
            raise ConfigError(f"the mark {token.type} is not printed: write text, *slanted*, **bold** or `typed`")
    for block in PARSER.parse(text)[:1]:
        if block.type != "paragraph_open":
            kind = block.type.removesuffix("_open").replace("_", " ")
            raise ConfigError(f"{shown(text)} begins as a {kind} of Markdown does: begin it with a word")


def blocks(text: str) -> Sequence[SyntaxTreeNode]:
    """Return the blocks of a Markdown text: headings, paragraphs, lists, tables, lines to write on.

    >>> [block.type for block in blocks("# Goal" + chr(10) + "Air rises.")]
    ['heading', 'paragraph']
    """
    return SyntaxTreeNode(PARSER.parse(text)).children


def inside(block: SyntaxTreeNode) -> list[SyntaxTreeNode]:
    """Return the lines of text in a block."""
    return [node for node in block.walk() if node.type == "inline"]


def rows(table: SyntaxTreeNode) -> list[list[SyntaxTreeNode]]:
    """Return the cells of a table, row by row."""
    return [inside(row) for part in table.children for row in part.children]


def axes(block: SyntaxTreeNode) -> tuple[str, str]:
    """Return the labels of empty axes to draw into, horizontal and vertical."""
    y, *_, x = block.content.splitlines()
    return x.partition("> ")[2], y.strip()


def as_paragraph(line: SyntaxTreeNode, size: float) -> str:
    """Return a line of Markdown as the text of a paragraph of reportlab.

    >>> as_paragraph(blocks("p<sup>2/7</sup> and `plot`")[0].children[0], 10.0)
    'p<sup rise="3.8" size="7.2">2/7</sup> and <font face="DejaVuSansMono">plot</font>'
    """
    made = []
    for token in line.to_tokens()[0].children or ():
        tag = token.content.strip("<>")
        if token.type == "html_inline" and tag in _RISE:
            made.append(f'<{tag} rise="{_RISE[tag] * size:.1f}" size="{SMALLER * size:.1f}">')
        elif token.content in _HTML and token.type == "html_inline":
            made.append(token.content)
        elif token.type == "code_inline":
            typed = token.content if len(token.content) > LONGEST else token.content.replace(" ", "\u00a0")
            made.append(f'<font face="{TYPED}">{escape(typed)}</font>')
        elif token.type == "link_open":
            made.append(f"<a href={quoteattr(str(token.attrGet('href')))}>")
        else:
            made.append(_TAGS.get(token.type) or escape(token.content or " "))
    return "".join(made)
