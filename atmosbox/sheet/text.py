"""The words of a sheet: what a lecturer writes about a scene, read from a file beside it.

The file of ``my_scene.py`` is ``my_scene.sheet.toml``. It is data: nothing in it runs. Its texts may hold sums in
braces (see `arithmetic`) and marks of `markup`.
"""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from atmosbox import scenarios
from atmosbox.errors import ConfigError, FileError
from atmosbox.sheet.entry import Table

__all__ = ["SECTIONS", "Change", "Prediction", "Question", "Row", "SheetText", "Sketch", "read", "text_of"]

SUFFIX = ".sheet.toml"
SECTIONS = {
    "notice": "Notice",
    "try": "Try",
    "differ": "Why do they differ?",
    "further": "Go further",
}
"""The headings of the questions by their names in the file."""
MOST_RUNS = 4


@dataclass(frozen=True)
class Sketch:
    """Empty axes to draw a guess into.

    Parameters
    ----------
    x, y
        What the axes show, with units.
    hint
        What to draw.
    """

    x: str
    y: str
    hint: str = ""


@dataclass(frozen=True)
class Prediction:
    """What is written down before the run.

    Parameters
    ----------
    ask
        The question.
    choices
        Answers to tick; none for free lines.
    sketch
        Axes to draw into; None for none.
    lines
        How many empty lines there are.
    answer
        What the run shows.
    """

    ask: str
    choices: tuple[str, ...] = ()
    sketch: Sketch | None = None
    lines: int = 1
    answer: str = ""


@dataclass(frozen=True)
class Change:
    """A run beside the first that differs in one thing.

    Parameters
    ----------
    title
        What differs, in words.
    settings
        The setting, or those few that make up the one thing.
    """

    title: str
    settings: Mapping[str, Any]


@dataclass(frozen=True)
class Row:
    """A row of the table: a headline of the scene.

    Parameters
    ----------
    headline
        Its name.
    label, unit
        What the table calls it and the unit it is in, as the headline has them.
    theory
        The formula from which the student works out what theory says; empty where a computer must.
    runs
        The letters of the runs that report it; empty for all.
    """

    headline: str
    label: str
    unit: str
    theory: str = ""
    runs: str = ""


@dataclass(frozen=True)
class Question:
    """A question with empty lines below it, or with its answer."""

    ask: str
    answer: str = ""
    lines: int = 2


@dataclass(frozen=True)
class SheetText:
    """All words of the sheet of a scene.

    Parameters
    ----------
    goal
        What it is about, in two sentences.
    predict
        What is to be written down before the run.
    changes
        The runs beside the first.
    rows
        The rows of the table; none to take whatever the scene reports.
    questions
        Those of each section, by its name in `SECTIONS`.
    constants
        What the formulas need, below the table.
    leaves_out
        What the model leaves out.
    """

    goal: str
    predict: tuple[Prediction, ...]
    changes: tuple[Change, ...]
    rows: tuple[Row, ...]
    questions: Mapping[str, tuple[Question, ...]]
    constants: str = ""
    leaves_out: str = ""


def text_of(module: ModuleType) -> Path | None:
    """Return the file with the words of a scene; a variant without its own has that of its original.

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


def read(path: str | os.PathLike[str]) -> SheetText:
    """Read the words of a sheet.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    SheetText
        Its words, with the sums in them not yet worked out.

    Raises
    ------
    FileError
        If it cannot be read.
    ConfigError
        If it is not TOML, lacks what a sheet needs, or says what a sheet does not know.

    Examples
    --------
    >>> read("no/such.sheet.toml")
    Traceback (most recent call last):
    atmosbox.errors.FileError: The words of the sheet cannot be read from no/such.sheet.toml: No such file or directory.
    """
    try:
        content = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise FileError(f"The words of the sheet cannot be read from {path}: {error.strerror}.") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path} is not TOML ({error}): correct it and try again.") from error
    return _sheet(Table(os.fspath(path), "the sheet", content))


def _sheet(table: Table) -> SheetText:
    """Return a sheet from the table that the file is."""
    questions = {
        name: tuple(_question(each) for each in table.tables(name, f"question [[{name}]]")) for name in SECTIONS
    }
    found = SheetText(
        goal=table.text("goal"),
        predict=tuple(_prediction(each) for each in table.tables("predict", "prediction")),
        changes=tuple(_change(each) for each in table.tables("change", "change")),
        rows=tuple(_row(each) for each in table.tables("row", "row")),
        questions=questions,
        constants=table.text("constants", ""),
        leaves_out=table.text("leaves_out", ""),
    )
    table.close()
    if len(found.changes) >= MOST_RUNS:
        raise table.refusal(f"has {len(found.changes)} changes, and {MOST_RUNS - 1} are the most")
    return found


def _question(table: Table) -> Question:
    found = Question(table.text("ask"), table.text("answer", ""), table.number("lines", 2))
    table.close()
    return found


def _row(table: Table) -> Row:
    names = table.text("headline"), table.text("label"), table.text("unit", "1")
    found = Row(*names, table.text("theory", ""), table.text("runs", ""))
    table.close()
    return found


def _change(table: Table) -> Change:
    settings = table.content.pop("set", None)
    if not isinstance(settings, dict) or not settings:
        raise table.refusal("needs the setting that it changes, such as set = {molecules = 800}")
    found = Change(table.text("title"), settings)
    table.close()
    return found


def _prediction(table: Table) -> Prediction:
    choices = table.content.pop("choices", [])
    if not isinstance(choices, list) or not all(isinstance(each, str) for each in choices):
        raise table.refusal("needs a list of texts for choices")
    sketch = table.content.pop("sketch", None)
    if sketch is not None:
        axes = Table(table.path, f"the sketch of {table.name}", sketch)
        sketch = Sketch(axes.text("x"), axes.text("y"), axes.text("hint", ""))
        axes.close()
    lines = table.number("lines", 0 if choices or sketch else 2)
    found = Prediction(table.text("ask"), tuple(choices), sketch, lines, table.text("answer", ""))
    table.close()
    return found
