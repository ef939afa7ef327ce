"""The errors of atmosbox, each with a message of one plain sentence.

The message says what is wrong, with the value that was given, and what to type instead; ``str(error)`` is the message,
and the command line prints it without a traceback. Every class is also a subclass of the built-in exception that a
Python programmer would catch, and has the exit status of the command line::

    AtmosboxError                        1
    |-- SettingError (ValueError)        2   a setting has a value that it may not have
    |   |-- UnknownSettingError          2   there is no setting of that name
    |   |-- UnitError                    2   a number or its unit cannot be understood or does not fit the setting
    |   `-- PackingError                 2   the molecules do not fit into their box
    |-- UnknownSceneError (LookupError)  2   there is no scene of that name
    |-- ConfigError (ValueError)         2   a settings file contains something that it must not
    |-- SoundingError (ValueError)       2   a sounding cannot be understood, or is impossible
    |-- FileError (OSError)              2   a file cannot be read or written, exists already, or is of another program
    |   `-- DiskFullError                1   the disk filled up while a run was saved
    |-- EngineError (RuntimeError)       1   the engine stopped: its state is no longer physically possible
    `-- PhysicsError (ArithmeticError)   3   a physics check failed: the run disagrees with the textbook
"""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

__all__ = [
    "AtmosboxError",
    "ConfigError",
    "DiskFullError",
    "EngineError",
    "FileError",
    "PackingError",
    "PhysicsError",
    "SettingError",
    "SoundingError",
    "UnitError",
    "UnknownSceneError",
    "UnknownSettingError",
    "shown",
]


def shown(value: object, longest: int = 60) -> str:
    r"""Return a value as a message can repeat it: short, printable and on one line.

    Parameters
    ----------
    value
        The value that the user gave, of any type and size.
    longest
        Largest number of characters to repeat; larger for the path of a file, which is useful only when complete.

    Returns
    -------
    str
        The value as text; characters that a terminal cannot print are escaped, and text that is empty, is cut, or
        begins or ends with white space is put in quotes.

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
    except Exception:  # str() of an object of another program may fail
        text = f"a {type(value).__name__}"
    cut = text[:longest]
    safe = "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in cut)
    if len(text) > longest:
        return f'"{safe}..."'
    return f'"{safe}"' if not text or text != text.strip() else safe


class AtmosboxError(Exception):
    """An error of atmosbox, with a message of one sentence.

    Parameters
    ----------
    sentence
        The message: what is wrong and what to do about it.

    Attributes
    ----------
    exit_code
        The status with which the command line ends: 1 a run failed, 2 a request is wrong, 3 a physics check
        failed.

    Examples
    --------
    >>> raise EngineError("Molecule 7 left the box at 0.3 ns.")
    Traceback (most recent call last):
    atmosbox.errors.EngineError: Molecule 7 left the box at 0.3 ns.
    """

    exit_code: ClassVar[int] = 1

    def reword(self, words: Callable[[str], str]) -> None:
        """Change the words of the message, for a caller who does not type commands; given values stay as they are.

        Parameters
        ----------
        words
            Function that takes a sentence, or a part of it, and returns it in other words.
        """
        self.args = tuple(words(part) if isinstance(part, str) else part for part in self.args)


class SettingError(AtmosboxError, ValueError):
    """A setting was given a value that it may not have.

    Parameters
    ----------
    setting
        The name of the setting.
    value
        The value as the user gave it; None if there is none to show.
    problem
        What is wrong with the value, worded to follow it in the sentence, with the allowed range.
    fix
        What to type instead.

    Attributes
    ----------
    setting, value, problem, fix
        The parts of the sentence, as given.

    Examples
    --------
    >>> str(SettingError("temperature", "-5 K", "is below the lowest allowed, 1 K to 2000 K",
    ...                  "give --set temperature=25degC"))
    'temperature = -5 K is below the lowest allowed, 1 K to 2000 K: give --set temperature=25degC.'
    """

    exit_code = 2

    def __init__(self, setting: str, value: object, problem: str, fix: str) -> None:
        super().__init__(setting, value, problem, fix)
        self.setting = setting
        self.value = value
        self.problem = problem
        self.fix = fix

    def reword(self, words: Callable[[str], str]) -> None:
        """Change the words of the message; the value stays as the user gave it."""
        self.setting, self.problem, self.fix = words(self.setting), words(self.problem), words(self.fix)
        self.args = (self.setting, self.value, self.problem, self.fix)

    def __str__(self) -> str:
        """Return the sentence."""
        subject = shown(self.setting) if self.value is None else f"{shown(self.setting)} = {shown(self.value)}"
        return f"{subject} {self.problem}: {self.fix}."


class UnknownSettingError(SettingError):
    """A scene has no setting of that name; the message offers the nearest one."""


class UnitError(SettingError):
    """A number or its unit cannot be understood, or its unit has another dimension than the setting."""


class PackingError(SettingError):
    """The molecules do not fit into their box."""


class UnknownSceneError(AtmosboxError, LookupError):
    """There is no scene of that name."""

    exit_code = 2


class ConfigError(AtmosboxError, ValueError):
    """A settings file is not TOML, or contains something that a settings file must not."""

    exit_code = 2


class SoundingError(AtmosboxError, ValueError):
    """A sounding is in no known format, lacks required values, or has values that are impossible in an atmosphere."""

    exit_code = 2


class FileError(AtmosboxError, OSError):
    """A file cannot be read, was not written by atmosbox, exists already, or cannot be written."""

    exit_code = 2


class DiskFullError(FileError):
    """The disk filled up while a run was saved."""

    exit_code = 1


class EngineError(AtmosboxError, RuntimeError):
    """The engine stopped, because its state is no longer one that the laws of motion allow."""


class PhysicsError(AtmosboxError, ArithmeticError):
    """A physics check failed: the run disagrees with the textbook by more than its error allows."""

    exit_code = 3
