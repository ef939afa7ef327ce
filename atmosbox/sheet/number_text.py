"""Numbers and units as a page prints them: with a true minus, raised powers, and no more digits than are known."""

from __future__ import annotations

import math

__all__ = ["bare", "measured", "raised", "spelled", "theoretical"]

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_UNITS = {"degC": "°C", "percent": "%", "um": "µm", "us": "µs"}
LONGEST = 8
"""How many decimals a number has at most before its power of ten is taken out."""


def raised(exponent: int) -> str:
    """Return an exponent in raised digits.

    Examples
    --------
    >>> raised(-21)
    '⁻²¹'
    """
    return str(exponent).translate(_RAISED)


def spelled(unit: str) -> str:
    """Return a unit as it is printed; nothing for a pure number.

    Examples
    --------
    >>> spelled("degC"), spelled("m s-1"), spelled("1")
    ('°C', 'm s⁻¹', '')
    """
    words = []
    for word in unit.split():
        base = word.rstrip("-0123456789")
        words.append(_UNITS.get(word) or base + word[len(base) :].translate(_RAISED))
    return " ".join(words) if unit != "1" else ""


def _power(value: float) -> int:
    """Return the power of ten to take out of a number; zero for one that is easily read as it is."""
    first = math.floor(math.log10(abs(value))) if value and math.isfinite(value) else 0
    return 0 if -4 < first < 6 else first


def _decimals(value: float, decimals: int) -> str:
    """Return a number with so many decimals, fewer than none for tens and hundreds."""
    rounded = round(value, decimals) + 0.0  # never "-0"
    return f"{rounded:.{max(decimals, 0)}f}".replace("-", "−")


def _scaled(mantissa: str, power: int) -> str:
    """Return a number with its power of ten."""
    return f"{mantissa}·10{raised(power)}" if power else mantissa


def bare(value: float, figures: int = 3) -> str:
    """Return a number with so many significant figures.

    Examples
    --------
    >>> bare(17.2071), bare(-0.000123), bare(2.4e19), bare(1013.25)
    ('17.2', '−1.23·10⁻⁴', '2.40·10¹⁹', '1013')
    """
    if not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    power = _power(value)
    mantissa = value / 10.0**power
    first = math.floor(math.log10(abs(mantissa)))
    return _scaled(_decimals(mantissa, max(figures - 1 - first, 0)), power)


def measured(value: float, error: float) -> str:
    """Return a measurement with its standard error, of which two figures are shown.

    Examples
    --------
    >>> measured(25.784, 0.983), measured(6.691e9, 6.0e7), measured(-18.25, 0.31), measured(3.0, 0.0)
    ('25.78 ± 0.98', '(6.691 ± 0.060)·10⁹', '−18.25 ± 0.31', '3.00')
    """
    if not (math.isfinite(value) and math.isfinite(error)):
        return "–"
    if error <= 0.0:
        return bare(value)
    power = _power(max(abs(value), error))
    value, error = value / 10.0**power, error / 10.0**power
    decimals = min(1 - math.floor(math.log10(error)), LONGEST)
    both = f"{_decimals(value, decimals)} ± {_decimals(error, decimals)}"
    return _scaled(f"({both})", power) if power else both


def theoretical(value: float, beside: float, error: float) -> str:
    """Return a number of theory with the digits of the measurement beside it.

    Examples
    --------
    >>> theoretical(25.0, 25.784, 0.983), theoretical(6.671e9, 6.691e9, 6.0e7)
    ('25.00', '6.671·10⁹')
    """
    if not (math.isfinite(value) and math.isfinite(beside) and error > 0.0):
        return bare(value, 4)
    power = _power(max(abs(beside), error))
    decimals = min(1 - math.floor(math.log10(error / 10.0**power)), LONGEST)
    return _scaled(_decimals(value / 10.0**power, decimals), power)
