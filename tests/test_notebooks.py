"""The notebooks: stored without output, with a first line that installs atmosbox, and links that launch them.

Here their cells run in small boxes. The site runs them as they are when it is published, and in the validate tier
(tests/test_site.py); a cell that fails is a failure of it.
"""

import ast
import json
import re
import tomllib
from pathlib import Path
from urllib.parse import unquote

import pytest
from matplotlib import pyplot

import atmosbox
from atmosbox.simulation.preparation import prepare

ROOT = Path(__file__).resolve().parents[1]
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
REPOSITORY = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["urls"]["Repository"]


class Small:
    """The package as a notebook sees it, whose boxes are small and whose ascents are fast."""

    def __getattr__(self, name):
        return getattr(atmosbox, name)

    @staticmethod
    def smaller(scene, settings):
        """Return settings of fewer molecules, unless they follow from an accuracy that is asked for."""
        if "accuracy" in settings:
            return settings
        of_scene = prepare(scene, {}).settings.as_dict()
        least = {"molecules": 200} | ({"ascent": 150} if "ascent" in of_scene else {})
        return settings | {name: min(settings.get(name, most), most) for name, most in least.items()}

    def run(self, scene, **settings):
        return atmosbox.run(scene, **self.smaller(scene, settings))

    def sweep(self, scene, varied, **settings):
        rest = {name: value for name, value in self.smaller(scene, settings).items() if name not in varied}
        return atmosbox.sweep(scene, varied, **rest)


def cells(path, kind):
    found = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return ["".join(cell["source"]) for cell in found if cell["cell_type"] == kind]


def test_a_notebook_is_kept_without_output_and_begins_with_what_installs():
    assert len(NOTEBOOKS) == 6
    for path in NOTEBOOKS:
        book = json.loads(path.read_text(encoding="utf-8"))
        assert book["nbformat"] == 4
        code = [cell for cell in book["cells"] if cell["cell_type"] == "code"]
        assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in code), path
        assert book["metadata"]["kernelspec"]["name"] == "python3"
        assert len({cell["id"] for cell in book["cells"]}) == len(book["cells"])
        first = cells(path, "code")[0]
        assert "%pip install --quiet atmosbox" in first
        assert first.endswith("import atmosbox as ab")


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_all_cells_run_and_show_their_last_value(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = {"ab": Small()}
    shown = 0
    for cell in cells(path, "code")[1:]:
        *before, last = ast.parse(cell).body
        value = None
        if isinstance(last, ast.Expr):
            exec(compile(ast.Module(before, []), path.name, "exec"), names)
            value = eval(compile(ast.Expression(last.value), path.name, "eval"), names)
        else:
            exec(compile(ast.Module([*before, last], []), path.name, "exec"), names)
        shown += bool(getattr(value, "_repr_html_", str)())
    pyplot.close("all")
    assert shown > 0


def test_a_notebook_is_launched_from_where_it_stands():
    project = REPOSITORY.removeprefix("https://github.com/")
    for path in NOTEBOOKS:
        place = path.relative_to(ROOT).as_posix()
        links = [unquote(link) for link in re.findall(r"\]\((https://[^)]+)\)", cells(path, "markdown")[0])]
        assert links == [
            f"https://colab.research.google.com/github/{project}/blob/main/{place}",
            f"https://mybinder.org/v2/gh/{project}/main?urlpath=/doc/tree/{place}",
        ]
    assert (ROOT / ".binder" / "requirements.txt").read_text(encoding="utf-8").splitlines()[-1] == "."


def test_a_lecture_asks_for_a_prediction_before_it_shows_and_ends_with_questions():
    for path in NOTEBOOKS:
        told = "\n".join(cells(path, "markdown"))
        assert "**Predict**" in told, path
        assert len(re.findall(r"^\d\. ", told.partition("## Questions")[2], re.MULTILINE)) >= 4, path
        assert f"({path.name})" in (path.parent / "index.md").read_text(encoding="utf-8")
