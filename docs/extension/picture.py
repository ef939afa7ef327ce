"""Pictures that open in full when they are touched: a figure of three panels is small on a telephone."""

import posixpath

from docutils import nodes
from sphinx.application import Sphinx


def open_in_full(app: Sphinx, doctree: nodes.document, docname: str) -> None:
    """Make of every picture a link to its file."""
    here = posixpath.dirname(docname)
    for image in list(doctree.findall(nodes.image)):
        name = app.env.images.get(image["uri"], (None, None))[1]
        if name is None or isinstance(image.parent, nodes.reference):
            continue
        target = posixpath.relpath(posixpath.join(app.builder.imagedir, name), here or ".")
        link = nodes.reference("", "", refuri=target, classes=["picture"], internal=True)
        image.replace_self(link)
        link.append(image)


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx."""
    app.connect("doctree-resolved", open_in_full)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
