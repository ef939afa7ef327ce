"""The few main results of a run, each beside the answer of the textbook."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

if TYPE_CHECKING:
    from atmosbox.scene.statistics import BlockAverage

__all__ = ["AS_STATED", "CHANCE_ALONE", "CHANCE_LIMIT", "ENGINE_IS_OFF", "NO", "YES", "Headline"]

CHANCE_ALONE = "none: the model has no other error than chance"
"""Reason of a tolerance of zero."""
ENGINE_IS_OFF = "the measured error of this engine is that large"
"""Reason of a bias of the engine."""
CHANCE_LIMIT = 4.0
"""Largest misfit, in standard errors, that counts as chance: chance exceeds it once in 16,000 times."""
YES, AS_STATED, NO = "yes", "as stated", "no"
"""The verdicts on a misfit: explained by chance alone; only with the known error of the model; not explained."""


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
    (5.0, 'as stated', 'no')
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
