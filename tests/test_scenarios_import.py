"""The scenarios are found by their names, and a lecturer's own file works like them.

That an installed wheel finds them is tried by .ci/run, which builds one and runs it from another folder.
"""

import sys

import pytest

from atmosbox import scenarios
from atmosbox.errors import FileError, UnknownSceneError

OWN_SCENE = """
from dataclasses import dataclass

@dataclass
class Settings:
    molecules: int = 100

def build(settings): ...
def theory(dataset): ...

headlines = ()
panels = ()
"""


def test_the_scenes_are_in_the_order_of_teaching_each_with_its_level_and_minutes():
    found = scenarios.summaries()
    assert tuple(found) == scenarios.names()
    assert set(found) == set(scenarios._ORDER)
    assert [name for name in found if name.startswith("lifting")] == [
        "lifting-dry",
        "lifting-moist",
        "lifting-sounding",
    ]
    levels = [each.level for each in found.values()]
    assert set(levels) == {"school", "first year", "second year"}
    assert levels[0] == "school"
    assert all(5 <= each.minutes <= 50 for each in found.values())


def test_an_unknown_scenario_offers_the_nearest_ones():
    for name in ("lifting-dri", "Lifting-Dry", "lifting"):
        with pytest.raises(UnknownSceneError, match=f"{name}.*lifting-dry.*atmosbox.scenes"):
            scenarios.load(name)


def test_an_edited_own_file_is_read_anew(tmp_path):
    path = tmp_path / "my_scene.py"
    for molecules in (100, 200, 300):
        path.write_text(OWN_SCENE.replace("100", str(molecules)), encoding="utf-8")
        assert scenarios.load(path).Settings().molecules == molecules


def test_an_own_file_that_fails_is_refused_with_its_line(tmp_path):
    path = tmp_path / "my_scene.py"
    before = set(sys.modules)
    for source, sentence in [
        ("x = 1\ny = (\n", r"line 2, .*SyntaxError: '\(' was never closed"),
        ("x = 1\nimport no_such_library\n", "line 2, .*ModuleNotFoundError: No module named 'no_such_library'"),
        ("def f():\n    return 1 / 0\n\nf()\n", "line 2, .*ZeroDivisionError"),
        ("import json\n\njson.loads('{')\n", "line 3, .*JSONDecodeError"),
        ("import sys\nsys.exit()\n", "line 2, .*SystemExit"),
        ("x = '\xe9'\n", "SyntaxError"),
        ("x = 1\0\n", "cannot be run"),
    ]:
        path.write_bytes(source.encode("latin-1"))
        with pytest.raises(FileError, match=sentence) as caught:
            scenarios.load(path)
        assert str(path) in str(caught.value)
        assert len(str(caught.value).splitlines()) == 1
    assert not [name for name in set(sys.modules) - before if "my_scene" in name]
