"""A number in the pages is listed as stale when the code that made it changes; `.ci/run` fails then."""

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


spec = importlib.util.spec_from_file_location("docs_jobs_source", ROOT / "docs" / "jobs" / "source.py")
source = importlib.util.module_from_spec(spec)
spec.loader.exec_module(source)


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


def digest(house):
    source.room.cache_clear()
    return source.digest("seeds", house / "docs" / "jobs" / "lifting.py", house)


@pytest.mark.parametrize(
    ("path", "old", "new", "stale"),
    [
        *((f"atmosbox/{name}/law.py", "2 * x", "3 * x", True) for name in source.PHYSICS),
        ("scenarios/lifting_dry.py", "lifting_dry", "lifting", True),
        ("docs/jobs/lifting.py", "SEEDS = 8", "SEEDS = 9", True),
        ("atmosbox/engine/law.py", "    return", '    """Double."""\n    # so much\n\n    return', False),
        ("atmosbox/sheet/law.py", "2 * x", "3 * x", False),
        ("scenarios/evaporation.py", "name =", "title =", False),
        ("docs/jobs/lifting.py", '("b", 2)', '("b", 3)', False),
    ],
)
def test_a_number_is_stale_if_what_its_job_depends_on_has_changed(house, path, old, new, stale):
    before = digest(house)
    (house / path).write_text((house / path).read_text().replace(old, new))
    assert (digest(house) != before) is stale
