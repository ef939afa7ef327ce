"""Errors: each is a built-in one with an exit status, survives another process, and is worded by each interface."""

import copy
import pickle

from atmosbox import errors
from atmosbox.errors import AtmosboxError, Command, FileError, Option, Setting, on_command_line, shown

TREE = {  # error: the built-in exception that it is, exit status
    "AtmosboxError": (Exception, 1), "SettingError": (ValueError, 2), "UnknownSettingError": (errors.SettingError, 2),
    "UnitError": (errors.SettingError, 2), "PackingError": (errors.SettingError, 2),
    "UnknownSceneError": (LookupError, 2), "ConfigError": (ValueError, 2), "SoundingError": (ValueError, 2),
    "FileError": (OSError, 2), "DiskFullError": (FileError, 1), "EngineError": (RuntimeError, 1),
    "PhysicsError": (ArithmeticError, 3),
}  # fmt: skip


def test_every_error_is_a_builtin_with_a_status_and_survives_the_way_back_from_another_process():
    assert set(TREE) == {name for name in vars(errors) if name.endswith("Error")}
    for name, (builtin, status) in TREE.items():
        kind = getattr(errors, name)
        assert issubclass(kind, (AtmosboxError, builtin) if kind is AtmosboxError else AtmosboxError)
        assert issubclass(kind, builtin)
        assert kind.exit_code == status
        words = ("temperature", "-5 K", "is too low", Setting("temperature", "25degC"))
        made = kind(*words) if issubclass(kind, errors.SettingError) else kind("It is full", "give ", Option("out"))
        said = 'temperature = -5 K is too low: give temperature="25degC".'
        assert str(made) == (said if issubclass(kind, errors.SettingError) else "It is full: give out.")
        for twin in (pickle.loads(pickle.dumps(made)), copy.copy(made)):
            assert (type(twin), str(twin), vars(twin)) == (kind, str(made), vars(made))


def test_each_interface_says_in_its_own_words_what_to_give():
    for given, typed, python in [
        (Setting("molecules", 200), "give --set molecules=200", "give molecules=200"),
        (Setting("height", "2km"), "give --set height=2km", 'give height="2km"'),
        (Setting("title", "a run"), "give --set title='a run'", 'give title="a run"'),
        (Setting("rotation", False), "give --set rotation=off", "give rotation=False"),
        (Setting("height"), "give --set height", "give height"),
        (Option("jobs", 1), "give --jobs 1", "give jobs=1"),
        (Option("force", True), "give --force", "give force=True"),
        (Option("save_molecules"), "give --save-molecules", "give save_molecules"),
        (Option("vary", {"x": "1,2"}), "give --vary x=1,2", 'give vary={"x": "1,2"}'),
        (Option("vary", {"x": None}), "give --vary x", 'give vary={"x": ...}'),
        (Command("list"), "type atmosbox list", "type atmosbox.scenes()"),
        (Command("run", ("a b",)), "type atmosbox run 'a b'", 'type atmosbox.run("a b")'),
        (Command("live", ("x",)), "type atmosbox live x", "type atmosbox live x"),
    ]:
        error = FileError("It cannot be", given, " instead")
        assert error.said(on_command_line) == f"It cannot be: {typed} instead."
        assert str(error) == f"It cannot be: {python} instead."


class Stranger:
    def __repr__(self):
        raise RuntimeError


def test_any_value_is_shown_on_one_short_printable_line():
    cases = [
        ("25 degC", "25 degC"), ("25°C", "25°C"), ("", '""'), (" 25", '" 25"'),
        ("a\nb\x1b[31m\u202e", "a\\nb\\x1b[31m\\u202e"), ("\ud800", "\\ud800"), ("x" * 61, '"' + "x" * 60 + '..."'),
        (True, "True"), (2**63, "9223372036854775808"), (10**60, "about 1e60"), (10**400, "about 1e400"),
        (10**400 - 1, "about 1e399"), (-(10**4000), "about -1e4000"), (float("nan"), "nan"), ([1, 2], "[1, 2]"),
        (Stranger(), "a Stranger"),
    ]  # fmt: skip
    for value, text in cases:
        assert shown(value) == text
