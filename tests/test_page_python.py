"""Every line of Python in a page runs: its fenced blocks, in order, in a folder with the files that they name.

Boxes hold few molecules, so that all pages take some seconds; nothing else of a block is changed.
"""

import re
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

import atmosbox
from atmosbox import sweep
from atmosbox.scene import engines
from atmosbox.simulation import preparation, runner

ROOT = Path(__file__).resolve().parents[1]
FEW = 200


def blocks(page):
    """Return the Python blocks of a page, each with the line on which it begins."""
    text = page.read_text(encoding="utf-8")
    found = re.finditer(r"^```(?:python|py)\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    return [(text[: match.start(1)].count("\n"), match.group(1)) for match in found]


PAGES = [page for page in [ROOT / "README.md", *sorted(ROOT.glob("docs/**/*.md"))] if blocks(page)]


def execute(page, names):
    """Run the blocks of a page, which share their names; a traceback has the line of the page."""
    for line, block in blocks(page):
        exec(compile("\n" * line + block, str(page), "exec", dont_inherit=True), names)


@pytest.fixture
def few(monkeypatch, tmp_path):
    """Boxes of few molecules, in a folder of their own."""

    def prepare(scene, settings, **options):
        return preparation.prepare(scene, {**settings, "molecules": FEW}, **options)

    monkeypatch.setattr(runner, "prepare", prepare)
    monkeypatch.chdir(tmp_path)
    yield
    plt.close("all")


def lifted():
    atmosbox.run("lifting-dry", out="lifting-dry.nc")
    return {}


def swept():
    plan = sweep.plan("condensation", ["temperature=-10degC:40degC:6"], settings={"molecules": FEW, "duration": "1 ns"})
    sweep.sweep(plan, Path("condensation-sweep.nc"), jobs=1)
    return {}


def built():
    """Return the local variables of a ``build`` at its call of `Setup`."""
    page = {}
    exec(blocks(ROOT / "docs/own-scene.md")[0][1], page)
    settings = page["Settings"]()
    setup = page["build"](settings, engines.EXACT)
    return {"settings": settings, "parcel": setup.parcel, "scale": setup.scale}


GIVEN = {"docs/netcdf.md": lifted, "docs/sweep.md": swept, "docs/own-scene.md": built}
"""What a page assumes to exist: files, or names."""


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_python_line_of_a_page_runs(page, few):
    execute(page, GIVEN.get(page.relative_to(ROOT).as_posix(), dict)())
