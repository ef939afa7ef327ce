"""The text of a sheet: what a lecturer writes about a scene, read from a file beside the scene.

The file for ``my_scene.py`` is ``my_scene.sheet.toml``. It is data and runs no code. Its texts may contain sums (see
`sums`) and marks (see `marks`). ``my_scene.sheet.de.toml`` has its texts in German.
"""

import os
import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from atmosbox import scenarios
from atmosbox.errors import ConfigError, FileError, Option, shown
from atmosbox.sheet import marks, sums

SUFFIX = ".sheet.toml"
LANGUAGES = {"en": "English", "de": "German"}
"""The languages of a sheet, with their names in English."""
MOST_CHANGES = 3
SECTIONS = {"notice": "Notice", "try": "Try", "differ": "Why do they differ?", "further": "Go further"}
"""The headings of the groups of questions, by their names in the file."""


def _text(found: Any, place: str) -> str:
    """Return a text as one line; refuse it if its sums or marks are not allowed."""
    if not isinstance(found, str):
        raise ConfigError(f"{place} is not a text: put it in quotes")
    text = " ".join(found.split())
    try:
        sums.check(text)
        marks.check(re.sub(r"\{\{.*?\}\}", "0", text))
    except ConfigError as error:
        raise ConfigError(f"{place}: {error}") from error
    return text


_KINDS: dict[str, tuple[Callable[[Any], bool], str]] = {
    "text": (lambda found: bool(found.strip()), "is empty: write a text"),
    "number": (lambda found: type(found) is int and 0 <= found <= 12, "is not a whole number from 0 to 12: correct it"),
    "switch": (lambda found: isinstance(found, bool), "is neither true nor false: write one of them"),
    "settings": (lambda found: isinstance(found, dict) and bool(found), "names no setting: write {molecules = 200}"),
}
"""What an entry of each kind must be, and what is wrong with another one."""
_QUESTION: dict[str, tuple[Any, Any]] = {  # the shape of each entry, and its default, which is ... if it must be given
    "ask": ("text", ...),
    "answer": ("text", ""),
    "lines": ("number", None),  # empty ones, below the question
    "lab": ("switch", True),  # whether running pages can answer it
}
_PREDICTION = _QUESTION | {
    "choices": (["text"], ()),  # to tick; the one with the number `right` is right
    "right": ("number", None),
    "sketch": ({"x": ("text", ...), "y": ("text", ...)}, None),  # empty axes for a guess: their labels, with units
}
_ROW = {
    "headline": ("text", ...),
    "label": ("text", ...),
    "unit": ("text", "1"),
    "theory": ("text", ""),  # the formula for students; empty if that needs a computer
    "runs": ("text", "ABCD"),  # the letters of the runs that report it
}
_SHEET = {
    "goal": ("text", ...),  # the subject of the sheet, in two sentences
    "predict": ([_PREDICTION], ()),
    "change": ([{"title": ("text", ...), "set": ("settings", ...)}], ()),  # of the runs after the first
    "row": ([_ROW], ()),  # of the table; if there are none, it has all headlines of the scene
    **{name: ([_QUESTION], ()) for name in SECTIONS},
    "constants": ("text", ""),  # that the formulas need, printed above the table
    "copying": ("text", ""),  # about the theory in the table, printed after them; not in a sheet for pages
    "leaves_out": ("text", ""),  # what the model leaves out; if it is empty, the scene's docstring tells it
}


def _checked(found: Any, shape: Any, place: str, default: Any = ...) -> Any:
    """Return an entry of the file, checked: a table, a list of entries, a text, or a value of another kind."""
    match shape:
        case dict():
            return _table(found, shape, place)
        case [entry]:
            if not isinstance(found, list):
                again = f"write [[{place.partition(' ')[0]}]] with two brackets, or a list of texts for choices"
                raise ConfigError(f"{place} is not a list: {again}")
            if place == "change" and len(found) > MOST_CHANGES:
                raise ConfigError(f"{place} are too many: keep {MOST_CHANGES} of them")
            return [_checked(each, entry, f"{place} {number}") for number, each in enumerate(found, 1)]
    found = _text(found, place) if shape == "text" else found
    allowed, problem = _KINDS[shape]
    if not allowed(found) and found != default:
        raise ConfigError(f"{place} {problem}")
    return found


def _table(found: Any, entries: dict[str, tuple[Any, Any]], place: str) -> dict[str, Any]:
    """Return a table of the file, checked, with the defaults of what it does not have."""
    if not isinstance(found, dict):
        raise ConfigError(f"{place} is not a table: write [{place}] above its entries")
    within = f"{place}, " if place else ""
    for name in sorted(found.keys() - entries.keys()):
        raise ConfigError(f"{within}{shown(name)} is unknown: correct the name, or remove it")
    read = {}
    for name, (shape, default) in entries.items():
        if default is ... and name not in found:
            raise ConfigError(f"{within}{name} is missing: add it")
        read[name] = _checked(found[name], shape, within + name, default) if name in found else default
    if (right := read.get("right")) is not None and not 1 <= right <= len(read["choices"]):
        count = len(read["choices"])
        raise ConfigError(f"{place}: right = {right} is the number of none of its {count} choices: count from 1")
    return read


_DATA = {"set", "headline", "unit", "runs", "right", "lines", "lab"}
"""The entries that are no text: a translation has those of the English file."""


def _overlaid(english: Any, told: Any, place: str) -> Any:
    """Return an entry of the English file, not yet checked, with its texts from a translation."""
    match english, told:
        case dict(), dict():
            for name in sorted(told.keys() - (english.keys() - _DATA)):
                raise ConfigError(f"{place}{shown(name)} is not a text of the English file: remove it")
            kept = _DATA if "theory" in told else {*_DATA, "theory"}  # a formula without words is the same
            return {
                name: each if name in kept else _overlaid(each, told.get(name), f"{place}{name}, ")
                for name, each in english.items()
            }
        case list(), list() if len(english) == len(told):
            pairs = zip(english, told, strict=True)
            return [_overlaid(*pair, f"{place.rstrip(', ')} {n}, ") for n, pair in enumerate(pairs, 1)]
        case str(), str():
            return told
    raise ConfigError(f"{place.rstrip(', ')} is missing or has other entries than the English file: write it as there")


def text_of(module: ModuleType) -> Path | None:
    """Return the file with the text of a scene's sheet; a variant without a file has that of its original scene.

    >>> from atmosbox import scenarios
    >>> text_of(scenarios.load("lifting-dry")).name
    'lifting_dry.sheet.toml'
    """
    own = Path(str(module.__file__)).with_suffix(SUFFIX)
    if own.is_file():
        return own
    base = getattr(module, "variant_of", None)
    return None if base is None else text_of(scenarios.load(base))


def translated(path: str | os.PathLike[str], language: str) -> Path:
    """Return the file with the text of a sheet in a language, from that of the English text.

    >>> translated("my_scene.sheet.toml", "de").name
    'my_scene.sheet.de.toml'
    """
    return Path(path) if language == "en" else Path(path).with_suffix(f".{language}.toml")


def read(path: str | os.PathLike[str], language: str = "en") -> dict[str, Any]:
    """Read the text of a sheet: the entries of its file, and the defaults of those that it does not have.

    Its sums are not yet worked out. In another language than English, its texts are those of a second file.

    >>> read("no/such.sheet.toml")
    Traceback (most recent call last):
    atmosbox.errors.FileError: The words of the sheet cannot be read from no/such.sheet.toml: No such file or directory.
    """
    translation = translated(path, language)
    if language != "en" and not translation.is_file():
        missing = f"This scene has no worksheet in {LANGUAGES[language]} (no file {translation.name})"
        raise FileError(missing, "leave ", Option("language"), " out")
    try:
        found = tomllib.loads(Path(path).read_text(encoding="utf-8"))
        if language != "en":
            path = translation
            found = _overlaid(found, tomllib.loads(path.read_text(encoding="utf-8")), "")
        return _table(found, _SHEET, "")
    except OSError as error:
        raise FileError(f"The words of the sheet cannot be read from {path}: {error.strerror}.") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path} is not TOML ({error}): correct it and try again.") from error
    except ConfigError as error:
        raise ConfigError(f"{path}: {error}; see docs/sheet.md.") from error
