import copy
import pickle

from atmosbox import errors
from atmosbox.errors import (
    AtmosboxError,
    Command,
    ConfigError,
    DiskFullError,
    EngineError,
    FileError,
    Option,
    PackingError,
    PhysicsError,
    Setting,
    SettingError,
    SoundingError,
    UnitError,
    UnknownSceneError,
    UnknownSettingError,
    on_command_line,
    shown,
)

TREE = [
    # error, built-in exception that it is a subclass of, exit status
    (AtmosboxError, Exception, 1),
    (SettingError, ValueError, 2),
    (UnknownSettingError, SettingError, 2),
    (UnitError, SettingError, 2),
    (PackingError, SettingError, 2),
    (UnknownSceneError, LookupError, 2),
    (ConfigError, ValueError, 2),
    (SoundingError, ValueError, 2),
    (FileError, OSError, 2),
    (DiskFullError, FileError, 1),
    (EngineError, RuntimeError, 1),
    (PhysicsError, ArithmeticError, 3),
]


def made(error):
    if issubclass(error, SettingError):
        return error(
            "temperature",
            "-5 K",
            "is below the lowest allowed, 1 K to 2000 K",
            Setting("temperature", "25degC"),
        )
    return error("The disk is full", "delete something, or give another ", Option("out"))


def test_every_error_is_an_atmosbox_error_and_a_builtin_with_a_status():
    for error, builtin, status in TREE:
        assert issubclass(error, AtmosboxError)
        assert issubclass(error, builtin)
        assert error.exit_code == status


def test_the_tree_here_and_in_the_docstring_is_complete():
    defined = {name for name in errors.__all__ if name.endswith("Error")}
    assert {error.__name__ for error, _, _ in TREE} == defined
    drawn = {word for word in errors.__doc__.split() if word.endswith("Error")}
    assert defined <= drawn


def test_the_text_of_an_error_is_its_sentence():
    for error in [error for error, _, _ in TREE]:
        expected = "The disk is full: delete something, or give another out."
        if issubclass(error, SettingError):
            expected = 'temperature = -5 K is below the lowest allowed, 1 K to 2000 K: give temperature="25degC".'
        assert str(made(error)) == expected


def test_errors_survive_the_way_back_from_another_process():
    for error in [error for error, _, _ in TREE]:
        original = made(error)
        for twin in (pickle.loads(pickle.dumps(original)), copy.copy(original)):
            assert type(twin) is error
            assert str(twin) == str(original)
            assert vars(twin) == vars(original)


def test_a_setting_error_without_a_value_starts_with_the_setting_alone():
    assert str(SettingError("x", None, "has no value", Setting("x", 1))) == "x has no value: give x=1."


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
        ("25 degC", "25 degC"),
        ("25°C", "25°C"),
        ("", '""'),
        (" 25", '" 25"'),
        ("a\nb\x1b[31m\u202e", "a\\nb\\x1b[31m\\u202e"),
        ("\ud800", "\\ud800"),
        ("x" * 61, '"' + "x" * 60 + '..."'),
        (True, "True"),
        (2**63, "9223372036854775808"),
        (10**60, "about 1e60"),
        (10**400, "about 1e400"),
        (10**400 - 1, "about 1e399"),
        (-(10**4000), "about -1e4000"),
        (float("nan"), "nan"),
        ([1, 2], "[1, 2]"),
        (Stranger(), "a Stranger"),
    ]
    for value, text in cases:
        assert shown(value) == text


def test_a_number_too_long_to_be_written_out_is_shown():
    assert shown(10**5000) == "about 1e5000"
    assert shown([10**5000]) == "a list"
