"""The benchmarks run; what they time is not tested."""

import importlib.util
import json
import math
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.core.state import Modes

ROOT = Path(__file__).resolve().parents[1]
# liquid has kernels of its own, which a gas never loads; the layout of rows is not a feature of a gas
LIQUID = {"phases", "pool", "drops", "rows"}


def run(script, *arguments):
    command = [sys.executable, str(ROOT / "benchmarks" / script), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_pace_of_the_engine_is_measured(tmp_path):
    file = tmp_path / "engine.json"
    printed = run("engine.py", "--n", 100, "--phi", 0.01, "--cases", "periodic", "--repeats", 1, "--json", file)
    told = json.loads(file.read_text())
    (result,) = told["results"]
    assert set(told["measured_on"]) == {"date", "processor", "processors", "python", "numba"}
    assert "| periodic | 0.01 | 100 |" in printed
    assert result["collisions_per_second"] > 0.0
    assert 0.0 < result["bytes_per_molecule"] < 2000.0


@pytest.mark.validate  # compiles the same scene twice
def test_whole_runs_are_timed_in_turns_with_another_checkout(tmp_path):
    file = tmp_path / "scenes.json"
    asked = ("elastic-collisions", "--set", "duration=2s", "--repeats", 1, "--against", ROOT, "--json", file)
    printed = run("scenes.py", *asked)
    (result,) = json.loads(file.read_text())["results"]
    assert "| elastic-collisions | " in printed
    assert 0.2 < result["ratio"] < 5.0
    parts = [result[part] for part in ("start", "compile", "build", "kernel", "files")]
    assert min(parts) >= 0.0
    assert sum(parts) <= result["cpu"]


@pytest.fixture(scope="module")
def features():
    specification = importlib.util.spec_from_file_location("features", ROOT / "benchmarks" / "features.py")
    module = importlib.util.module_from_spec(specification)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(ROOT / "benchmarks")
        specification.loader.exec_module(module)
    return module


def test_every_mode_of_the_engine_has_a_gas_that_shows_its_price(features):
    assert set(features.GASES.values()) - {""} == set(Modes._fields) - LIQUID


def sources(folder):
    """Return the texts of a copy of the engine by their names, and how often they read each of its modes."""
    texts = {str(file.relative_to(folder)): file.read_text(encoding="utf-8") for file in folder.rglob("*.py")}
    return texts, Counter(re.findall(r"\bmodes\.(\w+)\b", "\n".join(texts.values())))


def test_a_feature_is_struck_out_of_every_source_of_the_engine_and_no_other_is(features, tmp_path):
    before, used = sources(features.ENGINE)
    assert all(used[mode] for mode in Modes._fields)
    for feature in ("nothing", *Modes._fields):
        after, left = sources(features.without(feature, tmp_path) / "atmosbox" / "engine")
        assert after.keys() == before.keys()
        assert left == Counter({mode: n for mode, n in used.items() if mode != feature})
        for name, text in after.items():
            if text != before[name]:
                compile(text, name, "exec")
        assert (after == before) == (feature == "nothing")


def test_lines_of_code_are_those_that_were_gone_through(features):
    def work():
        total = 0
        if total > 0:
            total = 5
        for i in range(3):
            total += i

    first = work.__code__.co_firstlineno
    seen = features.lines_of(work, (__file__,))
    assert {line - first for file, line in seen if file == __file__} == {1, 2, 4, 5}
    assert features.lines_of(work, ("elsewhere",)) == set()


def test_a_median_has_the_error_of_gaussian_numbers(features):
    rng = np.random.default_rng(1)
    samples = np.array([features.middle(list(rng.normal(2.0, 0.3, 40))) for _ in range(500)])
    # the median of 500 such standard errors is within 5 % of the scatter, which itself is known to 3 %; seed fixed
    assert np.median(samples[:, 1]) == pytest.approx(samples[:, 0].std(ddof=1), rel=0.12)
    assert samples[:, 0].mean() == pytest.approx(2.0, abs=4.0 * samples[:, 0].std() / math.sqrt(500))


@pytest.mark.validate
def test_the_cost_of_features_is_measured(tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")  # compiling eleven engines would take minutes
    file = tmp_path / "features.json"
    run("features.py", "--trial", "--n", 20, "--processes", 2, "--repeats", 1, "--span", 1, "--json", file)
    result = json.loads(file.read_text())["results"]
    assert set(result["off"]) == {"nothing", *Modes._fields}
    for each in result["on"].values():
        assert each["shows"] in ("", *each["modes"])
        assert each["lines"] > result["lines_of_points"] > 0
        assert each["ns"] > 0.0
        assert 0.0 < each["bytes"] < 2000.0
    assert {mode for each in result["on"].values() for mode in each["modes"]} == set(Modes._fields) - LIQUID
    assert all(each["lines"] > 5 for each in result["instruments"].values())
    assert result["instruments"]["trails: discs"]["bytes"] > 0.0


@pytest.mark.validate
@pytest.mark.skipif(not COMPILED, reason="so many steps take minutes without numba")
def test_single_precision_is_measured_and_makes_energy_and_loses_gravity(tmp_path):
    file = tmp_path / "precision.json"
    run("precision.py", "--n", 2000, "--repeats", 1, "--json", file)
    found = json.loads(file.read_text())
    double, single = found["energy"]["error"]
    assert double < 1e-13 < 1e-10 < single < 1e-4
    assert found["pace"][0]["bytes_per_molecule"][1] < 0.7 * found["pace"][0]["bytes_per_molecule"][0]
    errors = {one["gain"]: one["error"] for one in found["fall"]}
    assert all(abs(each[0]) < 1e-8 for each in errors.values())
    assert abs(errors[1e-2][1]) < 1e-4
    assert abs(errors[1e-8][1]) > 0.2
