"""One setting as a scene declares it: the values it allows, and how the value that a user gives is read."""

from __future__ import annotations

import contextlib
import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from typing import Literal, TypeVar

from pydantic import TypeAdapter, ValidationError

from atmosbox.errors import SettingError, UnitError, UnknownSettingError, shown
from atmosbox.scene.conversion import MEASURES, declared_unit, known_unit, slashed
from atmosbox.scene.quantity import converted, number_and_unit, phrase, typed
from atmosbox.scene.spelling import field_name, nearest, plain

__all__ = ["Kind", "Parameter", "Value", "by_name"]

Value = bool | int | float | str
Kind = Literal["int", "float", "bool", "str"]
T = TypeVar("T")

_SWITCH = TypeAdapter(bool)  # on and off, true and false, yes and no, 1 and 0


@dataclass(frozen=True)
class Parameter:
    """One setting as it was declared.

    Parameters
    ----------
    name
        Its name.
    unit
        The unit of a bare number, "1" for a pure number, empty for switches and words.
    default
        Its value unless it is set.
    low, high
        The lowest and highest value allowed, in `unit`; None where there is no limit.
    choices
        The words allowed; None for numbers, switches and free text.
    help
        What the setting is, in one line.
    kind
        The type of its value: "int", "float", "bool" or "str".
    """

    name: str
    unit: str
    default: Value
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] | None = None
    help: str = ""
    kind: Kind = "float"

    @property
    def allowed(self) -> str:
        """What may be set, in words: "-100 degC to 500 degC", "on or off", "equilibrium or bottom"."""
        if self.kind == "bool":
            return "on or off"
        if self.kind == "str":
            return " or ".join(self.choices) if self.choices else "any text"
        low, high = (None if limit is None else phrase(limit, self.unit) for limit in (self.low, self.high))
        if low and high:
            return f"{low} to {high}"
        if low or high:
            return f"at least {low}" if low else f"at most {high}"
        number = "any whole number" if self.kind == "int" else "any number"
        return number if self.unit == "1" else f"{number} ({self.unit})"

    def typed(self, value: Value | None = None) -> str:
        """Return a value, or else the default, in the form in which it is typed after ``--set name=``."""
        value = self.default if value is None else value
        if isinstance(value, bool):
            return "on" if value else "off"
        return shlex.quote(value) if isinstance(value, str) else typed(value, self.unit)

    def parse(self, value: object) -> Value:
        """Return what a user gave for this setting, in its documented unit.

        Parameters
        ----------
        value
            A number, a switch or a text; a number may come with a unit, as in "25 degC", "298.15 K" or "77F", and a
            bare one is in the documented unit.

        Returns
        -------
        bool, int, float or str
            The value; a number that came in another unit is rounded to 12 digits.

        Raises
        ------
        UnitError
            If a number or its unit cannot be understood.
        SettingError
            If the value is not allowed.

        Examples
        --------
        >>> height = Parameter("height", "km", 2.0, 0.0, 12.0)
        >>> height.parse("500 m")
        0.5
        >>> height.parse("5 hPa")
        Traceback (most recent call last):
        atmosbox.errors.UnitError: height = 5 hPa is a pressure, but a length from 0 km to 12 km is wanted:
        give --set height=2km.
        """
        if self.kind == "bool":
            return self._switch(value)
        return self._word(value) if self.kind == "str" else self._number(value)

    def takes(self, value: object) -> bool:
        """Whether a value is of the kind of this setting, even if it is out of range or a row of several values.

        Examples
        --------
        >>> height = Parameter("height", "km", 2.0, 0.0, 12.0)
        >>> height.takes("50 km"), height.takes("1:2:3"), height.takes("2 ns")
        (True, True, False)
        """
        try:
            unit = number_and_unit(value)[1]
        except ValueError:
            return self.kind not in ("int", "float") or any(
                c.isdigit() for c in str(value)
            )  # words, or several numbers
        known = known_unit(unit or "1")
        if known is None:
            return True  # a row of numbers, or a unit that is misspelled
        number = self.kind in ("int", "float")
        return number and (not unit or known.si == declared_unit(self.unit).si)

    def _switch(self, value: object) -> bool:
        try:
            return _SWITCH.validate_python(value.strip() if isinstance(value, str) else value)
        except ValidationError:
            raise self._refusal(value, "is neither on nor off") from None

    def _word(self, value: object) -> str:
        text = value.strip() if isinstance(value, str) else ""
        if self.choices is None:
            if isinstance(value, str) and (text or not self.default):
                return text
            raise self._refusal(value, "is empty" if isinstance(value, str) else "is not a text")
        for choice in self.choices:
            if plain(choice) == plain(text):
                return choice
        raise self._refusal(value, f"is not one of {', '.join(self.choices)}", nearest(text, self.choices))

    def _number(self, value: object) -> float:
        try:
            exact, unit = number_and_unit(value)
            if unit not in ("", self.unit, slashed(self.unit)):
                exact = Decimal(repr(converted(float(exact), unit, self.unit)))
            if self.kind == "int" and exact != exact.to_integral_value():
                raise ValueError("is not whole")
        except ValueError as error:
            problem = f"{error}, but {self._wanted} is wanted"
            raise UnitError(self.name, value, problem, self._fix(self._without_comma(value))) from None
        number = int(exact) if self.kind == "int" else float(exact)
        below = self.low is not None and number < self.low
        if below or (self.high is not None and number > self.high):
            given = shown(value.strip() if isinstance(value, str) else value)
            given = given if unit or self.unit == "1" else f"{given} {self.unit}"
            side, limit = ("below the lowest", self.low) if below else ("above the highest", self.high)
            raise self._refusal(given, f"is {side} allowed, {self.allowed}", self.typed(limit))
        return number

    def _without_comma(self, value: object) -> str | None:
        """Return how a number is typed that was written with commas, if it is allowed: 30,5 or 1,000."""
        if isinstance(value, str) and "," in value and len(value) < 100:
            point, none = value.replace(",", "."), value.replace(",", "")
            for text in (none, point) if self.kind == "int" else (point, none):
                with contextlib.suppress(SettingError):
                    return self.typed(self.parse(text))
        return None

    @property
    def _wanted(self) -> str:
        """What is allowed, with its kind: "a temperature from -100 degC to 500 degC"."""
        kind = "a percentage" if self.unit == "%" else MEASURES.get(declared_unit(self.unit).si, "a quantity")
        if self.kind == "int":
            kind = "a whole number" + ("" if self.unit == "1" else f" of {self.unit}")
        limits = (self.low is not None) + (self.high is not None)
        return f"{kind} {('in', 'of', 'from')[limits]} {self.allowed if limits else self.unit}".removesuffix(" in 1")

    def _fix(self, example: str | None = None) -> str:
        return f"give --set {self.name}={example or self.typed()}"

    def _refusal(self, value: object, problem: str, example: str | None = None) -> SettingError:
        return SettingError(self.name, value, problem, self._fix(example))


def by_name(
    given: Mapping[str, T], parameters: Mapping[str, Parameter], whose: str = "a setting of this scene"
) -> dict[str, T]:
    """Return values by the names of their settings, however a user spelled these names.

    Parameters
    ----------
    given
        The values; a name may be spelled with "-" for "_".
    parameters
        The settings by name.
    whose
        What the settings belong to, for the sentence of a refusal.

    Raises
    ------
    UnknownSettingError
        If there is no setting of a name; the sentence suggests the nearest name.
    SettingError
        If a setting is given twice.

    Examples
    --------
    >>> by_name({"box-height": "3 km"}, {"box_height": Parameter("box_height", "km", 2.0)})
    {'box_height': '3 km'}
    """
    values: dict[str, T] = {}
    for spelled, value in given.items():
        name = field_name(spelled)
        if name in values:
            raise SettingError(name, value, "is given twice", f"give --set {name} once")
        if name not in parameters:
            near = nearest(name, (known for known, parameter in parameters.items() if parameter.takes(value)))
            fix = f"give one of {', '.join(parameters)}"
            if near is not None:
                usable = isinstance(value, str) and shown(value) == value
                fix = f"give --set {near}={shlex.quote(str(value)) if usable else parameters[near].typed()}"
            raise UnknownSettingError(spelled, value, f"is not {whose}", fix)
        values[name] = value
    return values
