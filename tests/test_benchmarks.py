"""The benchmarks run; what they time is not tested."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


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
