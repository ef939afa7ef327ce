"""Sweeps on a Dask cluster: a worker that is killed half-way, and clusters that cannot be used."""

import os
import signal
from collections import Counter

import pytest

from atmosbox.errors import SettingError
from atmosbox.file.netcdf import read
from atmosbox.sweep import conduct, plan, sweep
from tests.few_frames import few_frames_of
from tests.test_sweep import SCENE

distributed = pytest.importorskip("distributed")

UNUSED = "tcp://127.0.0.1:1"


few_frames = few_frames_of({"elastic-collisions": (60, 20)})
"""The runs of discs in this process have the few frames that they have in `SCENE`."""


@pytest.fixture(scope="module")
def cluster():
    """A cluster of one process on this machine, which is started again when it is killed."""
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=True, dashboard_address=":0", memory_limit=None
    ) as made:
        yield made


def discs(**words):
    return plan("elastic-collisions", ["molecules=10,20"], settings={"duration": 2.0}, **words)


def test_a_sweep_outlives_a_killed_worker_and_computes_nothing_twice_that_was_saved(cluster, tmp_path):
    scene, file = tmp_path / "discs.py", tmp_path / "discs.nc"
    scene.write_text(SCENE, encoding="utf-8")
    slow = tmp_path / "slow"
    slow.touch()
    grid = plan(scene, ["molecules=10,20,30"], settings={"duration": 2.0}, members=3)
    at_the_kill = []

    def show(share, word):
        if share >= 0.33 and not at_the_kill:
            at_the_kill.extend(path.name for path in file.with_suffix("").glob("?-?.nc"))
            os.kill(next(iter(cluster.workers.values())).pid, signal.SIGKILL)

    swept = sweep(grid, file, scheduler=cluster.scheduler_address, progress=show)
    assert not swept.member_status.values.any()
    assert 3 <= len(at_the_kill) < 9
    begun = Counter(path.name.split("-")[1] for path in tmp_path.glob("run-*"))
    assert len(begun) == 9
    assert sum(begun.values()) <= 9 + 2, "only what the killed worker had not handed over is run again"
    slow.unlink()
    alone = sweep(grid, jobs=1)
    assert alone.drop_attrs().identical(read(file).drop_attrs())


@pytest.mark.parametrize("address", [UNUSED, "nonsense://here", "tcp://no-such-host.invalid:8786"])
def test_a_scheduler_that_does_not_answer_is_said(monkeypatch, address):
    monkeypatch.setattr(conduct, "PATIENCE", 0.1)
    with pytest.raises(SettingError, match="cannot be reached") as refused:
        sweep(discs(), scheduler=address)
    assert address in str(refused.value)
