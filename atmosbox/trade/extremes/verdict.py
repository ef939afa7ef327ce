"""What came out of an extreme: right, refused, degraded as stated, or wrong."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, get_args

__all__ = ["OUTCOMES", "Outcome", "Verdict", "degraded", "judged", "wrong"]

Outcome = Literal["right", "refused", "degrades", "wrong"]
OUTCOMES: tuple[Outcome, ...] = get_args(Outcome)


@dataclass(frozen=True)
class Verdict:
    """The outcome of one extreme on one engine.

    Parameters
    ----------
    outcome
        "right": the number is that of mechanics or of kinetic theory. "refused": the engine said no, in a
        sentence. "degrades": the number is off, and obeys the law or bound by which it is known to be.
        "wrong": anything else.
    sentence
        What was measured, or what the refusal says.
    value, expected, tolerance
        The number, what it should be, and by how much it may be off; None where the outcome is no number.
    """

    outcome: Outcome
    sentence: str
    value: float | None = None
    expected: float | None = None
    tolerance: float | None = None

    @property
    def passed(self) -> bool:
        """Whether the engine did what it should."""
        return self.outcome != "wrong"

    @property
    def figures(self) -> str:
        """The number with what it should be; empty where the outcome is no number."""
        if self.value is None:
            return ""
        if self.expected:
            return f"{self.value:.6g}, expected {self.expected:.6g} ± {self.tolerance:.2g}"
        return f"{self.value:.2g}, at most {self.tolerance:.2g}" if self.tolerance else f"{self.value:.6g}"

    @property
    def told(self) -> str:
        """The sentence, with its number."""
        return f"{self.sentence}: {self.figures}" if self.figures else self.sentence

    def __str__(self) -> str:
        """Return the outcome with its number."""
        return f"{self.outcome}: {self.figures}" if self.figures else self.outcome


def judged(sentence: str, value: float, expected: float = 0.0, tolerance: float = 0.0) -> Verdict:
    """Return "right" if a number is what it should be, else "wrong".

    Examples
    --------
    >>> judged("hits", 31, 31).outcome, judged("hits", 30, 31).outcome, judged("hits", math.nan, 31, 99).outcome
    ('right', 'wrong', 'wrong')
    """
    return _by_number("right", sentence, value, expected, tolerance)


def degraded(sentence: str, value: float, expected: float = 0.0, tolerance: float = 0.0) -> Verdict:
    """Return "degrades" if a number obeys the law of its degradation, else "wrong".

    Parameters
    ----------
    sentence
        What degrades, and by which law or bound.
    value, expected, tolerance
        The number, what the law gives (0 for a bound), and how far from it the number may be.

    Examples
    --------
    >>> degraded("energy error of a step of 0.1, at most its square", 0.009, 0.0, 0.01).outcome
    'degrades'
    """
    return _by_number("degrades", sentence, value, expected, tolerance)


def wrong(sentence: str) -> Verdict:
    """Return the verdict on what should not have happened."""
    return Verdict("wrong", sentence)


def _by_number(outcome: Outcome, sentence: str, value: float, expected: float, tolerance: float) -> Verdict:
    value, expected, tolerance = float(value), float(expected), float(tolerance)
    off = abs(value - expected)
    met = math.isfinite(off) and off <= tolerance
    return Verdict(outcome if met else "wrong", sentence, value, expected, tolerance)
