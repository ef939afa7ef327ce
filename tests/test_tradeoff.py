"""Speed against accuracy: the ways of running a scene, the measurement, its files and its figure."""

import json
import math
import os
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from atmosbox import scenarios
from atmosbox.cli import app
from atmosbox.engine import CoarseStepWarning
from atmosbox.errors import FileError
from atmosbox.file.netcdf import read
from atmosbox.plot import save
from atmosbox.plot.tradeoff_figure import recommended
from atmosbox.scene.setup import Series
from atmosbox.simulation.accuracy import choose
from atmosbox.trade import timed_run
from atmosbox.trade.tradeoff import Way, _summary, measure, ways_of

ROOT = Path(__file__).resolve().parents[1]
QUICK = (
    Series("exact", "ascent", (20, 40), {"molecules": 100}, {"temperature_at_700_hpa": -1.0}),
    Series("stepped", "delta", (0.4,), {"molecules": 100, "ascent": 20}),
)
DISCS = [Way("exact", {"duration": 2.0}, 0, 2.0), Way("exact", {"duration": 4.0}, 0, 4.0)]


@pytest.fixture(scope="module", autouse=True)
def compiled():
    """Compile the engines before any test that looks at the time."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CoarseStepWarning)
        for way in ways_of(QUICK, {}):
            timed_run.compile_way("lifting-dry", way)
        timed_run.compile_way("elastic-collisions", DISCS[0])


@pytest.fixture(scope="module")
def found():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(timed_run, "MOST_RUNS", 4)  # this ends it, on a computer that is not busy
        return measure("lifting-dry", ways=ways_of(QUICK, {}), budget=60.0)


@pytest.fixture
def runs(monkeypatch):
    """Let each way run twice, however long the budget; return the runs that were made, as way and seed."""
    made, once = [], timed_run.run
    monkeypatch.setattr(timed_run, "MOST_RUNS", 2)
    monkeypatch.setattr(timed_run, "run", lambda *run: made.append((run[1].label, run[2])) or once(*run))
    return made


def test_bias_and_noise_are_told_apart():
    # A hundred members with an error of 0.5 and a scatter of 2: four standard errors, a false alarm in 16 000 seeds.
    rng = np.random.default_rng(1)
    error = 0.5 + 2.0 * rng.normal(size=(100, 1))
    bias, se, noise = _summary(error, np.full((100, 1), 9.0))
    assert abs(bias - 0.5) < 4.0 * se
    assert se == pytest.approx(noise / 10.0)
    assert abs(noise - 2.0) < 4.0 * 2.0 / math.sqrt(200.0)


def test_a_measurement_has_errors_beside_costs(found):
    assert found.sizes["configuration"] == 3
    assert (found.members.values >= 1).all()
    assert (found.engine_seconds.values > 0.0).all()
    assert found.cost.values[1] == 1.0, "the reference is the dearest of the first exact series"
    assert (found.escaped.values == 0).all()
    assert (found.ledger.values < 1e-10).all()
    assert (found.energy_drift.values == 0.0).all()
    one = found.sel(quantity="temperature_at_700_hpa")
    assert one.unit.item() == "K"
    assert (one.noise.values > 0.0).all()
    assert np.allclose(one.bias_se.values, one.noise.values / np.sqrt(found.members.values))


def stored(scene):
    """Return a tradeoff that was measured for the pages."""
    return read(ROOT / f"benchmarks/tradeoff-{scene}.nc")


@pytest.mark.parametrize("scene", ["atmosphere", "evaporation", "lifting-dry", "temperature-large"])
def test_the_recommended_run_is_the_one_that_accuracy_lecture_takes(scene):
    best, enough = recommended(stored(scene))
    way = stored(scene).isel(configuration=best)
    chosen = choose(scene, "lecture")
    assert enough == chosen.met
    assert str(way.engine.item()) == chosen.way.engine
    assert scenarios.load(scene).Settings.from_user(json.loads(way.settings.item())).changed() == chosen.way.settings


class Clock:
    """A clock that moves only with the simulated work, and the runs that use it.

    ``building`` and ``running`` are seconds by way; a run calls its watch a hundred times.
    """

    def __init__(self, budget, building, running):
        self.now, self.log, self.building, self.running = 0.0, [], building, running
        self.results = [[] for _ in running]
        self.said = timed_run.repeat(budget, self.results, self.run, clock=lambda: self.now)

    def run(self, k, watch):
        self.log.append(k)
        watch(0.0, "compiling the engine, once")
        self.now += self.building[k]
        for share in np.linspace(0.0, 1.0, 101):
            watch(share, "running")
            self.now += self.running[k] / 100.0
        return self.now

    @property
    def counts(self):
        return [len(done) for done in self.results]


def test_the_budget_is_kept_and_what_fits_is_run():
    # the second takes more than its share at first, the third is built for longer than it runs, the fourth never fits
    watched = Clock(60.0, [0.0, 0.0, 5.0, 0.0], [1.0, 30.0, 0.5, 500.0])
    assert watched.now <= 60.0
    assert watched.counts[1] == 1
    assert watched.counts[0] >= 1 <= watched.counts[2]
    assert watched.counts[3] == 0
    assert watched.said == ["", "", "", "left out: one run takes about 500 s"]


def test_the_command_writes_a_file_and_says_what_is_in_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(scenarios.load("lifting-dry"), "series", QUICK, raising=False)
    monkeypatch.setattr(timed_run, "MOST_RUNS", 2)
    done = CliRunner().invoke(app, ["tradeoff", "lifting-dry", "--budget", "60s", "--json"])
    assert done.exit_code == 0, done.output
    said = json.loads(done.stdout)
    assert said["file"] == "lifting-dry-tradeoff.nc"
    assert (tmp_path / said["file"]).stat().st_size > 100


KILLED = """
import os
from pathlib import Path
from atmosbox.file.checkpoint import Checkpoint
from atmosbox.trade import timed_run
from atmosbox.trade.tradeoff import measure
from tests.test_tradeoff import DISCS

def run(*words):
    if len(made) == 3:
        os._exit(9)  # as a kill: nothing is closed or cleaned up
    made.append(words)
    return once(*words)

made, once, timed_run.run = [], timed_run.run, run
timed_run.MOST_RUNS = 2
Checkpoint.__call__ = lambda self, make: self.save(make())  # after every run, and not only after two seconds
measure("elastic-collisions", ways=DISCS, out=Path("x.nc"), budget=600.0)
"""


@pytest.mark.nightly
def test_a_tradeoff_that_was_killed_goes_on_to_the_same_errors(tmp_path, runs):
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), *filter(None, sys.path)])}
    done = subprocess.run([sys.executable, "-c", KILLED], cwd=tmp_path, env=environment, check=False)
    assert done.returncode == 9
    part = read(tmp_path / "x.part.nc")
    assert sorted(part.members.values.tolist()) == [1, 2]
    assert save(part, tmp_path / "part.svg").exists()
    with pytest.raises(FileError, match="another tradeoff \\(seed\\)"):
        measure("elastic-collisions", ways=DISCS, out=tmp_path / "x.nc", seed=2, budget=600.0)
    notes = []
    measure("elastic-collisions", ways=DISCS, out=tmp_path / "x.nc", note=notes.append, budget=600.0)
    assert runs == [(DISCS[int(part.members.values.argmin())].label, 2)]
    assert "3 runs are saved" in notes[0]
    assert sorted(path.suffix for path in tmp_path.iterdir()) == [".nc", ".svg"]
    found, undisturbed = read(tmp_path / "x.nc"), measure("elastic-collisions", ways=DISCS, budget=600.0)
    assert len(found.attrs["history"].splitlines()) == 2
    for name in ("bias", "bias_se", "noise", "members", "ledger", "missed", "escaped", "theory"):
        assert found[name].values.tobytes() == undisturbed[name].values.tobytes(), name
