"""The expected time of a run, from the measured table and the speed of this computer, and how it is shown."""

import contextlib
import json

import pytest
from typer.testing import CliRunner

from atmosbox.cli import app
from atmosbox.simulation import expected_time as times
from atmosbox.simulation import runner
from atmosbox.simulation.accuracy.measured import load
from atmosbox.simulation.expected_time import expected_time, remember_pace
from atmosbox.text import progress as bars


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    """A separate, empty cache, in which no speed of this computer is known yet."""
    monkeypatch.setattr(times, "cache_home", lambda: tmp_path)
    return tmp_path


def expected(scene, engine=None, **settings):
    return expected_time(runner.prepare(scene, settings, engine=engine))


def test_what_was_measured_is_expected_as_it_was_measured():
    for scene in sorted(load()):
        table = load()[scene]
        for way in table.ways:
            found = expected(scene, way.engine, **way.settings)
            assert found.seconds == pytest.approx(table.how["seconds"] * way.cost, rel=0.02)


def test_between_and_beyond_what_was_measured_the_cost_grows_as_its_neighbours_do():
    ways = {
        way.settings["ascent"]: way.cost
        for way in load()["lifting-dry"].ways
        if [*way.settings] == ["ascent"] and way.engine == "exact"
    }
    at = {ascent: expected("lifting-dry", ascent=ascent).seconds for ascent in (100.0, 150.0, 200.0)}
    assert at[100.0] < at[150.0] < at[200.0]
    assert at[200.0] / at[100.0] == pytest.approx(ways[200.0] / ways[100.0])
    assert expected("temperature", molecules=1000).seconds == pytest.approx(
        5.0 * expected("temperature", molecules=200).seconds
    )
    assert expected("lifting-dry", ascent=1e6) is None
    assert expected("lifting-dry", "stepped:delta=0.03") is None
    assert expected("mountains") is None or "mountains" in load()


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


def test_a_complete_run_is_remembered_and_a_cache_that_cannot_be_written_is_no_error(home, monkeypatch):
    monkeypatch.setattr(times, "_ENOUGH", 0.0)
    runner.run("elastic-collisions", duration="5 s")
    assert len(json.loads((home / "pace.json").read_text())) == 1
    monkeypatch.setattr(times, "cache_home", lambda: home / "gone")
    runner.run("elastic-collisions", duration="5 s")


def test_it_is_said_before_a_run_and_in_its_bar(home, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (home / "pace.json").write_text("[2.0]")
    said = str(expected("lifting-dry"))
    for words in (["info", "lifting-dry"], ["run", "lifting-dry", "--dry-run"]):
        done = CliRunner().invoke(app, words)
        assert said in done.stdout
        told = json.loads(CliRunner().invoke(app, [*words, "--json"]).stdout)
        assert told["expected_seconds"] == expected("lifting-dry").seconds
    named = []

    @contextlib.contextmanager
    def bar(name):
        named.append(name)
        yield lambda share: None, named.append

    monkeypatch.setattr(bars, "_bar", bar)
    monkeypatch.setattr(bars.sys, "stderr", type("Terminal", (), {"isatty": lambda self: True})())
    monkeypatch.setenv("TERM", "xterm")
    with bars.progress("lifting-dry", quiet=False, expected=said) as show:
        show(0.1, "running")
    assert named == [f"lifting-dry, {said}"] * 2
