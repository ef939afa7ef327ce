"""A run that was stopped, killed or finished is continued: the results are those of a run that was not stopped."""

import contextlib
import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import netCDF4
import numpy as np
import pytest

import atmosbox
from atmosbox import __version__, scenarios
from atmosbox.errors import FileError
from atmosbox.file.checkpoint import Checkpoint
from atmosbox.file.netcdf import read
from atmosbox.simulation import restart, runner
from tests.few_frames import FRAMES, cut, few_frames_of
from tests.in_process import refused, typed

RUNS = {  # scene, molecules and length of a small box, and of one that takes seconds, so that it can be killed; engine
    "discs": ("elastic-collisions", {"duration": ("5 s", "7500 s")}, (60, 400), None),
    "walls": ("temperature", {"duration": ("0.4 ns", "200 ns")}, (60, 4000), None),
    "applet": ("elastic-collisions", {"duration": ("5 s", "70 s")}, (60, 400), "stepped:applet-discs,delta=0.005"),
    "column": ("atmosphere", {"duration": (3, 1200)}, (200, 3000), None),
    "column by dsmc": ("atmosphere", {"duration": (3, 16000)}, (200, 4000), "dsmc"),
    "piston": ("lifting-dry", {"ascent": (50, 3000)}, (60, 8000), None),
    "in steps": ("lifting-dry", {"ascent": (30, 250)}, (60, 2000), "stepped:delta=0.005"),
    "mist": ("lifting-moist", {"ascent": (60, 2500)}, (200, 4000), None),
    "mist by dsmc": ("lifting-moist", {"ascent": (60, 2000)}, (200, 20000), "dsmc"),
    "attraction": ("attraction", {"duration": ("0.1 ns", "4 ns")}, (100, 2000), None),
    "liquid": ("condensation", {"duration": ("0.3 ns", "300 ns")}, (200, 2000), None),
    "drops": ("condensation", {"duration": ("0.3 ns", "200 ns"), "drops": (2, 2)}, (200, 2000), None),
    "rain": ("mountains", {"travel": (40, 2000)}, (200, 2000), None),
}


def settings_of(name, large=False):
    """Return the settings of a box."""
    _, lengths, molecules, _ = RUNS[name]
    return {"molecules": molecules[large]} | {key: value[large] for key, value in lengths.items()}


KILLS = 56  # four for each box; if some boxes finish before their last kill, fifty kills are still made


class Stop(KeyboardInterrupt):
    """Simulates Ctrl-C at a moment that a test chooses."""


def content(path):
    """Return every variable with its bytes and attributes, and every attribute of a file, in any order."""
    with netCDF4.Dataset(path) as file:
        file.set_auto_maskandscale(False)
        held = {name: str(file.getncattr(name)) for name in file.ncattrs()}
        for name, each in file.variables.items():
            said = {key: str(each.getncattr(key)) for key in each.ncattrs()}
            values = np.asarray(each[...])
            held[name] = values.tolist() if values.dtype == object else values.tobytes(), each.dimensions, said
    return held


FEWER = {scene: frames for scene, frames in FRAMES.items() if scene != "temperature"}
few_frames = few_frames_of(FEWER | {"elastic-collisions": (60, 20), "mountains": (24, None)})
"""The runs in this process have few frames, but for those that are compared with runs in another one."""


@pytest.fixture(autouse=True)
def same_date(monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    monkeypatch.setattr(runner, "_BREATH", 0.0)


def stopping(shares):
    """Return a progress function that stops a run at given shares of it."""
    left = sorted(shares)

    def progress(share, word):
        if left and word == "running" and share >= left[0]:
            left.pop(0)
            raise Stop

    return progress


@pytest.mark.parametrize("name", RUNS)
def test_a_run_that_was_stopped_goes_on_bit_for_bit(name, tmp_path, monkeypatch):
    scene, _, _, engine = RUNS[name]
    monkeypatch.setattr(runner, "_BREATH", 0.0)
    cut(monkeypatch, {"temperature": (60, 10)})
    prepared = runner.prepare(scene, settings_of(name), engine=engine, save_molecules=name in ("walls", "drops"))
    runner.execute(prepared, checkpoint=Checkpoint(tmp_path / "whole.nc"), command="a test")
    checkpoint = Checkpoint(tmp_path / "stopped.nc", every_seconds=0.0)
    halts = stopping([0.3, 0.75])
    with pytest.raises(runner.Interrupted):
        runner.execute(prepared, checkpoint=checkpoint, command="a test", progress=halts)
    stops = 1
    while not checkpoint.path.exists():
        found = restart.read_state(checkpoint.part)
        again = runner.prepared_again(found)
        try:
            runner.execute(again, checkpoint=checkpoint, restart=found, progress=halts)
        except runner.Interrupted:
            stops += 1
    assert stops == 2
    assert content(tmp_path / "stopped.nc") == content(tmp_path / "whole.nc")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["stopped.nc", "whole.nc"]


OFTEN = """
from atmosbox.cli import main
from atmosbox.file import checkpoint
checkpoint.Checkpoint.__init__.__defaults__ = (0.05,)
main()
"""
"""The command, changed to save its first state after 0.05 s, so that a run of a second can be killed after that."""


def started(words, folder, *program):
    """Start the real command, or a program, in a separate folder."""
    folder.mkdir(exist_ok=True)
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    return subprocess.Popen(
        [sys.executable, *(program or ("-m", "atmosbox")), *words], cwd=folder, env=environment, stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
    )  # fmt: skip


def killed_again_and_again(words, folder, kills, draw, *program):
    """Run the command, kill it at random moments, and resume it each time; return at which stage each kill struck.

    Every second kill waits for a state that is newer than the one from which the process was resumed, so that the run
    comes to its end; the others come at random: while Python starts, while the state is loaded, while the engine runs,
    or while a file is written.
    """
    part, struck = folder / "x.part.nc", []
    now = words
    while not (folder / "x.nc").exists():
        with started(now, folder, *program) as process:
            old = part.stat().st_mtime_ns if part.exists() else 0
            if len(struck) < kills:
                patient = len(struck) % 2 == 0
                waits = draw.uniform(0.0, 0.3 if patient else 3.0)
                while patient and process.poll() is None and (not part.exists() or part.stat().st_mtime_ns == old):
                    time.sleep(0.01)
                with contextlib.suppress(subprocess.TimeoutExpired):
                    process.wait(waits)
                if process.poll() is None:
                    process.send_signal(signal.SIGKILL)
                    struck.append("after a state" if patient else "anywhere")
            _, said = process.communicate()
        assert process.returncode in (0, 3, -signal.SIGKILL), said
        now = ["run", "--resume", "x.part.nc", "--quiet"] if part.exists() else words
    return struck


def test_the_command_killed_at_a_random_moment_goes_on_bit_for_bit(tmp_path):
    """kill -9, like switching off the computer: the run continues from the last saved state."""
    words = ["run", "temperature", "--set", "molecules=2500", "--quiet", "--out", "x.nc"]
    whole = tmp_path / "whole.nc"
    prepared = runner.prepare("temperature", {"molecules": 2500}, save_molecules=None)
    runner.execute(prepared, checkpoint=Checkpoint(whole), command=" ".join(["atmosbox", *words]))
    killed = tmp_path / "killed"
    assert killed_again_and_again(words, killed, 1, random.Random(17), "-c", OFTEN)
    assert content(killed / "x.nc") == content(whole)
    assert [each.name for each in killed.iterdir()] == ["x.nc"]


@pytest.mark.soak
def test_fifty_kills_of_the_command_change_nothing(tmp_path, request):
    """All engines and kinds of liquid; the moments differ each time, and are printed."""
    seed = random.SystemRandom().randrange(2**32)
    report = request.config.getoption("--soak-report")
    total = 0
    for place, name in enumerate(RUNS):
        kills = KILLS // len(RUNS) + (place < KILLS % len(RUNS))
        scene, _, _, engine = RUNS[name]
        values = [
            word for pair in settings_of(name, large=True).items() for word in ("--set", "=".join(map(str, pair)))
        ]
        words = ["run", scene, *values, *(["--engine", engine] if engine else []), "--quiet", "--out", "x.nc"]
        with started(words, tmp_path / f"{place}-whole") as process:
            _, said = process.communicate()
        assert (tmp_path / f"{place}-whole" / "x.nc").exists(), said
        killed = tmp_path / f"{place}-killed"
        struck = killed_again_and_again(words, killed, kills, random.Random(seed + place))
        total += len(struck)
        same = content(killed / "x.nc") == content(tmp_path / f"{place}-whole" / "x.nc")
        left = sorted(each.name for each in killed.iterdir())
        if report:
            facts = {"killed": name, "kills": len(struck), "seed": seed + place, "same": same, "left": left}
            with open(report, "a", encoding="utf-8") as file:
                file.write(json.dumps(facts) + "\n")
        assert same, (name, seed)
        assert left == ["x.nc"]
    assert total >= 50


@pytest.fixture
def part(tmp_path):
    """The part of a run of discs that was stopped half-way."""
    prepared = runner.prepare("elastic-collisions", {"duration": "5 s"})
    checkpoint = Checkpoint(tmp_path / "x.nc")
    with pytest.raises(runner.Interrupted):
        runner.execute(prepared, checkpoint=checkpoint, progress=stopping([0.5]))
    return checkpoint.part


def test_a_run_does_not_go_on_where_what_made_it_has_changed(part):
    for changed, said in [
        ({"version": "0.0.9"}, "version (0.0.9, now"),
        ({"format of the state": 99}, "format of the state (99, now 3)"),
        ({"sources of the engine": "other"}, "sources of the engine (other, now"),
        ({"content of the scene": "other"}, "content of the scene (other, now"),
        ({"processor": "vax"}, "processor (vax, now"),
    ]:
        found = restart.read_state(part)
        prepared = runner.prepared_again(found)
        restart.check_alike(found, prepared)
        with pytest.raises(FileError) as refusal:
            runner.execute(prepared, restart=found._replace(about=found.about | changed))
        assert said in str(refusal.value)


def test_what_holds_no_state_or_a_damaged_one_is_refused(part, tmp_path):
    atmosbox.run("elastic-collisions", duration="2 s", out=tmp_path / "done.nc")
    assert "done.nc is finished: type atmosbox run --from" in refused(typed("run", "--resume", tmp_path / "done.nc"))
    with netCDF4.Dataset(part) as file:
        whole = np.asarray(file.variables["atmosbox_state"][:])
        attributes = {name: file.getncattr(name) for name in file.ncattrs() if name != "atmosbox_headlines"}
    damages = {
        "empty": whole[:0],
        "cut": whole[: len(whole) // 2],
        "head": np.concatenate([whole[:30], whole[31:]]),
        "nested": np.frombuffer((3000).to_bytes(8, "little") + b"[" * 3000, np.uint8),
        "objects": np.frombuffer(bytes(whole).replace(b"'|u1'", b"'|O' ", 1), np.uint8),
    }
    for name, bytes_ in damages.items():
        odd = tmp_path / f"{name}.part.nc"
        with netCDF4.Dataset(odd, "w") as file:
            file.setncatts(attributes)
            file.createDimension("byte", len(bytes_))
            file.createVariable("atmosbox_state", "u1", ("byte",))[:] = bytes_
        assert "damaged" in refused(typed("run", "--resume", odd)), name
    with netCDF4.Dataset(part, "r+") as file:
        file.delncattr("history")
    assert "damaged" in refused(typed("run", "--resume", part))


def test_the_state_of_a_scene_of_ones_own_needs_its_path_typed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    source = Path(scenarios.load("elastic-collisions").__file__).read_text(encoding="utf-8")
    Path("mine.py").write_text(source, encoding="utf-8")
    prepared = runner.prepare("./mine.py", {"duration": "5 s"})
    with pytest.raises(runner.Interrupted):
        runner.execute(prepared, checkpoint=Checkpoint("x.nc"), progress=stopping([0.5]))
    assert "atmosbox run ./mine.py --resume x.part.nc" in refused(typed("run", "--resume", "x.part.nc"))
    assert typed("run", "./mine.py", "--resume", "x.part.nc").exit_code == 0


def test_a_run_whose_instruments_keep_what_no_file_can_hold_says_so_and_saves_its_frames(tmp_path, monkeypatch):
    prepared = runner.prepare("elastic-collisions", {"duration": "5 s"})
    true = runner.build

    def odd(prepared):
        setup = true(prepared)
        setup.instruments[0].seen = {1, 2}
        return setup

    monkeypatch.setattr(runner, "build", odd)
    checkpoint = Checkpoint(tmp_path / "x.nc")
    with pytest.warns(UserWarning, match=r"instruments\.0\.seen"), pytest.raises(runner.Interrupted):
        runner.execute(prepared, checkpoint=checkpoint, progress=stopping([0.5]))
    assert read(checkpoint.part).sizes["elapsed_time"] > 0
    assert "holds no state" in refused(typed("run", "--resume", checkpoint.part))


@pytest.mark.parametrize(
    "turns",
    [
        "scene=temperature&molecules=60&duration=1&seed=1&turns=5:temperature:300,40:temperature:start,80:temperature:60",
        pytest.param(
            "scene=lifting-dry&molecules=60&ascent=40&seed=1&turns=5:altitude:3,40:altitude:1.5,50:altitude:start",
            marks=pytest.mark.nightly,
        ),
    ],
)
def test_a_replayed_run_that_was_stopped_turns_the_other_knobs_when_it_goes_on(turns, tmp_path):
    prepared = runner.replayed(f"#atmosbox={__version__}&{turns}&frames=100&end")
    runner.execute(prepared, checkpoint=Checkpoint(tmp_path / "whole.nc"), command="a test")
    checkpoint = Checkpoint(tmp_path / "stopped.nc", every_seconds=0.0)
    with pytest.raises(runner.Interrupted):
        runner.execute(prepared, checkpoint=checkpoint, command="a test", progress=stopping([0.455]))
    found = restart.read_state(checkpoint.part)
    runner.execute(runner.prepared_again(found), checkpoint=checkpoint, restart=found)
    assert content(tmp_path / "stopped.nc") == content(tmp_path / "whole.nc")
