"""Units and numbers with units: read from what a user types, such as "25 degC" or 4e3, converted, and written.

The units that scenes declare are in a table. Any other unit that a user types, from feet to inches of mercury, is
looked up in pint, which is imported only then: the first such unit takes 0.4 s, one of the table 0.0001 s.
"""

from __future__ import annotations

import functools
import math
import re
import unicodedata
from decimal import Decimal, InvalidOperation
from numbers import Integral, Real
from typing import Any, NamedTuple

from atmosbox.errors import UnitError, shown


class Unit(NamedTuple):
    """A unit: value * up / down + offset is the value in the SI unit `si`."""

    si: str
    up: float = 1.0
    down: float = 1.0
    offset: float = 0.0


_UNITS = {
    "1": Unit("1"), "%": Unit("1", 1, 1e2), "kg kg-1": Unit("kg kg-1"), "g kg-1": Unit("kg kg-1", 1, 1e3),
    "K": Unit("K"), "degC": Unit("K", offset=273.15),
    "Pa": Unit("Pa"), "hPa": Unit("Pa", 1e2), "kPa": Unit("Pa", 1e3), "bar": Unit("Pa", 1e5),
    "m": Unit("m"), "km": Unit("m", 1e3), "cm": Unit("m", 1, 1e2), "mm": Unit("m", 1, 1e3),
    "um": Unit("m", 1, 1e6), "nm": Unit("m", 1, 1e9),
    "s": Unit("s"), "min": Unit("s", 60), "h": Unit("s", 3600), "ms": Unit("s", 1, 1e3),
    "us": Unit("s", 1, 1e6), "ns": Unit("s", 1, 1e9), "ps": Unit("s", 1, 1e12), "fs": Unit("s", 1, 1e15),
    "m s-1": Unit("m s-1"), "km h-1": Unit("m s-1", 1, 3.6), "m s-2": Unit("m s-2"),
    "K m-1": Unit("K m-1"), "K km-1": Unit("K m-1", 1, 1e3), "K s-1": Unit("K s-1"),
    "K ns-1": Unit("K s-1", 1e9), "J mol-1 K-1": Unit("J mol-1 K-1"),
    "J": Unit("J"), "mJ": Unit("J", 1, 1e3), "zJ": Unit("J", 1, 1e21), "J-1": Unit("J-1"), "zJ-1": Unit("J-1", 1e21),
    "s-1": Unit("s-1"), "ns-1": Unit("s-1", 1e9), "kg m-3": Unit("kg m-3"), "g m-3": Unit("kg m-3", 1, 1e3),
    "kg": Unit("kg"), "g": Unit("kg", 1, 1e3),
    "N m-1": Unit("N m-1"), "mN m-1": Unit("N m-1", 1, 1e3),
    "J mol-1": Unit("J mol-1"), "kJ mol-1": Unit("J mol-1", 1e3), "m-3": Unit("m-3"), "nm-3": Unit("m-3", 1e27),
    "kg mol-1": Unit("kg mol-1"), "g mol-1": Unit("kg mol-1", 1, 1e3),
}  # fmt: skip

MEASURES = {
    "1": "a pure number", "K": "a temperature", "Pa": "a pressure", "m": "a length", "s": "a time",
    "kg": "a mass", "J": "an energy", "N": "a force", "m2": "an area", "m3": "a volume", "s-1": "a frequency",
    "m s-1": "a speed", "m s-2": "an acceleration", "K m-1": "a lapse rate", "kg m-3": "a density",
    "kg kg-1": "a mixing ratio", "kg mol-1": "a molar mass",
}  # fmt: skip
"""The quantity that each SI unit of the scenes measures, in words."""

_SPELLINGS = {
    "C": "degC", "c": "degC", "celsius": "degC", "Celsius": "degC", "centigrade": "degC",
    "F": "degF", "f": "degF", "fahrenheit": "degF", "Fahrenheit": "degF",
    "k": "K", "kelvin": "K", "Kelvin": "K", "kelvins": "K", "degK": "K",
    "pa": "Pa", "hpa": "hPa", "kpa": "kPa", "mbar": "hPa", "mb": "hPa", "millibar": "hPa", "millibars": "hPa",
    "μm": "um", "μs": "us", "percent": "%", "Torr": "torr",
}  # fmt: skip

_DEGREES = re.compile(r"(?:°|\b(?i:deg(?:rees?)?))[\s_]*((?i:[cfk]|celsius|fahrenheit|kelvin))(?![A-Za-z])")
_POWER = re.compile(r"(?<=[^\W\d])([+-]?\d+)")  # "m s-2" is "m s**-2"
_TOWER = re.compile(r"\d\s*(?:\^|\*\*)|\d{3}")  # a power of a power would take pint years
_QUANTITY = re.compile(
    r"([+-]?(?:[0-9][0-9_]*\.?[0-9_]*|\.[0-9][0-9_]*)(?:e[+-]?[0-9]+)?|[+-]?(?:nan|inf(?:inity)?)(?![a-z]))\s*(.*)",
    re.DOTALL | re.IGNORECASE,
)
_LONGEST = 200  # characters of a text that can be a quantity
SIGNS = str.maketrans({"−": "-", "º": "°", "˚": "°"})
"""Other characters that keyboards and word processors write for - and °, for ``str.translate``."""


def slashed(unit: str) -> str:
    """Return a unit in the form in which it is typed, without a blank.

    >>> slashed("m s-2"), slashed("K km-1"), slashed("degC")
    ('m/s2', 'K/km', 'degC')
    """
    typed = re.sub(r" ([A-Za-z]+)-(\d+)", lambda match: f"/{match[1]}{match[2].removeprefix('1')}", unit)
    return typed.replace(" ", "*")


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_PRINTED = {"degC": "°C", "um": "µm", "us": "µs", "percent": "%"}


def power_of_ten(power: int) -> str:
    """Return a power of ten as it is printed, its exponent as a superscript.

    >>> power_of_ten(25)
    '10²⁵'
    """
    return "10" + str(power).translate(_RAISED)


def spelled(unit: str, power: int = 0) -> str:
    """Return a unit as it is printed, empty for a pure number; with a power of ten before it unless that is 0.

    >>> spelled("m s-1"), spelled("J kg-1 K-1"), spelled("ns-1"), spelled("degC"), spelled("1"), spelled("1", power=-15)
    ('m/s', 'J/(kg K)', 'ns⁻¹', '°C', '', '10⁻¹⁵')
    """
    factors = [
        re.sub(r"-?\d+$", lambda digits: digits[0].translate(_RAISED), _PRINTED.get(each, each))
        for each in unit.split()
        if each != "1"
    ]
    above = [each for each in factors if "⁻" not in each]
    below = [each.replace("⁻¹", "").replace("⁻", "") for each in factors if "⁻" in each]
    divisor = below[0] if len(below) == 1 else f"({' '.join(below)})"
    words = f"{' '.join(above)}/{divisor}" if above and below else " ".join(factors)
    return f"{power_of_ten(power)} {words}".rstrip() if power else words


_UNITS |= {slashed(name): unit for name, unit in _UNITS.items()}


@functools.cache
def _registry() -> Any:
    """Return pint's units, imported at the first unit that is not in the table."""
    import pint

    return pint.UnitRegistry()


def _looked_up(name: str) -> Unit | None:
    """Return a unit from pint; None for an unknown unit, for a pure number and for a logarithmic scale."""
    registry = _registry()
    if _TOWER.search(name) or name.startswith("delta"):  # a temperature is wanted, not a difference of two
        return None
    try:
        unit = registry.parse_units(name)
        zero, one, two = (registry.Quantity(x, unit).to_base_units().magnitude for x in (0.0, 1.0, 2.0))
    except Exception:  # pint's parser fails in a dozen ways, from AssertionError to TypeError
        return None
    if unit.dimensionless:
        return Unit("kg kg-1", float(one)) if "gram" in str(unit) else None
    if not math.isclose(two - one, one - zero):
        return None
    alike = (si for si in MEASURES if registry.parse_units(_POWER.sub(r"**\1", si)).is_compatible_with(unit))
    return Unit(next(alike, str(unit.dimensionality)), float(one - zero), 1.0, float(zero))


@functools.lru_cache(maxsize=256)
def known_unit(text: str) -> Unit | None:
    """Return the unit of any spelling, from the table or else from pint; None if there is none.

    >>> known_unit("m/s^2") == known_unit("m s-2"), known_unit("blorp")
    (True, None)
    """
    if text not in _UNITS:
        text = unicodedata.normalize("NFKC", text).translate(SIGNS)  # "m s⁻²" is "m s-2", "℃" is "°C"
        text = _DEGREES.sub(lambda match: f"deg{match[1][0].upper()}", text)
        text = re.sub(r"[^\W\d]+", lambda match: _SPELLINGS.get(match[0], match[0]), text).strip()
    return _UNITS.get(text) or _looked_up(_POWER.sub(r"**\1", text))


def declared_unit(unit: str) -> Unit:
    """Return the unit that a scene declares; raise UnitError if there is no such unit.

    >>> declared_unit("hPa").si
    'Pa'
    """
    known = known_unit(unit)
    if known is None:
        raise UnitError("unit", unit, "is not known", 'give one such as "hPa", "degC", "K/km" or "1"')
    return known


def to_si(value: float, unit: str, *, difference: bool = False) -> float:
    """Return a value in SI units; ``unit`` is "hPa", "degC", "K/km", "%", "1" for a pure number, or any other.

    A ``difference``, which may be an error bar, is converted without an offset: one of 2 degC is one of 2 K.

    >>> to_si(25.0, "degC"), to_si(1013.25, "hPa"), to_si(0.5, "degC", difference=True)
    (298.15, 101325.0, 0.5)
    """
    known = declared_unit(unit)
    return value * known.up / known.down + (0.0 if difference else known.offset)


def from_si(value: float, unit: str, *, difference: bool = False) -> float:
    """Return a value in SI units in another unit; the inverse of :func:`to_si`.

    >>> from_si(298.15, "degC"), from_si(0.0098, "K/km")
    (25.0, 9.8)
    """
    known = declared_unit(unit)
    return (value - (0.0 if difference else known.offset)) * known.down / known.up


def phrase(value: float, unit: str) -> str:
    """Return a number and its unit for a sentence; the unit "1" is left out.

    >>> phrase(25.0, "degC"), phrase(4000, "1")
    ('25 degC', '4000')
    """
    number = shown(value) if isinstance(value, int) else f"{value:.12g}"
    return number if unit in ("1", "") else f"{number} {unit}"


def typed(value: float, unit: str) -> str:
    """Return a number and its unit in the form in which they are typed after ``--set``, without a blank.

    >>> typed(25.0, "degC"), typed(9.8, "m s-2"), typed(3.0, "m s-1")
    ('25degC', '9.8m/s2', '3m/s')
    """
    return phrase(value, slashed(unit)).replace(" ", "")


def number_and_unit(value: object) -> tuple[Decimal, str]:
    """Return a finite number with all the digits that were given, and its unit, empty for a bare number.

    A ValueError says what is wrong with the value, in words that follow it.

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
    """Return a number of one unit in another, rounded to 12 digits; a ValueError says what is wrong with its unit.

    Temperatures are absolute; a degree in a product, as in "6.5 degC/km", is a difference of temperature.

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
