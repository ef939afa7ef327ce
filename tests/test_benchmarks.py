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
    (result,) = json.loads(file.read_text())
    assert "| periodic | 0.01 | 100 |" in printed
    assert result["collisions_per_second"] > 0.0
    assert 0.0 < result["bytes_per_molecule"] < 2000.0


@pytest.mark.validate
def test_the_cost_of_features_is_measured(tmp_path):
    file = tmp_path / "features.json"
    run("features.py", "--n", 100, "--repeats", 1, "--span", 1, "--json", file)
    result = json.loads(file.read_text())
    assert set(result["off"]) == {"nothing", "gravity", "rotation", "mixed", "spanning", "periodic", "piston"}
    assert len(result["on"]) == 8
