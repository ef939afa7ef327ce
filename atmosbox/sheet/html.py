"""A sheet as a web page, which a screen reader can read and in which answers can be typed."""

import itertools
import re
from collections.abc import Callable, Sequence
from html import escape

from markdown_it.tree import SyntaxTreeNode

from atmosbox.sheet.marks import PARSER, axes, blocks, inside, rows
from atmosbox.sheet.worksheet import Worksheet

_STYLE = """
body { max-width: 46rem; margin: 1.5rem auto; padding: 0 1rem; font: 1rem/1.45 system-ui, sans-serif; color: #111; background: #fff; }
h1, h2 { line-height: 1.2; }
table { border-collapse: collapse; width: 100%; }
.wide { overflow-x: auto; }
th, td { border: 1px solid #666; padding: 0.25rem 0.4rem; text-align: left; vertical-align: top; font-weight: normal; }
thead th, caption { font-weight: bold; text-align: left; }
blockquote { margin: 0.4rem 0; padding-left: 0.8rem; border-left: 3px solid #0072b2; }
ul { list-style: none; padding: 0; }
pre { overflow-x: auto; }
textarea { width: 100%; box-sizing: border-box; font: inherit; }
svg { width: 100%; max-width: 30rem; border: 1px solid #666; }
"""  # noqa: E501
_FIELD = re.compile(r"(\w+): _{5,}")


def html(sheet: Worksheet) -> str:
    """Return a sheet as one HTML file: headings, a table with headers, fields with names, axes with a description.

    >>> from atmosbox.sheet import worksheet
    >>> html(worksheet("lifting-dry")).count("<h1>")
    1
    """
    title = escape(sheet.title + (f": {sheet.said('answers')}" if sheet.answers else ""))
    body = "".join(_elements(sheet))
    return (
        f'<!doctype html>\n<html lang="{sheet.language}">\n<head>\n<meta charset="utf-8">\n<title>{title}</title>\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<style>{_STYLE}</style>\n</head>\n<body>\n<main>\n{body}</main>\n</body>\n</html>\n"
    )


def _elements(sheet: Worksheet) -> list[str]:
    """Return the elements of the page, one for each block of the Markdown."""
    made: list[str] = []
    question, said = "", sheet.said
    for kind, run in itertools.groupby(blocks(sheet.text), lambda block: block.type):
        several = list(run)
        if kind == "hr":  # lines to write on: those of a question become one field
            name = said("your answer to question {}").format(question)
            made.append(f'<textarea rows="{len(several)}" aria-label="{name}"></textarea>\n')
            continue
        for block in several:
            lines = inside(block)
            numbered = re.match(r"\*\*(\d+)\.\*\*", lines[0].content) if lines else None
            question = numbered[1] if numbered else question
            if kind == "table":
                made.append(_table([[*map(_written, row)] for row in rows(block)], said))
            elif kind == "bullet_list":
                name = said("choices of question {}").format(question)
                made.append(_choices([*map(_written, lines)], name, ticked=sheet.answers))
            elif kind == "fence" and block.info == "axes":
                x, y = map(escape, axes(block))
                made.append(_axes(x, y, said))
            else:
                made.append(_FIELD.sub(r'<label>\1: <input type="text"></label>', _written(block)))
    return made


def _written(node: SyntaxTreeNode) -> str:
    """Return a block, or a line of text, as HTML."""
    return str(PARSER.renderer.render(node.to_tokens(), PARSER.options, {}))


def _choices(items: Sequence[str], name: str, *, ticked: bool) -> str:
    """Return boxes to tick; in a sheet with answers they show what is right and cannot be changed."""
    rows = []
    for item in items:
        state = (" checked" if item.startswith("[x]") else "") + (" disabled" if ticked else "")
        rows.append(f'<li><label><input type="checkbox"{state}> {item[4:]}</label></li>')
    return f'<ul aria-label="{name}">\n' + "\n".join(rows) + "\n</ul>\n"


def _table(rows: Sequence[Sequence[str]], said: Callable[[str], str]) -> str:
    """Return the table: each row begins with its quantity and its run, so that it can be understood alone."""
    made = [f'<div class="wide" tabindex="0">\n<table>\n<caption>{said("Measurements")}</caption>\n<thead><tr>']
    made += [*(f'<th scope="col">{name}</th>' for name in rows[0]), "</tr></thead>\n<tbody>\n"]
    quantity, formula = "", ""
    for label, theory, run, *others in rows[1:]:
        quantity, formula = (label, theory) if label else (quantity, formula)
        made.append(f'<tr><th scope="row">{quantity}</th><td>{formula}</td><td>{run}</td>')
        named = f"{re.sub('<.*?>', '', quantity)}, {said('run')} {run}"
        for what, other in zip(rows[0][3:], others, strict=True):
            field = f'<input type="text" size="9" aria-label="{what}, {named}">'
            made.append(f"<td>{field if other in ('', '±') else other}</td>")
        made.append("</tr>\n")
    return "".join([*made, "</tbody>\n</table>\n</div>\n"])


def _axes(x: str, y: str, said: Callable[[str], str]) -> str:
    """Return empty axes to draw into, with a description."""
    name = said("Empty axes for a sketch: horizontally {}, vertically {}").format(x, y)
    return (
        f'<svg role="img" aria-label="{name}" viewBox="0 0 480 170">'
        '<path d="M20 20V145H440" fill="none" stroke="#111" stroke-width="1.5"/>'
        f'<text x="26" y="16" font-size="12">{y}</text>'
        f'<text x="440" y="162" font-size="12" text-anchor="end">{x}</text></svg>\n'
    )
