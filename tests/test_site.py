"""The site: it is built without a warning, needs no network, and all its links work."""

import importlib
import os
import posixpath
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

from atmosbox.simulation.preparation import prepare

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
LOADS = {"script": "src", "img": "src", "iframe": "src", "source": "src", "video": "src", "audio": "src", "use": "href"}
"""Elements that make a browser fetch a file, and the attribute that names it."""
FETCHED = {"stylesheet", "icon", "shortcut", "preload", "prefetch", "modulepreload", "apple-touch-icon"}
"""Kinds of ``<link>`` whose target a browser fetches."""
SHOWN = ["elastic-collisions"]
"""Scenes in the gallery of this test; each takes seconds."""
ENVIRONMENT = {**os.environ, "COLUMNS": "100", "NO_COLOR": "1", "PYTHONPATH": str(ROOT), "MPLBACKEND": "agg"}


class Page(HTMLParser):
    """The content of a page: anchors, links and loaded files."""

    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.loads = set(), [], []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        named = dict(attributes)
        self.anchors |= {named[key] for key in ("id", "name") if named.get(key)}
        if tag == "a" and "href" in named:
            self.links.append(named["href"])
        if tag == "link" and FETCHED & set((named.get("rel") or "").split()):
            self.loads.append(named["href"])
        elif named.get(LOADS.get(tag, "")):
            self.loads.append(named[LOADS[tag]])


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Return the folder of the built site, the messages of the build, and its exit status.

    It runs the notebooks as they are, each in a process of Jupyter.
    """
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-d", str(folder / "trees")]
    command += ["-D", f"gallery_scenes={','.join(SHOWN)}", "-D", "gallery_film=1"]
    command += [str(DOCS), str(folder / "site")]
    done = subprocess.run(command, cwd=folder, env=ENVIRONMENT, capture_output=True, encoding="utf-8", check=False)
    said = [line for line in (done.stdout + done.stderr).splitlines() if not line.startswith("[IPKernelApp] WARNING")]
    return folder / "site", "\n".join(said), done.returncode


@pytest.fixture(scope="module")
def pages(site):
    """Return every page of the site by its path."""
    found = [
        path for path in site[0].glob("**/*.html") if path.parent.name not in ("gallery", "labs")
    ]  # pages of runs, not of the site
    read = {path.relative_to(site[0]).as_posix(): Page(path) for path in found}
    assert "index.html" in read, site[1]
    return read


@pytest.mark.nightly
def test_the_site_is_built_without_a_warning(site):
    _, said, status = site
    assert (status, said.strip()) == (0, "")


@pytest.mark.nightly  # Sphinx is not installed for the other tests
def test_the_gallery_runs_every_scene_with_settings_that_it_has(monkeypatch):
    monkeypatch.syspath_prepend(DOCS)
    gallery = importlib.import_module("extension.gallery")
    assert set(gallery.FEW) == {page.stem for page in DOCS.glob("scenes/*.md")}
    for name, settings in gallery.FEW.items():
        prepare(name, settings)


@pytest.mark.nightly
def test_no_page_loads_anything_from_a_network(site, pages):
    loads = {load for page in pages.values() for load in page.loads}
    assert len(loads) > 10
    assert [load for load in loads if urlsplit(load).scheme not in {"", "data"} or load.startswith("//")] == []
    sheets = list(site[0].glob("**/*.css"))
    assert sheets
    for sheet in sheets:
        text = re.sub(r"/\*.*?\*/", "", sheet.read_text(encoding="utf-8"), flags=re.DOTALL)
        assert not re.search(r"""(url\(|@import)\s*["']?(https?:)?//""", text), sheet.name


@pytest.mark.nightly
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
