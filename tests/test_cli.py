"""The command line: what each command prints and where, how it ends, and what it leaves on the disk."""

import io
import itertools
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import xarray as xr

from atmosbox import scenarios
from atmosbox.cli import terminal
from atmosbox.cli.option import Sought, _completed
from atmosbox.cli.request import gather
from atmosbox.errors import EngineError
from atmosbox.file import checkpoint, output_lock
from atmosbox.file import netcdf as output
from atmosbox.scene.headline import Headline
from atmosbox.scene.instruments import Discs
from atmosbox.simulation import runner
from atmosbox.text import progress, report, table
from tests.few_frames import few_frames_of
from tests.in_process import refused, typed

ROOT = Path(__file__).resolve().parents[1]
COMMANDS = ("list", "info", "run", "plot", "check")
SCENE = "elastic-collisions"
SHORT = ("run", SCENE, "--set", "duration=2s")  # a fraction of a second
HEAVY = ("numba", "xarray", "netCDF4", "matplotlib", "metpy", "pint", "scipy", "pandas")

posix = pytest.mark.skipif(os.name == "nt", reason="signals, pipes and terminals are those of POSIX")


def atmosbox_in_process(*words, **environment):
    """Run a command in this process; the width of output that is not a terminal is unlimited."""
    return typed(*words, **{"COLUMNS": None, **environment})


few_frames = few_frames_of({SCENE: (60, 20)})
"""The runs of the scene in this process have a twentieth of its frames, the ends of which take most of the time."""


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """The file of a short run."""
    path = tmp_path_factory.mktemp("finished") / "short.nc"
    result = atmosbox_in_process(*SHORT, "--out", str(path))
    assert result.exit_code == 0, result.output
    return path


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty folder, which is made the current one."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def no_computing(monkeypatch):
    """Fail if anything is computed."""
    monkeypatch.setattr(runner, "execute", lambda *args, **kwargs: pytest.fail("a run was begun"))


def planned(*words):
    """Return the settings with which a run would start."""
    result = atmosbox_in_process("run", *words, "--dry-run", "--json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


# Help


def test_the_help_of_a_command_has_examples_that_use_options_that_exist():
    for command in COMMANDS:
        result = atmosbox_in_process(command, "--help", COLUMNS="200")
        options, found, examples = result.stdout.partition("Examples:\n")
        assert found
        assert all(line.strip().startswith(f"atmosbox {command}") for line in examples.strip().splitlines())
        assert set(re.findall(r"--[a-z-]+", examples)) <= set(re.findall(r"--[a-z-]+", options))


def test_what_must_be_there_at_once_waits_for_nothing_heavy(folder):
    code = (
        "import sys\nimport typer\n"
        "import atmosbox\nfrom atmosbox import errors, scenarios\nfrom atmosbox.scene import settings\n"
        "assert 'numpy' not in sys.modules\n"
        "from atmosbox.cli import app\n"
        "app = typer.main.get_command(app)  # built once for all words\n"
        "for words in ['--help'], ['run', '--help'], ['--version'], ['list']:\n"
        "    app(words, standalone_mode=False)\n"
        "for name in scenarios.names():\n"
        "    for words in ['info', name], ['run', name, '--dry-run']:\n"
        "        app(words, standalone_mode=False)\n"
        "print(*sys.modules)"
    )
    options = {"env": {**os.environ, "PYTHONPATH": str(ROOT)}, "capture_output": True, "text": True}
    loaded = subprocess.run([sys.executable, "-c", code], check=True, **options).stdout.splitlines()[-1].split()
    assert "numpy" in loaded
    assert set(HEAVY).isdisjoint(loaded)


def test_a_high_temperature_without_a_unit_is_said_to_be_in_degrees_celsius():
    for value, told in [("300", True), (" 300.5", True), ("300K", False), ("300degC", False), ("30", False)]:
        result = atmosbox_in_process("run", "temperature", f"temperature={value}", "--dry-run")
        number = value.strip()
        note = f"note: temperature={number} is taken as {number} degC; for kelvin, give temperature={number}K\n"
        assert result.stderr == (note if told else "")


REFUSED = [
    (["run", SCENE, "--no-such-option"], "No such option: --no-such-option"),
    (["run", "temperature", "--forse"], "--force"),
    (["--foo"], "atmosbox --help"),
    (["list", "--json=3"], "'--json' does not take a value"),
    (["run", "temperature", "--set"], "'--set' requires an argument"),
    (["plot"], "Missing argument 'FILE': type for instance atmosbox plot lifting-dry.nc"),
    (["plot", "x.nc", "--theme", "slide"], "Invalid value for '--theme': 'slide' is not one of 'notes', 'slides'"),
    (["animate", "x.nc", "--fps", "fast"], "'--fps'"),
    (["live", "--no-browser", "temperature", "--port", "0"], "give --port 8642"),
    (["lsit"], "did you mean atmosbox list?"),
    (["no-such-command"], "There is no command no-such-command"),
    (["set", "temperature=30"], "atmosbox run SCENE --set temperature=30"),
    (["temperature", "temperature=30"], "atmosbox run temperature temperature=30"),
    (["start", "temperature"], "atmosbox run temperature"),
    (["run", "temperature", "--temperature", "30"], "give temperature=30, or --set temperature=30"),
    (["run", "temperature", "--temperature=30degC"], "give temperature=30degC"),
    (["run", "temperature", "-temperature", "30"], "give temperature=30"),
    (["run", "temperature", "--set", "temperature", "=", "30"], "NAME=VALUE: write temperature=30"),
    (["run", "temperature", "temperature=", "30"], "NAME=VALUE: write temperature=30"),
    (["run", "temperature", "temperature=30", "degC"], "NAME=VALUE: write temperature=30degC"),
    (["run", "temperature", "temperature", "30"], "NAME=VALUE: write temperature=30"),
    (["run", "temperature", "temperature"], "NAME=VALUE: write temperature=VALUE"),
    (["run", SCENE, "30"], "30 has no meaning for atmosbox run"),
    (["run", "temperature", "temperature="], "has no value: give --set temperature=value"),
    (["run", "temperature", "rotation=maybe"], "give one of molecules, temperature"),
    (["run", SCENE, "--set", "duration=2degC"], "--set duration="),
    (["run", SCENE, "--seed", "x"], "--set seed="),
    (["info", "temperature", "temperature=30"], "atmosbox info takes no settings"),
    (["plot", "a.nc", "b.nc"], "atmosbox compare a.nc b.nc"),
    (["run"], "No scene"),
    (["info", "elastic-colisions"], SCENE),
    (["prepare", "no-such-scene"], "atmosbox list"),
    (["run", "temperature.nc"], "atmosbox run --from temperature.nc"),
    (["run", "./no_such.py"], "no_such.py"),
    (["run", SCENE, "--out", "no/such/folder/x.nc"], "mkdir"),
    (["run", SCENE, "--out", "lift.png"], "atmosbox plot lift.nc --out lift.png"),
    (["run", "temperature", "--config", "discs.toml"], SCENE),
    (["run", "--config", "evil.toml"], "atmosbox run ./evil.py --config evil.toml"),
    (["run", "temperature", "--accuracy", "sketch", "--engine", "stepped:applet"], "picks the engine itself"),
    (["sheet", "temperature", "--lab", "--engine", "dsmc"], "exact engine"),
    (["sweep", SCENE, "--vary", "molecules=10,20", "--jobs", "0"], "give --jobs 1"),
    (["sweep", SCENE, "--vary", "molecules=10,20", "--members", "many"], "give --members 8"),
    (["sweep", SCENE, "--vary", "molecules=10,20", "--jobs", "2", "--scheduler", "tcp://a:1"], "leave one of them out"),
    (["tradeoff", SCENE, "--budget", "5 km"], "--budget 40s"),
    (["tradeoff", SCENE, "--seed", "-1"], "--seed"),
]
"""What is typed, and what the one sentence of the refusal must say: the value, the range or the command to type."""


@pytest.mark.parametrize(("words", "said"), REFUSED, ids=lambda part: " ".join(part) if isinstance(part, list) else "")
def test_what_cannot_be_is_one_sentence_with_what_to_type_and_writes_nothing(folder, no_computing, words, said):
    Path("discs.toml").write_text(f'scene = "{SCENE}"', encoding="utf-8")
    Path("evil.toml").write_text('scene = "./evil.py"', encoding="utf-8")
    Path("evil.py").write_text("open('ran', 'w')", encoding="utf-8")  # a settings file never makes a program run
    assert said in refused(atmosbox_in_process(*words))
    assert sorted(path.name for path in folder.iterdir()) == ["discs.toml", "evil.py", "evil.toml"]


# The scenes


def test_list_has_every_scene_with_its_first_sentence():
    lines = atmosbox_in_process("list").stdout.splitlines()
    listed = json.loads(atmosbox_in_process("list", "--json").stdout)["scenes"]
    assert tuple(atmosbox_in_process("list", "--names").stdout.split()) == scenarios.names()
    assert tuple(scene["name"] for scene in listed) == scenarios.names()
    for name in scenarios.names():
        (line,) = (line for line in lines if line.split()[:1] == [name])
        assert (scenarios.load(name).__doc__ or "").split("\n")[0] in line
    assert _completed("elas") == [SCENE]


def test_info_shows_story_facts_and_every_setting_and_nothing_is_cut():
    for name, width in [(SCENE, "40"), *((name, "80") for name in scenarios.names())]:
        card = runner.card(runner.prepare(name, {}))
        shown = atmosbox_in_process("info", name, COLUMNS=width).stdout
        words = " ".join(shown.split())
        assert " ".join(card.story.replace("``", "").split()) in words
        assert all(f"\n{parameter.name}" in shown and parameter.allowed in words for parameter in card.parameters)
        assert all(f"\n{fact}" in shown and value in words for fact, value in card.facts)
        assert max(map(len, shown.splitlines())) <= max(int(width), 50)  # some words are long
    card = json.loads(atmosbox_in_process("info", SCENE, "--json").stdout)
    assert {"scene", "title", "story", "facts", "parameters", "expected_seconds"} == set(card)


# A run


def test_a_run_prints_its_results_and_json_is_one_object_that_says_the_same(folder):
    result = atmosbox_in_process(*SHORT)
    assert result.exit_code == 0, result.output
    headlines = runner.headlines_of(output.read(f"{SCENE}.nc"))
    for text in ("agrees?", "±", "energy budget: closed to ", " collisions in ", *(one.label for one in headlines)):
        assert text in result.stdout
    assert result.stdout.endswith(f"\nfile: {SCENE}.nc\nnext: atmosbox plot {SCENE}.nc\n")
    found = json.loads(atmosbox_in_process(*SHORT, "--json", "--force").stdout)
    assert [(one["name"], one["agrees"]) for one in found["headlines"]] == [(one.name, one.agrees) for one in headlines]
    assert (found["file"], found["status"], found["ledger"]["closes"]) == (f"{SCENE}.nc", "complete", True)
    assert found["settings"]["duration"] == 2.0
    assert found["collisions"] > 0
    assert [path.name for path in folder.iterdir()] == [f"{SCENE}.nc"]


def test_a_second_run_gets_a_number_and_loses_nothing(folder):
    Path(f"{SCENE}.nc").write_text("mine", encoding="utf-8")
    Path(f"{SCENE}-2.part.nc").write_text("of a run that was stopped", encoding="utf-8")
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert planned(*SHORT[1:])["file"] == f"{SCENE}-3.nc"
    result = atmosbox_in_process(*SHORT)
    assert (result.exit_code, result.stderr) == (
        0,
        f"note: the name {SCENE}.nc is in use, so this file is {SCENE}-3.nc\n",
    )
    assert result.stdout.endswith(f"file: {SCENE}-3.nc\nnext: atmosbox plot {SCENE}-3.nc\n")
    assert output.read(f"{SCENE}-3.nc").attrs["atmosbox_status"] == "complete"
    assert {name: Path(name).read_bytes() for name in before} == before


def test_two_runs_at_once_write_two_files(folder):
    """The second begins when the first has its name but no file yet."""
    lock = output_lock.OutputLock(folder / f"{SCENE}.nc")
    assert atmosbox_in_process(*SHORT, "--quiet").stdout == f"{SCENE}-2.nc\n"
    lock.release()


def test_a_dry_run_shows_everything_and_writes_nothing(folder, no_computing):
    result = atmosbox_in_process(*SHORT, "--dry-run")
    card = runner.card(runner.prepare(SCENE, {"duration": "2 s"}))
    assert all(fact in result.stdout and value in result.stdout for fact, value in card.facts)
    assert re.search(r"^duration +2 s +set$", result.stdout, re.MULTILINE)
    assert f"file: {SCENE}.nc (not written" in result.stdout
    assert list(folder.iterdir()) == []


def test_the_molecules_are_saved_on_request_and_those_of_a_small_run_unasked(folder):
    small = ["run", "temperature", "duration=0.05ns", "molecules=50"]
    large = ["run", "temperature", "duration=0.05ns", "molecules=400"]
    for words, kept in [
        ([*SHORT, "--save-molecules"], True),
        (SHORT, False),  # its discs are saved in any case
        (small, True),
        ([*small, "--no-save-molecules"], False),
        (large, False),
        ([*large, "--save-molecules"], True),
    ]:
        result = atmosbox_in_process(*words, "--out", "x.nc", "--force")
        assert ("molecule_position" in output.read("x.nc")) is kept, words
        assert ("molecules: not kept" in result.stdout) is (words is large)
        assert (gather(Sought(source="x.nc")).save_molecules) is {"-": kept}.get(words[-1][0]), words


def test_a_scene_of_ones_own_runs_by_its_path_and_its_prints_are_no_result(folder):
    source = Path(scenarios.load(SCENE).__file__).read_text(encoding="utf-8")
    Path("my scene.py").write_text(source + "\nprint('hello from the scene')\n", encoding="utf-8")
    result = atmosbox_in_process("run", "./my scene.py", "--set", "duration=2s", "--json")
    assert json.loads(result.stdout)["next"] == "atmosbox plot 'my scene.nc'"
    assert "hello from the scene" in result.stderr


# Where settings come from


def test_seed_counts_before_set_before_config_before_an_earlier_run(folder, finished):
    Path("a.toml").write_text('[settings]\nduration = "3 s"\nseed = 3\n', encoding="utf-8")
    earlier = ("--from", str(finished))
    assert planned(*earlier)["settings"]["duration"] == 2.0
    assert planned(*earlier)["scene"] == SCENE
    config = (*earlier, "--config", "a.toml")
    assert planned(*config)["settings"]["duration"] == 3.0
    typed = (*config, "--set", "duration=5s", "--set", "seed=5")
    assert planned(*typed)["settings"]["duration"] == 5.0
    assert planned(*typed)["settings"]["seed"] == 5
    assert planned(*typed, "--seed", "7")["settings"]["seed"] == 7


def test_an_earlier_run_is_repeated_bit_for_bit(folder, finished):
    assert atmosbox_in_process("run", "--from", str(finished), "--out", "again.nc").exit_code == 0
    first, again = output.read(finished), output.read("again.nc")
    xr.testing.assert_equal(first, again)


READERS = [
    "info {}", "run {}", "run ./{}", "run --from {}", "run --config {}", "plot {}", "animate {}", "check {}",
    "export {}", "view {}", "view whole.nc {}", "compare {} whole.nc", "compare whole.nc {}", "live --no-browser {}",
    "live --no-browser --from {}", "sheet ./{}", "tradeoff ./{}", "sweep ./{} --vary duration=1,2",
]  # fmt: skip
"""Commands that read a file."""


def test_no_path_is_a_bug(folder, no_computing, finished):
    """Whatever path a command is told to read, the answer is one sentence, and nothing is written."""
    Path("folder").mkdir()
    Path("empty.nc").touch()
    Path("text.nc").write_text("elapsed_time, temperature\n", encoding="utf-8")
    shutil.copy(finished, "whole.nc")
    Path("cut.nc").write_bytes(Path("whole.nc").read_bytes()[:3000])
    before = sorted(folder.rglob("*"))
    for words, name in itertools.product(READERS, ("", ".", "folder", "no.nc", "empty.nc", "text.nc", "cut.nc")):
        refused(atmosbox_in_process(*(word.format(name) for word in words.split(" "))))
        assert sorted(folder.rglob("*")) == before, (words, name)


WRITERS = [
    ("nc", ["run", SCENE]), ("nc", ["sweep", SCENE, "--vary", "duration=1,2"]), ("nc", ["tradeoff", SCENE]),
    ("pdf", ["sheet", SCENE]), ("md", ["sheet", SCENE, "--format", "md"]), ("png", ["plot", "whole.nc"]),
    ("gif", ["animate", "whole.nc", "--graphs"]), ("csv", ["export", "whole.nc"]), ("html", ["view", "whole.nc"]),
    ("svg", ["compare", "whole.nc", "whole.nc"]),
]  # fmt: skip
"""Commands that write a file, and the ending of its name."""


@pytest.mark.parametrize(("ending", "words"), WRITERS, ids=lambda part: part[0] if isinstance(part, list) else part)
def test_no_command_replaces_a_file_unasked_or_writes_where_it_cannot(folder, no_computing, finished, ending, words):
    Path("folder").mkdir()
    shutil.copy(finished, "whole.nc")
    made = Path("mine-headlines.csv" if ending == "csv" else f"mine.{ending}")  # a spreadsheet has several files
    made.write_text("mine", encoding="utf-8")
    before = sorted(folder.rglob("*"))
    for name in ("", "..", "folder", "whole.nc/x.nc", f"mine.{ending}"):
        said = refused(atmosbox_in_process(*words, "-o", name))
        assert ("--force" in said) == name.startswith("mine")
        assert "bug" not in said
        assert sorted(folder.rglob("*")) == before, (words, name)
    assert made.read_text(encoding="utf-8") == "mine"


def test_a_default_name_that_is_in_use_gets_a_number(folder, finished):
    shutil.copy(finished, "x.nc")
    for words, first in [
        (["plot", "x.nc"], "x.png"),
        (["view", "x.nc"], "x.html"),
        (["compare", "x.nc", "x.nc"], "x-and-x.png"),
        (["export", "x.nc", "--format", "csv"], "x-headlines.csv"),
        (["sheet", SCENE, "--format", "md"], f"{SCENE}-sheet.md"),
        (["lab", SCENE], f"{SCENE}-lab.html"),
    ]:
        Path(first).write_text("mine", encoding="utf-8")
        before = set(folder.iterdir())
        result = atmosbox_in_process(*words)
        assert result.exit_code == 0, result.output
        second = first.replace("x-headlines", "x-2-headlines") if "csv" in words else "-2.".join(first.rsplit(".", 1))
        assert folder / second in set(folder.iterdir()) - before, words
        assert second in result.stdout + result.stderr
        assert "is in use, so this file is" in result.stderr
        assert Path(first).read_text(encoding="utf-8") == "mine"


# Failures


@pytest.mark.parametrize(
    ("error", "status", "said"),
    [
        (EngineError("Molecule 7 left the box at 0.3 ns."), 1, "error: Molecule 7 left the box at 0.3 ns."),
        (KeyError("x\ny"), 1, "bug"),
        (MemoryError(), 1, "fewer molecules"),
        (KeyboardInterrupt(), 130, "stopped"),
        (runner.Interrupted(None), 130, "nothing is kept"),
    ],
)
def test_a_failed_run_ends_with_one_sentence_and_its_status_and_without_traceback(
    folder, monkeypatch, error, status, said
):
    def execute(*args, **kwargs):
        raise error

    monkeypatch.setattr(runner, "execute", execute)
    result = atmosbox_in_process(*SHORT)
    assert (result.exit_code, result.stdout, result.stderr.count("\n")) == (status, "", 1)
    assert said in result.stderr
    assert list(folder.iterdir()) == []
    if said == "bug":
        assert "Traceback (most recent call last)" in atmosbox_in_process(*SHORT, "--verbose").stderr


def test_a_run_whose_energy_budget_does_not_close_ends_with_3_and_keeps_the_file(folder, monkeypatch):
    execute = runner.execute
    monkeypatch.setattr(runner, "execute", lambda *a, **k: execute(*a, **k)._replace(ledger=1e-3))
    result = atmosbox_in_process(*SHORT)
    assert result.exit_code == 3
    assert "energy budget: not closed" in result.stdout
    assert f"atmosbox check {SCENE}.nc" in result.stderr
    assert Path(f"{SCENE}.nc").exists()


def stop_after(monkeypatch, fraction):
    """Simulate Ctrl-C when a share of a run is done."""
    execute = runner.execute

    def stopped(*args, progress, **kwargs):
        def watch(done, doing):
            progress(done, doing)
            if doing == "running" and done > fraction:
                raise KeyboardInterrupt

        return execute(*args, progress=watch, **kwargs)

    monkeypatch.setattr(runner, "execute", stopped)
    monkeypatch.setattr(runner, "_BREATH", 0.0)


def test_a_stopped_run_says_where_its_frames_are_and_how_to_see_them(folder, monkeypatch):
    stop_after(monkeypatch, 0.5)
    part = f"{SCENE}.part.nc"
    result = atmosbox_in_process(*SHORT)
    assert (result.exit_code, result.stdout) == (130, "")
    assert f"atmosbox plot {part}" in result.stderr
    frames = int(re.search(r"(\d+) complete frames", result.stderr)[1])
    assert output.read(part).sizes["elapsed_time"] == frames > 0
    assert json.loads(atmosbox_in_process(*SHORT, "--json", "--force").stdout)["file"] == part
    assert atmosbox_in_process(*SHORT, "--quiet", "--force").stdout == f"{part}\n"
    assert [path.name for path in folder.iterdir()] == [part]


def raise_inside(monkeypatch, home, name, call, number=signal.SIGINT):
    """Send this process a signal in the n-th call of a function."""
    original, calls = getattr(home, name), []

    def pressed(*args, **kwargs):
        calls.append(args)
        if len(calls) == call:
            signal.raise_signal(number)
        return original(*args, **kwargs)

    monkeypatch.setattr(home, name, pressed)


@posix
@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_a_signal_while_a_frame_ends_keeps_the_frames_of_all_instruments(folder, monkeypatch, number, status):
    raise_inside(monkeypatch, Discs, "end_frame", 10, number)
    assert atmosbox_in_process(*SHORT).exit_code == status
    kept = output.read(f"{SCENE}.part.nc")
    assert kept.sizes["elapsed_time"] == 10
    assert kept.attrs["atmosbox_status"] == "interrupted"


def test_ctrl_c_while_the_finished_file_is_written_keeps_it(folder, monkeypatch):
    raise_inside(monkeypatch, checkpoint.Checkpoint, "finish", 1)
    assert atmosbox_in_process(*SHORT).exit_code == 130
    assert [path.name for path in folder.iterdir()] == [f"{SCENE}.nc"]
    assert output.read(f"{SCENE}.nc").attrs["atmosbox_status"] == "complete"


# Streams


@posix
@pytest.mark.parametrize(
    ("line", "status", "said"),
    [("| head -c 1", 0, ""), (">&-", 0, ""), ("> /dev/full", 1, "error: "), ("--help > /dev/full", 1, "error: ")],
)
def test_a_reader_that_has_seen_enough_is_no_error_and_a_full_disk_is_one_sentence(line, status, said):
    options = {"env": {**os.environ, "PYTHONPATH": str(ROOT)}, "stderr": subprocess.PIPE, "stdout": subprocess.DEVNULL}
    typed = f"set -o pipefail; {shlex.join([sys.executable, '-m', 'atmosbox', 'list'])} {line}"
    run = subprocess.run(["bash", "-c", typed], text=True, check=False, **options)
    assert run.returncode in (status, 1 if line[0] == "|" else status)
    assert run.stderr.startswith(said)
    assert run.stderr.count("\n") == bool(said)


class Stream(io.StringIO):
    """A stream with an encoding, which can act as a terminal."""

    def __init__(self, encoding="utf-8", tty=False):
        super().__init__()
        self._encoding, self._tty = encoding, tty

    encoding = property(lambda self: self._encoding)
    errors = property(lambda self: "strict")

    def isatty(self):
        return self._tty


def test_what_an_encoding_lacks_is_spelled_out(monkeypatch):
    stream = Stream("ascii")
    monkeypatch.setattr(sys, "stdout", stream)
    terminal.say("15.0 ± 0.1 (2σ) \udcff 雲")
    assert stream.getvalue() == "15.0 +- 0.1 (2 sigma) \\udcff \\u96f2\n"


# Progress


def test_a_terminal_shows_how_far_a_run_is_and_no_trace_of_it_is_left(monkeypatch):
    stream = Stream(tty=True)
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "40")
    monkeypatch.setenv("NO_COLOR", "1")
    with progress.progress("a [bold]scene", quiet=False) as show:
        show(0.25, "running")
        show(0.5, "running")
    text = stream.getvalue()
    assert "a [bold]scene" in text
    assert "25%" in text
    assert "50%" in text
    assert re.search(r"\d:\d\d:\d\d|-:--:--", text)  # the remaining time
    assert not re.search(r"\x1b\[\d*(;\d+)*m", text)  # no colour
    assert text.endswith("\x1b[1A\x1b[2K")  # the line is cleared


@pytest.mark.parametrize("term", ["dumb", "xterm"])
def test_elsewhere_a_word_is_said_only_when_it_takes_long(monkeypatch, term):
    stream = Stream(tty=term == "dumb")
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setenv("TERM", term)
    monkeypatch.setattr(progress, "DELAY", 0.05)
    with progress.progress("scene", quiet=False) as show:
        show(0.0, "checking at once")
        show(0.0, "compiling the engine, once")
        show(0.0, "compiling the engine, once")
        time.sleep(0.5)
        show(0.5, "running")
        show(1.0, "done")
        time.sleep(0.2)
    assert stream.getvalue() == "scene: compiling the engine, once\n"


# Tables and numbers


def test_no_value_of_a_result_is_cut_at_any_width():
    warm = Headline("t", 288.1492, 0.0312, 288.0, 0.0, "the box is small", "K", "degC", "temperature")
    many = Headline("n", -1e9, 3e7, 288.0, 0.0, "", "s-1", "s-1", "collisions")
    for width in [20, 40, 60, 80, 120, terminal.ENDLESS]:
        words = " ".join(" ".join(report.headline_lines([warm, many], width)).split())
        for value in ("14.999 ± 0.031", "14.850", "+0.149 K", "no", "(-1.000 ± 0.030)e9", "0.000e9"):
            assert value in words


def test_a_measurement_has_the_digits_that_its_error_deserves():
    cases = [
        (12345.0, 1234.0, "12300 ± 1200"), (0.00001234, 0.0000005, "(1.234 ± 0.050)e-5"),
        (1.0, 1e-20, "1.00000000000 ± 0.00000000000"), (0.0, 0.5, "0.00 ± 0.50"), (float("nan"), 0.1, "nan ± 0.1"),
    ]  # fmt: skip
    for value, error, shown in cases:
        assert table.measurement(value, error) == shown


# Checks


def test_check_of_a_sound_file_ends_with_0_and_lists_every_check_and_json_is_one_object(finished):
    result = atmosbox_in_process("check", str(finished))
    assert result.exit_code == 0, result.output
    lines = result.stdout.splitlines()
    assert len(lines) == len(runner.verify(output.read(finished)))
    assert all(line.startswith("ok ") for line in lines)
    found = json.loads(atmosbox_in_process("check", str(finished), "--json").stdout)
    assert found["passed"] is True
    assert all(set(one) == {"name", "passed", "sentence"} for one in found["checks"])


def test_check_of_a_tampered_file_ends_with_3(folder, finished):
    dataset = output.read(finished)
    dataset["kinetic_energy"][-1] *= 1.1
    output.write(dataset, "tampered.nc")
    result = atmosbox_in_process("check", "tampered.nc")
    assert result.exit_code == 3
    assert result.stderr == ""
    failed = [line.split()[1] for line in result.stdout.splitlines() if line.startswith("FAILED")]
    assert failed[0] == "balance"
