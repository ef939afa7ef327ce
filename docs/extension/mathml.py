"""Formulas as MathML, made when the site is built: a browser draws them itself, without a script or a network."""

import re
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.util import logging

LOGGER = logging.getLogger(__name__)
NOT_UNDERSTOOD = re.compile(r">\s*\\")
BOLD = {
    ord(first) + i: chr(start + i)
    for first, start, count in (("A", 0x1D400, 26), ("a", 0x1D41A, 26), ("0", 0x1D7CE, 10))
    for i in range(count)
}
"""Browsers know no bold in formulas, but bold letters."""

FUNCTION = r"<mi>(?:ln|log|exp|sin|cos)</mi>"
THIN = '<mspace width="0.167em"/>'


def in_bold(found: re.Match[str]) -> str:
    """Return a letter in bold."""
    return f'<mi mathvariant="normal">{found[1].translate(BOLD)}</mi>'


AS_TEX_SETS_IT = (
    (re.compile(r"<mo[^>]*>(?:\||&#x0007C;)</mo>"), '<mo lspace="0" rspace="0" stretchy="false">|</mo>'),
    (re.compile(r"<mo>&#x0002F;</mo>"), '<mo lspace="0" rspace="0">/</mo>'),
    (re.compile(r"<mi>(&#x003[9A][0-9A-F];)</mi>"), r'<mi mathvariant="normal">\1</mi>'),
    (re.compile(r'<mi mathvariant="bold">(\w)</mi>'), in_bold),
    (re.compile(rf"(?<=</m[in]>)(?={FUNCTION})"), THIN),
    (re.compile(rf'({FUNCTION})(?!<mo stretchy="false">&#x00028;)'), rf"\1{THIN}"),
    (
        re.compile(r'<mover>(.*?)<mo stretchy="true">&#x000AF;</mo></mover>'),
        r'<mover accent="true">\1<mo stretchy="false">&#x000AF;</mo></mover>',
    ),
)
"""What the converter leaves to the browser, and browsers do not do."""


def markup(node: nodes.Element, display: str) -> str:
    """Return a formula as MathML, and warn of what is not understood."""
    tex = node.astext()
    try:
        mathml: str = convert(tex, display=display)
    except Exception as error:  # of any kind: it is not the converter that checks its input
        LOGGER.warning("the formula %s cannot be drawn: %r", tex, error, location=node)
        return ""
    if NOT_UNDERSTOOD.search(mathml) or tex.count("{") != tex.count("}"):
        LOGGER.warning("the formula %s holds a command that is not known, or a bracket alone", tex, location=node)
    for pattern, replacement in AS_TEX_SETS_IT:
        mathml = pattern.sub(replacement, mathml)
    return mathml


def visit_inline(translator: Any, node: nodes.Element) -> None:
    """Write a formula that stands in a sentence."""
    translator.body.append(markup(node, "inline"))
    raise nodes.SkipNode


def visit_block(translator: Any, node: nodes.Element) -> None:
    """Write a formula on a line of its own."""
    translator.body.append(f'<div class="formula">{markup(node, "block")}</div>\n')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx."""
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
