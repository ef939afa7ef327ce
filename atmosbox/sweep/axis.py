"""One setting that varies in a sweep: the text that a user types after ``--vary``, and its values."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from atmosbox.errors import Option, SettingError, UnitError, UnknownSettingError
from atmosbox.scene.conversion import from_si, to_si
from atmosbox.scene.settings import Parameter, SceneSettings, Value, by_name
from atmosbox.scene.spelling import field_name

__all__ = ["LONGEST", "Axis", "parse_vary"]

LONGEST = 10_000
"""Greatest number of values of one setting."""

_COUNT = re.compile(r"\s*([0-9]{1,9})\s*(log|lin)?\s*")


@dataclass(frozen=True)
class Axis:
    """One setting that varies, with its values.

    Parameters
    ----------
    parameter
        The setting as its scene declares it.
    values
        Its values in the documented unit: numbers in ascending order, words and switches in the given order.

    Examples
    --------
    >>> warm = Parameter("temperature", "degC", 20.0, -60.0, 95.0)
    >>> Axis(warm, (0.0, 10.0)).si
    (273.15, 283.15)
    """

    parameter: Parameter
    values: tuple[Value, ...]

    @property
    def name(self) -> str:
        """The name of the setting."""
        return self.parameter.name

    @property
    def numeric(self) -> bool:
        """Whether the values are numbers, and neither words nor switches."""
        return self.parameter.kind in ("int", "float")

    @property
    def si(self) -> tuple[float, ...]:
        """The numbers in SI units."""
        return tuple(to_si(float(value), self.parameter.unit) for value in self.values)


def parse_vary(items: Iterable[str], settings: type[SceneSettings]) -> tuple[Axis, ...]:
    """Return the settings that vary, from the texts after each ``--vary``.

    Parameters
    ----------
    items
        ``name=a:b:n`` for n values from a to b with equal differences, ``name=a:b:nlog`` for n values with equal
        ratios, or ``name=x,y,z`` for these values. Numbers may have units as after ``--set``.
    settings
        The settings of the scene.

    Returns
    -------
    tuple of Axis
        One axis for each text, in the same order.

    Raises
    ------
    UnitError
        If a number or its unit cannot be understood.
    SettingError
        If a text has none of these forms, a value is not allowed, or a setting varies twice.

    Examples
    --------
    >>> from atmosbox import scenarios
    >>> grid = parse_vary(["molecules=100:10000:3log", "start=equal,maxwell"], scenarios.load("temperature").Settings)
    >>> [axis.values for axis in grid]
    [(100, 1000, 10000), ('equal', 'maxwell')]
    """
    parameters = {p.name: p for p in settings.describe()}
    axes: list[Axis] = []
    for item in items:
        name, equals, text = (part.strip() for part in item.partition("="))
        name = field_name(name)
        if not (name and equals and text):
            lacks = "name" if equals and not name else "values" if equals else '"=" between name and values'
            raise SettingError("vary", item, f"has no {lacks}", *_fix(parameters.get(name)))
        if name == "seed":
            raise SettingError("seed", text, "is what the members vary already", Option("members", 8), " instead")
        if name in (axis.name for axis in axes):
            raise SettingError(name, text, "is varied twice", Option("vary", {name: None}), " once")
        try:
            by_name({name: text}, parameters)  # raises the error that names the most similar setting
            axes.append(Axis(parameters[name], _values(text, parameters[name])))
        except UnknownSettingError as error:
            error.instead_of_settings(lambda part: Option("vary", {part.name: str(part.value)}))
            raise
        except SettingError as error:
            error.remedy = _fix(parameters[name])
            raise
    return tuple(axes)


def _fix(parameter: Parameter | None) -> tuple[Option | str, ...]:
    """Return what to give instead."""
    if parameter is None:
        example = Option("vary", {"temperature": "0degC:40degC:5"})
        return Option("vary", {"name": "a:b:n"}), ", such as ", example
    if parameter.kind in ("int", "float"):
        example = Option("vary", {parameter.name: "a:b:n"})
        return example, f" or x,y,z, such as {parameter.typed(parameter.default)}"
    allowed = ("on", "off") if parameter.kind == "bool" else parameter.choices or (str(parameter.default),)
    return (Option("vary", {parameter.name: ",".join(allowed)}),)


def _values(text: str, parameter: Parameter) -> tuple[Value, ...]:
    """Return the values in a text after "="; numbers in ascending order."""
    numeric = parameter.kind in ("int", "float")
    if numeric and ":" in text:
        return _row(text, parameter)
    values = [parameter.parse(part.strip()) for part in text.split(",")]
    if len(set(values)) < len(values):
        raise SettingError(parameter.name, text, "names a value twice")
    if len(values) > LONGEST:
        raise SettingError(parameter.name, text, f"has {len(values)} values, more than {LONGEST}")
    return tuple(sorted(values, key=float) if numeric else values)


def _row(text: str, parameter: Parameter) -> tuple[Value, ...]:
    """Return n values from a to b for the text a:b:n or a:b:nlog."""
    parts = text.split(":")
    count = _COUNT.fullmatch(parts[-1]) if len(parts) == 3 else None
    if count is None:
        raise UnitError(parameter.name, text, "is neither a:b:n, a:b:nlog nor x,y,z")
    low, high = sorted((parameter.parse(part.strip()) for part in parts[:2]), key=float)
    n = int(count[1])
    if not 2 <= n <= LONGEST:
        raise SettingError(parameter.name, text, f"asks for {n} values, and from 2 to {LONGEST} are possible")
    if low == high:
        raise SettingError(parameter.name, text, "begins where it ends")
    ends = float(low), float(high)
    if count[2] == "log":
        start, end = (to_si(limit, parameter.unit) for limit in ends)
        if start <= 0.0:
            raise SettingError(parameter.name, text, "begins at or below zero, where no ratios are even")
        inner = [from_si(value, parameter.unit) for value in np.geomspace(start, end, n)[1:-1].tolist()]
    else:
        inner = np.linspace(*ends, n)[1:-1].tolist()
    whole = parameter.kind == "int"
    values = (low, *(round(value) if whole else float(f"{value:.12g}") for value in inner), high)
    if len(set(values)) < n:
        raise SettingError(parameter.name, text, f"has only {len(set(values))} different values, not {n}")
    return values
