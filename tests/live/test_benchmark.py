"""The benchmark of the page runs; its timings are not tested."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.validate
def test_the_pictures_that_a_page_gets_are_counted(tmp_path):
    file = tmp_path / "live.json"
    words = ["--scene", "elastic-collisions", "--molecules", "20", "--seconds", "1", "--json", str(file)]
    command = [sys.executable, str(ROOT / "benchmarks" / "live.py"), *words]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120, env=environment)
    assert done.returncode == 0, done.stderr
    (found,) = json.loads(file.read_text(encoding="utf-8"))
    assert found["molecules"] == 20
    assert found["pictures_per_second"] > 0.0
    assert found["bytes_per_picture"] == 32 + 20 * 8 + 4
