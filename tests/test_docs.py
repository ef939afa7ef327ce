"""The pages are right: links work, tables are up to date, examples give the output that is printed."""

import itertools
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from atmosbox import scenarios
from atmosbox.simulation import runner

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(DOCS.glob("**/*.md"))]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "100", "NO_COLOR": "1", "MPLBACKEND": "agg"}


def heading_anchor(heading):
    """Return the anchor that the host of a page makes from a heading."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def links(page):
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    return re.findall(r"\]\((?!https?://)([^)\s]+)\)", text)


def commands(page):
    """Return the commands in the blocks of a page, without comments."""
    for block in re.findall(r"```sh\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        for line in block.splitlines():
            if line.startswith("atmosbox run "):
                yield shlex.split(line, comments=True)[2:]


def test_every_relative_link_of_a_page_leads_somewhere():
    for page in PAGES:
        for link in links(page):
            target, _, anchor = link.partition("#")
            path = (page.parent / target).resolve() if target else page
            assert path.exists(), (page, link)
            if anchor:
                headings = re.findall(r"^#+ (.*)$", path.read_text(encoding="utf-8"), re.MULTILINE)
                assert anchor in map(heading_anchor, headings), (page, link)


def test_every_scene_has_a_page_that_the_index_names_and_a_variant_that_of_its_base():
    index = (DOCS / "index.md").read_text(encoding="utf-8")
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    pages = {path.stem: path.read_text(encoding="utf-8") for path in DOCS.glob("scenes/*.md")}
    bases = {name: getattr(scenarios.load(name), "variant_of", name) for name in scenarios.names()}
    assert set(bases.values()) == set(pages)
    for name, base in bases.items():
        assert f"(scenes/{base}.md)" in index
        assert f"(docs/scenes/{base}.md)" in readme
        assert f"atmosbox run {name}" in pages[base]


def test_cheap_tables_are_fresh_and_pages_and_jobs_know_each_other():
    command = [sys.executable, str(DOCS / "figures.py"), "--quick", "--check"]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", env=ENVIRONMENT, check=False)
    assert done.returncode == 0, done.stderr


def test_every_run_that_a_page_suggests_is_understood():
    for scene, *words in itertools.chain.from_iterable(map(commands, PAGES)):
        if scene in scenarios.names():
            settings = dict(word.split("=", 1) for word in words if re.fullmatch(r"[\w-]+=.+", word))
            changed = runner.prepare(scene, settings).settings.changed().keys()
            # heating and a case change other defaults, too
            assert changed <= settings.keys() or {"heating", "case"} & settings.keys(), words
