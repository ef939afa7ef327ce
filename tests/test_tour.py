"""The tour: every step works and waits for Enter, and Ctrl-C ends the tour without an error message."""

import contextlib
import importlib
import os
import pty
import shlex
import signal
import subprocess
import sys
import time

import pytest
import typer
from typer.testing import CliRunner

from atmosbox.cli import app
from atmosbox.cli.tour import STEPS


def typed(*words, folder, **more):
    return subprocess.run(
        [sys.executable, "-m", "atmosbox", "tour", *words], cwd=folder, capture_output=True, text=True, **more
    )


def test_the_tour_goes_through_without_stopping_and_leaves_what_it_has_made(tmp_path, monkeypatch):
    """The sixteen commands are run in this process, where all libraries are loaded after the first one."""

    def status(words, folder):
        here = ["--jobs", "1"] if words[3] == "sweep" else []
        with contextlib.chdir(folder):
            done = CliRunner().invoke(app, [*words[3:], *here])
        sys.stdout.write(done.stdout)
        sys.stderr.write(done.stderr)
        return done.exit_code

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(importlib.import_module("atmosbox.cli.tour"), "_status", status)
    done = CliRunner().invoke(app, ["tour", "--yes"])
    assert done.exit_code == 0, done.output
    shown = [line for line in done.stdout.splitlines() if line.startswith("$ atmosbox ")]
    assert shown == [f"$ atmosbox {command}" for step in STEPS for command in step.commands]
    assert "Traceback" not in done.stdout + done.stderr
    made = {path.name for path in (tmp_path / "atmosbox-tour").iterdir()}
    assert {"mild.nc", "mild.png", "mild.html", "lift.png", "cloud.png", "lifting-dry-sheet.md"} <= made


def test_every_step_names_a_command_that_there_is():
    known = set(typer.main.get_command(app).commands)
    assert {shlex.split(command)[0] for step in STEPS for command in step.commands} <= known
    assert len(STEPS) >= 10


def test_without_a_terminal_it_says_how_to_go_through(tmp_path):
    done = typed(folder=tmp_path, stdin=subprocess.DEVNULL)
    assert done.returncode == 2
    assert "give --yes" in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_there_is_left_alone(tmp_path):
    (tmp_path / "mine").mkdir()
    done = typed("--yes", "--out", "mine", folder=tmp_path, stdin=subprocess.DEVNULL)
    assert done.returncode == 2
    assert "give --out another one" in done.stderr


@pytest.mark.parametrize("ending", ["ctrl-c", pytest.param("ctrl-d", marks=pytest.mark.validate)])
def test_enter_goes_on_and_ctrl_c_leaves_cleanly(tmp_path, ending):
    ours, theirs = pty.openpty()
    tour = subprocess.Popen(
        [sys.executable, "-m", "atmosbox", "tour"],
        cwd=tmp_path, stdin=theirs, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    os.close(theirs)
    said = ""

    def until(words):
        nonlocal said
        end = time.monotonic() + 60.0
        while words not in said:
            assert time.monotonic() < end, said
            said += os.read(tour.stdout.fileno(), 4096).decode()

    until("[Enter]")
    assert "── 1 of" in said
    assert "lifting-dry  " not in said  # the list has not been shown yet
    os.write(ours, b"\n")
    until("── 2 of")
    assert "lifting-dry  " in said
    until("info temperature\n  [Enter]")
    if ending == "ctrl-c":
        # Python handles a signal between the prompt and the wait for a line only after that line
        time.sleep(0.3)
        for _ in range(12):
            tour.send_signal(signal.SIGINT)
            with contextlib.suppress(subprocess.TimeoutExpired):
                tour.wait(timeout=5)
                break
    else:
        os.write(ours, b"\x04")
    rest = tour.communicate(timeout=60)[0]
    os.close(ours)
    assert tour.returncode == 130
    assert rest.strip().endswith("stopped")
    assert "Traceback" not in said + rest
    assert list(tmp_path.iterdir()) == []  # nothing was made, so nothing is left
