"""Numbers and units as a page prints them: with a true minus sign, superscripts, and only the digits that are known."""

from __future__ import annotations

import math
import re

from uncertainties import ufloat

from atmosbox.scene.conversion import power_of_ten, spelled

__all__ = ["bare", "fixed", "measured", "spelled", "theoretical"]


def _easy(size: float) -> bool:
    """Return whether a number of this size is easily read without a power of ten."""
    return size == 0.0 or 1e-4 <= size < 1e6


def bare(value: float, figures: int = 3) -> str:
    """Return a number as text with some significant figures.

    Examples
    --------
    >>> bare(17.2071), bare(-0.000123), bare(2.4e-19), bare(1013.25)
    ('17.2', '−0.000123', '2.40·10⁻¹⁹', '1013')
    """
    if not math.isfinite(value):
        return "–"
    mantissa, power = f"{value:.{figures - 1}e}".split("e")
    if not _easy(abs(value)):
        return f"{mantissa}·{power_of_ten(int(power))}".replace("-", "−")
    return f"{value:.{max(figures - 1 - int(power), 0) if value else 0}f}".replace("-", "−")


def fixed(value: float, decimals: int) -> str:
    """Return a number as text with some decimals, and never "-0".

    Examples
    --------
    >>> fixed(-17.25, 1), fixed(-0.04, 1)
    ('−17.2', '0.0')
    """
    return f"{round(value, decimals) + 0.0:.{decimals}f}".replace("-", "−")


def measured(value: float, error: float) -> str:
    """Return a measurement with its standard error; the error has two significant figures.

    Examples
    --------
    >>> measured(25.784, 0.983), measured(6.691e9, 6.0e7), measured(-18.25, 0.31), measured(3.0, 0.0)
    ('25.78 ± 0.98', '(6.691 ± 0.060)·10⁹', '−18.25 ± 0.31', '3.00')
    """
    if not (math.isfinite(value) and math.isfinite(error)):
        return "–"
    if error <= 0.0:
        return bare(value)
    form = "f" if _easy(max(abs(value), error)) else "e"
    text = format(ufloat(value, error), f".2u{form}P")
    return text.replace("±", " ± ").replace("×", "·").replace("-", "−")


def theoretical(value: float, error: float) -> str:
    """Return a number of theory with as many digits as a measurement with this standard error.

    Examples
    --------
    >>> theoretical(25.0, 0.983), theoretical(6.671e9, 6.0e7)
    ('25.00', '6.671·10⁹')
    """
    if not (math.isfinite(value) and error > 0.0):
        return bare(value, 4)
    return re.sub(r"\(?([−\d.]+) ± [\d.]+\)?", r"\1", measured(value, error))
