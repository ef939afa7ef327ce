"""The few numbers that a run is about, each beside the answer of the textbook."""

from __future__ import annotations

import math
from dataclasses import dataclass

__all__ = ["Headline"]


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

    Examples
    --------
    With an error bar of 2 K, 3 K of misfit is no disagreement:

    >>> warm = Headline("air_temperature", 291.0, 2.0, 288.0, 0.0, "an ideal gas", "K", "degC", "temperature")
    >>> warm.misfit, warm.agrees
    (3.0, True)
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

    @property
    def misfit(self) -> float | None:
        """Measurement minus theory [unit]; None without a theory."""
        return None if self.theory is None else self.value - self.theory

    @property
    def agrees(self) -> bool | None:
        """Whether the misfit is within four standard errors and the tolerance; None without a theory.

        A measurement or an error bar that is not a finite number agrees with nothing.
        """
        if self.misfit is None:
            return None
        allowed = 4.0 * self.standard_error + self.tolerance
        return math.isfinite(allowed) and abs(self.misfit) <= allowed
