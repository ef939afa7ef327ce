"""The site: it is built without a warning, needs no network, and all its links work."""

import importlib
import json
import logging
import os
import posixpath
import re
import shlex
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from docutils import nodes
from typer.testing import CliRunner

from atmosbox import scenarios
from atmosbox.cli import app
from atmosbox.file.netcdf import read
from atmosbox.lab.wasm_module import SCENES
from atmosbox.simulation.preparation import prepare
from atmosbox.simulation.verification import verify

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
PAGES = sorted(path for path in [*DOCS.glob("**/*.md"), *DOCS.glob("**/*.rst")])
MARKDOWN = [ROOT / "README.md", *sorted(DOCS.glob("**/*.md"))]
LOADS = {"script": "src", "img": "src", "iframe": "src", "source": "src", "video": "src", "audio": "src", "use": "href"}
"""Elements that make a browser fetch a file, and the attribute that names it."""
FETCHED = {"stylesheet", "icon", "shortcut", "preload", "prefetch", "modulepreload", "apple-touch-icon"}
"""Kinds of ``<link>`` whose target a browser fetches."""
VERBATIM = {"code", "pre", "script", "style", "math", "title"}
VOID = {"area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr"}
SHOWN = ["elastic-collisions"]
"""Scenes in the gallery of this test; each takes seconds."""
PARTS = [
    "Run it",
    "What is prescribed, and what emerges",
    "What to notice, what to try",
    "Settings",
    "What is modelled, left out, exaggerated",
    "Theory",
]
PARTS += ["What it does not show", "Questions"]
PLAIN = {"COLUMNS": "100", "NO_COLOR": "1"}
ENVIRONMENT = {**os.environ, **PLAIN, "PYTHONPATH": str(ROOT), "MPLBACKEND": "agg"}


class Page(HTMLParser):
    """The content of a page: anchors, links, loaded files, pictures, and its words outside of code and formulas."""

    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.loads, self.pictures, self.words = set(), [], [], [], []
        self.navigation, self.inside = set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        named = dict(attributes)
        if tag not in VOID:
            self.inside.append((tag, named.get("class") or ""))
        self.anchors |= {named[key] for key in ("id", "name") if named.get(key)}
        if tag == "a" and "href" in named:
            self.links.append(named["href"])
            if any(kind == "sidebar-tree" for _, kind in self.inside):
                self.navigation.add(named["href"])
        if tag == "img":
            self.pictures.append(named)
        if tag == "link" and FETCHED & set((named.get("rel") or "").split()):
            self.loads.append(named["href"])
        elif named.get(LOADS.get(tag, "")):
            self.loads.append(named[LOADS[tag]])

    def handle_endtag(self, tag):
        while tag in (open_tag for open_tag, _ in self.inside) and self.inside.pop()[0] != tag:
            pass

    def handle_data(self, text):
        if not VERBATIM & {tag for tag, _ in self.inside}:
            self.words.append(text)


@pytest.fixture(scope="module")
def site(request, tmp_path_factory):
    """Return the folder of the built site, the messages of the build, and its exit status.

    Only the validate tier runs the notebooks in it, each in a process of Jupyter: see test_notebooks.
    """
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-d", str(folder / "trees")]
    if not request.config.getoption("--validate"):
        command += ["-D", "nb_execution_mode=off"]
    command += ["-D", f"gallery_scenes={','.join(SHOWN)}", "-D", "gallery_film=1"]
    command += [str(DOCS), str(folder / "site")]
    done = subprocess.run(command, cwd=folder, env=ENVIRONMENT, capture_output=True, encoding="utf-8", check=False)
    said = [line for line in (done.stdout + done.stderr).splitlines() if not line.startswith("[IPKernelApp] WARNING")]
    return folder / "site", "\n".join(said), done.returncode


@pytest.fixture(scope="module")
def pages(site):
    """Return every page of the site by its path."""
    found = [
        path for path in site[0].glob("**/*.html") if path.parent.name != "gallery"
    ]  # pages of runs, not of the site
    read = {path.relative_to(site[0]).as_posix(): Page(path) for path in found}
    assert "index.html" in read, site[1]
    return read


def test_the_site_is_built_without_a_warning(site):
    _, said, status = site
    assert (status, said.strip()) == (0, "")


def test_the_gallery_has_a_page_that_plays_a_film_a_worksheet_and_a_lab_of_every_scene_that_it_shows(site, pages):
    made = {path.name: path.read_bytes()[:15] for path in (site[0] / "gallery").iterdir()}
    for name in SHOWN:
        assert made.pop(f"{name}.html") == b"<!doctype html>"
        assert made.pop(f"{name}.mp4")[4:8] == b"ftyp"
        assert made.pop(f"{name}-sheet.pdf").startswith(b"%PDF")
        assert made.pop(f"{name}-lab.html") == b"<!doctype html>"
        assert {f"gallery/{name}-sheet.pdf", f"gallery/{name}-lab.html"} <= set(pages["gallery.html"].links)
        assert {f"gallery/{name}.html", f"gallery/{name}.mp4"} <= set(pages["gallery.html"].loads)
        assert f"../gallery/{name}-lab.html" in pages[f"scenes/{name}.html"].loads
    assert made == {}
    for name in set(scenarios.names()) - set(SHOWN):
        assert not [link for link in pages["gallery.html"].links if link.startswith(f"gallery/{name}")]


def test_the_gallery_runs_every_scene_with_settings_that_it_has(monkeypatch):
    monkeypatch.syspath_prepend(DOCS)
    gallery = importlib.import_module("extension.gallery")
    assert set(gallery.FEW) == {page.stem for page in DOCS.glob("scenes/*.md")}
    assert set(gallery.LABS) == set(SCENES)
    for name, settings in [*gallery.FEW.items(), *gallery.LABS.items()]:
        prepare(name, settings)


def test_every_page_is_reached_from_the_navigation_of_the_first(pages):
    built = {path.relative_to(DOCS).with_suffix(".html").as_posix() for path in PAGES}
    assert len(built) > 30
    assert built - {"index.html"} <= pages["index.html"].navigation
    assert built <= pages.keys()


def test_no_page_loads_anything_from_a_network(site, pages):
    loads = {load for page in pages.values() for load in page.loads}
    assert len(loads) > 10
    assert [load for load in loads if urlsplit(load).scheme not in {"", "data"} or load.startswith("//")] == []
    sheets = list(site[0].glob("**/*.css"))
    assert sheets
    for sheet in sheets:
        text = re.sub(r"/\*.*?\*/", "", sheet.read_text(encoding="utf-8"), flags=re.DOTALL)
        assert not re.search(r"""(url\(|@import)\s*["']?(https?:)?//""", text), sheet.name


def test_everything_that_is_loaded_or_linked_is_there(site, pages):
    folder, missing = site[0], set()
    for name, page in pages.items():
        for link in [*page.links, *page.loads]:
            parts = urlsplit(link)
            if parts.scheme:
                continue
            path = unquote(parts.path)
            target = posixpath.normpath(posixpath.join(posixpath.dirname(name), path)) if path else name
            anchor = unquote(parts.fragment)
            html = target.endswith(".html")
            if not (folder / target).is_file() or (anchor and html and anchor not in pages[target].anchors):
                missing.add((name, link))
    assert missing == set()


def test_no_page_shows_the_marks_of_its_source(pages):
    for path in PAGES:
        name = path.relative_to(DOCS).with_suffix(".html").as_posix()
        text = " ".join(pages[name].words)
        shown = re.findall(r"<!--|-->|\$[^$\s]|\\[a-z]+|:math:|\]\([\w./]+\)|\{toctree\}|``", text)
        assert shown == [], name


def test_every_picture_says_what_it_shows(pages):
    pictures = [(name, picture) for name, page in pages.items() for picture in page.pictures]
    assert len(pictures) > 20
    assert [name for name, picture in pictures if len(picture.get("alt") or "") < 20] == []


def test_a_link_to_a_source_leads_to_the_line_of_the_definition(pages):
    leading = re.compile(r"\.\./source/(.+)\.html#L-(\d+)")
    places = [
        found.groups()
        for page in ("units", "theory", "settings")
        for link in pages[f"api/{page}.html"].links
        if (found := leading.fullmatch(link))
    ]
    assert len(places) > 50
    for path, line in places:
        text = (ROOT / path).read_text(encoding="utf-8").splitlines()[int(line) - 1]
        assert re.match(r"\s*(@|class |def |\w+(: .+)? = )", text), (path, line, text)


def test_a_formula_that_cannot_be_read_is_a_warning(monkeypatch, caplog):
    monkeypatch.syspath_prepend(DOCS)
    mathml = importlib.import_module("extension.mathml")
    monkeypatch.setattr(logging.getLogger("sphinx"), "propagate", True)
    assert "<msup>" in mathml.markup(nodes.math("", "x^2"), "inline")
    assert caplog.messages == []
    for count, tex in enumerate([r"\alpha_0 \nonsense", r"\frac{1", "x_{"], start=1):
        mathml.markup(nodes.math("", tex), "inline")
        assert len(caplog.messages) == count


def test_the_contents_are_the_links_of_a_page_under_its_headings(monkeypatch):
    monkeypatch.syspath_prepend(DOCS)
    contents = importlib.import_module("extension.contents")
    text = "# A\n## B\n[x](a.md) and [y](../CONTRIBUTING.md), [here](#b)\n## C\n[x](a.md) [z](c/d.rst) [w](e.py)"
    assert contents.sections(text) == {"B": ["a.md", "../CONTRIBUTING.md"], "C": ["c/d.rst"]}


def test_a_scene_has_a_page_with_all_its_parts():
    for path in sorted(DOCS.glob("scenes/*.md")):
        name, text = path.stem, path.read_text(encoding="utf-8")
        title, seen, level, goals, predict, picture, *_ = text.split("\n\n")
        assert title.startswith("# ")
        assert seen.startswith("You will see ")
        assert f"<!-- number:scenes.{name} -->" in level
        assert len(re.findall("^- ", goals, re.MULTILINE)) == 3
        assert predict.startswith("**Predict first:**")
        assert re.fullmatch(r"!\[.{20,}\]\(\.\./figures/[\w-]+\.png\)", picture, re.DOTALL)
        headings = re.findall(r"^## (.+)$", text, re.MULTILINE)
        assert [heading for heading in headings if heading in PARTS] == PARTS
        sections = dict(zip(headings, re.split(r"^## .+$", text, flags=re.MULTILINE)[1:], strict=True))
        assert re.search(rf"^atmosbox run {name}( --save-molecules)?$", sections["Run it"], re.MULTILINE)
        assert f"<!-- table:parameters.{name} -->" in sections["Settings"]
        assert f"<!-- table:facts.{name} -->" in sections["What is modelled, left out, exaggerated"]
        assert "doi" in sections["Theory"]
        assert len(re.findall(r"^\d\. ", sections["Questions"], re.MULTILINE)) >= 2


def test_no_number_in_a_sentence_begins_a_line():
    """Markdown treats a line that begins with a comment as HTML, which would cut the sentence in two."""
    for page in MARKDOWN:
        text = page.read_text(encoding="utf-8")
        assert re.findall(r"^\s*<!-- number:.*", text, re.MULTILINE) == [], page


def test_the_own_scene_page_can_be_followed_letter_by_letter(tmp_path, monkeypatch):
    text = (DOCS / "own-scene.md").read_text(encoding="utf-8")
    (scene,) = re.findall(r"<!-- table:own-scene.source -->\n```python\n(.*?)```", text, re.DOTALL)
    assert scene.rstrip() == (DOCS / "examples" / "my_scene.py").read_text(encoding="utf-8").rstrip()
    (tmp_path / "my_scene.py").write_text(scene, encoding="utf-8")
    blocks = [block.splitlines() for block in re.findall(r"```sh\n(.*?)```", text, re.DOTALL)]
    typed = [line for block in blocks for line in block]
    assert [line.split()[:2] for line in typed] == [["atmosbox", verb] for verb in ("run", "plot", "run")]
    monkeypatch.chdir(tmp_path)
    said = []
    for line in typed:
        done = CliRunner().invoke(app, shlex.split(line)[1:], env=PLAIN)
        assert done.exit_code == 0, done.output
        said.append(done.stdout)
    (printed,) = re.findall(r"<!-- table:own-scene.run -->\n```console\n(.*?)```", text, re.DOTALL)
    command, header, row, *_ = printed.splitlines()
    assert command == f"$ {typed[0]}"
    assert said[0].splitlines()[0].split() == header.split()
    label = re.split(r"\s{2,}", row)[0]
    for run in (said[0], said[2]):  # on the exact engine, and on another
        assert re.search(rf"^{re.escape(label)} .* yes$", run, re.MULTILINE)
    engines = [
        json.loads(read(tmp_path / name).atmosbox_parameters)["engine"] for name in ("my_scene.nc", "flask-dsmc.nc")
    ]
    assert engines == ["exact", "dsmc"]
    assert all(check.passed for check in verify(read(tmp_path / "my_scene.nc")))
    assert sorted(path.name for path in tmp_path.iterdir() if path.is_file()) == [
        "flask-dsmc.nc",
        "my_scene.nc",
        "my_scene.png",
        "my_scene.py",
    ]
