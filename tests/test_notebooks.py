"""The notebooks: every cell runs and shows its last value, here in small boxes.

The site runs them as they are when it is published, and in the nightly tier (tests/test_site.py).
"""

import ast
import json
from pathlib import Path

import pytest
from matplotlib import pyplot

import atmosbox
from atmosbox.simulation.preparation import prepare

ROOT = Path(__file__).resolve().parents[1]
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))


OWN_KERNELS = {"the-dry-adiabat"}
"""Notebooks of molecules that do not rotate."""


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


@pytest.mark.parametrize(
    "path",
    [pytest.param(path, marks=pytest.mark.nightly if path.stem in OWN_KERNELS else ()) for path in NOTEBOOKS],
    ids=lambda path: path.stem,
)
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
