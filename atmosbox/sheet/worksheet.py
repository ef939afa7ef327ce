"""From the text and the runs of a sheet to its Markdown, by the template ``sheet.md.jinja``."""

import functools
import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import jinja2

from atmosbox.errors import ConfigError
from atmosbox.page.document import phrase
from atmosbox.page.saved_run import check_choice
from atmosbox.scene.conversion import from_si
from atmosbox.scene.headline import AS_STATED
from atmosbox.sheet.graph_row import graph_rows, until
from atmosbox.sheet.sheet_run import Trial, execute, trials
from atmosbox.sheet.sums import Facts, bare, filled, fixed, measured, spelled, theoretical
from atmosbox.sheet.text import LANGUAGES, SECTIONS, read, text_of, translated
from atmosbox.simulation import runner
from atmosbox.simulation.preparation import build
from atmosbox.version import __version__

WORDS = Path(__file__).with_name("generic.sheet.toml")
"""The text of a sheet for a scene without a sheet of its own."""
MOST_SETTINGS = 6
"""Greatest number of settings that the sheet names."""


def left_out(story: str) -> str:
    r"""Return the part of a scene's docstring on what is left out and exaggerated; empty if there is none.

    >>> left_out("Air rises.\n\nModelled: spheres.\nLeft out: water,\nwind. Exaggerated: the pace.")
    'Left out: water, wind. Exaggerated: the pace.'
    """
    found = re.search(r"Left out: .*", " ".join(story.split()))
    return found.group() if found else ""


class AnyScene(NamedTuple):
    """The object that the text of `WORDS` calls ``scene``; those ``runs`` that were made give their headlines."""

    runs: Sequence[Trial]

    def fact(self, name: str) -> Any:
        """Return a text about the scene by name.

        >>> from atmosbox.simulation import runner
        >>> AnyScene([Trial("A", "", runner.prepare("lifting-dry", {}))]).fact("quantity")
        'result'
        """
        prepared, found = self.runs[0].prepared, list(self.runs[0].headlines.values())
        story = prepared.module.__doc__ or ""
        made = {each.name: [run.fact(each.name) for run in self.runs if each.name in run.headlines] for each in found}
        known = [(each.label, *made[each.name]) for each in found if each.standard_error > 0.0]
        match name:
            case "goal":
                sentences = re.split(r"(?<=[.!?])\s+", " ".join(story.partition("Modelled:")[0].split()))
                return " ".join(sentences[:2]) or f"{getattr(prepared.module, 'title', prepared.scene)}."
            case "leaves_out":
                return left_out(story)
            case "settings":
                named = [f"`{p.name}` ({p.help})" for p in prepared.settings.describe() if p.name != "seed"]
                return f": {', '.join(named[:MOST_SETTINGS])}" if named else ""
            case "quantity" if found:
                unit = spelled(found[0].display_unit)
                return f"{found[0].label} in {unit}" if unit else found[0].label
            case "both" if found:
                return " and ".join(measured(x.n, x.s) for x in made[found[0].name]) + " with the two seeds."
            case "misfits":
                far = [f"{label}: {abs(a.n - a.theory) / a.s:.1f}" for label, a, *_ in known if a.theory is not None]
                return f"Difference in standard errors: {'; '.join(far)}." if far else ""
            case "differences":
                apart = [(label, b[0] - a) for label, a, *b in known if b]
                said = "; ".join(f"{label}: {measured(x.n, x.s)}" for label, x in apart)
                chance = "Chance exceeds 4 standard errors of such a difference about once in 3 500 times."
                return f"B minus A: {said}. {chance}" if said else ""
        return "result" if name == "quantity" else ""


_COMMAND = "`--"
"""A question that contains this needs commands."""
_SLIDERS = "Begin A again, and move a slider above its graphs while it plays. Write down first what each graph will do."
_NOT_HERE = "*Written for the default settings: the numbers are not available with these settings.*"
_WITH_CARE = (
    "The numbers are of these runs, but the answers were written for the default settings: read them with care."
)


@dataclass(frozen=True)
class Worksheet:
    """A sheet that is ready to be printed.

    Parameters
    ----------
    scene, title
        Name and title of the scene.
    about
        The line below the title: number of molecules, seed, engine.
    text
        The whole sheet as Markdown.
    answers
        Whether it has the answers, for the lecturer.
    disagreements
        A sentence for each headline of a run that disagrees with theory.
    runs
        Its runs; a sheet for pages needs a page for each.
    lab
        Whether it is a sheet for pages.
    language
        Its language, "en" or "de".
    """

    scene: str
    title: str
    about: str
    text: str
    answers: bool
    disagreements: tuple[str, ...] = ()
    runs: tuple[Trial, ...] = ()
    lab: bool = False
    language: str = "en"

    def said(self, text: str) -> str:
        """Return an English text of the layout in the language of the sheet."""
        return phrase(self.language, text)


def worksheet(
    scene: str | os.PathLike[str],
    settings: Mapping[str, Any] | None = None,
    *,
    engine: str | None = None,
    answers: bool = False,
    lab: bool = False,
    language: str = "en",
    progress: Callable[[float, str], None] | None = None,
) -> Worksheet:
    """Return the sheet of a scene, for students or with the answers.

    Parameters
    ----------
    scene
        A name that `atmosbox.scenarios.names` lists, or the path of a file of your own.
    settings
        The settings that all its runs share, as for `atmosbox.run`.
    engine
        The engine of its runs, as for `atmosbox.run`.
    answers
        Whether the runs are made and the answers given. A scene whose sheet names no rows of the table is run once even
        without answers, because only a run tells which numbers it reports.
    lab
        Whether the sheet is done with a page for each run (see `atmosbox.lab`). It then names buttons in place of
        commands, and asks for values that are read off graphs in place of headline numbers.
    language : {"en", "de"}
        The language of the sheet.
    progress
        Called with the share that is done and a short text on the present step.

    Returns
    -------
    Worksheet
        The sheet, which `save` writes to a file.

    Raises
    ------
    AtmosboxError
        If the scene, a setting or the text of the sheet is refused, the scene has no text in the language, or a run
        fails.

    Examples
    --------
    >>> sheet = worksheet("lifting-dry", {"molecules": 500, "seed": 7})
    >>> sheet.about
    'N = 500, seed 7'
    """
    check_choice("language", language, tuple(LANGUAGES))
    first = runner.prepare(scene, settings or {}, engine=engine)
    path = text_of(first.module) or WORDS
    words = read(path, language)
    path = translated(path, language)
    runs = trials(first, _Filling(path, trials(first, ())).all(words.pop("change"), "change"))
    due = len(runs) if answers else 0 if words["row"] or lab else 1
    if due and path != WORDS:
        _Filling(path, runs).all(words, "")  # a mistake is refused before time is spent on a run
    runs = (*execute(runs[:due], progress), *runs[due:])
    return _written(path, words, runs, answers, lab, language)


class _Filling:
    """Works out the sums in the text of a sheet.

    ``path`` is the file of the text, for error messages, and ``answers`` whether answers are given. ``differs`` is
    printed in place of an answer in which a sum fails, if the settings are not those for which the text was written.
    """

    def __init__(self, path: Path, runs: Sequence[Trial], *, answers: bool = False, differs: str = "") -> None:
        self.path, self.answers, self.differs = path, answers, differs
        scene: dict[str, Facts] = {"scene": AnyScene(runs)} if path == WORDS else {}
        self.after = {run.letter: run for run in runs} | scene
        # questions and all other texts except answers may not use results of the runs
        self.before = {run.letter: Trial(run.letter, run.title, run.prepared) for run in runs} | scene

    def all(self, value: Any, place: str) -> Any:
        """Return an entry with all sums in it worked out; an error message names the place of the entry."""
        match value:
            case dict():
                return {key: self.all(each, f"{place}, {key}".removeprefix(", ")) for key, each in value.items()}
            case list() | tuple():
                return [self.all(each, f"{place} {number}") for number, each in enumerate(value, 1)]
            case str():
                answer = place.endswith(", answer")
                if answer and not self.answers:
                    return ""
                try:
                    return filled(value, self.after if answer else self.before, setting=", set, " in place)
                except ConfigError as error:
                    if answer and self.differs:
                        return self.differs
                    raise ConfigError(f"{self.path}: {place}: {error}; see docs/sheet.md.") from error
        return value


def _written(
    path: Path, words: dict[str, Any], runs: Sequence[Trial], answers: bool, lab: bool, language: str
) -> Worksheet:
    """Return the sheet as Markdown, with what belongs to it."""
    said, first = functools.partial(phrase, language), runs[0].prepared
    differs = bool(first.settings.changed().keys() - {"seed"}) or bool(first.unusual_engine)
    content = _Filling(path, runs, answers=answers, differs=said(_NOT_HERE) if differs else "").all(words, "")
    story = first.module.__doc__ or "" if language == "en" else ""
    content["leaves_out"] = content["leaves_out"] or left_out(story).replace("<", "&lt;")
    for name in ("predict", *SECTIONS) if lab else ():
        content[name] = [each for each in content[name] if each["lab"] and _COMMAND not in each["ask"]]
    for each in content["predict"] if lab else ():
        if each["sketch"] and "logarithm" in each["sketch"]["x"]:  # the axis of time of a page is linear
            each["sketch"]["x"] = each["sketch"]["x"].partition(",")[0]
    if lab and build(first).knobs:
        content["try"] = [*content["try"], {"ask": said(_SLIDERS), "answer": "", "lines": 4}]
    content |= {"lab": lab, "graphs": graph_rows(runs, said) if lab else []}
    if lab:
        content["row"] = []
    elif not words["row"]:
        content["row"] = [
            {"headline": h.name, "label": said(h.label), "unit": h.display_unit, "theory": "", "runs": "ABCD"}
            for h in runs[0].headlines.values()
            if h.resolved and not h.program
        ]
    labels = {row["headline"]: row["label"] for row in content["row"]}
    for row in content["row"]:
        unit = spelled(row["unit"])
        row["label"] += f" [{unit}]" if unit else ""
        row["lines"] = [_line(run, row["headline"], answers, said) for run in runs if run.letter in row["runs"]]
    off = [(run, each) for run in runs for each in run.headlines.values() if each.agrees is False and not lab]
    disagrees = said("Run {} disagrees with theory: {}.")
    disagreements = [disagrees.format(run.letter, labels.get(each.name, said(each.label))) for run, each in off]
    remarks = [*_excuses(runs, labels, said), *disagreements]
    title, about = said(getattr(first.module, "title", first.scene)), _about(first, answers, said)
    environment = jinja2.Environment(trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters["said"] = said
    layout = Path(__file__).with_name("sheet.md.jinja").read_text(encoding="utf-8")
    text = environment.from_string(layout).render(
        content, scene=first.scene, title=title, about=about, answers=answers, runs=runs,
        sections=SECTIONS, questions={name: content[name] for name in SECTIONS},
        until=until(runs[0].prepared, said) if lab else "",
        remarks=[*remarks, *([said(_WITH_CARE)] if differs else [])] if answers else [], ticked=answers and not differs,
    )  # fmt: skip
    text = re.sub(r"\n{3,}", "\n\n", text).strip() + "\n"
    return Worksheet(first.scene, title, about, text, answers, tuple(disagreements), tuple(runs), lab, language)


def _about(first: runner.Prepared, answers: bool, said: Callable[[str], str]) -> str:
    """Return the line below the title: number of molecules, seed and engine."""
    molecules = getattr(first.settings, "molecules", None)
    parts = [] if molecules is None else [f"N = {molecules}"]
    parts.append(said("seed {}").format(first.settings.seed))
    parts += [said("engine {}").format(first.unusual_engine)] if first.unusual_engine else []
    return ", ".join([*parts, f"atmosbox {__version__}"] if answers else parts)


def _line(run: Trial, name: str, answers: bool, said: Callable[[str], str]) -> tuple[str, str, str, str]:
    """Return the line of a run for a quantity: letter, measurement, theory, difference over error; empty to fill in."""
    if not answers:
        return run.letter, "±", "", ""
    if name not in run.headlines or not run.headlines[name].resolved:
        return run.letter, said("not reported"), "–", "–"
    found = run.fact(name)
    theory = "–" if found.theory is None else theoretical(found.theory, found.s)
    known = found.theory is not None and found.s > 0.0
    misfit = fixed((found.n - found.theory) / found.s, 1) if known else "–"
    return run.letter, measured(found.n, found.s), theory, misfit


def _excuses(runs: Sequence[Trial], labels: Mapping[str, str], said: Callable[[str], str]) -> list[str]:
    """Return sentences on numbers that agree with theory only with the stated model error, and its reason."""
    stated = [(run, each) for run in runs for each in run.headlines.values() if each.verdict == AS_STATED]
    found = []
    for run, each in stated:
        if each.name in labels:
            known = bare(from_si(each.known, each.display_unit, difference=True), 2)
            allowed = f"{known} {spelled(each.difference_unit)}".rstrip()
            sentence = said("More than four standard errors: {} in run {} (up to {}), because {}.")
            found.append(sentence.format(labels[each.name], run.letter, allowed, said(each.excuse)))
    return found
