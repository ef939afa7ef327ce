"""One setting as a scene declared it: which values it allows, and how it reads the one that a user gave."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from typing import Literal

from atmosbox.errors import SettingError
from atmosbox.scene.quantity import parse_quantity, parse_whole, phrase, typed
from atmosbox.scene.spelling import nearest, plain

__all__ = ["Kind", "Parameter", "Value"]

Value = bool | int | float | str
Kind = Literal["int", "float", "bool", "str"]

_SWITCH = {
    "on": True,
    "true": True,
    "yes": True,
    "1": True,
    "off": False,
    "false": False,
    "no": False,
    "0": False,
}


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
        What it is, in one line.
    kind
        The type of its value: "int", "float", "bool" or "str".
    """

    name: str
    unit: str
    default: Value
    low: float | None
    high: float | None
    choices: tuple[str, ...] | None
    help: str
    kind: Kind

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
        """Return a value, or else the default, as it is typed after ``--set name=``."""
        value = self.default if value is None else value
        if isinstance(value, bool):
            return "on" if value else "off"
        return shlex.quote(value) if isinstance(value, str) else typed(value, self.unit)

    def parse(self, value: object) -> Value:
        """Return what a user gave for this setting, in its documented unit.

        Parameters
        ----------
        value
            A number, a switch or a text.

        Raises
        ------
        UnitError
            If a number or its unit cannot be understood.
        SettingError
            If the value is not allowed.

        Examples
        --------
        >>> Parameter("height", "km", 2.0, 0.0, 12.0, None, "of the box", "float").parse("500 m")
        0.5
        """
        if self.kind == "bool":
            return self._switch(value)
        if self.kind == "str":
            return self._word(value)
        parse = parse_whole if self.kind == "int" else parse_quantity
        return parse(value, self.unit, self.name, low=self.low, high=self.high, example=self.typed())

    def _switch(self, value: object) -> bool:
        if isinstance(value, str) and value.strip().casefold() in _SWITCH:
            return _SWITCH[value.strip().casefold()]
        if isinstance(value, int) and value in (0, 1):
            return bool(value)
        raise self._refusal(value, "is neither on nor off", self.typed())

    def _word(self, value: object) -> str:
        text = value.strip() if isinstance(value, str) else ""
        if self.choices is None:
            if isinstance(value, str) and (text or not self.default):
                return text
            raise self._refusal(value, "is empty" if isinstance(value, str) else "is not a text", self.typed())
        for choice in self.choices:
            if plain(choice) == plain(text):
                return choice
        example = nearest(text, self.choices) or self.typed()
        raise self._refusal(value, f"is not one of {', '.join(self.choices)}", example)

    def _refusal(self, value: object, problem: str, example: str) -> SettingError:
        return SettingError(self.name, value, problem, f"give --set {self.name}={example}")
