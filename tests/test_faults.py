"""Faults of the system; each test checks a promise of docs/reliability.md.

Tests that take long, or must run as root, are in the tier ``soak``.
"""

import contextlib
import ctypes
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import typer

from atmosbox.cli.terminal import guarded
from atmosbox.file.checkpoint import Checkpoint
from atmosbox.file.netcdf import read
from atmosbox.simulation import runner
from atmosbox.text import progress as bars
from tests.test_restart import content

ROOT = Path(__file__).resolve().parents[1]
SCENE = "elastic-collisions"
SHORT = ["run", SCENE, "--set", "duration=2s", "--out", "x.nc"]
pytestmark = pytest.mark.skipif(os.name == "nt", reason="signals, locales and disks of another kind")
NOBODY = {"HOME": None, "XDG_CACHE_HOME": None, "USER": None, "LOGNAME": None}
root = pytest.mark.skipif(os.name == "nt" or os.geteuid() != 0, reason="only root may mount a disk")


def started(words, folder, *flags, package=ROOT, **variables):
    """Start the real command in a folder, with flags of Python and variables of the environment; None removes one."""
    wanted = {**os.environ, "PYTHONPATH": str(package), "SOURCE_DATE_EPOCH": "1700000000", **variables}
    environment = {name: value for name, value in wanted.items() if value is not None}
    folder.mkdir(exist_ok=True)
    return subprocess.Popen(
        [sys.executable, *flags, "-m", "atmosbox", *words], cwd=folder, env=environment, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True, encoding="utf-8", preexec_fn=listen,
    )  # fmt: skip


def listen():
    """Restore signals that nohup or a background job ignores."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


def command(words, folder, *flags, **more):
    """Run the real command to its end; return its status, stdout and stderr."""
    with started(words, folder, *flags, **more) as process:
        out, said = process.communicate()
    assert "Traceback" not in said, said
    assert "This is a bug" not in said, said
    return process.returncode, out, said


@pytest.fixture(scope="module")
def usual(tmp_path_factory):
    """The folder of a run on a computer without faults, in this process, which has loaded all libraries."""
    folder = tmp_path_factory.mktemp("usual")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", "1700000000")
        prepared = runner.prepare(SCENE, {"duration": 2.0}, save_molecules=None)
        runner.execute(prepared, checkpoint=Checkpoint(folder / "x.nc"), command=" ".join(["atmosbox", *SHORT]))
    return folder


def same(folder, usual):
    return content(folder / "x.nc") == content(usual / "x.nc")


# Unusual environments

TURKISH = "tr_TR.UTF-8"
"""In this locale numbers have decimal commas, and the capital of i has a dot."""


@pytest.mark.parametrize(
    ("flags", "variables"),
    [
        (["-W", "error"], {"LC_ALL": TURKISH, "LANG": TURKISH, "TERM": None, "TZ": "Pacific/Kiritimati"}),
        ([], {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"} | NOBODY),
        pytest.param(["-O"], {}, marks=pytest.mark.nightly),  # it translates all libraries again
    ],
    ids=["-W error, Turkish, far zone", "C, no home", "-O"],
)
def test_an_odd_environment_changes_no_number(usual, tmp_path, flags, variables):
    status, _, said = command(SHORT, tmp_path, *flags, **variables)
    assert status == 0, said
    assert same(tmp_path, usual)


# Clocks


def test_a_clock_that_is_set_back_and_forth_changes_no_number(usual, tmp_path, monkeypatch):
    """Checkpoints and the progress bar use a clock that cannot be set."""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    monkeypatch.setattr(runner, "_BREATH", 0.0)
    draw, now = random.Random(3), time.time()
    monkeypatch.setattr(time, "time", lambda: now + draw.uniform(-1e8, 1e8))
    prepared = runner.prepare(SCENE, {"duration": 2.0}, save_molecules=None)
    shares = []
    checkpoint = Checkpoint(tmp_path / "x.nc", every_seconds=0.0)
    with bars.progress(SCENE, quiet=False) as show:

        def both(share, word):
            shares.append(share)
            show(share, word)

        runner.execute(prepared, checkpoint=checkpoint, progress=both, command="a test")
    assert shares == sorted(shares)
    assert not list(tmp_path.glob(".*"))
    kept, whole = content(tmp_path / "x.nc"), content(usual / "x.nc")
    assert {name for name in whole if kept[name] != whole[name]} == {"history"}


# Signals


def dropped_by_c(number):
    """Raise a signal in a function that C calls, where Python drops the exception of its handler."""
    ctypes.CFUNCTYPE(None)(lambda: signal.raise_signal(number))()
    until = time.monotonic() + 20.0
    while time.monotonic() < until:
        pass


def dropped_by_python(number):
    with contextlib.suppress(BaseException):
        signal.raise_signal(number)


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
@pytest.mark.parametrize("command", [dropped_by_c, dropped_by_python])
def test_a_signal_is_not_lost_where_its_exception_is_dropped(number, status, command):
    began = time.monotonic()
    with pytest.raises(typer.Exit) as end:
        guarded(command)(number)
    assert end.value.exit_code == status
    assert time.monotonic() - began < 10.0
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL


# Disks


@contextlib.contextmanager
def disk(place, options):
    """Mount a small separate disk."""
    place.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", place], check=True)
    try:
        yield place
    finally:
        subprocess.run(["umount", "-l", place], check=True)


@root
@pytest.mark.soak
@pytest.mark.parametrize("room", [100, 1200])
def test_a_disk_that_fills_ends_a_run_with_a_sentence_and_nothing_half_written(tmp_path, room):
    words = ["run", "temperature", "--set", "molecules=3000", "--set", "duration=3ns", "--save-molecules", "--out"]
    with disk(tmp_path / "disk", f"size={room}k") as place:
        (place / "old.nc").write_bytes(b"old")
        status, _, said = command([*words, "x.nc"], place)
        assert status == 1, said
        assert "has no room" in said
        assert (place / "old.nc").read_bytes() == b"old"
        names = {path.name for path in place.iterdir()}
        assert names <= {"old.nc", "x.part.nc"}
        if "x.part.nc" in names:
            assert read(place / "x.part.nc").sizes["elapsed_time"] > 0
            if room == 1200:  # with more room the run continues
                subprocess.run(["mount", "-o", "remount,size=200m", place], check=True)
                assert command(["run", "--resume", "x.part.nc"], place)[0] in (0, 3)


# Caches
