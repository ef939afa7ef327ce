"""Pages that show the sources, so that what a page says about a file leads to the file.

Every Python file of atmosbox and of its scenes has a page, and so has every other file that a page links to; a folder
has a page that lists what is in it, each file with the first sentence of its docstring. They are plain pages, without
the navigation, which is larger than most of the files.
"""

import ast
import posixpath
from collections.abc import Iterator
from html import escape
from pathlib import Path
from string import Template
from typing import Any

from docutils import nodes
from extension.definition import ROOT, Place, place, place_of_member, sources
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import get_lexer_for_filename
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.transforms import SphinxTransform

DOCS = ROOT / "docs"
FOLDER = "source"
PAGES = {"README.md": "index", "CONTRIBUTING.md": "contributing", "CHANGELOG.md": "changes"}
"""Files outside ``docs/`` that are pages of the site."""
TOPS = {"contributing", "changes"}
"""Pages whose text, and whose links, are those of a file at the top."""
PAGE = Template((Path(__file__).parent / "source.html").read_text(encoding="utf-8"))


def page_of(path: Path) -> str:
    """Return the name of the page that shows a file or a folder."""
    name = posixpath.join(FOLDER, path.relative_to(ROOT).as_posix())
    return posixpath.normpath(f"{name}/index" if path.is_dir() else name)


def relative(page: str, docname: str, anchor: str = "") -> str:
    """Return the link from one page to another."""
    return posixpath.relpath(f"{page}.html", posixpath.dirname(docname) or ".") + (f"#{anchor}" if anchor else "")


def link_to(found: Place | None, docname: str) -> str | None:
    """Return the link from a page to a line of a source."""
    if found is None:
        return None
    return relative(page_of(found.path), docname, f"L-{found.line}" if found.line else "")


def link_to_member(module: str, fullname: str) -> str | None:
    """Return the link from a page in ``api/`` to where a member of a module is defined."""
    return link_to(place_of_member(module, fullname), "api/any")


def lead_to_source(
    app: Sphinx, env: BuildEnvironment, node: addnodes.pending_xref, inside: nodes.Element
) -> nodes.Element | None:
    """Lead a name that has no place in the documentation, but one in atmosbox, to its source."""
    link = link_to(place(node["reftarget"]), node["refdoc"]) if node.get("refdomain") == "py" else None
    return None if link is None else nodes.reference("", "", inside, refuri=link, internal=True)


class SourceLinks(SphinxTransform):
    """Lead the links to files and folders outside the pages to the pages that show them."""

    default_priority = 100

    def target(self, node: nodes.Element) -> str | None:
        """Return the page that a link is led to; None if Sphinx knows it."""
        home = ROOT if self.env.docname in TOPS else (DOCS / self.env.docname).parent
        written = node["reftarget"].partition("#")[0]
        if node.get("refdomain") == "doc":
            if written in self.env.found_docs:
                return None
            path = (DOCS / f"{written}.md").resolve()
        else:
            path = (home / written).resolve()
        if not written or not path.is_relative_to(ROOT) or not path.exists():
            return None
        name = path.relative_to(ROOT).as_posix()
        if name in PAGES:
            return PAGES[name]
        if path.is_relative_to(DOCS) and path.suffix in {".md", ".rst"}:
            return path.relative_to(DOCS).with_suffix("").as_posix()
        self.env.shown_sources.add(name)
        return page_of(path)

    def apply(self, **named: Any) -> None:
        """Rewrite the links of one page."""
        links = [*self.document.findall(addnodes.download_reference), *self.document.findall(addnodes.pending_xref)]
        for node in links:
            target = self.target(node) if node.get("reftype") == "myst" else None
            if target is not None:
                uri = relative(target, self.env.docname, node["reftarget"].partition("#")[2])
                node.replace_self(nodes.reference("", "", *node.children, refuri=uri, internal=True))


def summary(path: Path) -> str:
    """Return the first sentence about a file or a package."""
    source = path / "__init__.py" if path.is_dir() else path
    if source.suffix != ".py" or not source.is_file():
        return ""
    text = ast.get_docstring(ast.parse(source.read_text(encoding="utf-8"))) or ""
    return " ".join(text.partition("\n\n")[0].split())


def parts(folder: Path) -> list[Path]:
    """Return what a folder holds, packages first, without what tools leave behind."""
    inside = [each for each in folder.iterdir() if not each.name.startswith((".", "__pycache__"))]
    folders = sorted(each for each in inside if each.is_dir() and any(each.glob("*.py")))
    return [*folders, *sorted(each for each in inside if each.suffix == ".py")]


def name_of(path: Path, page: str, shown: set[Path]) -> str:
    """Return the name of a file or folder, a link if it has a page."""
    name = escape(path.name)
    return f'<a href="{relative(page_of(path), page)}">{name}</a>' if path in shown else name


def listing(folder: Path, page: str, shown: set[Path]) -> str:
    """Return what the page of a folder says."""
    rows = [
        f"<tr><td><code>{name_of(each, page, shown)}</code></td><td>{escape(summary(each)).replace('`', '')}</td></tr>"
        for each in parts(folder)
    ]
    return f"<table>{''.join(rows)}</table>"


def trail(path: Path, page: str, shown: set[Path]) -> str:
    """Return where a file stands, each folder above it a link."""
    above = [each for each in reversed(path.parents) if each != ROOT and each.is_relative_to(ROOT)]
    return " / ".join([*(name_of(each, page, shown) for each in above), escape(path.name)])


def shown_files(app: Sphinx) -> set[Path]:
    """Return the files and folders that have a page."""
    shown = {ROOT / name for name in app.env.shown_sources} | set(sources())
    shown |= {folder for path in sources() for folder in path.parents if folder != ROOT and folder.is_relative_to(ROOT)}
    return shown | {each for folder in shown if folder.is_dir() for each in parts(folder) if each.is_file()}


def write_pages(app: Sphinx) -> Iterator[tuple[str, dict[str, Any], str]]:
    """Write the pages of the sources; Sphinx has none of its own to make of them."""
    shown = shown_files(app)
    look = HtmlFormatter(lineanchors="L", anchorlinenos=True, linenos="inline")
    for path in sorted(shown):
        page = page_of(path)
        if path.is_dir():
            body = listing(path, page, shown)
        else:
            lexer = get_lexer_for_filename(path.name, stripnl=False)
            body = highlight(path.read_text(encoding="utf-8"), lexer, look)
        static = posixpath.relpath("_static", posixpath.dirname(page))
        text = PAGE.substitute(
            name=escape(path.relative_to(ROOT).as_posix()),
            home=relative("index", page),
            static=static,
            trail=trail(path, page, shown),
            body=body,
        )
        file = Path(app.outdir, f"{page}.html")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    yield from ()


def begin(app: Sphinx) -> None:
    """Remember from one build to the next which sources pages link to."""
    app.env.shown_sources = getattr(app.env, "shown_sources", set())


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx."""
    app.connect("builder-inited", begin)
    app.add_transform(SourceLinks)
    app.connect("missing-reference", lead_to_source)
    app.connect("html-collect-pages", write_pages)
    return {"parallel_read_safe": False, "parallel_write_safe": True}
