"""The few main results of a run, each beside the answer of the textbook."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

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
RESOLVED = 0.1
"""Largest standard error of a result, as a share of the range in which it must be."""


@dataclass(frozen=True)
class Headline:
    """One main result of a run, with its error bar and the answer of the textbook.

    Parameters
    ----------
    name
        Its name in the output.
    value, standard_error
        The measurement and its statistical error [unit].
    theory
        The closed-form answer [unit]; None if there is none.
    tolerance
        How far the model itself may be from the textbook, in addition to the statistical error [unit].
    reason
        Why the tolerance has this size.
    unit
        The SI unit of the numbers here.
    display_unit
        The unit in which a table shows them.
    label
        Its name in a table.
    bias, bias_se
        The measured error of runs with this approximate engine, and its standard error [unit].
    low, high
        The range in which the value must be, which is also that of the figure's axis [unit]; None if it has none.

    Examples
    --------
    With an error bar of 2 K, 3 K of misfit may be chance:

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

    @classmethod
    def of_mean(
        cls,
        name: str,
        label: str,
        mean: BlockAverage,
        theory: float | None,
        unit: str,
        display_unit: str = "",
        *,
        tolerance: float = 0.0,
        reason: str = CHANCE_ALONE,
    ) -> Self:
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
    def difference_unit(self) -> str:
        """The unit in which a table shows differences: K for temperatures in degC, and none for a pure number."""
        return {"degC": "K", "1": ""}.get(self.display_unit, self.display_unit)

    @property
    def chance(self) -> float:
        """Largest misfit that chance alone may cause [unit]: four standard errors."""
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
        """Largest misfit allowed [unit]: by `chance` and by the `known` error together."""
        return self._allowed(self.bias, self.bias_se)

    def _allowed(self, bias: float, bias_se: float) -> float:
        """Return the largest misfit allowed for this bias of the engine [unit]."""
        aside = max(math.copysign(1.0, self.misfit or 0.0) * bias, 0.0)
        return CHANCE_LIMIT * math.hypot(self.standard_error, bias_se) + self.tolerance + aside

    @property
    def verdict(self) -> str | None:
        """Whether chance alone explains the misfit, or only with the known error, or neither; None without a theory.

        A measurement or an error bar that is not a finite number agrees with nothing.
        """
        if self.misfit is None:
            return None
        if not math.isfinite(self.allowed) or not abs(self.misfit) <= self.allowed:
            return NO
        return YES if abs(self.misfit) <= self.chance else AS_STATED

    @property
    def agrees(self) -> bool | None:
        """Whether the misfit is within what is `allowed`; None without a theory."""
        return None if self.verdict is None else self.verdict != NO

    @property
    def excuse(self) -> str:
        """Why the misfit may exceed chance: the reason of the tolerance, or that the engine is known to be off."""
        return self.reason if abs(self.misfit or 0.0) <= self._allowed(0.0, 0.0) else ENGINE_IS_OFF
