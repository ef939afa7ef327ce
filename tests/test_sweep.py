"""Sweeps: settings that vary, seeds, joined results, runs that are not repeated, refusals, processes that die."""

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

import numpy as np
import pytest

from atmosbox import scenarios
from atmosbox.errors import FileError, SettingError, UnitError, UnknownSettingError
from atmosbox.file.netcdf import read
from atmosbox.simulation import runner
from atmosbox.sweep import member_seed, parse_vary, plan, sweep
from atmosbox.sweep.result import mean_and_error
from tests import in_process
from tests.few_frames import few_frames_of

ROOT = Path(__file__).resolve().parents[1]
CHECKER = shutil.which("compliance-checker", path=Path(sys.executable).parent)

SCENE = '''"""Discs, some of which have trouble."""

import os
import signal
import time
from pathlib import Path

from atmosbox.scene.engines import EXACT
from atmosbox.errors import Option, EngineError, SettingError
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
    stop = Path(__file__).with_name("stop")
    if stop.exists() and settings.molecules > 20:
        number = int(stop.read_text())
        stop.unlink()
        signal.raise_signal(number)
    if settings.molecules > 20 and "HOLD" in os.environ:
        time.sleep(600)
    if Path(__file__).with_name("slow").exists():
        time.sleep(0.2)
    return discs.build(settings, engine)
'''

QUICK = {"duration": 2.0}


few_frames = few_frames_of({"elastic-collisions": (60, 20), "temperature": (60, 20), "atmosphere": (80, 14)})
"""The runs of discs have the few frames that they have in `SCENE`."""


@pytest.fixture
def scene(tmp_path):
    """The path of a user's own scene that writes a file for each box that it builds."""
    path = tmp_path / "discs.py"
    path.write_text(SCENE, encoding="utf-8")
    return path


def built(scene):
    """Return the number of times that the box of a run was built, by its seed."""
    return Counter(int(path.name.split("-")[1]) for path in scene.parent.glob("run-*"))


def typed(*words):
    return in_process.typed("sweep", *words)


SETTINGS = scenarios.load("temperature").Settings


def test_what_varies_is_typed_as_a_row_or_as_a_list():
    cases = [
        ("temperature=-10degC:40degC:6", (-10.0, 0.0, 10.0, 20.0, 30.0, 40.0)),
        ("temperature=40degC:-10degC:3", (-10.0, 15.0, 40.0)), ("temperature=273.15K:10:2", (0.0, 10.0)),
        ("molecules=100:400:4", (100, 200, 300, 400)), ("molecules=10:1000:3log", (10, 100, 1000)),
        ("molecules = 400, 1e2,200", (100, 200, 400)), ("molecules=7", (7,)),
        ("pressure=0.1bar:10bar:3log", (100.0, 1000.0, 10000.0)), ("start=maxwell", ("maxwell",)),
    ]  # fmt: skip
    for text, values in cases:
        (found,) = parse_vary([text], SETTINGS).values()
        assert found == values
        assert [type(value) for value in found] == [type(value) for value in values]


REFUSED = [
    ({"vary": []}, SettingError, 'is not given: give vary={"name": "a:b:n"}'),
    ({"vary": ["temperature"]}, SettingError, 'no values: give vary={"temperature": "a:b:n"}'),
    ({"vary": ["=1:2:3"]}, SettingError, 'has no name or no values: give vary={"name"'),
    ({"vary": ["temperature=1:2"]}, UnitError, 'a:b:nlog nor x,y,z: give vary={"temperature"'),
    ({"vary": ["temperature=1:2:3:4"]}, UnitError, "neither a:b:n"),
    ({"vary": ["temperature=1:2:x"]}, UnitError, "neither a:b:n"),
    ({"vary": ["temperature=1:2:" + "9" * 5000]}, UnitError, "neither a:b:n"),
    ({"vary": ["temperature=1:2:1"]}, UnitError, "with n from 2 to 100000"),
    ({"vary": ["temperature=1:2:900000"]}, UnitError, "with n from 2 to 100000"),
    ({"vary": ["temperature=2:2:3"]}, SettingError, "only 1 different values"),
    ({"vary": ["temperature=1:-300:3"]}, SettingError, "below the allowed range"),
    ({"vary": ["temperature=5m:6m:3"]}, UnitError, "is a length"),
    ({"vary": ["temperature=1,2,1"]}, SettingError, "names a value twice"),
    ({"vary": ["temperature=nan:2:3"]}, UnitError, "not finite"),
    ({"vary": ["molecules=100:102:9"]}, SettingError, "only 3 different values"),
    ({"vary": ["start=fast"]}, SettingError, 'is not one of maxwell, equal: give vary={"start": "maxwell,equal"}'),
    ({"vary": ["seed=1:5:5"]}, SettingError, "members=8"),
    ({"vary": ["temprature=1:2:3"]}, UnknownSettingError, 'vary={"temperature": "1:2:3"}'),
    ({"vary": ["molecules=1,2", "molecules=3,4"]}, SettingError, "varied twice"),
    ({"settings": {"molecule": 3}}, UnknownSettingError, "give molecules="),
    ({"settings": {"molecules": 3}}, SettingError, "leave out molecules"),
    ({"members": 0}, SettingError, "give members=1"),
    ({"members": 10**6}, SettingError, "vary fewer"),
    ({"engine": "magic"}, SettingError, "magic"),
    ({"accuracy": "perfect"}, SettingError, "perfect"),
]
"""What is asked for, the class of the error, and what its sentence must say: the value, and what to give."""


@pytest.mark.parametrize(("words", "error", "said"), REFUSED)
def test_what_cannot_be_swept_is_refused_before_anything_runs(words, error, said):
    with pytest.raises(error) as refused:
        plan("temperature", **{"vary": ["molecules=10,20"], **words})
    assert type(refused.value) is error
    assert said in str(refused.value)


def test_seeds_are_those_of_the_documented_rule_and_all_different():
    state = np.random.SeedSequence(7, spawn_key=(3, 2)).generate_state(1, np.uint64)
    assert member_seed(7, 3, 2) == int(state[0]) >> 11
    seeds = [member_seed(1, point, member) for point in range(1, 101) for member in range(1, 21)]
    assert len(set(seeds)) == len(seeds)
    assert max(seeds) < 2**53
    # The mean of 2000 uniform numbers is within 4 standard errors of a half, but for one seed of a sweep in 16 000.
    assert abs(np.mean(seeds) / 2**53 - 0.5) < 4.0 / math.sqrt(12.0 * len(seeds))


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
    found = sweep(grid, tmp_path / "discs.nc", jobs=1)
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
    assert np.array_equal(again.energy_of_light_discs_by_member, found.energy_of_light_discs_by_member)
    assert json.loads(again.attrs["atmosbox_parameters"])["sweep"]["members"] == 2
    alone = read(tmp_path / "discs" / "4-2.nc")
    assert float(alone.energy_of_light_discs) == one.headlines[0].value
    assert alone.attrs["atmosbox_status"] == "complete"


def test_the_same_seed_gives_the_same_file_on_one_process_or_several(scene, tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    grid = plan(scene, ["molecules=10,20"], members=2)
    for jobs in (1, 2):
        sweep(grid, tmp_path / f"{jobs}.nc", jobs=jobs)
    # HDF5 itself notes the second in which a file was made: all else is the same
    assert read(tmp_path / "1.nc").identical(read(tmp_path / "2.nc"))


@pytest.mark.skipif(CHECKER is None, reason="no checker")
def test_the_file_keeps_to_the_conventions_with_words_switches_units_and_failures(scene, tmp_path):
    quick = {"molecules": 20, "duration": 1.0}
    grids = {
        "failures": plan(scene, ["trouble=0,2"], members=2),
        "words": plan("temperature", ["pressure=500,1000", "start=equal,maxwell"], settings=quick),
        "heights": plan("atmosphere", ["height=5,10"], settings={"molecules": 50, "duration": 2}),
    }
    files = [tmp_path / f"{name}.nc" for name in grids]
    for grid, file in zip(grids.values(), files, strict=True):
        sweep(grid, file, jobs=1)
    words = ["-t", "cf:1.11", "-c", "strict", *files]
    done = subprocess.run([CHECKER, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_run_that_fails_is_told_and_takes_no_other_with_it(scene, tmp_path):
    """One run of three raises an error, and one kills its process; the command is given two processes."""
    with pytest.raises(SettingError, match=r"is no setting to run with \(at trouble=1\)"):
        plan(scene, ["trouble=0,1"])
    file = tmp_path / "discs-sweep.nc"
    done = typed(scene, "--vary", "trouble=0,2,3", "--jobs", "2", "--out", file, "--json")
    assert done.exit_code == 1, done.output
    assert "2 of 3 runs failed" in done.stderr
    assert "trouble=2, member 1 (The discs have stalled); trouble=3, member 1 (Its process died twice" in done.stderr
    means = [point["headlines"]["energy_of_light_discs"]["mean"] for point in json.loads(done.stdout)["points"]]
    assert means[0] > 0.0
    assert means[1:] == [None, None]
    found = read(file)
    assert np.isfinite(found.energy_of_light_discs.values).tolist() == [True, False, False]
    assert found.member_status.values.ravel().tolist() == [0, 1, 1]
    assert found.member_reason.astype(str).values[1].tolist() == ["The discs have stalled."]
    assert max(built(scene).values()) == 2, "the run that killed its process was begun twice"
    assert sorted(path.name for path in (tmp_path / "discs-sweep").glob("*.nc")) == ["1-1.nc"]


@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGINT, 130), pytest.param(signal.SIGTERM, 143, marks=pytest.mark.nightly)]
)
def test_a_stopped_sweep_goes_on_and_finds_the_same(scene, tmp_path, number, status):
    """The third of six runs is stopped; then the same call, and one with more members."""
    file = tmp_path / "a.nc"
    words = [scene, "--vary", "molecules=10,20,30", "--members", "2", "--jobs", "1", "--out", file]
    (tmp_path / "stop").write_text(str(int(number)), encoding="utf-8")
    stopped = typed(*words)
    assert stopped.exit_code == status, stopped.output
    assert "2 of 6 runs are saved" in stopped.stderr
    before, shares = set(built(scene)), []
    grid = plan(scene, ["molecules=10,20,30"], members=2)
    done = sweep(grid, file, jobs=1, progress=lambda share, word: shares.append(round(6 * share)))
    assert shares == [2, 3, 4, 5, 6]
    assert sorted(built(scene)[seed] for seed in before) == [1, 1, 2], "only the run that was stopped begins again"
    fresh = sweep(grid, jobs=1)
    assert fresh.drop_attrs().identical(done.drop_attrs())
    assert fresh.drop_attrs().identical(read(file).drop_attrs())
    again = len(list(tmp_path.glob("run-*")))
    sweep(plan(scene, ["molecules=10,20,30"], members=3), file, jobs=1)
    assert len(list(tmp_path.glob("run-*"))) == again + 3


def test_another_sweep_never_takes_the_place_of_one(scene, tmp_path):
    first = {"scene": scene, "vary": ["molecules=10,20"], "settings": QUICK, "members": 1}
    file = tmp_path / "a.nc"
    sweep(plan(**first), file, jobs=1)
    for change, sentence in [
        ({"seed": 9}, "with setting seed 1 and not 9"),
        ({"vary": ["molecules=10,30"]}, "with vary"),
        ({"settings": {**QUICK, "side": 2}}, "with setting side .* and not 2"),
        ({"engine": "stepped"}, "with engine"),
    ]:
        with pytest.raises(FileError, match=sentence) as refused:
            sweep(plan(**{**first, **change}), file, jobs=1)
        assert "force=True" in str(refused.value)
    scene.write_text(f"{SCENE}\n", encoding="utf-8")
    with pytest.raises(FileError, match="with content of"):
        sweep(plan(**first), file, jobs=1)
    before = len(list(tmp_path.glob("run-*")))
    sweep(plan(**first), file, jobs=1, force=True)
    assert len(list(tmp_path.glob("run-*"))) == before + 2
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "diary.txt").touch()
    with pytest.raises(FileError, match="holds other things than a sweep"):
        sweep(plan(**first), tmp_path / "b.nc", jobs=1)


def test_the_command_says_the_points_beside_theory(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = typed("elastic-collisions", "--vary", "molecules=10,20", "--set", "duration=2s", "--jobs", "1")
    assert done.exit_code == 0, done.output
    assert "energy of a light disc / mean energy" in done.stdout
    assert "next: atmosbox plot elastic-collisions-sweep.nc" in done.stdout
    assert max(map(len, done.stdout.splitlines())) <= 80
    again = typed("elastic-collisions", "--vary", "molecules=10,20", "--set", "duration=2s", "--jobs", "1")
    assert "2 of 2 runs are saved" in again.stderr
    other = typed("elastic-collisions", "--vary", "molecules=10,30", "--set", "duration=2s", "--jobs", "1")
    assert "file: elastic-collisions-sweep-2.nc" in other.stdout
    quiet = typed("elastic-collisions", "--vary", "molecules=10", "--set", "duration=2s", "--quiet", "--force")
    assert quiet.stdout == "elastic-collisions-sweep.nc\n"
    assert quiet.stderr == ""


def test_a_killed_sweep_leaves_no_process_and_computes_nothing_twice(scene, tmp_path):
    """kill -9 when two runs are saved and two others are under way: the same command again gives the same results."""
    file = tmp_path / "discs-sweep.nc"
    words = ["sweep", str(scene), "--vary", "molecules=10,20,30,40", "--out", str(file), "--jobs"]
    process = subprocess.Popen(
        [sys.executable, "-m", "atmosbox", *words, "2"],
        env={**os.environ, "PYTHONPATH": str(ROOT), "HOLD": "1"}, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
    )  # fmt: skip
    deadline = time.monotonic() + 120.0
    runs = [tmp_path / "discs-sweep" / f"{point}-1.nc" for point in (1, 2)]
    while (
        process.poll() is None
        and time.monotonic() < deadline
        and not (all(run.exists() for run in runs) and len(built(scene)) == 4)
    ):
        time.sleep(0.02)
    process.send_signal(signal.SIGKILL)
    _, said = process.communicate()
    assert all(run.exists() for run in runs), said
    workers = {int(path.name.split("-")[2]) for path in tmp_path.glob("run-*")}
    while any(Path(f"/proc/{pid}").exists() for pid in workers) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not any(Path(f"/proc/{pid}").exists() for pid in workers)
    done = in_process.typed(*words, "1")
    assert done.exit_code == 0, done.output
    assert "2 of 4 runs are saved" in done.stderr
    undisturbed = sweep(plan(scene, words[3:4]), jobs=1)
    assert read(file).drop_attrs().identical(undisturbed.drop_attrs())
