"""Everything atmosbox can refuse or fail at, each said in one plain sentence.

An error says what is wrong, with the value that was given, and what to type instead; ``str(error)`` is that
sentence, and the command line prints it alone, without a traceback. Every class is also the builtin that a
Python programmer would catch, and knows the status with which the command line ends::

    AtmosboxError                        1
    |-- SettingError (ValueError)        2   a setting has a value that it may not have
    |   |-- UnknownSettingError          2   there is no setting of that name
    |   |-- UnitError                    2   a number or its unit cannot be understood
    |   `-- PackingError                 2   the molecules do not fit into their box
    |-- UnknownSceneError (LookupError)  2   there is no scene of that name
    |-- ConfigError (ValueError)         2   a settings file says something it cannot say
    |-- SoundingError (ValueError)       2   a sounding cannot be understood, or not be true
    |-- FileError (OSError)              2   a file is unreadable, foreign, in the way or unwritable
    |   `-- DiskFullError                1   the disk filled up while a run was saved
    |-- EngineError (RuntimeError)       1   the engine stopped: its state is no longer lawful
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
    r"""Return a value as a sentence can repeat it: short, printable and on one line.

    Parameters
    ----------
    value
        Whatever the user gave, of any type and size.
    longest
        How many characters of it are repeated; more for the path of a file, which is of use only when whole.

    Returns
    -------
    str
        The value as text; what a terminal cannot print is escaped, and text that would not be seen, or not be
        seen whole, is put in quotes.

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
    except Exception:  # a stranger's object may fail to say what it is
        text = f"a {type(value).__name__}"
    cut = text[:longest]
    safe = "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in cut)
    if len(text) > longest:
        return f'"{safe}..."'
    return f'"{safe}"' if not text or text != text.strip() else safe


class AtmosboxError(Exception):
    """Something atmosbox could not do, said in one sentence.

    Parameters
    ----------
    sentence
        What is wrong and what to do about it.

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
        """Say the same in other words, for a caller who does not type commands; what was given stays as it is.

        Parameters
        ----------
        words
            Returns a sentence, or a part of it, in those words.
        """
        self.args = tuple(words(part) if isinstance(part, str) else part for part in self.args)


class SettingError(AtmosboxError, ValueError):
    """A setting was given a value that it may not have.

    Parameters
    ----------
    setting
        The name of the setting.
    value
        The value as the user gave it; None where there is none to show.
    problem
        What is wrong with it, worded to follow the value, with the range that is allowed.
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
        """Say the same in other words; the value stays as the user gave it."""
        self.setting, self.problem, self.fix = words(self.setting), words(self.problem), words(self.fix)
        self.args = (self.setting, self.value, self.problem, self.fix)

    def __str__(self) -> str:
        """Return the sentence."""
        subject = shown(self.setting) if self.value is None else f"{shown(self.setting)} = {shown(self.value)}"
        return f"{subject} {self.problem}: {self.fix}."


class UnknownSettingError(SettingError):
    """A scene has no setting of that name; the sentence offers the nearest one."""


class UnitError(SettingError):
    """A number or its unit cannot be understood, or measures something else than the setting."""


class PackingError(SettingError):
    """So many molecules of that diameter do not fit into their box."""


class UnknownSceneError(AtmosboxError, LookupError):
    """There is no scene of that name."""

    exit_code = 2


class ConfigError(AtmosboxError, ValueError):
    """A settings file is not TOML, or holds something else than one scene and its settings."""

    exit_code = 2


class SoundingError(AtmosboxError, ValueError):
    """A sounding is in no known format, lacks what it must hold, or says what no atmosphere can be."""

    exit_code = 2


class FileError(AtmosboxError, OSError):
    """A file is unreadable, not one of atmosbox's, in the way of a new one, or cannot be written."""

    exit_code = 2


class DiskFullError(FileError):
    """The disk filled up while a run was saved."""

    exit_code = 1


class EngineError(AtmosboxError, RuntimeError):
    """The engine stopped, because its state is no longer one that the laws of motion allow."""


class PhysicsError(AtmosboxError, ArithmeticError):
    """A physics check failed: the run disagrees with the textbook by more than its error allows."""

    exit_code = 3
