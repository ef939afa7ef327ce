"""The outcome of an extreme: right, refused, degrades (and by how much), or wrong."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal, NamedTuple, get_args

__all__ = ["OUTCOMES", "STORED", "Outcome", "Reading", "Verdict", "compared", "judged", "stored", "wrong"]

Outcome = Literal["right", "refused", "degrades", "wrong"]
OUTCOMES: tuple[Outcome, ...] = get_args(Outcome)

STORED = Path(__file__).with_name("stored_outcomes.json")
"""The file of outcomes that ``benchmarks/extremes.py`` has stored, by extreme and engine."""
LOOSE = 0.05
"""A number whose tolerance is a larger share of the expected value than this is never "right"."""
WORSE = 1.25
"""Factor by which an error may exceed the stored error before the engine counts as worse."""


class Reading(NamedTuple):
    """A measured number, the expected value, and the tolerance for chance and rounding."""

    what: str
    value: float
    expected: float = 0.0
    tolerance: float = 0.0


@dataclass(frozen=True)
class Verdict:
    """The outcome of one extreme on one engine.

    Parameters
    ----------
    outcome
        "right": the number agrees with mechanics or kinetic theory within a tolerance of at most 5 %. "degrades": the
        number is off by more than its tolerance, or its tolerance is larger than 5 %. "refused": the engine refused the
        box, with a message. "wrong": a law was violated, the engine hung or crashed, or was worse than the stored
        outcome.
    sentence
        The name of the measured quantity, or the text of the refusal or fault.
    value, expected, tolerance
        The number, the expected value, and the tolerance; None if the outcome is no number.
    """

    outcome: Outcome
    sentence: str
    value: float | None = None
    expected: float | None = None
    tolerance: float | None = None

    @property
    def passed(self) -> bool:
        """Whether the outcome is acceptable: anything but "wrong"."""
        return self.outcome != "wrong"

    @property
    def off(self) -> float:
        """Error of the number, relative to the expected value unless that is 0; 0 without a number."""
        if self.value is None or self.expected is None:
            return 0.0
        return (self.value - self.expected) / (abs(self.expected) or 1.0)

    @property
    def error(self) -> str:
        """Error of the number, as text; empty if the outcome is no number."""
        if self.value is None:
            return ""
        if not self.expected:
            return f"by {self.value:.2g}"
        percent = 100.0 * self.off
        if abs(percent) >= 1000.0:
            return f"by a factor of {self.value / self.expected:.0f}"
        return f"by {percent:+.0f} %" if abs(percent) >= 10.0 else f"by {percent:+.2g} %"

    @property
    def figures(self) -> str:
        """The number with its expected value and tolerance, as text; empty if the outcome is no number."""
        if self.value is None or self.tolerance is None:
            return ""
        if self.expected and 0.0 < self.tolerance < 1e-6 and self.outcome == "right":
            return f"{self.expected:g}, off by {self.off:.2g}, at most {self.tolerance:.2g}"
        return f"{self.value:.6g}, expected {self.expected:.6g} ± {self.tolerance:.2g}"

    @property
    def told(self) -> str:
        """The sentence, followed by the number if there is one."""
        return f"{self.sentence}: {self.figures}" if self.figures else self.sentence

    def __str__(self) -> str:
        """Return the outcome in a few words."""
        return f"degrades {self.error}" if self.outcome == "degrades" else self.outcome


def judged(reading: Reading) -> Verdict:
    """Return "right" for a number within a tight tolerance, "wrong" for one that is not finite, else "degrades".

    Examples
    --------
    >>> print(judged(Reading("hits", 31, 31)), judged(Reading("hits", 30, 31)), judged(Reading("hits", math.nan)))
    right degrades by -3.2 % wrong
    """
    what, value, expected, tolerance = reading
    if not math.isfinite(value):
        return Verdict("wrong", f"{what} is {value}")
    tight = not expected or tolerance <= LOOSE * abs(expected)
    outcome: Outcome = "right" if tight and abs(value - expected) <= tolerance else "degrades"
    return Verdict(outcome, what, float(value), float(expected), float(tolerance))


def compared(now: Verdict, before: Verdict | None) -> Verdict:
    """Return a verdict, or "wrong" if the stored outcome is better.

    Parameters
    ----------
    now
        The present outcome.
    before
        The stored outcome; None if there is none, as for an engine with options.

    Examples
    --------
    >>> before = Verdict("degrades", "pressure", 7.14, 12.2, 0.2)
    >>> compared(Verdict("degrades", "pressure", 7.3, 12.2, 0.2), before).outcome
    'degrades'
    >>> print(compared(Verdict("degrades", "pressure", 4.5, 12.2, 0.2), before).sentence)
    pressure is 4.5, expected 12.2 ± 0.2; it was 7.14, expected 12.2 ± 0.2
    """
    if before is None or now.outcome in ("right", "wrong"):
        return now
    if now.outcome == "refused":
        if before.outcome == "refused":
            return now
        return wrong(f"refused, but the stored outcome is {before.outcome}: {now.sentence}")
    if now.value is None or now.expected is None or now.tolerance is None:
        return now
    slack = 2.0 * now.tolerance / (abs(now.expected) or 1.0)
    worse = before.outcome == "right" or abs(now.off) > WORSE * abs(before.off) + slack
    if before.outcome == "refused" or not worse:
        return now
    return wrong(f"{now.sentence} is {now.figures}; it was {before.figures}")


def wrong(sentence: str) -> Verdict:
    """Return the verdict "wrong" with a sentence."""
    return Verdict("wrong", sentence)


@cache
def stored() -> Mapping[str, Mapping[str, Verdict]]:
    """Return the stored outcomes, by extreme and engine."""
    if not STORED.exists():
        return {}
    kept = json.loads(STORED.read_text(encoding="utf-8"))
    return {name: {who: Verdict(**one) for who, one in row.items()} for name, row in kept.items()}
