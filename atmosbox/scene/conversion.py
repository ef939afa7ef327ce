"""Conversion between units, in any of their spellings.

The units that scenes declare are in a table. Any other unit that a user types, from feet to inches of mercury, is
looked up in pint, which is imported only then: the first such unit takes 0.4 s, one of the table 0.0001 s. The input of
a user is read by :mod:`atmosbox.scene.quantity`.
"""

from __future__ import annotations

import functools
import math
import re
import unicodedata
from typing import Any, NamedTuple

from atmosbox.errors import UnitError

__all__ = ["MEASURES", "SIGNS", "Unit", "declared_unit", "from_si", "known_unit", "slashed", "to_si"]


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
    "K m-1": Unit("K m-1"), "K km-1": Unit("K m-1", 1, 1e3),
    "J": Unit("J"), "zJ": Unit("J", 1, 1e21), "J-1": Unit("J-1"), "zJ-1": Unit("J-1", 1e21),
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
SIGNS = str.maketrans({"−": "-", "º": "°", "˚": "°"})
"""Other characters that keyboards and word processors write for - and °, for ``str.translate``."""


def slashed(unit: str) -> str:
    """Return a unit in the form in which it is typed, without a blank.

    Parameters
    ----------
    unit
        The unit as a scene declares it.

    Examples
    --------
    >>> slashed("m s-2"), slashed("K km-1"), slashed("degC")
    ('m/s2', 'K/km', 'degC')
    """
    typed = re.sub(r" ([A-Za-z]+)-(\d+)", lambda match: f"/{match[1]}{match[2].removeprefix('1')}", unit)
    return typed.replace(" ", "*")


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

    Parameters
    ----------
    text
        The unit as a user types it.

    Examples
    --------
    >>> known_unit("m/s^2") == known_unit("m s-2"), known_unit("blorp")
    (True, None)
    """
    if text not in _UNITS:
        text = unicodedata.normalize("NFKC", text).translate(SIGNS)  # "m s⁻²" is "m s-2", "℃" is "°C"
        text = _DEGREES.sub(lambda match: f"deg{match[1][0].upper()}", text)
        text = re.sub(r"[^\W\d]+", lambda match: _SPELLINGS.get(match[0], match[0]), text).strip()
    return _UNITS.get(text) or _looked_up(_POWER.sub(r"**\1", text))


def declared_unit(unit: str) -> Unit:
    """Return the unit that a scene declares.

    Parameters
    ----------
    unit
        The unit, such as "hPa", "degC", "K/km", "%", or "1" for a pure number.

    Raises
    ------
    UnitError
        If there is no such unit.

    Examples
    --------
    >>> declared_unit("hPa").si
    'Pa'
    """
    known = known_unit(unit)
    if known is None:
        raise UnitError("unit", unit, "is not known", 'give one such as "hPa", "degC", "K/km" or "1"')
    return known


def to_si(value: float, unit: str, *, difference: bool = False) -> float:
    """Return a value in SI units.

    Parameters
    ----------
    value
        A number in `unit`.
    unit
        The unit, such as "hPa", "degC", "K/km", "%", or "1" for a pure number.
    difference
        Whether the value is a difference or an error bar: one of 2 degC is one of 2 K, not of 275.15 K.

    Returns
    -------
    float
        The value in Pa, K, K m-1, 1, ...

    Raises
    ------
    UnitError
        If there is no such unit.

    Examples
    --------
    >>> to_si(25.0, "degC"), to_si(1013.25, "hPa"), to_si(0.5, "degC", difference=True)
    (298.15, 101325.0, 0.5)
    """
    known = declared_unit(unit)
    return value * known.up / known.down + (0.0 if difference else known.offset)


def from_si(value: float, unit: str, *, difference: bool = False) -> float:
    """Return a value in SI units in another unit; the inverse of :func:`to_si`.

    Parameters
    ----------
    value
        A number in Pa, K, K m-1, 1, ...
    unit
        The unit wanted.
    difference
        Whether the value is a difference or an error bar, to which no offset is added.

    Returns
    -------
    float
        The value in `unit`.

    Raises
    ------
    UnitError
        If there is no such unit.

    Examples
    --------
    >>> from_si(298.15, "degC"), from_si(0.0098, "K/km")
    (25.0, 9.8)
    """
    known = declared_unit(unit)
    return (value - (0.0 if difference else known.offset)) * known.down / known.up
