"""The errors of atmosbox, each with a message of one plain sentence.

The message says what is wrong, with the value that was given, and what to type instead; ``str(error)`` is that
sentence, and the command line prints it alone, without a traceback. Every class is also the builtin exception that a
Python programmer would catch, and has the status with which the command line ends::

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
    |-- EngineError (RuntimeError)       1   the engine stopped: its state is no longer valid
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


class AtmosboxError(Exception):
    """Something that atmosbox could not do; the message is one sentence.

    Parameters
    ----------
    sentence
        What is wrong and what the user can do.

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
        """Change the wording for a caller who does not type commands; the given values stay as they are.

        Parameters
        ----------
        words
            Function that returns a sentence, or a part of it, in the new wording.
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
        What is wrong with it, with the range that is allowed; the sentence puts it after the value.
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
        """Change the wording; the value stays as the user gave it."""
        self.setting, self.problem, self.fix = words(self.setting), words(self.problem), words(self.fix)
        self.args = (self.setting, self.value, self.problem, self.fix)

    def __str__(self) -> str:
        """Return the sentence."""
        subject = shown(self.setting) if self.value is None else f"{shown(self.setting)} = {shown(self.value)}"
        return f"{subject} {self.problem}: {self.fix}."


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
    """The engine stopped, because its state is no longer one that the laws of motion allow."""


class PhysicsError(AtmosboxError, ArithmeticError):
    """A physics check failed: the run disagrees with the textbook by more than its error allows."""

    exit_code = 3
