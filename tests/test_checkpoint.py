"""The file of a run that goes on, is killed, or is finished."""

import inspect
import os
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest

from atmosbox.errors import FileError
from atmosbox.file.checkpoint import Checkpoint
from atmosbox.file.dataset import dataset
from atmosbox.file.netcdf import read
from atmosbox.file.provenance import global_attributes


def run_so_far(frames):
    times = np.arange(1.0, frames + 1)
    attrs = global_attributes({"scene": "temperature"}, title="A box", command="a test", status="partial")
    return dataset({"air_temperature": 300.0 + times}, {"elapsed_time": times}, attrs)


CHILD = f"""
import os, sys, time
import numpy as np
from atmosbox.file.checkpoint import Checkpoint
from atmosbox.file.dataset import dataset
from atmosbox.file.provenance import global_attributes

{inspect.getsource(run_so_far)}
"""


def frames_in(path):
    return read(path).sizes["elapsed_time"]


def test_a_checkpoint_keeps_the_run_so_far_and_the_finished_run_takes_its_place(tmp_path):
    checkpoint = Checkpoint(tmp_path / "run.nc", every_seconds=0.0)
    assert checkpoint(lambda: run_so_far(3))
    assert {path.name for path in tmp_path.iterdir()} == {"run.part.nc", ".run.nc.lock"}
    assert read(checkpoint.part).identical(run_so_far(3).assign_attrs(read(checkpoint.part).attrs))
    assert checkpoint.finish(run_so_far(5)) == tmp_path / "run.nc"
    assert [path.name for path in tmp_path.iterdir()] == ["run.nc"]
    assert frames_in(tmp_path / "run.nc") == 5


def test_a_checkpoint_waits_and_takes_less_than_a_fiftieth_of_the_time(tmp_path, monkeypatch):
    clock = SimpleNamespace(now=100.0, writing=0.0, written=[])
    checkpoint = Checkpoint(tmp_path / "run.nc", every_seconds=2.0, clock=lambda: clock.now)

    def slow(_path, _dataset):
        cost = 0.002 * (clock.now - 100.0)  # the file grows with the run
        clock.written.append(clock.now - 100.0)
        clock.now += cost
        clock.writing += cost

    monkeypatch.setattr("atmosbox.file.checkpoint.write_dataset", slow)
    while clock.now < 1100.0:
        clock.now += 0.01
        checkpoint(lambda: None)
    gaps = np.diff(clock.written)
    assert clock.written[0] == pytest.approx(2.0, abs=0.02)
    assert gaps.min() >= 2.0
    assert 0.008 * 1000.0 < clock.writing < 0.02 * 1000.0
    assert 1000.0 - clock.written[-1] < 100.0


def test_a_file_that_appears_during_the_run_is_not_overwritten(tmp_path):
    checkpoint = Checkpoint(tmp_path / "run.nc")
    (tmp_path / "run.nc").write_text("another's")
    with pytest.raises(FileError, match=r"run\.part\.nc"):
        checkpoint.finish(run_so_far(5))
    assert (tmp_path / "run.nc").read_text() == "another's"
    assert frames_in(checkpoint.part) == 5


def test_two_runs_cannot_write_one_file(tmp_path):
    path = tmp_path / "run.nc"
    code = """
checkpoint = Checkpoint(sys.argv[1]).begin()
print("begun", flush=True)
sys.stdin.read()
checkpoint.release()
"""
    command = [sys.executable, "-W", "error", "-c", CHILD + code, str(path)]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen(command, text=True, env=environment, **pipes) as process:
        assert process.stdout.readline() == "begun\n"
        with pytest.raises(FileError, match=rf"run\.nc is being written by process {process.pid} on "):
            Checkpoint(path).begin()
        Checkpoint(tmp_path / "other.nc").begin().release()
        process.communicate()
    assert process.returncode == 0
    assert not list(tmp_path.iterdir())
    Checkpoint(path).begin().release()
