"""A number in the pages is listed as stale when the code that made it changes.

`.ci/run` fails if there is a stale job, but the tests do not: all jobs together take a quarter of an hour, and most
edits of the engine do not change what they find. The list itself must be right, and that is tested here. Jobs that take
seconds are run again by tests/test_docs.py.
"""

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


def loaded(name, path):
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


source = loaded("docs_jobs_source", ROOT / "docs" / "jobs" / "source.py")


@pytest.fixture
def house(tmp_path):
    """Return a small copy of the project: four packages of physics, another package, two scenarios and a job."""
    for name in (*source.PHYSICS, "sheet"):
        (tmp_path / "atmosbox" / name).mkdir(parents=True)
        (tmp_path / "atmosbox" / name / "law.py").write_text(f"def {name}(x):\n    return 2 * x\n")
    (tmp_path / "scenarios").mkdir()
    for name in ("lifting_dry", "evaporation"):
        (tmp_path / "scenarios" / f"{name}.py").write_text(f'"""A card."""\nname = "{name}"\n')
    (tmp_path / "docs" / "jobs").mkdir(parents=True)
    (tmp_path / "docs" / "jobs" / "lifting.py").write_text(
        "from jobs.registry import Findings, job\nfrom atmosbox.simulation import runner\nSEEDS = 8\n\n"
        '@job("seeds")\ndef seeds(found):\n    found.number("a", runner.run("lifting-dry", SEEDS))\n\n'
        '@job("price")\ndef price(found):\n    found.number("b", 2)\n'
    )
    return tmp_path


def edited(house, path, old, new):
    """Return whether an edit makes the job stale."""
    before = digest(house)
    text = (house / path).read_text()
    assert old in text
    (house / path).write_text(text.replace(old, new))
    return digest(house) != before


def digest(house):
    source.room.cache_clear()
    return source.digest("seeds", house / "docs" / "jobs" / "lifting.py", house)


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        *((f"atmosbox/{name}/law.py", "2 * x", "3 * x") for name in source.PHYSICS),
        ("scenarios/lifting_dry.py", "lifting_dry", "lifting"),
        ("docs/jobs/lifting.py", "SEEDS = 8", "SEEDS = 9"),
        ("docs/jobs/lifting.py", '"a", runner', '"c", runner'),
    ],
)
def test_a_change_of_what_a_job_depends_on_makes_it_stale(house, path, old, new):
    assert edited(house, path, old, new)


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        ("atmosbox/engine/law.py", "    return", '    """Double."""\n    # so much\n\n    return'),
        ("atmosbox/engine/law.py", "def", "from math import pi\n__all__ = ['engine']\ndef"),
        ("atmosbox/sheet/law.py", "2 * x", "3 * x"),
        ("scenarios/lifting_dry.py", "A card.", "Another card."),
        ("scenarios/evaporation.py", "name =", "title ="),
        ("docs/jobs/lifting.py", '("b", 2)', '("b", 3)'),
    ],
)
def test_an_edit_of_words_or_of_something_else_does_not(house, path, old, new):
    assert not edited(house, path, old, new)
