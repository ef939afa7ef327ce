"""What a user types, such as "25 degC" or 4e3, as a number in the unit of the setting it is for.

A bare number is in the unit in which the setting is documented; every refusal is one sentence that names the
setting, the value and what to type instead. The units themselves stand in :mod:`atmosbox.scene.conversion`.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from numbers import Integral, Real

from atmosbox.errors import SettingError, UnitError, shown
from atmosbox.scene.conversion import MEASURES, SIGNS, declared_unit, known_unit, to_si

__all__ = ["parse_quantity", "parse_whole", "phrase", "typed"]

_NUMBER = r"[+-]?(?:[0-9](?:_?[0-9])*\.?(?:[0-9](?:_?[0-9])*)?|\.[0-9](?:_?[0-9])*)(?:[eE][+-]?[0-9]+)?"
_QUANTITY = re.compile(rf"({_NUMBER}|[+-]?(?i:nan|inf(?:inity)?)(?![A-Za-z]))\s*(.*)", re.DOTALL)
_LONGEST = 200  # characters of a text that can be a quantity


def phrase(value: float, unit: str) -> str:
    """Return a number and its unit as a sentence says them.

    Parameters
    ----------
    value
        A number in `unit`.
    unit
        The unit; "1" and the empty one are not said.

    Examples
    --------
    >>> phrase(25.0, "degC"), phrase(4000, "1")
    ('25 degC', '4000')
    """
    number = shown(value) if isinstance(value, int) else f"{value:.12g}"
    return number if unit in ("1", "") else f"{number} {unit}"


def typed(value: float, unit: str) -> str:
    """Return a number and its unit as they are typed after ``--set``, without a blank.

    Parameters
    ----------
    value
        A number in `unit`.
    unit
        The unit; "1" and the empty one are not typed.

    Examples
    --------
    >>> typed(25.0, "degC"), typed(9.8, "m s-2"), typed(3.0, "m s-1")
    ('25degC', '9.8m/s2', '3m/s')
    """
    slashed = re.sub(r" ([A-Za-z]+)-(\d+)", lambda match: f"/{match[1]}{match[2].removeprefix('1')}", unit)
    return phrase(value, slashed.replace(" ", "*")).replace(" ", "")


@dataclass(frozen=True)
class _Request:
    """A number that is asked of the user: it reads the answer and words the refusals."""

    setting: str
    unit: str
    low: float | None
    high: float | None
    example: str | None
    whole: bool = False

    @property
    def wanted(self) -> str:
        """What would be right: "a temperature from -100 degC to 500 degC"."""
        kind = "a percentage" if self.unit == "%" else MEASURES.get(declared_unit(self.unit).si, "a quantity")
        if self.whole:
            kind = "a whole number" if self.unit == "1" else f"a whole number of {self.unit}"
        limits = [None if limit is None else phrase(limit, self.unit) for limit in (self.low, self.high)]
        match limits:
            case [str(low), str(high)]:
                return f"{kind} from {low} to {high}"
            case [str(low), None]:
                return f"{kind} of at least {low}"
            case [None, str(high)]:
                return f"{kind} of at most {high}"
        return kind if self.whole or self.unit in ("1", "%") else f"{kind} in {self.unit}"

    @property
    def fix(self) -> str:
        """What to type instead: the example, or else 25 degC, 1000 hPa or a limit."""
        if self.example is not None:
            return f"give --set {self.setting}={self.example}"
        usual = {"K": ("25degC", 298.15), "Pa": ("1000hPa", 1e5)}
        text, value = usual.get(declared_unit(self.unit).si, ("", math.nan))
        low = -math.inf if self.low is None else to_si(self.low, self.unit)
        high = math.inf if self.high is None else to_si(self.high, self.unit)
        if not low <= value <= high:
            text = typed(next((x for x in (self.low, self.high) if x is not None), 1), self.unit)
        return f"give --set {self.setting}={text}"

    def refusal(self, value: object, problem: str) -> UnitError:
        """Return the error that says what is wrong with a value and what is wanted."""
        return UnitError(self.setting, value, f"{problem}, but {self.wanted} is wanted", self.fix)

    def read(self, value: object) -> tuple[Decimal, str]:
        """Return the number, exactly as given, and the spelling of its unit, empty for a bare number."""
        number: float | str
        unit = ""
        if isinstance(value, bool) or not isinstance(value, str | Real):
            raise self.refusal(value, "is not a number")
        if isinstance(value, str):
            text = value.strip().translate(SIGNS)
            if not text:
                raise self.refusal(value, "is empty")
            match = _QUANTITY.fullmatch(text) if len(text) <= _LONGEST else None
            if match is None or match[2].startswith(","):
                comma = re.match(r"[+-]?[0-9]*,[0-9]", text)
                raise self.refusal(value, "is written with a comma" if comma else "is not a number")
            number, unit = match[1], match[2]
        else:
            number = int(value) if isinstance(value, Integral) else float(value)
        try:
            exact = Decimal(number)
        except InvalidOperation:  # an exponent of twenty digits
            raise self.refusal(value, "is out of reach of any number") from None
        if not exact.is_finite():
            raise self.refusal(value, "is not finite")
        if math.isinf(float(exact)):
            raise self.refusal(value, "is too large")
        return exact, unit

    def converted(self, value: object, number: float, unit: str) -> float:
        """Return a number of the unit that was given in the one that is asked for."""
        known = None if unit == "1" else known_unit(unit)
        if known is None:
            raise self.refusal(value, "has an unknown unit")
        aim = declared_unit(self.unit)
        if known.si != aim.si:
            kind = MEASURES.get(known.si, "a quantity of another kind")
            raise self.refusal(value, f"is {kind}")
        result = (number * known.up / known.down + known.offset - aim.offset) * aim.down / aim.up
        if not math.isfinite(result):
            raise self.refusal(value, "is too large")
        # A typed number has few digits: 77 degF is 25 degC, not 25.00000000000006.
        return float(f"{round(result, 9) if aim.offset else result:.12g}")

    def check_range(self, value: object, unit: str, number: Decimal | float) -> None:
        """Raise SettingError if a number is outside the limits."""
        below = self.low is not None and number < self.low
        if not below and (self.high is None or number <= self.high):
            return
        limits = " to ".join(phrase(limit, self.unit) for limit in (self.low, self.high) if limit is not None)
        given = shown(value.strip() if isinstance(value, str) else value)
        if not unit and self.unit != "1":
            given = f"{given} {self.unit}"
        side = "below the lowest" if below else "above the highest"
        raise SettingError(self.setting, given, f"is {side} allowed, {limits}", self.fix)


def parse_quantity(
    value: object,
    unit: str,
    setting: str,
    *,
    low: float | None = None,
    high: float | None = None,
    example: str | None = None,
) -> float:
    """Return what a user gave for a setting as a number of the setting's unit.

    Parameters
    ----------
    value
        A number, or a text such as "25 degC", "298.15 K", "77F", "1013.25 mbar" or "9.8 m/s^2". A bare number
        is taken in `unit`. Temperatures are absolute; a degree in a product, as in "6.5 degC/km", is one of
        difference.
    unit
        The documented unit of the setting, "1" for a pure number.
    setting
        The name of the setting, for the sentence of an error.
    low, high
        The lowest and highest number allowed, in `unit`.
    example
        What an error tells the user to type; without it, something usual.

    Returns
    -------
    float
        The finite value in `unit`. One that was converted is rounded to 12 digits.

    Raises
    ------
    UnitError
        If the value is not a finite number of that kind.
    SettingError
        If it is below `low` or above `high`.

    Examples
    --------
    >>> parse_quantity("77 degF", "degC", "temperature"), parse_quantity(300, "hPa", "pressure")
    (25.0, 300.0)
    >>> parse_quantity("5 m", "degC", "temperature", low=-100.0, high=500.0)
    Traceback (most recent call last):
    atmosbox.errors.UnitError: temperature = 5 m is a length, but a temperature from -100 degC to 500 degC
    is wanted: give --set temperature=25degC.
    """
    request = _Request(setting, unit, low, high, example)
    exact, given = request.read(value)
    number = float(exact)
    if given and given != unit:
        number = request.converted(value, number, given)
    request.check_range(value, given, number)
    return number


def parse_whole(
    value: object,
    unit: str,
    setting: str,
    *,
    low: float | None = None,
    high: float | None = None,
    example: str | None = None,
) -> int:
    """Return what a user gave for a setting that counts something, exactly.

    Parameters
    ----------
    value, unit, setting, low, high, example
        As for :func:`parse_quantity`; "4e3" and 4000.0 are whole numbers, too.

    Returns
    -------
    int
        The value in `unit`, with all its digits.

    Raises
    ------
    UnitError
        If the value is not a whole number of that kind.
    SettingError
        If it is below `low` or above `high`.

    Examples
    --------
    >>> parse_whole("4e3", "1", "molecules"), parse_whole("9223372036854775807", "1", "seed")
    (4000, 9223372036854775807)
    """
    request = _Request(setting, unit, low, high, example, whole=True)
    exact, given = request.read(value)
    if given and given != unit:
        exact = Decimal(repr(request.converted(value, float(exact), given)))
    if exact != exact.to_integral_value():
        raise request.refusal(value, "is not whole")
    request.check_range(value, given, exact)
    return int(exact)
