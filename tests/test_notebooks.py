"""The notebooks: kept without output, begun by a line that installs, launched from where they stand.

The site runs every cell of them when it is built (tests/test_site.py), and a cell that fails is a failure of it.
"""

import ast
import json
import re
import tomllib
from pathlib import Path
from urllib.parse import unquote

import pytest

ROOT = Path(__file__).resolve().parents[1]
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
REPOSITORY = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["urls"]["Repository"]


def cells(path, kind):
    found = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return ["".join(cell["source"]) for cell in found if cell["cell_type"] == kind]


def test_there_are_six():
    assert len(NOTEBOOKS) == 6


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_kept_without_output(path):
    book = json.loads(path.read_text(encoding="utf-8"))
    assert book["nbformat"] == 4
    code = [cell for cell in book["cells"] if cell["cell_type"] == "code"]
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in code)
    assert book["metadata"]["kernelspec"]["name"] == "python3"
    assert len({cell["id"] for cell in book["cells"]}) == len(book["cells"])


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_the_first_cell_installs_where_nothing_is_installed_and_the_rest_is_python(path):
    first, *rest = cells(path, "code")
    assert "%pip install --quiet atmosbox" in first
    assert first.endswith("import atmosbox as ab")
    for cell in rest:
        ast.parse(cell)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_launched_from_where_it_stands(path):
    project = REPOSITORY.removeprefix("https://github.com/")
    place = path.relative_to(ROOT).as_posix()
    links = [unquote(link) for link in re.findall(r"\]\((https://[^)]+)\)", cells(path, "markdown")[0])]
    assert links == [
        f"https://colab.research.google.com/github/{project}/blob/main/{place}",
        f"https://mybinder.org/v2/gh/{project}/main?urlpath=/doc/tree/{place}",
    ]
    assert (ROOT / ".binder" / "requirements.txt").read_text(encoding="utf-8").splitlines()[-1] == "."


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_lecture_asks_for_a_prediction_before_it_shows_and_ends_with_questions(path):
    told = "\n".join(cells(path, "markdown"))
    assert "**Predict**" in told
    assert len(re.findall(r"^\d\. ", told.partition("## Questions")[2], re.MULTILINE)) >= 4
    assert f"({path.name})" in (path.parent / "index.md").read_text(encoding="utf-8")
