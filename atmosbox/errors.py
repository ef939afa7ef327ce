"""The errors of atmosbox, each with a message of one plain sentence.

The message says what is wrong, with the value that was given, and what to give instead; ``str(error)`` is that
sentence for a Python programmer, and the command line prints it in its own words. Every class is also the builtin
exception that a Python programmer would catch, and has the status with which the command line ends::

    AtmosboxError                        1
    |-- SettingError (ValueError)        2   a setting has a value that it may not have
    |   |-- UnknownSettingError          2   there is no setting of that name
    |   |-- UnitError                    2   a number or its unit cannot be understood or does not fit the setting
    |   `-- PackingError                 2   the molecules do not fit into their box
    |-- UnknownSceneError (LookupError)  2   there is no scene of that name
    |-- ConfigError (ValueError)         2   a settings file holds something that is not allowed there
    |-- SoundingError (ValueError)       2   a sounding cannot be understood, or cannot be true
    |-- FileError (OSError)              2   a file cannot be read or written, exists already, or is not from atmosbox
    |   `-- DiskFullError                1   the disk filled up while a run was saved
    |-- EngineError (RuntimeError)       1   the engine, or what it needs, cannot begin or cannot go on
    `-- PhysicsError (ArithmeticError)   3   the energy budget of a run is not closed
"""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable, Iterable, Mapping
from typing import ClassVar, NamedTuple


def shown(value: object, longest: int = 60) -> str:
    r"""Return a value in the form in which a sentence can repeat it: short, printable and on one line.

    Parameters
    ----------
    value
        The value that the user gave, of any type and size.
    longest
        Number of characters that are repeated; more for the path of a file, which is useful only as a whole.

    Returns
    -------
    str
        The value as text; characters that a terminal cannot print are escaped, and text that is empty, cut off, or
        begins or ends with a blank is put in quotes.

    Examples
    --------
    >>> shown("25 degC"), shown(""), shown("two\nlines"), shown(10**400)
    ('25 degC', '""', 'two\\nlines', 'about 1e400')
    """
    if isinstance(value, int) and abs(value) >= 10**longest:
        power = int((abs(value).bit_length() - 1) * 0.30102999)  # log10(2), rounded down
        power += abs(value) >= 10 ** (power + 1)
        return f"about {'-' if value < 0 else ''}1e{power}"
    try:
        text = value if isinstance(value, str) else str(value) if isinstance(value, int | float) else repr(value)
    except Exception:  # an unknown object may fail to describe itself
        text = f"a {type(value).__name__}"
    cut = text[:longest]
    safe = "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in cut)
    if len(text) > longest:
        return f'"{safe}..."'
    return f'"{safe}"' if not text or text != text.strip() else safe


class Setting(NamedTuple):
    """A setting of a scene that the user may give.

    Parameters
    ----------
    name
        Its name.
    value
        Its value, a text if it has a unit; None for the name alone.
    """

    name: str
    value: bool | float | str | None = None


class Option(NamedTuple):
    """An option of a command, which in Python is an argument of a function.

    Parameters
    ----------
    name
        Its name in Python.
    value
        Its value; True for a switch, a mapping for ``--vary``, None for the name alone.
    """

    name: str
    value: bool | float | str | Mapping[str, bool | float | str | None] | None = None


class Command(NamedTuple):
    """A command of atmosbox, some of which are functions in Python.

    Parameters
    ----------
    name
        Its name.
    given
        What it is given.
    """

    name: str
    given: tuple[str | Setting | Option, ...] = ()


Given = Setting | Option | Command
_FUNCTIONS = {"list": "scenes", "plot": "plot", "run": "run"}


def on_command_line(given: Given | str) -> str:
    """Return how something is typed on the command line.

    Examples
    --------
    >>> on_command_line(Setting("rotation", False)), on_command_line(Option("save_molecules", True))
    ('--set rotation=off', '--save-molecules')
    >>> on_command_line(Command("run", ("my scene.py", Option("engine", "dsmc"))))
    "atmosbox run 'my scene.py' --engine dsmc"
    """
    if isinstance(given, str):
        return shlex.quote(given)
    if isinstance(given, Command):
        return " ".join(["atmosbox", given.name, *map(on_command_line, given.given)])
    if isinstance(given, Setting):
        return on_command_line(Option("set", {given.name: given.value}))
    option = f"--{given.name.replace('_', '-')}"
    if isinstance(given.value, Mapping):
        return " ".join([option, *(name if v is None else f"{name}={_typed(v)}" for name, v in given.value.items())])
    return option if given.value is None or given.value is True else f"{option} {_typed(given.value)}"


def in_python(given: Given | str) -> str:
    """Return how something is written in Python; a command that is no function there is typed in a shell.

    Examples
    --------
    >>> in_python(Setting("rotation", False)), in_python(Option("out"))
    ('rotation=False', 'out')
    >>> in_python(Command("run", ("lifting-dry", Option("save_molecules", True))))
    'atmosbox.run("lifting-dry", save_molecules=True)'
    """
    if isinstance(given, str):
        return json.dumps(given, ensure_ascii=False)
    if isinstance(given, Command):
        options = {part.name for part in given.given if isinstance(part, Option)}
        if given.name not in _FUNCTIONS or options & {"from", "resume"}:
            return on_command_line(given)
        return f"atmosbox.{_FUNCTIONS[given.name]}({', '.join(map(in_python, given.given))})"
    if isinstance(given.value, Mapping):
        pairs = (f"{in_python(name)}: {'...' if v is None else in_python(str(v))}" for name, v in given.value.items())
        return f"{given.name}={{{', '.join(pairs)}}}"
    if given.value is None:
        return given.name
    return f"{given.name}={in_python(given.value) if isinstance(given.value, str) else given.value}"


def either(option: str, values: Iterable[str]) -> tuple[Option | str, ...]:
    """Return the parts of a remedy that name several values of an option, with "or" between them.

    Examples
    --------
    >>> str(SettingError("theme", "pink", "is not a theme", *either("theme", ["notes", "slides"])))
    'theme = pink is not a theme: give theme="notes" or theme="slides".'
    """
    return tuple(part for value in values for part in (" or ", Option(option, value)))[1:]


def _typed(value: bool | float | str) -> str:
    """Return a value as it is typed in a shell."""
    return ("on" if value else "off") if isinstance(value, bool) else shlex.quote(str(value))


class AtmosboxError(Exception):
    """Something that atmosbox could not do; the message is one sentence.

    It names what the user may give by name and value, and each interface has its own words for that: ``str(error)``
    those of Python, ``error.said(on_command_line)`` those of the command line.

    Parameters
    ----------
    problem
        What is wrong; a whole sentence if there is no remedy.
    *remedy
        What the user can do: the parts of the end of the sentence, each a text or something to give. Before a first
        part that is to be given stands "give", before a command "type".

    Attributes
    ----------
    problem, remedy
        The parts of the sentence.
    exit_code
        The status with which the command line ends: 1 a run failed, 2 a request is wrong, 3 a physics check
        failed.

    Examples
    --------
    >>> raise EngineError("Molecule 7 left the box at 0.3 ns.")
    Traceback (most recent call last):
    atmosbox.errors.EngineError: Molecule 7 left the box at 0.3 ns.
    >>> error = FileError("x.nc exists already", "add ", Option("force", True), " to replace it")
    >>> str(error), error.said(on_command_line)
    ('x.nc exists already: add force=True to replace it.', 'x.nc exists already: add --force to replace it.')
    """

    exit_code: ClassVar[int] = 1

    def __init__(self, problem: str, *remedy: Given | str) -> None:
        super().__init__(problem)
        self.args = (problem, *remedy)  # with which another process makes this error
        self.problem = problem
        self.remedy = remedy

    def instead_of_settings(self, given: Callable[[Setting], Given]) -> None:
        """Name something else in place of each setting in the remedy, such as the option for which a value was read."""
        self.remedy = tuple(given(part) if isinstance(part, Setting) else part for part in self.remedy)

    def said(self, words: Callable[[Given], str]) -> str:
        """Return the sentence in the words of an interface.

        Parameters
        ----------
        words
            Function that returns how something is given there: `on_command_line`, `in_python`.
        """
        if not self.remedy:
            return self._wrong()
        first = "" if isinstance(self.remedy[0], str) else "type " if isinstance(self.remedy[0], Command) else "give "
        remedy = "".join(part if isinstance(part, str) else words(part) for part in self.remedy)
        return f"{self._wrong()}: {first}{remedy}."

    def _wrong(self) -> str:
        return self.problem

    def __str__(self) -> str:
        """Return the sentence in the words of Python."""
        return self.said(in_python)


class SettingError(AtmosboxError, ValueError):
    """A setting or an option was given a value that it may not have.

    Parameters
    ----------
    name
        Its name.
    value
        The value as the user gave it; None if there is none to show.
    problem
        What is wrong with it, with the range that is allowed; the sentence puts it after the value.
    *remedy
        What to give instead: the parts of the end of the sentence, each a text or something to give.

    Attributes
    ----------
    name, value, problem, remedy
        The parts of the sentence.

    Examples
    --------
    >>> error = SettingError("temperature", "-5 K", "is below the allowed range, 1 K to 2000 K",
    ...                      Setting("temperature", "1K"))
    >>> print(error)
    temperature = -5 K is below the allowed range, 1 K to 2000 K: give temperature="1K".
    >>> print(error.said(on_command_line))
    temperature = -5 K is below the allowed range, 1 K to 2000 K: give --set temperature=1K.
    """

    exit_code = 2

    def __init__(self, name: str, value: object, problem: str, *remedy: Given | str) -> None:
        super().__init__(problem, *remedy)
        self.args = (name, value, problem, *remedy)
        self.name = name
        self.value = value

    def _wrong(self) -> str:
        return f"{shown(self.name)}{'' if self.value is None else f' = {shown(self.value)}'} {self.problem}"


class UnknownSettingError(SettingError):
    """A scene has no setting of that name; the sentence suggests the nearest one."""


class UnitError(SettingError):
    """A number or its unit cannot be understood, or its unit has another dimension than the setting."""


class PackingError(SettingError):
    """The molecules are too many or too large for their box."""


class UnknownSceneError(AtmosboxError, LookupError):
    """There is no scene of that name."""

    exit_code = 2


class ConfigError(AtmosboxError, ValueError):
    """A settings file is not TOML, or contains something that a settings file must not."""

    exit_code = 2


class SoundingError(AtmosboxError, ValueError):
    """A sounding is in no known format, lacks required values, or has values that no atmosphere can have."""

    exit_code = 2


class FileError(AtmosboxError, OSError):
    """A file cannot be read, was not written by atmosbox, exists already, or cannot be written."""

    exit_code = 2


class DiskFullError(FileError):
    """The disk filled up while a run was saved."""

    exit_code = 1


class EngineError(AtmosboxError, RuntimeError):
    """The engine, or what it needs, cannot begin or cannot go on."""


class PhysicsError(AtmosboxError, ArithmeticError):
    """The energy budget of a run is not closed."""

    exit_code = 3
