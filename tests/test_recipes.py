"""The recipes of the page on design: applied to a copy of the package as printed, they work as described."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SECTION = re.compile(r"^### (.*?)\n(.*?)(?=^##)", re.MULTILINE | re.DOTALL)
RECIPES = dict(SECTION.findall((ROOT / "docs" / "design.md").read_text(encoding="utf-8")))


def follow(recipe, folder):
    """Change a copy of the package: lines that a file must contain begin with a space, lines to add with a plus."""
    ignore = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "atmosbox", folder / "atmosbox", ignore=ignore)
    shutil.copytree(ROOT / "scenarios", folder / "scenarios", ignore=ignore)
    shutil.copy(ROOT / "pyproject.toml", folder)
    (text,) = re.findall(r"```diff\n(.*?)```", RECIPES[recipe], re.DOTALL)
    changed = set()
    for name, lines in re.findall(r"^(atmosbox/\S+)\n((?:[ +].*\n)+)", text, re.MULTILINE):
        path = folder / name
        old = path.read_text(encoding="utf-8") if path.exists() else ""
        before = "".join(f"{line[1:]}\n" for line in lines.splitlines() if line[0] == " ")
        after = "".join(f"{line[1:]}\n" for line in lines.splitlines())
        assert old.count(before) == 1 or not old, f"{name} has no longer exactly one place for this:\n{before}"
        path.write_text(old.replace(before, after) if old else after, encoding="utf-8")
        changed.add(name)
    return changed


def python(folder, code):
    """Return the output of code that imports the copy."""
    command = [sys.executable, "-c", f"import sys\nsys.path.insert(0, {str(folder)!r})\n{code}"]
    done = subprocess.run(command, cwd=folder, capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_new_variable_is_two_files_and_stands_in_the_file_of_a_run(tmp_path):
    assert len(follow("A new variable", tmp_path)) == 2
    code = """
import json, atmosbox, xarray
atmosbox.run("elastic-collisions", duration="2 s", out="run.nc")
run = xarray.open_dataset("run.nc")
share = (run.largest_kinetic_energy / run.kinetic_energy).values
mean = 1.0 / run.sizes["molecule"]
print(json.dumps([atmosbox.__file__, run.largest_kinetic_energy.units, bool(((share > mean) & (share < 1.0)).all())]))
"""
    file, *held = json.loads(python(tmp_path, code))
    assert Path(file).is_relative_to(tmp_path)
    assert held == ["J", True]


def test_a_new_command_is_one_file_and_answers(tmp_path):
    assert len(follow("A new command", tmp_path)) == 1
    code = "from atmosbox.cli import main\nsys.argv[1:] = [{!r}]\nmain()"
    assert python(tmp_path, code.format("hello")) == "hello\n"
    assert re.search(r"^ +hello +Greet\.$", python(tmp_path, code.format("--help")), re.MULTILINE)


def test_every_file_that_a_recipe_names_is_there():
    for recipe in RECIPES:
        names = re.findall(r"`((?:engine|scene|file|simulation|cli)/[\w/.]+)`", RECIPES[recipe])
        assert names or "```diff" in RECIPES[recipe] or recipe == "A new scene"
        assert [name for name in names if not (ROOT / "atmosbox" / name).exists()] == []
