"""The text of a sheet: what a lecturer writes about a scene, read from a file beside the scene.

The file for ``my_scene.py`` is ``my_scene.sheet.toml``. It is data and runs no code. Its texts may contain sums (see
`sums`) and marks (see `marks`).
"""

from __future__ import annotations

import os
import re
import tomllib
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StrictInt, ValidationError, model_validator

from atmosbox import scenarios
from atmosbox.errors import ConfigError, FileError, shown
from atmosbox.sheet import marks, sums

__all__ = ["SECTIONS", "Change", "Prediction", "Question", "Row", "SheetText", "Sketch", "read", "text_of"]

SUFFIX = ".sheet.toml"
SECTIONS = {"notice": "Notice", "try": "Try", "differ": "Why do they differ?", "further": "Go further"}
"""The headings of the groups of questions, by their names in the file."""


def _checked(text: str) -> str:
    """Return a text as one line; refuse it if its sums or marks are not allowed."""
    text = " ".join(text.split())
    sums.check(text)
    marks.check(re.sub(r"\{\{.*?\}\}", "0", text))
    return text


Text = Annotated[str, AfterValidator(_checked)]
Needed = Annotated[Text, Field(pattern=r"\S")]
Lines = Annotated[StrictInt, Field(ge=0, le=12)]


class _Entry(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Sketch(_Entry):
    """Empty axes into which students draw a guess; ``x`` and ``y`` are their labels, with units."""

    x: Needed
    y: Needed


class Question(_Entry):
    """A question with empty lines below it, or with its answer; ``lab`` tells whether running pages can answer it."""

    ask: Needed
    answer: Text = ""
    lines: Lines | None = None
    lab: bool = True


class Prediction(Question):
    """A prediction that is written down before the run: answers to tick, one of them right; a sketch; or free lines."""

    choices: tuple[Needed, ...] = ()
    right: int | None = None
    sketch: Sketch | None = None

    @model_validator(mode="after")
    def _check_right(self) -> Prediction:
        if self.right is not None and not 1 <= self.right <= len(self.choices):
            raise ValueError(
                f"right = {self.right} is the number of none of its {len(self.choices)} choices: count from 1"
            )
        return self


class Change(_Entry):
    """The change of a further run, which differs from the first in one respect, by one or several settings."""

    title: Needed
    set: Annotated[dict[str, Any], Field(min_length=1)]


class Row(_Entry):
    """A row of the table.

    Attributes
    ----------
    headline
        Name of a headline of the scene.
    label, unit
        Its name in the table and its unit, as the headline has them.
    theory
        The formula with which students compute the value of theory; empty if that needs a computer.
    runs
        The letters of the runs that report it.
    """

    headline: Needed
    label: Needed
    unit: str = "1"
    theory: Text = ""
    runs: str = "ABCD"


class SheetText(_Entry):
    """The whole text of the sheet of a scene.

    Attributes
    ----------
    goal
        The subject of the sheet, in two sentences.
    predict
        The predictions that students write down before the run.
    change
        The changes of the runs after the first.
    row
        The rows of the table; if there are none, the table has all headlines of the scene.
    notice, try_, differ, further
        The questions.
    constants
        The constants that the formulas need, printed above the table.
    leaves_out
        What the model leaves out; if it is empty, the scene's docstring tells it.
    """

    goal: Needed
    predict: tuple[Prediction, ...] = ()
    change: Annotated[tuple[Change, ...], Field(max_length=3)] = ()
    row: tuple[Row, ...] = ()
    notice: tuple[Question, ...] = ()
    try_: tuple[Question, ...] = Field((), alias="try")
    differ: tuple[Question, ...] = ()
    further: tuple[Question, ...] = ()
    constants: Text = ""
    leaves_out: Text = ""


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


def read(path: str | os.PathLike[str]) -> SheetText:
    """Read the text of a sheet.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    SheetText
        The text; its sums are not yet worked out.

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
        return SheetText.model_validate(tomllib.loads(Path(path).read_text(encoding="utf-8")))
    except OSError as error:
        raise FileError(f"The words of the sheet cannot be read from {path}: {error.strerror}.") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path} is not TOML ({error}): correct it and try again.") from error
    except ValidationError as error:
        raise ConfigError(f"{path}: {_problem(error)}; see docs/sheet.md.") from error


_PROBLEMS = {
    "missing": "is missing: add it",
    "extra_forbidden": "is unknown: correct the name, or remove it",
    "string_pattern_mismatch": "is empty: write a text",
    "string_type": "is no text: put it in quotes",
    "tuple_type": "is no list: write [[{0}]] with two brackets, or a list of texts for choices",
    "too_long": "are too many: keep three of them",
}


def _problem(error: ValidationError) -> str:
    """Return a message on the first wrong entry, with its name and number: 'notice 2, ask is missing: add it'."""
    first = error.errors()[0]
    place = ", ".join(str(part) for part in first["loc"])
    place = re.sub(r", (\d+)", lambda n: f" {int(n[1]) + 1}", place)
    own = first.get("ctx", {}).get("error")
    said = f": {own}" if own else " " + _PROBLEMS.get(first["type"], first["msg"]).format(*first["loc"])
    return f"{shown(place, 100)}{said}"
