"""The few main results of a run, beside the answer of theory where there is one."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

from atmosbox.scene.conversion import from_si, slashed

if TYPE_CHECKING:
    from atmosbox.scene.statistics import BlockAverage

__all__ = ["AS_STATED", "CHANCE_ALONE", "CHANCE_LIMIT", "ENGINE_IS_OFF", "NO", "ROUNDING", "YES", "Headline"]

CHANCE_ALONE = "none: the model has no other error than chance"
"""Reason of a tolerance of zero."""
ENGINE_IS_OFF = "the measured error of this engine is that large"
"""Reason of a bias of the engine."""
CHANCE_LIMIT = 4.0
"""Largest difference from theory that raises no alarm, in standard errors.

Chance exceeds four standard errors once in 16,000 times if they are known exactly. An error that is read from twenty
blocks of a run is itself uncertain by a sixth: then chance exceeds four of them once in 1,300 times (Student's t with
19 degrees of freedom).
"""
YES, AS_STATED, NO = "yes", "yes, with the stated model error", "no"
"""Whether measurement and theory agree: within four standard errors, only with the error of the model, or not."""
ROUNDING = "a computer rounds at every collision"
"""Reason of the tolerance of a number that theory says is zero."""
CHANCE = f"{CHANCE_LIMIT:g} standard errors (chance)"
"""The part of the expected difference that is chance, in words."""
IGNORED = 0.05
"""A known error of the model is not told if it is at most this many standard errors."""
RESOLVED = 0.1
"""Largest standard error of a result, as a share of the range in which it must be."""


@dataclass(frozen=True)
class Headline:
    """One main result of a run, with its error bar and the answer of the textbook.

    Parameters
    ----------
    name, label
        Its names in the output and in a table.
    value, standard_error
        The measurement and its statistical error [unit].
    theory
        The answer of theory [unit]; None if there is none.
    tolerance, reason
        Known error of the model, in addition to the statistical error [unit]; why it has this size.
    unit, display_unit
        The SI unit of the numbers here, and the unit in which a table shows them.
    bias, bias_se
        The measured error of runs with this approximate engine, and its standard error [unit].
    low, high
        The range in which the value must be, which is also that of the figure's axis [unit]; None if it has none.
    program
        Another program that computed the value, which then is no measurement; `theory` is atmosbox's own number.

    Examples
    --------
    With an error bar of 2 K, a difference of 3 K is within four standard errors:

    >>> warm = Headline("air_temperature", 291.0, 2.0, 288.0, 0.0, "an ideal gas", "K", "degC", "temperature")
    >>> warm.misfit, warm.chance, warm.verdict
    (3.0, 8.0, 'yes')

    A known bias of the engine of 5 K explains a value 5 K too warm, but not one 5 K too cold:

    >>> from dataclasses import replace
    >>> sharp = replace(warm, standard_error=0.5, bias=5.0)
    >>> sharp.known, sharp.verdict, replace(sharp, value=283.0).verdict
    (5.0, 'yes, with the stated model error', 'no')
    """

    name: str
    value: float
    standard_error: float
    theory: float | None
    tolerance: float
    reason: str
    unit: str
    display_unit: str
    label: str
    bias: float = 0.0
    bias_se: float = 0.0
    low: float | None = None
    high: float | None = None
    program: str = ""

    @classmethod
    def of_mean(
        cls, name: str, label: str, mean: BlockAverage, theory: float | None, unit: str, display_unit: str = "", *,
        tolerance: float = 0.0, reason: str = CHANCE_ALONE,
    ) -> Self:  # fmt: skip
        """Return the headline of a mean with its standard error; the display unit is ``unit`` if none is given."""
        value, error = float(mean.mean), float(mean.standard_error)
        return cls(name, value, error, theory, tolerance, reason, unit, display_unit or unit, label)

    @property
    def misfit(self) -> float | None:
        """Measurement minus theory [unit]; None without a theory."""
        return None if self.theory is None else self.value - self.theory

    @property
    def resolved(self) -> bool:
        """Whether the value is a result: within its range, with a standard error of a tenth of that range at most.

        Examples
        --------
        A cloud base of 1013 hPa is below a ground of 1000 hPa:

        >>> from dataclasses import replace
        >>> base = Headline("cloud_base", 1013e2, 51e2, 888e2, 0.0, "", "Pa", "hPa", "cloud base", low=3e4, high=1e5)
        >>> base.resolved, replace(base, value=891e2).resolved, replace(base, value=891e2, standard_error=8e3).resolved
        (False, True, False)
        """
        if self.low is None or self.high is None:
            return True
        return self.low <= self.value <= self.high and self.standard_error <= RESOLVED * (self.high - self.low)

    @property
    def needed(self) -> float:
        """How many times as many molecules make it a result, if its standard error falls with their square root [1]."""
        if self.low is None or self.high is None:
            return 1.0
        room = [RESOLVED * (self.high - self.low)]
        if self.theory is not None and self.low < self.theory < self.high:
            room.append(min(self.theory - self.low, self.high - self.theory) / CHANCE_LIMIT)
        return max(math.ceil((self.standard_error / min(room)) ** 2), 2)

    @property
    def difference_unit(self) -> str:
        """The unit in which a table shows differences: K for temperatures in degC, and none for a pure number."""
        return {"degC": "K", "1": ""}.get(self.display_unit, self.display_unit)

    @property
    def chance(self) -> float:
        """Four standard errors [unit]; chance exceeds them rarely."""
        return CHANCE_LIMIT * self.standard_error

    @property
    def known(self) -> float:
        """Known error of the model and its engine, in addition to chance [unit].

        The sum of the tolerance, to either side, and of the measured bias of the engine, to its own side; with four
        standard errors of the bias.
        """
        return self._allowed(self.bias, self.bias_se) - self.chance

    @property
    def allowed(self) -> float:
        """How far the value is expected to be from theory at most [unit]: `chance` and `known` error together."""
        return self._allowed(self.bias, self.bias_se)

    def _allowed(self, bias: float, bias_se: float) -> float:
        """Return the largest difference expected with this bias of the engine [unit]."""
        aside = max(math.copysign(1.0, self.misfit or 0.0) * bias, 0.0)
        return CHANCE_LIMIT * math.hypot(self.standard_error, bias_se) + self.tolerance + aside

    @property
    def verdict(self) -> str | None:
        """Whether measurement and theory agree; None without a theory, and for what is not a result.

        A measurement or an error bar that is not a finite number agrees with nothing.
        """
        if self.misfit is None or self.program or not self.resolved:
            return None
        if not math.isfinite(self.allowed) or not abs(self.misfit) <= self.allowed:
            return NO
        return YES if abs(self.misfit) <= self.chance or self.reason == ROUNDING else AS_STATED

    @property
    def agrees(self) -> bool | None:
        """Whether the difference is within what is `allowed`; None if it is not judged, see `verdict`."""
        return None if self.verdict is None else self.verdict != NO

    @property
    def excuse(self) -> str:
        """Why the difference may exceed chance: the reason of the tolerance, or that the engine is known to be off."""
        return self.reason if abs(self.misfit or 0.0) <= self._allowed(0.0, 0.0) else ENGINE_IS_OFF

    def shown(self, size: float, sign: str = "") -> str:
        """Return a difference [unit] with two digits, in the unit in which a table shows it.

        Examples
        --------
        >>> Headline("p", 1e5, 150.0, 1e5, 0.0, "", "Pa", "hPa", "pressure").shown(612.3, "±")
        '±6.1 hPa'
        """
        value = from_si(size, self.display_unit, difference=True)
        number = re.sub(r"e\+?(-?)0?", r"e\1", f"{float(f'{value:.2g}'):g}")
        return f"{sign}{number} {slashed(self.difference_unit)}".rstrip()

    @property
    def tells(self) -> bool:
        """Whether the `known` error is large enough beside chance to be told."""
        return bool(self.known > IGNORED * self.standard_error)

    @property
    def expectation(self) -> str:
        """How far the value is expected to be from theory at most, in words, with the reason of the model's error.

        Examples
        --------
        >>> Headline("t", 291.0, 2.0, 288.0, 0.5, "the box is small", "K", "degC", "temperature").expectation
        '4 standard errors (chance) plus 0.5 K, because the box is small'
        """
        parts = [CHANCE] if self.standard_error > 0.0 else []
        if not self.tells:
            return " plus ".join(parts)
        return f"{' plus '.join([*parts, self.shown(self.known)])}, because {self.model_reason}"

    @property
    def model_reason(self) -> str:
        """Where the `known` error comes from: from the model, from the engine, or from both."""
        engine = ENGINE_IS_OFF if self.bias or self.bias_se else ""
        return ", and ".join(part for part in (self.reason if self.tolerance else "", engine) if part)
