"""The project itself: what an import costs, what the README promises, and the tiers of this suite."""

import doctest
import importlib
import inspect
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import atmosbox
from atmosbox import scenarios

ROOT = Path(__file__).resolve().parents[1]


def python(code, **options):
    """Return what a fresh Python prints when it runs this code in the checkout."""
    command = [sys.executable, "-c", code]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, **options)
    assert run.returncode == 0, run.stderr
    return run.stdout


def block_after(heading):
    """Return the lines of the first fenced block below a heading of the README."""
    _, found, rest = (ROOT / "README.md").read_text(encoding="utf-8").partition(f"\n## {heading}\n")
    assert found
    return re.search(r"```(?:sh|console)\n(.*?)```", rest, re.DOTALL).group(1).splitlines()


def test_python_m_atmosbox_is_the_command_line():
    command = [sys.executable, "-m", "atmosbox", "--version"]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert atmosbox.__version__ in run.stdout


def test_run_in_python_passes_everything_on_to_the_runner():
    ours = inspect.signature(atmosbox.run).parameters
    runner = inspect.signature(importlib.import_module("atmosbox.simulation.runner").run).parameters
    assert list(ours) == list(runner)
    assert [(p.kind, p.default) for p in ours.values()] == [(p.kind, p.default) for p in runner.values()]


def test_the_version_is_written_once_and_cited_rightly():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert "version" in project["dynamic"]
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {atmosbox.__version__}\n" in citation


def test_python_without_assertions_leaves_out_nothing_but_what_tells_types():
    for path in [*ROOT.glob("atmosbox/**/*.py"), *ROOT.glob("scenarios/*.py")]:
        source = path.read_text(encoding="utf-8")
        assert "__debug__" not in source, path
        for told in re.findall(r"^ *assert (.*)", source, re.MULTILINE):
            assert re.fullmatch(r"isinstance\([\w., ]+\)|\w+ is not None", told), (path, told)


def test_the_examples_in_the_docstrings_of_scenarios_hold():
    for module in map(scenarios.load, scenarios.names()):
        assert doctest.testmod(module, optionflags=doctest.NORMALIZE_WHITESPACE).failed == 0, module


@pytest.mark.parametrize("heading", ["Install and run", "Run the tests"])
def test_the_readme_says_it_in_one_command_that_makes_its_own_environment(heading):
    (command,) = block_after(heading)
    first, *_, last = command.split(" && ")
    assert first == "python3 -m venv atmosbox-env"
    assert last.startswith("atmosbox-env/bin/")


def test_the_environment_of_the_readme_is_ignored_by_git():
    assert "/atmosbox-env/" in (ROOT / ".gitignore").read_text(encoding="utf-8").splitlines()


@pytest.mark.skipif(os.name == "nt", reason="the script is for bash")
def test_the_ci_script_is_executable_and_takes_its_command_from_the_readme():
    script = ROOT / ".ci" / "run"
    assert os.access(script, os.X_OK)
    subprocess.run(["bash", "-n", str(script)], check=True)
    shown = subprocess.run([str(script), "--show-command"], cwd="/", capture_output=True, text=True, check=True)
    assert shown.stdout.splitlines() == block_after("Run the tests")


def test_long_validation_runs_only_when_asked_for(tmp_path):
    shutil.copy(ROOT / "tests" / "conftest.py", tmp_path)
    source = "import pytest\ndef test_short(): pass\n@pytest.mark.validate\ndef test_long(): pass\n"
    (tmp_path / "test_tiers.py").write_text(source, encoding="utf-8")
    (tmp_path / "pytest.ini").write_text("[pytest]\nmarkers = validate\n", encoding="utf-8")
    cases = {
        "": "1 passed, 1 deselected",
        "--validate": "2 passed",
        "-m validate": "1 passed, 1 deselected",
        "test_tiers.py::test_long": "1 passed",
    }
    code = "import sys, pytest\nfor words in sys.argv[1:]: pytest.main(['-p', 'no:cacheprovider', *words.split()])"
    command = [sys.executable, "-c", code, *cases]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert re.findall(r"^=+ (.*) in .* =+$", run.stdout, re.MULTILINE) == list(cases.values())
