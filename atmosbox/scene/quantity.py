"""Numbers with units: read from what a user types, such as "25 degC" or 4e3, and written in sentences.

The units are defined in :mod:`atmosbox.scene.conversion`, the allowed values of a setting in
:mod:`atmosbox.scene.parameter`.
"""

from __future__ import annotations

import math
import re
from decimal import Decimal, InvalidOperation
from numbers import Integral, Real

from atmosbox.errors import shown
from atmosbox.scene.conversion import MEASURES, SIGNS, declared_unit, known_unit, slashed

__all__ = ["converted", "number_and_unit", "phrase", "typed"]

_QUANTITY = re.compile(
    r"([+-]?(?:[0-9][0-9_]*\.?[0-9_]*|\.[0-9][0-9_]*)(?:e[+-]?[0-9]+)?|[+-]?(?:nan|inf(?:inity)?)(?![a-z]))\s*(.*)",
    re.DOTALL | re.IGNORECASE,
)
_LONGEST = 200  # characters of a text that can be a quantity


def phrase(value: float, unit: str) -> str:
    """Return a number and its unit for a sentence.

    Parameters
    ----------
    value
        A number in `unit`.
    unit
        The unit; "1" and the empty unit are left out.

    Examples
    --------
    >>> phrase(25.0, "degC"), phrase(4000, "1")
    ('25 degC', '4000')
    """
    number = shown(value) if isinstance(value, int) else f"{value:.12g}"
    return number if unit in ("1", "") else f"{number} {unit}"


def typed(value: float, unit: str) -> str:
    """Return a number and its unit in the form in which they are typed after ``--set``, without a blank.

    Parameters
    ----------
    value
        A number in `unit`.
    unit
        The unit; "1" and the empty unit are left out.

    Examples
    --------
    >>> typed(25.0, "degC"), typed(9.8, "m s-2"), typed(3.0, "m s-1")
    ('25degC', '9.8m/s2', '3m/s')
    """
    return phrase(value, slashed(unit)).replace(" ", "")


def number_and_unit(value: object) -> tuple[Decimal, str]:
    """Return a finite number with all the digits that were given, and its unit, empty for a bare number.

    Parameters
    ----------
    value
        A number, or a text such as "25 degC", "298.15K", "1_000 hPa" or "9.8 m/s^2".

    Raises
    ------
    ValueError
        If the value is not a number; the message says what is wrong, in words that follow the value.

    Examples
    --------
    >>> number_and_unit("25 degC"), number_and_unit(4000)
    ((Decimal('25'), 'degC'), (Decimal('4000'), ''))
    """
    number: float | str
    unit = ""
    if isinstance(value, bool) or not isinstance(value, str | Real):
        raise ValueError("is not a number")
    if isinstance(value, str):
        text = value.strip().translate(SIGNS)
        match = _QUANTITY.fullmatch(text) if len(text) <= _LONGEST else None
        if match is None or match[2].startswith(","):
            comma = re.match(r"[+-]?[0-9]*,[0-9]", text)
            raise ValueError("is written with a comma" if comma else "is not a number" if text else "is empty")
        number, unit = match[1], match[2]
    else:
        number = int(value) if isinstance(value, Integral) else float(value)
    try:
        exact = Decimal(number)
    except InvalidOperation:  # an exponent of twenty digits
        raise ValueError("is too large") from None
    if not math.isfinite(exact):
        raise ValueError("is too large" if exact.is_finite() else "is not finite")
    return exact, unit


def converted(number: float, unit: str, wanted: str) -> float:
    """Return a number of one unit in another, rounded to 12 digits.

    Temperatures are absolute; a degree in a product, as in "6.5 degC/km", is a difference of temperature.

    Parameters
    ----------
    number
        A number in `unit`.
    unit
        A unit as a user types it.
    wanted
        The unit wanted, as a scene declares it.

    Raises
    ------
    ValueError
        If there is no such unit, it has another dimension, or the result is too large; the message says which.

    Examples
    --------
    >>> converted(77.0, "degF", "degC"), converted(9.8, "N/kg", "m s-2")
    (25.0, 9.8)
    """
    known, aim = known_unit(unit), declared_unit(wanted)
    if known is None or unit == "1":
        raise ValueError("has an unknown unit")
    if known.si != aim.si:
        raise ValueError(f"is {MEASURES.get(known.si, 'a quantity of another kind')}")
    result = (number * known.up / known.down + known.offset - aim.offset) * aim.down / aim.up
    if not math.isfinite(result):
        raise ValueError("is too large")
    # A typed number has few digits: 77 degF is 25 degC, not 25.00000000000006.
    return float(f"{round(result, 9) if aim.offset else result:.12g}")
