"""From the words of a sheet and its runs to its blocks, in the order in which they are read."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from atmosbox.errors import ConfigError
from atmosbox.scene.conversion import from_si
from atmosbox.scene.headline import Headline
from atmosbox.sheet.arithmetic import filled
from atmosbox.sheet.block import (
    Answer,
    Axes,
    Blank,
    Block,
    Choices,
    Commands,
    Heading,
    Kept,
    Line,
    Measurements,
    Text,
)
from atmosbox.sheet.generic import generic, left_out
from atmosbox.sheet.number_text import bare, measured, spelled, theoretical
from atmosbox.sheet.sheet_run import LETTERS, Trial, execute, shown_of, trials
from atmosbox.sheet.text import SECTIONS, Prediction, Question, SheetText, read, text_of
from atmosbox.simulation import runner
from atmosbox.version import __version__

__all__ = ["Worksheet", "worksheet"]

_TABLE = (
    "Copy what the program prints, with its standard error. Work out the theory from the formula; where there is none, "
    "copy it: the program has solved the equations. misfit / error = (measured − theory) / standard error: "
    "up to 2 is chance nearly always, more than 4 practically never."
)


@dataclass(frozen=True)
class Worksheet:
    """A sheet that is ready to be printed.

    Parameters
    ----------
    scene, title
        What it is about.
    about
        The line below the title: number of molecules, seed, engine.
    blocks
        What it consists of.
    answers
        Whether it is the lecturer's.
    disagreements
        What of its runs disagrees with theory, a sentence each.
    """

    scene: str
    title: str
    about: str
    blocks: tuple[Block, ...]
    answers: bool
    disagreements: tuple[str, ...] = ()


def worksheet(
    scene: str | os.PathLike[str],
    settings: Mapping[str, Any] | None = None,
    *,
    engine: str | None = None,
    answers: bool = False,
    progress: Callable[[float, str], None] | None = None,
) -> Worksheet:
    """Return the sheet of a scene, for students or with the answers.

    Parameters
    ----------
    scene
        A name that `atmosbox.scenarios.names` lists, or the path of a file of your own.
    settings
        What all its runs have in common, as for `atmosbox.run`.
    engine
        What lets time pass in them.
    answers
        Whether its runs are made and its answers given. A scene that brings no words of its own is run once for
        the blank sheet, too: only a run tells which numbers it reports.
    progress
        Called with the share that is done and a word on what goes on.

    Returns
    -------
    Worksheet
        What `save` takes.

    Raises
    ------
    AtmosboxError
        If the scene, a setting or the words of its sheet are refused, or a run fails.

    Examples
    --------
    >>> sheet = worksheet("lifting-dry", {"molecules": 500, "seed": 7})
    >>> sheet.about
    'N = 500, seed 7'
    """
    first = runner.prepare(scene, settings or {}, engine=engine)
    path = text_of(first.module)
    if path is not None:
        words = read(path)
        asked = trials(first, words.changes)
        made = execute(asked, progress) if answers else asked
    else:
        (known,) = execute(trials(first, ()), progress)
        story, title = (first.module.__doc__ or "").strip(), getattr(first.module, "title", first.scene)
        words = generic(story, title, first.settings.describe(), tuple(known.headlines.values()))
        asked = trials(first, words.changes)
        made = (known, *execute(asked[1:], progress)) if answers else asked
    return _Composer(words, made, answers).sheet()


class _Composer:
    """Puts words and runs together."""

    def __init__(self, words: SheetText, runs: Sequence[Trial], answers: bool) -> None:
        self.words, self.runs, self.answers = words, runs, answers
        self.names = {run.letter: run for run in runs}
        # what is asked, and what is said beforehand, may not know what a run finds
        self.before = {run.letter: Trial(run.letter, run.title, run.prepared) for run in runs}
        self.number = 0

    def sheet(self) -> Worksheet:
        """Return the sheet."""
        first = self.runs[0].prepared
        parts: list[Block] = [Heading("Goal"), Text(self.ask(self.words.goal))]
        if self.words.predict:
            parts += self.section("Predict, before you run anything", map(self.prediction, self.words.predict))
        parts += [Heading("Run"), *(Commands(run.letter, run.title, (run.command,)) for run in self.runs)]
        parts.append(Text(self.drawing()))
        parts += [Heading("Measure"), *([] if self.answers else [Text(_TABLE, small=True)])]
        parts += [Text(self.ask(self.words.constants), small=True)] if self.words.constants else []
        parts.append(self.table())
        parts += self.remarks() if self.answers else []
        for name, heading in SECTIONS.items():
            if self.words.questions[name]:
                parts += self.section(heading, map(self.question, self.words.questions[name]))
        missing = self.words.leaves_out or left_out(first.module.__doc__ or "")
        if missing:
            parts.append(Kept((Heading("What the model leaves out"), Text(self.ask(missing)))))
        return Worksheet(
            first.scene, getattr(first.module, "title", first.scene), self.about(), tuple(parts), self.answers,
            tuple(self.disagreements()),
        )  # fmt: skip

    def ask(self, text: str) -> str:
        """Return a text of the student's, with the sums of settings in it worked out."""
        return filled(text, self.before)

    def section(self, heading: str, parts: Any) -> list[Block]:
        """Return a heading with what stands below it; the first question never leaves it."""
        first, *rest = parts
        return [Kept((Heading(heading), *first.blocks)), *rest]

    def numbered(self, ask: str) -> Text:
        """Return a question with its number."""
        self.number += 1
        return Text(f"**{self.number}.** {self.ask(ask)}")

    def answered(self, answer: str, blank: Sequence[Block]) -> tuple[Block, ...]:
        """Return the answer, or the place to write one."""
        if not self.answers:
            return tuple(blank)
        if not answer:
            return ()
        try:
            return (Answer(filled(answer, self.names)),)
        except ConfigError:
            if not self.differs:
                raise
            return (Answer("*Written for the scene as it comes; with these settings its numbers are not there.*"),)

    @property
    def differs(self) -> bool:
        """Whether the runs are not those that the words were written for."""
        first = self.runs[0].prepared
        return bool(first.settings.changed().keys() - {"seed"}) or str(first.engine) != "exact"

    def question(self, asked: Question) -> Kept:
        """Return a question with its lines, or its answer."""
        blank = [Blank(asked.lines)] if asked.lines else []
        return Kept((self.numbered(asked.ask), *self.answered(asked.answer, blank)))

    def prediction(self, asked: Prediction) -> Kept:
        """Return a prediction with what is to be ticked, drawn or written, or what comes out."""
        above: list[Block] = [self.numbered(asked.ask)]
        blank: list[Block] = []
        if asked.choices:
            above.append(Choices(tuple(self.ask(each) for each in asked.choices)))
        if asked.sketch is not None:
            above += [Text(self.ask(asked.sketch.hint), small=True)] if asked.sketch.hint else []
            blank.append(Axes(self.ask(asked.sketch.x), self.ask(asked.sketch.y)))
        blank += [Blank(asked.lines)] if asked.lines else []
        return Kept((*above, *self.answered(asked.answer, blank)))

    def drawing(self) -> str:
        """Return how the figures are made."""
        first, *others = self.runs
        also = f", and likewise of {' and '.join(run.letter for run in others)}" if others else ""
        return f"The figure of {first.letter}: `{first.plot_command}`{also}."

    def about(self) -> str:
        """Return number of molecules, seed and engine."""
        first = self.runs[0].prepared
        molecules = getattr(first.settings, "molecules", None)
        parts = [] if molecules is None else [f"N = {molecules}"]
        parts.append(f"seed {first.settings.seed}")
        parts += [] if str(first.engine) == "exact" else [f"engine {first.engine}"]
        parts += [f"atmosbox {__version__}"] if self.answers else []
        return ", ".join(parts)

    def table(self) -> Measurements:
        """Return the table of all runs."""
        rows = []
        for row in self.words.rows:
            name, label = filled(row.headline, self.before), self.ask(row.label)
            unit = spelled(row.unit)
            lines = tuple(self.line(run, name) for run in self.runs if run.letter in (row.runs or LETTERS))
            rows.append((f"{label} [{unit}]" if unit else label, self.ask(row.theory), lines))
        return Measurements(tuple(rows))

    def line(self, run: Trial, name: str) -> Line:
        """Return what a run says of a quantity; nothing on the student's sheet."""
        if run.outcome is None or not self.answers:
            return Line(run.letter)
        if name not in run.headlines:
            return Line(run.letter, "not reported", "–", "–")
        found = shown_of(run.headlines[name])
        theory = misfit = "–"
        if found.theory is not None:
            theory = theoretical(found.theory, found.value, found.error)
            if found.error > 0.0:
                misfit = f"{(found.value - found.theory) / found.error:.1f}".replace("-", "−")
        return Line(run.letter, measured(found.value, found.error), theory, misfit)

    def remarks(self) -> list[Block]:
        """Return why a number may be off, where it is by more than chance; and whether the words may not fit."""
        shown = {filled(row.headline, self.before) for row in self.words.rows}
        excuses: dict[str, dict[str, list[str]]] = {}
        for run in self.runs:
            for each in run.headlines.values():
                far = each.misfit is not None and abs(each.misfit) > 4.0 * each.standard_error
                if each.name in shown and each.agrees and far:
                    excuses.setdefault(each.reason, {}).setdefault(each.label, []).append(_excuse(run.letter, each))
        found = [
            "More than chance: "
            + "; ".join(f"{label} ({', '.join(each)})" for label, each in labels.items())
            + f", for {reason}."
            for reason, labels in excuses.items()
        ]
        found += self.disagreements()
        if self.differs:
            found.append(
                "The numbers are of these runs, but the words of the answers are for the scene as it comes: "
                "read them with care."
            )
        return [Text(f"*{text}*", small=True) for text in found]

    def disagreements(self) -> list[str]:
        """Return what disagrees with theory."""
        return [
            f"Run {run.letter} disagrees with theory: {each.label}."
            for run in self.runs
            for each in run.headlines.values()
            if each.agrees is False
        ]


def _excuse(letter: str, headline: Headline) -> str:
    """Return by how much a number of a run may be off."""
    unit = {"degC": "K"}.get(headline.display_unit, spelled(headline.display_unit))
    allowed = bare(from_si(headline.tolerance, headline.display_unit, difference=True), 2)
    return f"{letter}: up to {allowed} {unit}".rstrip()
