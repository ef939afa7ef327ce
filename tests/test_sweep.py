"""Sweeps: settings that vary, seeds, results, saved runs that are not computed twice, refusals, lost workers."""

import errno
import importlib
import json
import math
import os
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from atmosbox import scenarios
from atmosbox.cli import check
from atmosbox.errors import DiskFullError, FileError, SettingError, UnitError, UnknownSettingError
from atmosbox.file.checkpoint import Checkpoint
from atmosbox.file.journal import Journal
from atmosbox.file.netcdf import read, write
from atmosbox.file.output_lock import OutputLock
from atmosbox.file.output_path import part_path
from atmosbox.file.run_states import RunStates
from atmosbox.simulation import continuation, runner
from atmosbox.sweep import SweepInterrupted, member, member_seed, parse_vary, plan, sweep
from atmosbox.sweep.result import assemble, mean_and_error
from tests import in_process
from tests.few_frames import cut

ROOT = Path(__file__).resolve().parents[1]
CHECKER = shutil.which(check.CHECKER, path=Path(sys.executable).parent)

SCENE = '''"""Discs, some of which have trouble."""

import os
import signal
import time
from pathlib import Path

from atmosbox.scene.engines import EXACT
from atmosbox.errors import EngineError, SettingError
from atmosbox.scenarios import elastic_collisions as discs
from atmosbox.scenarios.elastic_collisions import headlines, panels, theory
from atmosbox.scene.settings import setting

title = "Discs"
discs.FRAMES, discs.SETTLE = 60, 20
assert headlines and panels and theory


class Settings(discs.Settings):
    trouble: int = setting(0, "1", "what goes wrong", low=0, high=9)
    molecules: int = setting(10, "1", "number of discs", low=2, high=5000)
    duration: float = setting(2.0, "s", "how long to watch", low=0.1, high=1e6)

    def check(self):
        if self.trouble == 1:
            raise SettingError("trouble", 1, "is no setting to run with", "give --set trouble=0")


def build(settings, engine=EXACT):
    (Path(__file__).parent / f"run-{settings.seed}-{os.getpid()}-{time.monotonic_ns()}").touch()
    if settings.trouble == 2:
        raise EngineError("The discs have stalled.")
    if settings.trouble == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return discs.build(settings, engine)
'''

HELD = f'''{SCENE}

if "HOLD" in os.environ:
    from atmosbox.file import run_states

    class Held(run_states.StateCheckpoint):
        """The state of a run, saved after its first frame; from the third point on, the run then stands still."""

        def __init__(self, path):
            super().__init__(path)
            self._every = 0.0

        def save(self, dataset):
            super().save(dataset)
            if int(self.path.name.partition("-")[0]) > 2:
                time.sleep(600)

    run_states.StateCheckpoint = Held
'''

QUICK = {"duration": 2.0}


@pytest.fixture(scope="module", autouse=True)
def few_frames():
    """The runs of discs have the few frames that they have in `SCENE`."""
    with pytest.MonkeyPatch.context() as patch:
        cut(patch, {"elastic-collisions": (60, 20)})
        yield


@pytest.fixture
def scene(tmp_path):
    """The path of a user's own scene that writes a file for each run that it begins."""
    path = tmp_path / "discs.py"
    path.write_text(SCENE, encoding="utf-8")
    return path


def begun(scene):
    """Return the number of times that a run was begun, by its seed."""
    return Counter(int(path.name.split("-")[1]) for path in scene.parent.glob("run-*"))


def saved(file):
    """Return the records of a journal, without its other lines."""
    path = file.with_name(f"{file.stem}.part.jsonl")
    lines = path.read_text(encoding="utf-8").split("\n")[:-1] if path.exists() else []
    return [record for record in map(json.loads, lines) if "point" in record]


def typed(*words):
    return in_process.typed("sweep", *words)


def stop_after(runs, total):
    """Return a progress function that stops, as by Ctrl-C, when a number of runs are complete."""

    def show(share, word):
        if share > runs / total:
            raise KeyboardInterrupt

    return show


PARAMETERS = {p.name: p for p in scenarios.load("temperature").Settings.describe()}


def test_what_varies_is_typed_as_a_row_or_as_a_list():
    cases = [
        ("temperature=-10degC:40degC:6", (-10.0, 0.0, 10.0, 20.0, 30.0, 40.0)),
        ("temperature=40degC:-10degC:3", (-10.0, 15.0, 40.0)),
        ("temperature=273.15K:10:2", (0.0, 10.0)),
        ("molecules=100:400:4", (100, 200, 300, 400)),
        ("molecules=10:1000:3log", (10, 100, 1000)),
        ("molecules = 400, 1e2,200", (100, 200, 400)),
        ("molecules=7", (7,)),
        ("pressure=0.1bar:10bar:3log", (100.0, 1000.0, 10000.0)),
        ("start=maxwell", ("maxwell",)),
    ]
    for text, values in cases:
        (axis,) = parse_vary([text], PARAMETERS)
        assert axis.values == values
        assert [type(value) for value in axis.values] == [type(value) for value in values]


def test_a_row_of_even_ratios_has_even_ratios_in_absolute_units():
    (axis,) = parse_vary(["temperature=100K:400K:3log"], PARAMETERS)
    assert axis.si == pytest.approx((100.0, 200.0, 400.0), rel=1e-12)


def test_what_cannot_vary_is_refused_with_what_to_type():
    cases = [
        ("temperature", SettingError, 'has no "="'),
        ("=1:2:3", SettingError, "has no name"),
        ("temperature=", SettingError, "has no values"),
        ("temperature=1:2", UnitError, "neither a:b:n"),
        ("temperature=1:2:3:4", UnitError, "neither a:b:n"),
        ("temperature=1:2:x", UnitError, "neither a:b:n"),
        ("temperature=1:2:1", SettingError, "asks for 1 values"),
        ("temperature=1:2:100000", SettingError, "from 2 to 10000"),
        ("temperature=2:2:3", SettingError, "begins where it ends"),
        ("temperature=1:-300:3", SettingError, "below the lowest"),
        ("temperature=5m:6m:3", UnitError, "is a length"),
        ("temperature=1,2,1", SettingError, "names a value twice"),
        ("temperature=nan:2:3", UnitError, "not finite"),
        ("molecules=100:102:9", SettingError, "only 3 different values"),
        ("molecules=1.5,2", UnitError, "not whole"),
        ("start=fast", SettingError, "is not one of"),
        ("seed=1:5:5", SettingError, "--members"),
    ]
    for text, error, sentence in cases:
        with pytest.raises(error, match=sentence) as refused:
            parse_vary([text], PARAMETERS)
        assert type(refused.value) is error
        assert "give --" in str(refused.value)
        assert "--set" not in str(refused.value)


def test_the_example_of_a_refusal_can_be_typed():
    for scene in scenarios.names():
        parameters = {p.name: p for p in scenarios.load(scene).Settings.describe()}
        for name in parameters.keys() - {"seed"}:
            with pytest.raises(SettingError) as refused:
                parse_vary([f"{name}="], parameters)
            example = str(refused.value).rpartition("give --vary ")[2].rstrip(".")
            assert parse_vary([example], parameters)


@given(st.text(max_size=30), st.sampled_from(["temperature", "molecules", "start", "pressure"]))
def test_any_text_is_understood_or_refused_in_a_sentence(text, name):
    try:
        (axis,) = parse_vary([f"{name}={text}"], PARAMETERS)
        said = "."
    except SettingError as error:
        said, axis = str(error), None
    assert "\n" not in said
    assert said.endswith(".")
    assert axis is None or len(set(axis.values)) == len(axis.values) > 0


@given(
    st.floats(-200.0, 1900.0),
    st.floats(-200.0, 1900.0),
    st.integers(2, 40),
    st.sampled_from(["", "log", "lin", " log"]),
)
def test_a_row_has_its_ends_its_number_and_an_order(first, last, n, spacing):
    try:
        (axis,) = parse_vary([f"temperature={first!r}:{last!r}:{n}{spacing}"], PARAMETERS)
    except SettingError:
        assert first == last or abs(first - last) < 1e-9 * max(abs(first), abs(last), 1e-300)
    else:
        assert (axis.values[0], axis.values[-1]) == (min(first, last), max(first, last))
        assert len(axis.values) == n
        assert list(axis.values) == sorted(axis.values)


def test_a_sweep_is_refused_before_anything_runs():
    cases = [
        ({"vary": []}, SettingError, "is not given"),
        ({"vary": ["temprature=1:2:3"]}, UnknownSettingError, "--vary temperature="),
        ({"settings": {"molecule": 3}}, UnknownSettingError, "--set molecules="),
        ({"settings": {"molecules": 3}}, SettingError, "leave out --set molecules"),
        ({"vary": ["molecules=1,2", "molecules=3,4"]}, SettingError, "given twice"),
        ({"members": 0}, SettingError, "give --members 8"),
        ({"members": 10**6}, SettingError, "vary fewer"),
        ({"engine": "magic"}, SettingError, "magic"),
        ({"accuracy": "perfect"}, SettingError, "perfect"),
        ({"settings": {"pressure": "5 m"}}, UnitError, "is a length"),
    ]
    for words, error, sentence in cases:
        with pytest.raises(error, match=sentence):
            plan("temperature", words.pop("vary", ["molecules=10,20"]), **words)


def test_an_accuracy_picks_an_engine_at_each_point():
    grid = plan("temperature", ["molecules=200,400"], accuracy="sketch")
    assert all(grid.engines)
    assert grid.engine is None
    assert grid.request()["--accuracy"] == "sketch"
    assert {task.accuracy for task in grid.tasks()} == {"sketch"}


def test_seeds_are_those_of_the_documented_rule_and_all_different():
    state = np.random.SeedSequence(7, spawn_key=(3, 2)).generate_state(1, np.uint64)
    assert member_seed(7, 3, 2) == int(state[0]) >> 11
    seeds = [member_seed(1, point, member) for point in range(1, 101) for member in range(1, 21)]
    assert len(set(seeds)) == len(seeds)
    assert max(seeds) < 2**53
    # The mean of 2000 uniform numbers is within 4 standard errors of a half, but for one seed of a sweep in 16 000.
    assert abs(np.mean(seeds) / 2**53 - 0.5) < 4.0 / math.sqrt(12.0 * len(seeds))


def test_every_point_gets_its_first_member_before_any_gets_a_second():
    grid = plan("temperature", ["molecules=10,20", "temperature=0,10"], members=2)
    assert [(task.point, task.member) for task in grid.tasks()] == [(p, m) for m in (1, 2) for p in (1, 2, 3, 4)]
    assert grid.values(3) == {"molecules": 20, "temperature": 0.0}


def test_the_error_of_a_mean_is_from_the_scatter_where_there_is_enough_of_it():
    # 2000 points of 4 members: the mean square of the errors is within 4 of its own (one false alarm in 16 000 seeds).
    rng = np.random.default_rng(3)
    value = 2.0 * rng.normal(size=(2000, 4))
    mean, error = mean_and_error(value, np.full(value.shape, 50.0))
    assert np.allclose(mean, value.mean(axis=1))
    assert abs(np.mean(error**2) - 1.0) < 4.0 * math.sqrt(2.0 / 3.0 / 2000.0)
    _, few = mean_and_error(value[:, :2], np.full((2000, 2), 3.0))
    assert np.allclose(few, 3.0 / math.sqrt(2.0))
    assert np.isnan(mean_and_error(np.full((1, 5), np.nan), np.ones((1, 5)))).all()


def test_a_sweep_holds_what_single_runs_find(tmp_path):
    grid = plan("elastic-collisions", ["molecules=10,20", "speed=0.5,1"], settings=QUICK, members=2, seed=5)
    found = sweep(grid, tmp_path / "discs.nc", jobs=1).dataset
    assert dict(found.sizes) == {"molecules": 2, "speed": 2, "member": 2}
    one = runner.execute(
        runner.prepare("elastic-collisions", {**QUICK, "molecules": 20, "speed": 1, "seed": member_seed(5, 4, 2)})
    )
    here = found.sel(molecules=20.0, speed=1.0)
    assert here.member_seed.values.tolist() == [member_seed(5, 4, 1), member_seed(5, 4, 2)]
    for headline in one.headlines:
        assert here[f"{headline.name}_by_member"].values[1] == headline.value
        assert here[f"{headline.name}_by_member_se"].values[1] == headline.standard_error
        assert here[headline.name].item() == pytest.approx(here[f"{headline.name}_by_member"].values.mean())
    assert here.energy_of_light_discs_theory.item() == 1.0
    assert found.molecules.attrs["long_name"] == "number of discs"
    again = read(tmp_path / "discs.nc")
    assert again.identical(read(tmp_path / "discs.nc"))
    assert np.array_equal(again.energy_of_light_discs_by_member, found.energy_of_light_discs_by_member)
    assert json.loads(again.attrs["atmosbox_parameters"])["sweep"]["members"] == 2
    assert not list(tmp_path.glob("*.part*"))


def test_the_same_seed_gives_the_same_file_in_whatever_order(tmp_path, monkeypatch):
    """Nor does it matter how many processes compute it, as the sweep that is killed below shows."""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    grid = plan("elastic-collisions", ["molecules=10,20"], settings=QUICK, members=2)
    for name in ("one", "two"):
        assert sweep(grid, tmp_path / f"{name}.nc", jobs=1).computed == 4
    # HDF5 itself notes the second in which a file was made: all else is the same
    first = read(tmp_path / "one.nc")
    assert first.identical(read(tmp_path / "two.nc"))
    backwards = assemble(grid, [member.run(task) for task in grid.tasks()[::-1]])
    assert backwards.drop_attrs().identical(first.drop_attrs())


@pytest.mark.skipif(CHECKER is None, reason="no checker")
def test_the_file_keeps_to_the_conventions_with_words_switches_units_and_failures(tmp_path):
    types = ["pressure=500,1000", "start=equal,maxwell", "temperature=0,20"]
    grid = plan("temperature", types, members=2)
    headline = {
        "name": "mean_temperature", "value": 280.0, "standard_error": 1.0, "theory": 281.0, "tolerance": 0.0,
        "reason": "none", "unit": "K", "display_unit": "degC", "label": "temperature",
    }  # fmt: skip
    about = {"seed": 1, "status": "complete", "ledger": 1e-15, "headlines": [headline]}
    records = [{**about, "point": point, "member": 1} for point in range(1, 8)]
    records.append({"point": 8, "member": 1, "seed": 1, "status": "failed", "reason": "It stalled."})
    file = write(assemble(grid, records, history=["now: this test"]), tmp_path / "grid.nc")
    found = read(file)
    assert found.member_reason.astype(str).values[1, 1, 1].tolist() == ["It stalled.", ""]
    assert np.isnan(found.mean_temperature.values[1, 1, 1])
    write(assemble(plan("atmosphere", ["height=5,10", "duration=1,2"]), records[:1]), tmp_path / "column.nc")
    words = ["-t", check.CONVENTION, "-c", "strict", file, tmp_path / "column.nc"]
    done = subprocess.run([CHECKER, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_failed_member_is_missing_with_its_reason_and_the_others_are_not_lost(scene, tmp_path):
    file = tmp_path / "discs.nc"
    done = typed(scene, "--vary", "trouble=0,1,2", "--members", "2", "--jobs", "1", "--out", file)
    assert done.exit_code == 1, done.output
    assert "4 of 6 runs failed" in done.output
    assert "trouble=2, member 2 (The discs have stalled)" in done.output
    found = read(file)
    assert np.isfinite(found.energy_of_light_discs.values).tolist() == [True, False, False]
    assert found.member_status.values.tolist() == [[0, 0], [1, 1], [1, 1]]
    reasons = found.member_reason.astype(str).values
    assert reasons[0, 0] == ""
    assert "is no setting to run with" in reasons[1, 0]
    assert reasons[2, 1] == "The discs have stalled."


def test_a_sweep_none_of_whose_points_can_run_is_refused(scene):
    with pytest.raises(SettingError, match="no setting to run with"):
        plan(scene, ["trouble=1"])


def test_a_worker_that_dies_takes_no_other_run_with_it(scene, tmp_path):
    done = typed(scene, "--vary", "trouble=0,3", "--jobs", "2", "--out", tmp_path / "a.nc", "--json")
    assert done.exit_code == 1, done.output
    assert "1 of 2 runs failed" in done.stderr
    assert "died 2 times (signal 9)" in done.stderr
    assert sorted(begun(scene).values()) == [1, 2]
    found = json.loads(done.stdout)
    assert found["points"][0]["headlines"]["energy_of_light_discs"]["mean"] > 0.0
    assert found["points"][1]["headlines"]["energy_of_light_discs"]["mean"] is None


def test_a_ledger_that_does_not_close_is_a_failure_of_physics(tmp_path, monkeypatch):
    monkeypatch.setattr(runner, "LEDGER_LIMIT", -1.0)
    words = ["--vary", "molecules=10,20", "--set", "duration=2s", "--jobs", "1", "--out", tmp_path / "discs.nc"]
    done = typed("elastic-collisions", *words)
    assert done.exit_code == 3
    assert "member_ledger" in done.stderr


def test_ctrl_c_keeps_what_is_complete_and_the_same_again_goes_on(scene, tmp_path):
    file = tmp_path / "discs.nc"
    grid = plan(scene, ["molecules=10,20,30"], members=2)
    with pytest.raises(SweepInterrupted) as stop:
        sweep(grid, file, jobs=1, progress=stop_after(2, 6))
    assert stop.value.swept.computed == 2
    part = read(part_path(file))
    assert part.attrs["atmosbox_status"] == "interrupted"
    assert np.isfinite(part.energy_of_light_discs_by_member.values).sum() == 2
    before = {record["seed"] for record in saved(file)}
    assert len(before) == 2
    remarks = []
    done = sweep(grid, file, jobs=1, note=remarks.append)
    assert (done.computed, done.recalled) == (4, 2)
    assert "2 of 6 runs are saved" in remarks[0]
    assert all(begun(scene)[seed] == 1 for seed in before)
    assert sum(begun(scene).values()) <= 7
    assert not list(tmp_path.glob("discs.part*"))
    fresh = sweep(grid, jobs=1).dataset
    assert fresh.drop_attrs().identical(read(file).drop_attrs())


def test_the_command_ends_with_130_when_it_is_stopped(scene, tmp_path, monkeypatch):
    conduct = importlib.import_module("atmosbox.sweep.conduct")
    keep = conduct._Conductor._keep

    def stopping(self, record):
        keep(self, record)
        raise KeyboardInterrupt

    monkeypatch.setattr(conduct._Conductor, "_keep", stopping)
    done = typed(scene, "--vary", "molecules=10,20", "--jobs", "1", "--out", tmp_path / "a.nc")
    assert done.exit_code == 130
    assert "1 of 2 runs are saved, type the same again" in done.stderr


def test_another_sweep_is_refused_in_the_place_of_an_unfinished_one(tmp_path):
    first = {"scene": "elastic-collisions", "vary": ["molecules=10,20"], "settings": QUICK, "members": 2}
    with Journal(tmp_path / "a.nc", plan(**first).request(), "then"):
        pass
    for change, sentence in [
        ({"members": 3}, "with --members 2 and not 3"),
        ({"seed": 9}, "with --seed 1 and not 9"),
        ({"vary": ["molecules=10,30"]}, "with --vary molecules 10,20 and not 10,30"),
        ({"settings": {**QUICK, "side": 2}}, "with --set side not given and not 2m"),
        ({"engine": "stepped"}, "with --engine exact and not stepped"),
        ({"scene": "temperature", "settings": {"duration": 2}}, "elastic-collisions and not temperature"),
    ]:
        other = plan(**{**first, **change})
        with pytest.raises(FileError, match=sentence) as refused:
            Journal(tmp_path / "a.nc", other.request(), "now")
        assert "--force" in str(refused.value)
    with Journal(tmp_path / "a.nc", other.request(), "now", force=True) as journal:
        assert journal.history == ["now"]


def test_the_same_settings_in_other_words_are_the_same_sweep():
    first = plan("temperature", ["temperature=0degC:10degC:3"], settings={"pressure": "1000hPa"}, engine="exact")
    second = plan("temperature", ["temperature=283.15K,0,5"], settings={"pressure": "1 bar"})
    assert first.request() == second.request()


def test_a_scene_that_was_edited_makes_another_sweep(scene, tmp_path):
    with Journal(tmp_path / "a.nc", plan(scene, ["molecules=10,20"]).request(), "then"):
        pass
    scene.write_text(f"{SCENE}\n", encoding="utf-8")
    with pytest.raises(FileError, match="for which the content of"):
        Journal(tmp_path / "a.nc", plan(scene, ["molecules=10,20"]).request(), "now")


def test_two_sweeps_never_write_one_journal(tmp_path):
    pytest.importorskip("fcntl")
    with Journal(tmp_path / "a.nc", {}, "one"), pytest.raises(FileError, match="written by another sweep"):
        Journal(tmp_path / "a.nc", {}, "two")


def test_a_file_that_is_no_journal_is_not_thrown_away(tmp_path):
    (tmp_path / "a.part.jsonl").write_text("a diary\n", encoding="utf-8")
    with pytest.raises(FileError, match="no journal of a sweep"):
        Journal(tmp_path / "a.nc", {}, "now")
    assert (tmp_path / "a.part.jsonl").read_text(encoding="utf-8") == "a diary\n"


def test_a_full_disk_ends_the_sweep_with_what_was_saved_kept(tmp_path, monkeypatch):
    grid = plan("elastic-collisions", ["molecules=10,20,30"], settings=QUICK)
    real, calls = os.fsync, []

    def full(descriptor):
        calls.append(descriptor)
        if len(calls) == 4:  # the first line and two runs have been written
            raise OSError(errno.ENOSPC, "No space left on device")
        real(descriptor)

    with monkeypatch.context() as patch:
        # writes of the journal only: on a slow computer the states of runs are written in between
        patch.setattr("atmosbox.file.journal.os", SimpleNamespace(**{**vars(os), "fsync": full}))
        with pytest.raises(DiskFullError, match=r"a\.part\.jsonl, which stays as it was"):
            sweep(grid, tmp_path / "a.nc", jobs=1)
    assert len(saved(tmp_path / "a.nc")) == 2
    done = sweep(grid, tmp_path / "a.nc", jobs=1)
    assert (done.computed, done.recalled) == (1, 2)


def test_the_command_says_the_points_beside_theory(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = typed("elastic-collisions", "--vary", "molecules=10,20", "--set", "duration=2s", "--jobs", "1")
    assert done.exit_code == 0, done.output
    assert "energy of a light disc over the mean" in done.stdout
    assert "next: atmosbox plot elastic-collisions-sweep.nc" in done.stdout
    quiet = typed("elastic-collisions", "--vary", "molecules=10", "--set", "duration=2s", "--quiet", "--force")
    assert quiet.stdout == "elastic-collisions-sweep.nc\n"
    assert quiet.stderr == ""


def test_a_dry_run_shows_the_points_and_writes_nothing(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words = ["temperature", "--vary", "temperature=0degC:10degC:2", "--vary", "start=equal,maxwell", "--dry-run"]
    done = typed(*words, "--members", "3")
    assert done.exit_code == 0, done.output
    assert "runs: 12, 3 at each of 4 points" in done.stdout
    assert json.loads(typed(*words, "--json").stdout)["points"][3] == {"temperature": 10.0, "start": "maxwell"}
    assert not list(tmp_path.iterdir())


def test_what_the_command_cannot_do_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for words, sentence in [
        (["--jobs", "0"], "give --jobs 1"),
        (["--members", "many"], "give --members 8"),
        (["--seed", "-1"], "give --seed 0"),
        (["--jobs", "2", "--scheduler", "tcp://127.0.0.1:1"], "leave one of them out"),
        (["--out", "figure.png"], "name of a figure"),
    ]:
        done = typed("elastic-collisions", "--vary", "molecules=10,20", *words)
        assert done.exit_code == 2
        assert sentence in done.stderr
    assert not list(tmp_path.iterdir())


def stopped_half_way(task, at):
    """Run a member, and stop it, as by Ctrl-C, at a share of the run."""

    def show(share, word):
        if word == "running" and share >= at:
            raise KeyboardInterrupt

    with pytest.raises(runner.Interrupted):
        member.run(task, show)


def test_a_member_goes_on_within_its_run_and_finds_the_same(tmp_path, monkeypatch):
    monkeypatch.setattr(runner, "_BREATH", 0.0)
    grid = plan("elastic-collisions", ["molecules=20,40"], settings={"duration": 5.0})
    states = RunStates(tmp_path / "a.nc")
    for task in grid.tasks():
        kept = task._replace(state=states.place(task.point, task.member))
        stopped_half_way(kept, 0.5)
        shares = []
        assert member.run(kept, lambda share, word, into=shares: into.append(share)) == member.run(task)
        assert min(shares[1:]) >= 0.4
    assert RunStates(tmp_path / "a.nc").begun == 2
    assert RunStates(tmp_path / "a.nc", [(1, 1)]).begun == 1  # killed between the journal and the state
    assert sweep(grid, tmp_path / "a.nc", jobs=1).computed == 2
    assert [each.name for each in tmp_path.iterdir()] == ["a.nc"]


@pytest.mark.parametrize("damage", ["other settings", "cut", "no folder", "in use", "full disk"])
def test_a_state_that_does_not_serve_costs_no_run(tmp_path, monkeypatch, damage):
    monkeypatch.setattr(runner, "_BREATH", 0.0)
    monkeypatch.setattr(continuation, "_PATIENCE", 0.1)
    first, second = plan("elastic-collisions", ["molecules=20,40"], settings={"duration": 5.0}).tasks()
    states = RunStates(tmp_path / "a.nc")
    task = second._replace(state=states.place(1, 1))
    part = part_path(task.state)
    stopped_half_way(task if damage != "other settings" else first._replace(state=task.state), 0.5)
    lock = None
    if damage == "cut":
        part.write_bytes(part.read_bytes()[:5000])
    elif damage == "no folder":
        shutil.rmtree(part.parent)
    elif damage == "in use":
        lock = OutputLock(Path(task.state))
    elif damage == "full disk":
        part.unlink()
        monkeypatch.setattr(Checkpoint, "save", raises(DiskFullError("The disk is full.")))
        stopped_half_way(task, 0.5)
    shares = []
    assert member.run(task, lambda share, word: shares.append(share)) == member.run(second)
    assert min(shares[1:]) < 0.1
    if lock is not None:
        lock.release()


def raises(error):
    def fail(*args, **words):
        raise error

    return fail


@pytest.mark.parametrize("jobs", [pytest.param(1, marks=pytest.mark.validate), 2])
def test_a_killed_sweep_goes_on_within_its_runs_computes_nothing_twice_and_leaves_no_process(scene, tmp_path, jobs):
    """kill -9 when two runs are saved and others half-way: the same command again gives the undisturbed results."""
    scene.write_text(HELD, encoding="utf-8")
    out = tmp_path / "out"
    out.mkdir()
    file = out / "discs.nc"
    words = ["sweep", str(scene), "--vary", "molecules=10,20,30,40", "--out", str(file), "--jobs"]
    process = subprocess.Popen(
        [sys.executable, "-m", "atmosbox", *words, str(jobs)],
        env={**os.environ, "PYTHONPATH": str(ROOT), "HOLD": "1"}, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
    )  # fmt: skip
    deadline = time.monotonic() + 120.0
    held = [out / "discs.part.states" / f"{point}-1.part.nc" for point in (3, 4)[:jobs]]
    while process.poll() is None and time.monotonic() < deadline:
        if len(saved(file)) == 2 and all(state.exists() for state in held):
            break
        time.sleep(0.02)
    process.send_signal(signal.SIGKILL)
    _, said = process.communicate()
    before = {record["seed"] for record in saved(file)}
    assert len(before) == 2, said
    assert all(state.exists() for state in held), said
    workers = {int(path.name.split("-")[2]) for path in tmp_path.glob("run-*")}
    while any(Path(f"/proc/{pid}").exists() for pid in workers) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not any(Path(f"/proc/{pid}").exists() for pid in workers)
    journal = file.with_name("discs.part.jsonl")
    journal.write_bytes(journal.read_bytes() + b'{"point": 1, "mem')
    done = in_process.typed(*words, "1")
    assert done.exit_code == 0, done.output
    assert f"2 of 4 runs are saved in {journal} and {jobs} begun" in done.stderr
    assert all(begun(scene)[seed] == 1 for seed in before)
    assert [each.name for each in out.iterdir()] == ["discs.nc"]
    found = read(file)
    history = found.attrs["history"].split("\n")
    assert [line.partition(": ")[2].split()[0] for line in history] == ["atmosbox", "atmosbox"]
    undisturbed = sweep(plan(scene, words[3:4]), jobs=1).dataset
    assert found.drop_attrs().identical(undisturbed.drop_attrs())
