"""The expected time of a run, from the measured table and the speed of this computer, and how it is shown."""

import json

import pytest

from atmosbox.simulation import compilation, runner
from atmosbox.simulation.expected_time import expected_time, remember_pace


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    """A separate, empty cache, in which no speed of this computer is known yet."""
    monkeypatch.setattr(compilation, "cache_home", lambda: tmp_path)
    return tmp_path


def test_a_run_tells_the_pace_of_this_computer(home):
    prepared = runner.prepare("lifting-dry", {})
    ours = expected_time(prepared)
    assert not ours.here
    assert "as fast as ours" in str(ours)
    for pace in (3.0, 2.0, 50.0):
        remember_pace(prepared, pace * ours.seconds)
    here = expected_time(prepared)
    assert here.here
    assert here.seconds == pytest.approx(3.0 * ours.seconds, rel=1e-3)
    assert "as fast" not in str(here)
    remember_pace(runner.prepare("elastic-collisions", {}), 0.01)  # too short for a measurement
    assert json.loads((home / "pace.json").read_text()) == [3.0, 2.0, 50.0]
    for odd in ("", "[", "{}", '["x"]', "[-1]", "[NaN]", "[1e999]"):
        (home / "pace.json").write_text(odd)
        assert not expected_time(prepared).here
