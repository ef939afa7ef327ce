"""Speed against accuracy: the rungs, the measurement, its files and its figure."""

import csv
import functools
import json
import math
import os
import subprocess
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

from atmosbox import scenarios
from atmosbox.cli import app
from atmosbox.cli import tradeoff as command
from atmosbox.engine import CoarseStepWarning
from atmosbox.errors import FileError, SettingError, UnknownSettingError
from atmosbox.file.journal import Journal
from atmosbox.file.netcdf import read, write
from atmosbox.file.run_states import RunStates
from atmosbox.plot import save, tradeoff_figure
from atmosbox.plot.tradeoff_choice import recommended
from atmosbox.scene.setup import Series
from atmosbox.simulation.accuracy import choose
from atmosbox.trade.tradeoff import (
    KeptRuns,
    Rung,
    budgeted_runs,
    measure,
    measured_trade,
    rungs,
    timed_run,
    warm_engine,
)
from atmosbox.trade.tradeoff.budgeted_runs import BudgetedRuns
from atmosbox.trade.tradeoff.measured_trade import _summary

ROOT = Path(__file__).resolve().parents[1]
QUICK = (
    Series("exact", "ascent", (20, 40), {"molecules": 100}, {"temperature_at_700_hpa": -1.0}),
    Series("stepped", "delta", (0.4,), {"molecules": 100, "ascent": 20}),
)


@pytest.fixture(scope="module", autouse=True)
def compiled():
    """Compile the engines before any budget begins, since compilation would count, and in this process."""
    with pytest.MonkeyPatch.context() as patch, warnings.catch_warnings():
        warnings.simplefilter("ignore", CoarseStepWarning)
        for rung in rungs(QUICK, {}):
            timed_run.warm_up("lifting-dry", rung)
        timed_run.warm_up("elastic-collisions", Rung("exact", {}, 0, 0.0))
        patch.setattr(warm_engine, "COMPILED", False)
        yield


@pytest.fixture(scope="module")
def found():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(budgeted_runs, "MOST_RUNS", 4)  # this ends it, on a computer that is not busy
        return measure("lifting-dry", ladder=rungs(QUICK, {}), budget=60.0)


def test_a_series_becomes_rungs_of_options_and_settings():
    steps, settings = Series("stepped:motion=euler", "delta", (0.2,)), Series("exact", "ascent", (100,), {"seed": 3})
    made = rungs([steps, settings], {"molecules": 50})
    assert [rung.engine for rung in made] == ["stepped:motion=euler,delta=0.2", "exact"]
    assert made[0].settings == {"molecules": 50}
    assert made[1].settings == {"molecules": 50, "seed": 3, "ascent": 100}
    assert made[1].label == "exact, molecules=50, seed=3, ascent=100"


def test_a_series_of_what_no_engine_knows_is_refused():
    with pytest.raises(UnknownSettingError, match="delt"):
        rungs([Series("stepped:delt=0.1", "ascent", (1,))], {})
    with pytest.raises(SettingError, match="ladder"):
        rungs([], {})


def test_the_ladder_of_a_scene_can_be_climbed():
    """Every rung names an engine and settings that the scene accepts."""
    for module in map(scenarios.load, scenarios.names()):
        for rung in rungs(module.ladder, {}):
            module.Settings.from_user(rung.settings)


def test_bias_and_noise_are_told_apart():
    # A hundred members with an error of 0.5 and a scatter of 2: four standard errors, a false alarm in 16 000 seeds.
    rng = np.random.default_rng(1)
    error = 0.5 + 2.0 * rng.normal(size=(100, 1))
    bias, se, noise = _summary(error, np.full((100, 1), 9.0))
    assert abs(bias - 0.5) < 4.0 * se
    assert se == pytest.approx(noise / 10.0)
    assert abs(noise - 2.0) < 4.0 * 2.0 / math.sqrt(200.0)


def test_few_members_are_judged_by_their_own_error_bars():
    bias, se, noise = _summary(np.array([[1.0], [3.0]]), np.array([[3.0], [4.0]]))
    assert (bias, noise) == (2.0, pytest.approx(math.sqrt(12.5)))
    assert se == pytest.approx(noise / math.sqrt(2.0))


def test_the_noise_of_a_curve_is_no_bias():
    # 25 points without bias: the part of the mean square due to chance is subtracted, to within its own scatter.
    rng = np.random.default_rng(2)
    bias, _, noise = _summary(rng.normal(size=(16, 25)), np.ones((16, 25)))
    assert noise == pytest.approx(1.0, abs=4.0 / math.sqrt(2 * 15 * 25))
    assert bias**2 < 4.0 * math.sqrt(2.0 / 25.0) / 16.0
    assert np.isnan(_summary(np.full((2, 3), np.nan), np.ones((2, 3)))).all()


def test_a_measurement_has_errors_beside_costs(found):
    assert found.sizes["rung"] == 3
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


def test_the_same_seeds_give_the_same_errors(monkeypatch):
    monkeypatch.setattr(budgeted_runs, "MOST_RUNS", 1)
    first, second = (measure("lifting-dry", ladder=rungs(QUICK, {})[:1], budget=10.0) for _ in range(2))
    assert first.members.values.tolist() == [1]
    assert np.array_equal(first.bias.values, second.bias.values, equal_nan=True)
    assert np.array_equal(first.noise.values, second.noise.values, equal_nan=True)


def test_two_series_that_cross_share_a_run(monkeypatch):
    asked = []
    run = timed_run.run
    monkeypatch.setattr(timed_run, "run", lambda scene, rung, *rest: asked.append(rung) or run(scene, rung, *rest))
    default = scenarios.load("elastic-collisions").Settings().molecules
    ladder = [
        Rung("exact", {"duration": 2}, 0, 2.0),
        Rung("exact", {"duration": 2, "molecules": default}, 1, float(default)),
        Rung("exact", {"duration": 2, "molecules": default // 2}, 1, default / 2.0),
    ]
    monkeypatch.setattr(budgeted_runs, "MOST_RUNS", 2)
    found = measure("elastic-collisions", budget=60.0, ladder=ladder)
    assert {rung.label for rung in asked} == {ladder[0].label, ladder[2].label}
    for name in ("bias", "engine_seconds", "members"):
        assert np.array_equal(found[name].values[0], found[name].values[1])
    assert found.members.values[0] >= 1


def test_a_run_that_is_too_dear_is_left_out(monkeypatch):
    monkeypatch.setattr(budgeted_runs, "MOST_RUNS", 1)
    ladder = (*rungs(QUICK, {})[:1], Rung("exact", {"ascent": 1e6, "molecules": 10_000}, 1, 1e6))
    found = measure("lifting-dry", ladder=ladder, budget=5.0)
    assert found.members.values.tolist()[1] == 0
    assert found.left_out.values[1].startswith("left out: ")


def test_what_an_engine_cannot_do_is_said_and_not_measured(monkeypatch):
    monkeypatch.setattr(budgeted_runs, "MOST_RUNS", 1)
    ladder = (*rungs(QUICK, {})[:1], Rung("stepped:delta=1000", {"molecules": 100}, 1, 0.1))
    found = measure("lifting-dry", ladder=ladder, budget=60.0)
    assert found.members.values[1] == 0
    assert "would cross the box" in found.left_out.values[1]


class Clock:
    """A clock that moves only with the simulated work, and the runs that use it.

    ``compiling``, ``building`` and ``running`` are seconds by way; a run calls its watch a hundred times.
    """

    def __init__(self, budget, compiling, building, running):
        self.now, self.log, self.compiling, self.building, self.running = 0.0, [], compiling, building, running
        labels = [str(k) for k in range(len(running))]
        self.runs = BudgetedRuns(budget, labels, self.compile, self.run, lambda *words: None, lambda: self.now)
        self.runs.run()

    def compile(self, k, seconds):
        self.now += min(self.compiling[k], seconds)
        return self.compiling[k] <= seconds

    def run(self, k, done, watch):
        self.log.append(k)
        watch(0.0, "compiling the engine, once")
        self.now += self.building[k]
        for share in np.linspace(0.0, 1.0, 101):
            watch(share, "running")
            self.now += self.running[k] / 100.0
        return self.now

    @property
    def counts(self):
        return [len(done) for done in self.runs.results]


def test_the_budget_is_kept_with_all_that_is_compiled_built_and_run():
    watched = Clock(60.0, [30.0, 20.0, 5.0, 40.0], [0.5, 2.0, 0.1, 0.0], [1.0, 3.0, 200.0, 1.0])
    assert watched.now <= 60.0
    assert "ended while its engine was compiled" in watched.runs.left_out[2] + watched.runs.left_out[3]
    assert Clock(60.0, [0.0] * 4, [0.5, 2.0, 0.1, 0.0], [1.0, 3.0, 200.0, 1.0]).now <= 60.0
    spent = Clock(60.0, [70.0, 50.0], [0.0, 0.0], [1.0, 1.0])
    assert spent.counts == [0, 0]
    assert spent.now == 60.0
    assert "ended while its engine was compiled" in spent.runs.left_out[0]
    assert "spent before its turn" in spent.runs.left_out[1]
    assert "compiling took 58 s" in Clock(60.0, [58.0, 1.0, 1.0], [0.0] * 3, [1.0] * 3).runs.left_out[2]


def test_what_fits_is_not_left_out_for_being_long_or_slow_to_build():
    # the second takes more than its share at first, the third is built for longer than it runs
    watched = Clock(60.0, [0.0] * 4, [0.0, 0.0, 5.0, 0.0], [1.0, 30.0, 0.5, 500.0])
    assert watched.counts[1] == 1
    assert watched.counts[0] >= 1 <= watched.counts[2]
    assert watched.runs.left_out[:3] == ["", "", ""]
    assert "500 s" in watched.runs.left_out[3]
    assert watched.counts[3] == 0


def test_those_with_the_fewest_runs_come_first():
    watched = Clock(60.0, [0.0] * 3, [0.0] * 3, [2.0, 1.0, 4.0])
    assert max(watched.counts) - min(watched.counts) <= 4
    assert watched.log[:3] == [0, 1, 2]
    assert sum(n * t for n, t in zip(watched.counts, (2.0, 1.0, 4.0), strict=True)) > 50.0


def test_a_compiler_that_takes_longer_than_the_budget_is_ended(monkeypatch, tmp_path):
    monkeypatch.setattr(warm_engine, "COMPILED", True)
    monkeypatch.setattr(warm_engine, "cache_folder", lambda: tmp_path)
    asked, program = Rung("exact", {}, 0, 0.0), warm_engine._PROGRAM
    monkeypatch.setattr(warm_engine, "_PROGRAM", "import time; time.sleep(60)")
    began = time.monotonic()
    assert not warm_engine.compile_within("elastic-collisions", asked, 0.5)
    assert time.monotonic() - began < 20.0
    assert not list(tmp_path.iterdir()), "what was ended is not taken for compiled"
    done = tmp_path / "done"
    monkeypatch.setattr(warm_engine, "_PROGRAM", f"{program}\nopen({str(done)!r}, 'w').close()")
    assert warm_engine.compile_within("elastic-collisions", asked, 600.0)
    assert done.exists(), "the other process came to its end"
    monkeypatch.setattr(warm_engine, "_PROGRAM", "import time; time.sleep(60)")
    assert warm_engine.compile_within("elastic-collisions", asked, 0.5), "it is not compiled twice"


def test_an_impossible_budget_is_refused():
    for budget in [0.0, -1.0, math.nan, math.inf, 1e9]:
        with pytest.raises(SettingError, match='budget="60s"'):
            measure("lifting-dry", budget=budget)


def test_ctrl_c_keeps_what_was_measured():
    def stop(share, word):
        if "ascent=40" in word:
            raise KeyboardInterrupt

    found = measure("lifting-dry", ladder=rungs(QUICK, {}), budget=30.0, progress=stop)
    assert found.attrs["atmosbox_status"] == "interrupted"
    assert found.members.values.tolist() == [1, 0, 0]


@pytest.mark.parametrize(("theme", "all_panels"), [("notes", False), ("notes", True), ("slides", False)])
def test_its_figure_is_the_same_to_the_byte_and_survives_the_file(found, tmp_path, theme, all_panels):
    saved = write(found, tmp_path / "trade.nc")
    first = save(found, tmp_path / "first.svg", theme=theme, all_panels=all_panels).read_bytes()
    assert save(read(saved), tmp_path / "second.svg", theme=theme, all_panels=all_panels).read_bytes() == first


def stored(scene):
    """Return a tradeoff that was measured for the pages."""
    return read(ROOT / f"benchmarks/tradeoff-{scene}.nc")


@pytest.mark.parametrize("scene", ["atmosphere", "evaporation", "lifting-dry", "temperature-large"])
def test_the_recommended_run_is_the_one_that_accuracy_lecture_takes(scene):
    best, enough = recommended(stored(scene))
    way = stored(scene).isel(rung=best)
    chosen = choose(scene, "lecture")
    assert enough == chosen.met
    assert str(way.engine.item()) == chosen.way.engine
    assert scenarios.load(scene).Settings.from_user(json.loads(way.settings.item())).changed() == chosen.way.settings


@pytest.mark.parametrize("scene", ["atmosphere", "lifting-dry", "lifting-moist", "temperature-large"])
@pytest.mark.parametrize("theme", ["notes", "slides"])
def test_one_panel_names_its_curves_where_they_are_and_covers_none_of_the_words(scene, theme):
    dataset = stored(scene)
    drawing = tradeoff_figure.figure(dataset, theme)
    drawing.draw_without_rendering()
    (axes,) = drawing.axes
    words = [text.get_text() for text in axes.texts]
    assert sum(text.startswith("recommended: ") for text in words) == 1
    assert len(words) == 1 + len({int(row) for row in dataset.series.values[dataset.members.values > 0]})
    boxes = [text.get_window_extent() for text in axes.texts]
    assert not any(box.overlaps(other) for k, box in enumerate(boxes) for other in boxes[k + 1 :])
    for box in boxes:
        assert drawing.bbox.x0 < box.x0
        assert box.x1 < drawing.bbox.x1


def test_another_experiment_is_not_recommended_however_good():
    column = stored("atmosphere")
    flat = column.settings.str.contains("plane")
    assert flat.any()
    perfect = {name: column[name].where(~flat, 0.0) for name in ("bias", "bias_se", "noise")}
    best, _ = recommended(column.assign(engine_seconds=column.engine_seconds.where(~flat, 1e-9), **perfect))
    assert not flat[best]


def test_a_budget_that_was_too_short_can_be_given_longer(tmp_path, monkeypatch):
    monkeypatch.setattr(measured_trade, "compile_within", lambda *_: False)
    for budget in (2.0, 3.0):
        with pytest.raises(SettingError, match="leaves nothing measured"):
            measure("elastic-collisions", budget=budget, out=tmp_path / "x.nc")
        assert not list(tmp_path.iterdir())


def test_where_nothing_is_accurate_enough_the_most_accurate_is_marked():
    unfit = stored("lifting-dry")
    best, enough = recommended(unfit.assign(noise=unfit.noise + 10.0))
    assert not enough
    assert str(unfit.rung.values[best]).startswith(("exact", "dsmc"))
    assert recommended(unfit.assign(engine_seconds=unfit.engine_seconds * np.nan)) is None


def test_the_table_has_a_line_for_every_run(found):
    lines = command.lines(found, 200)
    assert sum(line.startswith(("exact, molecules=100", "stepped:delta=0.4")) for line in lines) == 3
    records = list(csv.DictReader(command.as_csv(found).splitlines()))
    assert [record["run"] for record in records] == [str(name) for name in found.rung.values]
    assert float(records[0]["temperature_at_700_hpa_noise_K"]) > 0.0


def test_the_command_writes_table_file_and_figure(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(scenarios.load("lifting-dry"), "ladder", QUICK, raising=False)
    monkeypatch.setattr(budgeted_runs, "MOST_RUNS", 2)
    done = CliRunner().invoke(app, ["tradeoff", "lifting-dry", "--budget", "5s", "--json"])
    assert done.exit_code == 0, done.output
    said = json.loads(done.stdout)
    assert said["files"] == ["lifting-dry-tradeoff.nc", "lifting-dry-tradeoff.csv", "lifting-dry-tradeoff.png"]
    assert all((tmp_path / name).stat().st_size > 100 for name in said["files"])


def test_the_command_refuses_with_a_sentence(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for words, wanted in [
        (["--budget", "5 km"], "--budget 60s"),
        (["--budget", "0.1s"], "--budget"),
        (["--seed", "-1"], "--seed"),
        (["--set", "molecules=none"], "molecules"),
    ]:
        done = CliRunner().invoke(app, ["tradeoff", "lifting-dry", *words])
        assert done.exit_code == 2, done.output
        assert wanted in done.output
    assert not list(tmp_path.iterdir())


TRADE = """
import os, sys
from pathlib import Path
from atmosbox.trade.tradeoff import measure, rungs
from atmosbox.trade.tradeoff import budgeted_runs
from tests.test_tradeoff import LONG
budgeted_runs.MOST_RUNS = 2
found = measure("temperature", ladder=LONG, budget=1e5, out=Path("x.nc"), note=print)
found.drop_attrs(deep=False).to_netcdf("found.nc")
"""
LONG = (Rung("exact", {"molecules": 100}, 0, 100.0), Rung("exact", {"molecules": 15_000}, 0, 1.5e4))


@pytest.mark.soak
def test_a_tradeoff_that_is_killed_goes_on_within_its_run(tmp_path, monkeypatch):
    """kill -9: complete runs are kept, the interrupted run is continued, and every number is the same."""
    monkeypatch.setattr(budgeted_runs, "MOST_RUNS", 2)

    def under_way():
        journal = Journal.place(tmp_path / "x.nc")
        complete = journal.read_bytes().count(b"\n") - 1 if journal.exists() else 0
        return complete == 1 and (tmp_path / "x.part.states/2-1.part.nc").exists()

    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), *filter(None, sys.path)])}
    start = functools.partial(
        subprocess.Popen, [sys.executable, "-c", TRADE], cwd=tmp_path, env=environment, stdout=subprocess.PIPE,
        text=True,
    )  # fmt: skip
    with start() as process:
        deadline = time.monotonic() + 600.0
        while process.poll() is None and not under_way() and time.monotonic() < deadline:
            time.sleep(0.02)
        process.kill()
    assert under_way()
    with pytest.raises(FileError, match="another tradeoff, with budget 100000"):
        measure("temperature", ladder=LONG, budget=200.0, out=tmp_path / "x.nc")
    with start() as process:
        said, _ = process.communicate()
    assert "1 runs are saved" in said
    assert RunStates(tmp_path / "x.nc").begun == 0
    found = xr.load_dataset(tmp_path / "found.nc")
    undisturbed = measure("temperature", ladder=LONG, budget=1e5)
    assert found.members.values.tolist() == [2, 2] == undisturbed.members.values.tolist()
    for name in ("bias", "bias_se", "noise", "ledger", "escaped"):
        assert found[name].values.tobytes() == undisturbed[name].values.tobytes(), name
    KeptRuns.remove(tmp_path / "x.nc")
    assert [path.name for path in tmp_path.iterdir()] == ["found.nc"]
