"""The few numbers that a run is about, each beside the answer of the textbook."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

__all__ = ["CHANCE_ALONE", "Headline"]

CHANCE_ALONE = "none: the model has no other error than chance"
"""Reason of a tolerance of zero."""


@dataclass(frozen=True)
class Headline:
    """One number that a run is about, with its error bar and the answer of the textbook.

    Parameters
    ----------
    name
        Its name in the output.
    value, standard_error
        The measurement and its statistical error [unit].
    theory
        The closed-form answer [unit]; None where there is none.
    tolerance
        How far the model itself may be from the textbook, beyond the statistical error [unit].
    reason
        Why the tolerance is what it is.
    unit
        The SI unit of the numbers here.
    display_unit
        The unit in which a table shows them.
    label
        What a table calls it.
    bias, bias_se
        By how much runs of this approximate engine were measured to be off, and its standard error [unit].

    Examples
    --------
    With an error bar of 2 K, 3 K of misfit is no disagreement:

    >>> warm = Headline("air_temperature", 291.0, 2.0, 288.0, 0.0, "an ideal gas", "K", "degC", "temperature")
    >>> warm.misfit, warm.agrees
    (3.0, True)

    An engine that is known to be 5 K too warm may be that, but not as much too cold:

    >>> sharp = replace(warm, standard_error=0.5, bias=5.0)
    >>> sharp.agrees, sharp.excused, replace(sharp, value=283.0).agrees
    (True, True, False)
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

    @property
    def misfit(self) -> float | None:
        """Measurement minus theory [unit]; None without a theory."""
        return None if self.theory is None else self.value - self.theory

    @property
    def allowed(self) -> float:
        """How large the misfit may be [unit]: four standard errors, the tolerance, and a bias to the same side."""
        chance = 4.0 * math.hypot(self.standard_error, self.bias_se) + self.tolerance
        return chance + max(math.copysign(1.0, self.misfit or 0.0) * self.bias, 0.0)

    @property
    def excused(self) -> bool:
        """Whether it agrees for no other reason than that its engine is known to be so far off."""
        return bool(self.agrees) and not replace(self, bias=0.0, bias_se=0.0).agrees

    @property
    def agrees(self) -> bool | None:
        """Whether the misfit is within what is `allowed`; None without a theory.

        A measurement or an error bar that is not a finite number agrees with nothing.
        """
        if self.misfit is None:
            return None
        return math.isfinite(self.allowed) and abs(self.misfit) <= self.allowed
