"""The scenarios are found however atmosbox is installed, and a lecturer's own file works like them.

Nothing here needs a network: the wheels are built by the build backend directly and unpacked where an
installer would put them, in environments that borrow the libraries of this one.
"""

import os
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

from atmosbox import scenarios
from atmosbox.errors import FileError, UnknownSceneError

ROOT = Path(__file__).resolve().parents[1]

BUILD = "import sys; from hatchling import build; print(getattr(build, sys.argv[1])(sys.argv[2]))"

LOOK = """
import atmosbox, atmosbox.scenarios
print(atmosbox.__file__)
assert "lifting-dry" in atmosbox.scenarios.names()
module = atmosbox.scenarios.load("lifting-dry")
assert module.__name__ == "atmosbox.scenarios.lifting_dry"
assert all(hasattr(module, name) for name in atmosbox.scenarios.REQUIRED)
print(module.__file__)
"""

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


def build(tree, folder, hook):
    """Build a wheel, an editable wheel or an sdist of a source tree into a folder, and return its path."""
    folder.mkdir()
    command = [sys.executable, "-c", BUILD, f"build_{hook}", str(folder)]
    run = subprocess.run(command, cwd=tree, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return folder / run.stdout.split()[-1]


def new_environment(folder, wheel=None):
    """Make an environment with the libraries of this one, install a wheel into it, return its Python."""
    venv.EnvBuilder(with_pip=False, symlinks=os.name != "nt").create(folder)
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    where = "import sysconfig; print(sysconfig.get_path('purelib'))"
    site = Path(subprocess.run([python, "-c", where], capture_output=True, text=True, check=True).stdout.strip())
    libraries = [path for path in sys.path if path.endswith(("site-packages", "dist-packages"))]
    (site / "zz_libraries.pth").write_text("\n".join(libraries), encoding="utf-8")
    if wheel is not None:
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(site)
    return python


def look(python, cwd, **variables):
    """Return where a fresh Python started in a folder finds atmosbox and the scenario of dry lifting."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"} | variables
    run = subprocess.run([python, "-c", LOOK], cwd=cwd, env=environment, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return [Path(line).resolve() for line in run.stdout.splitlines()]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    return build(ROOT, tmp_path_factory.mktemp("wheel") / "dist", "wheel")


@pytest.fixture
def classroom(tmp_path):
    """Return a user's folder with the user's own folder ``scenarios`` and file ``lifting_dry.py``."""
    folder = tmp_path / "classroom"
    for name in ("scenarios/__init__.py", "scenarios/lifting_dry.py", "lifting_dry.py"):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("raise RuntimeError('the file of a user was imported')", encoding="utf-8")
    return folder


def test_an_installed_wheel_finds_its_scenarios(tmp_path, classroom, wheel):
    places = look(new_environment(tmp_path / "env", wheel), classroom)
    assert all(place.is_relative_to(tmp_path / "env") for place in places)


def test_a_wheel_does_not_look_into_the_project_of_somebody_else(tmp_path, wheel):
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)  # as `pip install --target .` does
    (tmp_path / "pyproject.toml").write_text('[project]\nname = "theirs"\n', encoding="utf-8")
    (tmp_path / "scenarios").mkdir()
    (tmp_path / "scenarios" / "theirs.py").write_text("", encoding="utf-8")
    code = "import atmosbox.scenarios; print(*atmosbox.scenarios.names())"
    run = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert "lifting-dry" in run.stdout.split()
    assert "theirs" not in run.stdout.split()


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
