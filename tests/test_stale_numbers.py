"""A number in the pages is listed as stale when the code that made it changes.

`.ci/run` fails if there is a stale job, but the tests do not: all jobs together take a quarter of an hour, and most
edits of the engine do not change what they find. The list itself must be right, and that is tested here. Jobs that take
seconds are run anew by tests/test_docs.py.
"""

import importlib.util
import json
import shutil
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
NUMBERS = json.loads((ROOT / "docs" / "numbers.json").read_text(encoding="utf-8"))


def loaded(name, path):
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


source = loaded("docs_jobs_source", ROOT / "docs" / "jobs" / "source.py")


@pytest.fixture(scope="module")
def figures():
    before = sys.path[:]
    try:
        return loaded("docs_figures", ROOT / "docs" / "figures.py")
    finally:
        sys.path[:] = before


@pytest.fixture
def house(tmp_path):
    """Return a small copy of the project: four packages of physics, another package, two scenarios and a job."""
    for name in (*source.PHYSICS, "sheet"):
        (tmp_path / "atmosbox" / name).mkdir(parents=True)
        (tmp_path / "atmosbox" / name / "law.py").write_text(f"def {name}(x):\n    return 2 * x\n")
    (tmp_path / "atmosbox" / "lab").mkdir()
    (tmp_path / "atmosbox" / "scene" / "knob.py").write_text("STEP = 1\n")
    (tmp_path / "atmosbox" / "scene" / "sounding").mkdir()
    (tmp_path / "atmosbox" / "scene" / "sounding" / "format.py").write_text("COLUMNS = 7\n")
    (tmp_path / "scenarios").mkdir()
    for name in ("lifting_dry", "lifting_sounding", "evaporation"):
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


@pytest.mark.parametrize(
    ("path", "old", "new", "job", "meeting_it"),
    [
        ("scene/knob.py", "STEP = 1", "STEP = 2", "import Findings, job", "import Findings, job\nimport atmosbox.lab"),
        ("scene/sounding/format.py", "COLUMNS = 7", "COLUMNS = 8", '"lifting-dry"', '"lifting-sounding"'),
    ],
)
def test_a_part_of_the_physics_that_few_runs_meet_makes_their_jobs_stale(house, path, old, new, job, meeting_it):
    assert not edited(house, f"atmosbox/{path}", old, new)
    assert edited(house, "docs/jobs/lifting.py", job, meeting_it)
    assert edited(house, f"atmosbox/{path}", new, old)


@pytest.fixture(scope="module")
def digests(figures):
    """The digest of the sources of each job, by the module that figures.py has loaded."""
    return {name: sys.modules["jobs.source"].digest(name, each.file) for name, each in figures.JOBS.items()}


def test_the_parts_that_few_runs_meet_are_there_and_some_job_meets_each_of_them(figures, digests, monkeypatch):
    sources = sys.modules["jobs.source"]
    for part, by in source.MET_BY.items():
        assert (ROOT / "atmosbox" / part).exists()
        if by:
            monkeypatch.setitem(sources.MET_BY, part, ())
            assert any(sources.digest(name, figures.JOBS[name].file) != digests[name] for name in digests), part
            monkeypatch.setitem(sources.MET_BY, part, by)


def test_a_function_may_move_to_another_file_and_a_refusal_may_get_better_words(house):
    before = digest(house)
    (house / "atmosbox" / "engine" / "exact").mkdir()
    shutil.move(house / "atmosbox" / "engine" / "law.py", house / "atmosbox" / "engine" / "exact" / "rule.py")
    assert digest(house) == before
    law = "def check(x):\n    if x < 0:\n        raise ValueError({})\n"
    assert source.statements(law.format("'no'")) == source.statements(law.format("f'{x} is below 0'"))
    assert source.statements(law.format("'no'")) != source.statements(law.format("'no'").replace("<", ">"))


def test_every_slow_job_has_said_which_sources_its_numbers_come_from(figures):
    slow = {name for name, each in figures.JOBS.items() if not each.quick}
    assert {name for name, kept in NUMBERS.items() if "sources" in kept} == slow


def test_the_stale_jobs_are_those_whose_sources_have_changed_and_listing_them_is_a_failure(
    figures, digests, capsys, monkeypatch
):
    fresh = {name: {"sources": digest} for name, digest in digests.items()}
    assert figures.stale(fresh) == []
    changed = fresh | {"lifting-seeds": {"sources": "of another day"}, "speed": {}}
    assert figures.stale(changed) == ["lifting-seeds"]
    for found, status in (["lifting-seeds"], 1), ([], 0):
        monkeypatch.setattr(figures, "stale", lambda known, found=found: found)
        assert figures.main(["--list", "--stale"]) == status
        assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == found


def test_what_a_job_finds_is_kept_with_the_digest_of_its_sources(figures, monkeypatch):
    job = figures.JOBS["lifting-seeds"]
    monkeypatch.setitem(figures.JOBS, "lifting-seeds", job._replace(function=lambda found: found.number("a", 1)))
    kept, failures = figures.run("lifting-seeds", write=False)
    assert failures == []
    assert kept["sources"] == source.digest("lifting-seeds", job.file)
    assert kept["seconds"] == 0
