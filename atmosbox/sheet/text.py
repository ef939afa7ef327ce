"""The text of a sheet: what a lecturer writes about a scene, read from a file beside the scene.

The file for ``my_scene.py`` is ``my_scene.sheet.toml``. It is data and runs no code. Its texts may contain sums (see
`sums`) and marks (see `marks`).
"""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from atmosbox import scenarios
from atmosbox.errors import ConfigError, FileError, shown
from atmosbox.sheet import marks, sums

__all__ = ["SECTIONS", "Change", "read", "text_of"]

SUFFIX = ".sheet.toml"
SECTIONS = {"notice": "Notice", "try": "Try", "differ": "Why do they differ?", "further": "Go further"}
"""The headings of the groups of questions, by their names in the file."""


Reader = Callable[[Any, str], Any]
"""Returns an entry of the file, checked, from what was written and the place where it stands."""


class Change(NamedTuple):
    """The change of a further run, which differs from the first in one respect, by one or several settings."""

    title: str
    set: dict[str, Any]


def _text(found: Any, place: str) -> str:
    """Return a text as one line; refuse it if its sums or marks are not allowed."""
    if not isinstance(found, str):
        raise ConfigError(f"{place} is no text: put it in quotes")
    text = " ".join(found.split())
    try:
        sums.check(text)
        marks.check(re.sub(r"\{\{.*?\}\}", "0", text))
    except ConfigError as error:
        raise ConfigError(f"{place}: {error}") from error
    return text


def _needed(found: Any, place: str) -> str:
    text = _text(found, place)
    if not text:
        raise ConfigError(f"{place} is empty: write a text")
    return text


def _such(allowed: Callable[[Any], bool], problem: str) -> Reader:
    """Return what reads a value that must be allowed."""

    def read(found: Any, place: str) -> Any:
        if not allowed(found):
            raise ConfigError(f"{place} {problem}")
        return found

    return read


_NUMBER = _such(lambda found: type(found) is int and 0 <= found <= 12, "is no whole number from 0 to 12: correct it")
_SWITCH = _such(lambda found: isinstance(found, bool), "is neither true nor false: write one of them")
_SETTINGS = _such(lambda found: isinstance(found, dict) and bool(found), "names no setting: write {molecules = 200}")


def _list(entry: Reader, most: int | None = None) -> Reader:
    """Return what reads a list of entries, at most so many."""

    def read(found: Any, place: str) -> list[Any]:
        if not isinstance(found, list):
            name = place.partition(" ")[0]
            raise ConfigError(f"{place} is no list: write [[{name}]] with two brackets, or a list of texts for choices")
        if most is not None and len(found) > most:
            raise ConfigError(f"{place} are too many: keep {most} of them")
        return [entry(each, f"{place} {number}") for number, each in enumerate(found, 1)]

    return read


def _table(**entries: tuple[Reader, Any]) -> Reader:
    """Return what reads a table of entries, each with its reader and its default, which is ... if it must be given."""

    def read(found: Any, place: str) -> dict[str, Any]:
        if not isinstance(found, dict):
            raise ConfigError(f"{place} is no table: write [{place}] above its entries")
        within = f"{place}, " if place else ""
        for name in sorted(found.keys() - entries.keys()):
            raise ConfigError(f"{within}{shown(name)} is unknown: correct the name, or remove it")
        for name, (_, default) in entries.items():
            if default is ... and name not in found:
                raise ConfigError(f"{within}{name} is missing: add it")
        return {
            name: reader(found[name], f"{within}{name}") if name in found else default
            for name, (reader, default) in entries.items()
        }

    return read


_QUESTION: dict[str, tuple[Reader, Any]] = {
    "ask": (_needed, ...),
    "answer": (_text, ""),
    "lines": (_NUMBER, None),  # empty ones, below the question
    "lab": (_SWITCH, True),  # whether running pages can answer it
}
_PREDICTION = _table(
    **_QUESTION,
    choices=(_list(_needed), ()),  # to tick; the one with the number `right` is right
    right=(_NUMBER, None),
    sketch=(_table(x=(_needed, ...), y=(_needed, ...)), None),  # empty axes for a guess: their labels, with units
)


def _prediction(found: Any, place: str) -> dict[str, Any]:
    """Return a prediction that is written down before the run: answers to tick, a sketch, or free lines."""
    read: dict[str, Any] = _PREDICTION(found, place)
    right, choices = read["right"], read["choices"]
    if right is not None and not 1 <= right <= len(choices):
        raise ConfigError(f"{place}: right = {right} is the number of none of its {len(choices)} choices: count from 1")
    return read


_SHEET = _table(
    goal=(_needed, ...),  # the subject of the sheet, in two sentences
    predict=(_list(_prediction), ()),
    change=(_list(_table(title=(_needed, ...), set=(_SETTINGS, ...)), 3), ()),  # of the runs after the first
    row=(  # of the table; if there are none, it has all headlines of the scene
        _list(
            _table(
                headline=(_needed, ...),
                label=(_needed, ...),
                unit=(_text, "1"),
                theory=(_text, ""),  # the formula for students; empty if that needs a computer
                runs=(_text, "ABCD"),  # the letters of the runs that report it
            )
        ),
        (),
    ),
    **{name: (_list(_table(**_QUESTION)), ()) for name in SECTIONS},
    constants=(_text, ""),  # that the formulas need, printed above the table
    leaves_out=(_text, ""),  # what the model leaves out; if it is empty, the scene's docstring tells it
)


def text_of(module: ModuleType) -> Path | None:
    """Return the file with the text of a scene's sheet; a variant without a file has that of its original scene.

    Parameters
    ----------
    module
        The scene, from `atmosbox.scenarios.load`.

    Returns
    -------
    pathlib.Path or None
        The file, None if there is none.

    Examples
    --------
    >>> from atmosbox import scenarios
    >>> text_of(scenarios.load("lifting-dry")).name
    'lifting_dry.sheet.toml'
    """
    own = Path(str(module.__file__)).with_suffix(SUFFIX)
    if own.is_file():
        return own
    base = getattr(module, "variant_of", None)
    return None if base is None else text_of(scenarios.load(base))


def read(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Read the text of a sheet.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    dict
        The entries of the file, and the defaults of those that it does not have; their sums are not yet worked out.

    Raises
    ------
    FileError
        If the file cannot be read.
    ConfigError
        If the file is not TOML, lacks an entry that a sheet needs, or has an unknown or wrong entry.

    Examples
    --------
    >>> read("no/such.sheet.toml")
    Traceback (most recent call last):
    atmosbox.errors.FileError: The words of the sheet cannot be read from no/such.sheet.toml: No such file or directory.
    """
    try:
        words: dict[str, Any] = _SHEET(tomllib.loads(Path(path).read_text(encoding="utf-8")), "")
        return words
    except OSError as error:
        raise FileError(f"The words of the sheet cannot be read from {path}: {error.strerror}.") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path} is not TOML ({error}): correct it and try again.") from error
    except ConfigError as error:
        raise ConfigError(f"{path}: {error}; see docs/sheet.md.") from error
