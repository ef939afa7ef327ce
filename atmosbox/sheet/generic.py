"""The words of a sheet for a scene that brings none: made from its card and from the numbers that it reports."""

from __future__ import annotations

import re
from collections.abc import Sequence

from atmosbox.scene.headline import Headline
from atmosbox.scene.parameter import Parameter
from atmosbox.sheet.number_text import spelled
from atmosbox.sheet.text import Change, Prediction, Question, Row, SheetText

__all__ = ["generic", "left_out"]

_CHANCE = Change("with another seed, and so by chance alone", {"seed": "{A.seed + 1}"})
MOST_SETTINGS = 6


def left_out(story: str) -> str:
    r"""Return what the story of a scene says is left out and exaggerated; nothing if it does not say.

    Examples
    --------
    >>> left_out("Air rises.\n\nModelled: spheres.\nLeft out: water,\nwind. Exaggerated: the pace.")
    'Left out: water, wind. Exaggerated: the pace.'
    """
    flat = " ".join(story.split())
    found = re.search(r"Left out: .*", flat)
    return found.group() if found else ""


def _goal(story: str, title: str) -> str:
    """Return the first two sentences of a story."""
    flat = " ".join(story.partition("Modelled:")[0].split())
    sentences = re.split(r"(?<=[.!?])\s+", flat)
    return " ".join(sentences[:2]) or f"{title}."


def _literal(text: str) -> str:
    """Return a text whose braces are no sums."""
    return text.replace("{", "{{").replace("}", "}}")


def generic(story: str, title: str, parameters: Sequence[Parameter], headlines: Sequence[Headline]) -> SheetText:
    """Return words that fit any scene; they ask what is chance and what is not.

    Parameters
    ----------
    story, title
        The docstring of the scene, and its title.
    parameters
        What may be set.
    headlines
        What a run of it has reported.

    Returns
    -------
    SheetText
        Words about runs A and B, which differ by their seed.

    Examples
    --------
    >>> warm = Headline("t", 291.0, 2.0, 288.0, 0.0, "none", "K", "degC", "temperature")
    >>> generic("A box. It is warm.", "Box", [], [warm]).predict[0].ask
    'What will come out for the temperature in °C, and by how much will a second run with another seed differ?'
    """
    rows = tuple(Row(each.name, each.label, each.display_unit) for each in headlines)
    names = [f"`{p.name}` ({p.help})" for p in parameters if p.name != "seed"][:MOST_SETTINGS]
    asked = f"the {rows[0].label}" + (f" in {spelled(rows[0].unit)}" if spelled(rows[0].unit) else "") if rows else "it"
    apart = "; ".join(
        _literal(f"{row.label}: ") + f"{{B.{row.headline} - A.{row.headline}}}"
        for row, each in zip(rows, headlines, strict=True)
        if each.standard_error > 0.0
    )
    known = "; ".join(
        _literal(f"{row.label}: ") + f"{{A.{row.headline}.sigmas:.1f}}"
        for row, each in zip(rows, headlines, strict=True)
        if each.theory is not None and each.standard_error > 0.0
    )
    return SheetText(
        goal=_literal(_goal(story, title)),
        predict=(
            Prediction(
                _literal(
                    f"What will come out for {asked}, and by how much will a second run with another seed differ?"
                ),
                lines=2,
                answer=f"{{A.{rows[0].headline}}} with the one seed, {{B.{rows[0].headline}}} with the other."
                if rows
                else "",
            ),
        ),
        changes=(_CHANCE,),
        rows=rows,
        questions={
            "notice": (
                Question(
                    "Which numbers of run A agree with theory? By how many of their standard errors are they apart?",
                    f"Standard errors apart: {known}." if known else "",
                ),
                Question("What in the figure did you not expect?", "", 3),
            ),
            "try": (
                Question(
                    _literal(
                        f"Change one setting{': ' + ', '.join(names) if names else ''}. "
                        "Write down the command and your prediction, and run it as `-C.nc`."
                    ),
                    "",
                    4,
                ),
            ),
            "differ": (
                Question(
                    "A and B differ in nothing but the seed. By how many standard errors are they apart? "
                    "From how many on would you no longer believe in chance?",
                    f"B less A: {apart}. More than 4 standard errors happen by chance once in 16 000 times."
                    if apart
                    else "",
                ),
                Question("Where a number is off by more than chance: is it the theory, the model, or the run?"),
            ),
            "further": (
                Question("Choose one thing that the model leaves out. Which number would it change, and which way?"),
            ),
        },
        leaves_out=_literal(left_out(story)),
    )
