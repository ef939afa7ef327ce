"""Whatever is typed, the result is a run or one sentence, and never a traceback; test_config.py has settings files."""

import os

import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from atmosbox import scenarios
from atmosbox.simulation import runner
from tests import fuzz_case
from tests.in_process import COMMAND

NAMES = sorted({p.name for name in scenarios.names() for p in scenarios.load(name).Settings.describe()})

# Any argument that an operating system can pass: all bytes but zero.
typed = st.one_of(
    st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=40),
    st.binary(max_size=20).map(lambda raw: os.fsdecode(raw.replace(b"\0", b""))),
)
numbers = st.one_of(
    st.floats().map(repr),
    st.integers(-(10**400), 10**400).map(str),
    st.sampled_from(["nan", "-inf", "1e999", "-0", "0x10", "1_000", "٣", "½", "1,5", "1e-400", "9" * 5000]),
)
units = st.sampled_from(
    ["", "degC", "K", "hPa", " Pa", "km", "nm", "ns", "%", "K/km", "K km-1", "degC**2", "kg", "µm", "°C"]
)
values = st.one_of(typed, st.builds(str.__add__, numbers, units), st.sampled_from(["on", "off", "maxwell", ""]))
pairs = st.builds("{}={}".format, st.one_of(st.sampled_from(NAMES), typed), values)
scenes = st.one_of(st.sampled_from([*scenarios.names(), "lifting_dry"]), typed)
options = st.one_of(
    st.tuples(st.just("--set"), st.one_of(pairs, pairs, pairs, typed)),
    st.tuples(st.just("--seed"), st.one_of(numbers, typed)),
    st.tuples(st.sampled_from(["--quiet", "--json", "--force", "--save-molecules"])),
    st.tuples(st.sampled_from(["--from", "--config", "--out", "--no-such-option"]), typed),
)


@pytest.fixture(scope="module", autouse=True)
def folder(tmp_path_factory):
    """An empty current folder, and runs that compute nothing."""
    place = tmp_path_factory.mktemp("fuzz")
    nothing = runner.Outcome(xr.Dataset(), (), 1.0, 1, 0.0, 1.0, 0.0, 0)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(place)
        patch.setattr(runner, "execute", lambda *args, **kwargs: nothing)
        yield place


def atmosbox_run(*words):
    """Type a run and return its status."""
    result = fuzz_case.typed("command lines", "run", *words)
    assert result.exit_code in (0, 2)
    return result.exit_code


@settings(max_examples=300)
@given(scene=scenes, words=st.lists(options, max_size=4))
def test_no_words_break_the_command_line(folder, scene, words):
    atmosbox_run(scene, *(word for option in words for word in option))
    assert list(folder.iterdir()) == []


# The commands that start no server and compute nothing, with all their options.
COMMANDS = {
    name: COMMAND.commands[name].params
    for name in ("list", "info", "plot", "view", "compare", "export", "animate", "check", "sweep")
}
SPARED = {"version", "help"}


@st.composite
def any_command(draw):
    """Return a command with arguments and options of that command, and values of all kinds."""
    name = draw(st.sampled_from(sorted(COMMANDS)))
    words = [name, *draw(st.lists(scenes, max_size=2))]
    for option in draw(st.lists(st.sampled_from(COMMANDS[name]), max_size=4)):
        if option.param_type_name == "argument" or option.name in SPARED:
            continue
        words.append(draw(st.sampled_from(option.opts)))
        if not getattr(option, "is_flag", False):
            words.append(draw(st.one_of(values, pairs, scenes)))
    return [*words, "--dry-run"] if name == "sweep" else words


@settings(max_examples=300)
@given(words=any_command())
def test_no_words_break_any_command(folder, words):
    fuzz_case.typed("command lines", *words)
    assert list(folder.iterdir()) == []


def test_the_fuzz_reaches_a_run(folder):
    assert atmosbox_run("lifting-dry", "--set", "temperature=20degC", "--seed", "3") == 0
