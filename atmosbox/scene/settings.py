"""What a user may set: declared once and checked once; each refusal is a full sentence.

A scene declares its settings in a class, and the command line, the settings file, the tables of ``atmosbox info`` and
the attributes of the output are all made from that declaration::

    class Settings(SceneSettings):
        molecules: int = setting(4000, "1", "number of simulated molecules", low=1, high=10_000_000)
        temperature: float = setting(15.0, "degC", "temperature at the start", low=-100.0, high=500.0)
        rotation: bool = setting(True, "", "whether molecules rotate")
        start: str = setting("equilibrium", "", "the first frame", choices=("equilibrium", "bottom"))

Values stay in the unit in which they are documented; ``settings.si`` has them in SI units.
"""

from __future__ import annotations

import contextlib
import functools
import inspect
import shlex
from collections.abc import Mapping
from dataclasses import dataclass, replace
from decimal import Decimal
from types import SimpleNamespace
from typing import Any, ClassVar, Never, Self, TypeVar

from atmosbox.errors import Given, Option, Setting, SettingError, UnitError, UnknownSettingError, shown
from atmosbox.scene import conversion
from atmosbox.scene.spelling import field_name, nearest, plain

__all__ = ["Parameter", "SceneSettings", "Value", "by_name", "setting"]

Value = bool | int | float | str
T = TypeVar("T")
_SWITCH = {"on": True, "true": True, "yes": True, "1": True, "off": False, "false": False, "no": False, "0": False}


@dataclass(frozen=True)
class Parameter:
    """One setting as it was declared.

    Parameters
    ----------
    name, help
        Its name, and what it is, in one line.
    unit
        The unit of a bare number, "1" for a pure number, empty for switches and words.
    default
        Its value unless it is set.
    low, high
        The lowest and highest value allowed, in `unit`; None where there is no limit.
    choices
        The words allowed; None for numbers, switches and free text.
    kind
        The type of its value: "int", "float", "bool" or "str".
    given_as
        `Option` if it is not a setting of a scene but an option of a command that is read like one.
    """

    name: str
    unit: str
    default: Value
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] | None = None
    help: str = ""
    kind: str = "float"
    given_as: type[Setting] | type[Option] = Setting

    @property
    def allowed(self) -> str:
        """What may be set, in words: "-100 degC to 500 degC", "on or off", "equilibrium or bottom"."""
        if self.kind == "bool":
            return "on or off"
        if self.kind == "str":
            return " or ".join(self.choices) if self.choices else "any text"
        low, high = (None if limit is None else conversion.phrase(limit, self.unit) for limit in (self.low, self.high))
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
        return shlex.quote(value) if isinstance(value, str) else conversion.typed(value, self.unit)

    def said(self, value: Value) -> str:
        """Return a value with its unit for a sentence or a table."""
        return self.typed(value) if isinstance(value, bool | str) else conversion.phrase(value, self.unit)

    def parse(self, value: object) -> Value:
        """Return what a user gave for this setting, in its documented unit.

        A number may come with a unit, as in "25 degC", "298.15 K" or "77F"; then it is rounded to 12 digits.

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
        give height="2km".
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
        number = self.kind in ("int", "float")
        try:
            unit = conversion.number_and_unit(value)[1]
        except ValueError:  # words, or several numbers
            return not number or any(c.isdigit() for c in str(value))
        known = conversion.known_unit(unit or "1")
        if known is None:
            return True  # a row of numbers, or a unit that is misspelled
        return number and (not unit or known.si == conversion.declared_unit(self.unit).si)

    def _switch(self, value: object) -> bool:
        if isinstance(value, str) and (word := value.strip().lower()) in _SWITCH:
            return _SWITCH[word]
        if isinstance(value, int | float) and value in (0, 1):
            return bool(value)
        raise self._refusal(value, "is neither on nor off")

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
            exact, unit = conversion.number_and_unit(value)
            if unit not in ("", self.unit, conversion.slashed(self.unit)):
                exact = Decimal(repr(conversion.converted(float(exact), unit, self.unit)))
            if self.kind == "int" and exact != exact.to_integral_value():
                raise ValueError("is not whole")
        except ValueError as error:
            problem = f"{error}, but {self._wanted} is wanted"
            raise UnitError(self.name, value, problem, self.instead(self._without_comma(value))) from None
        number = int(exact) if self.kind == "int" else float(exact)
        limit = self._limit(number)
        if limit is not None:
            given = shown(value.strip() if isinstance(value, str) else value)
            given = given if unit or self.unit == "1" else f"{given} {self.unit}"
            side = "below" if number < limit else "above"
            refusal = self._refusal(given, f"is {side} the allowed range, {self.allowed}", limit)
            if not unit and self.unit == "degC" and self._limit(number - 273.15) is None:
                refusal.remedy += (", or ", Setting(self.name, f"{exact}K"), " if it is in kelvin")
            raise refusal
        return number

    def _limit(self, number: float) -> float | None:
        """Return the limit beyond which a number is; None if it is allowed."""
        if self.low is not None and number < self.low:
            return self.low
        return self.high if self.high is not None and number > self.high else None

    def _without_comma(self, value: object) -> Value | None:
        """Return the number that was written with commas, if it is allowed: 30,5 or 1,000."""
        if isinstance(value, str) and "," in value and len(value) < 100:
            point, none = value.replace(",", "."), value.replace(",", "")
            for text in (none, point) if self.kind == "int" else (point, none):
                with contextlib.suppress(SettingError):
                    return self.parse(text)
        return None

    @property
    def _wanted(self) -> str:
        """What is allowed, with its kind: "a temperature from -100 degC to 500 degC"."""
        measured = conversion.MEASURES.get(conversion.declared_unit(self.unit).si, "a quantity")
        kind = "a percentage" if self.unit == "%" else measured
        if self.kind == "int":
            kind = "a whole number" + ("" if self.unit == "1" else f" of {self.unit}")
        limits = (self.low is not None) + (self.high is not None)
        return f"{kind} {('in', 'of', 'from')[limits]} {self.allowed if limits else self.unit}".removesuffix(" in 1")

    def instead(self, value: Value | None = None) -> Given:
        """Return a value, or else the default, for the remedy of an error."""
        value = self.default if value is None else value
        bare = isinstance(value, bool | str) or self.unit == "1"
        return self.given_as(self.name, value if bare else conversion.typed(float(value), self.unit))

    def _refusal(self, value: object, problem: str, instead: Value | None = None) -> SettingError:
        return SettingError(self.name, value, problem, self.instead(instead))


def by_name(
    given: Mapping[str, T], parameters: Mapping[str, Parameter], whose: str = "a setting of this scene"
) -> dict[str, T]:
    """Return values by the names of their settings, which a user may spell with "-" for "_".

    A name that is unknown, or given twice, is refused; `whose` says in that sentence what the settings belong to.

    Examples
    --------
    >>> by_name({"box-height": "3 km"}, {"box_height": Parameter("box_height", "km", 2.0)})
    {'box_height': '3 km'}
    """
    values: dict[str, T] = {}
    for spelled, value in given.items():
        name = field_name(spelled)
        if name in values:
            raise SettingError(name, value, "is given twice", Setting(name), " once")
        if name not in parameters:
            near = nearest(name, (known for known, parameter in parameters.items() if parameter.takes(value)))
            fix: Given | str = f"give one of {', '.join(parameters)}"
            if near is not None:
                usable = isinstance(value, str) and shown(value) == value
                fix = Setting(near, str(value)) if usable else parameters[near].instead()
            raise UnknownSettingError(spelled, value, f"is not {whose}", fix)
        values[name] = value
    return values


def setting(
    default: Value, unit: str, help: str, *, low: float | None = None, high: float | None = None,
    choices: tuple[str, ...] | None = None,
) -> Any:  # fmt: skip
    """Declare a setting of a scene.

    It returns a `Parameter`, typed as Any, so that ``temperature: float = setting(...)`` is right for a type checker.

    Parameters
    ----------
    default
        Its value unless the user sets it, in `unit`.
    unit
        The unit in which it is documented and a bare number is read; "1" for a pure number, empty for a
        switch or a word.
    help
        What it is, in one line.
    low, high, choices
        The lowest and highest value allowed, in `unit`; the words allowed.

    Examples
    --------
    >>> class Settings(SceneSettings):
    ...     start: str = setting("mixed", "", "the first frame", choices=("mixed", "layered"))
    >>> Settings.describe()[0].allowed
    'mixed or layered'
    """
    return Parameter("", unit, default, low, high, choices, help)


class SceneSettings:
    """The settings of a scene, checked and unchangeable; a scene derives its own from this.

    Making one checks every value as :meth:`from_user` does.

    Attributes
    ----------
    seed
        Seed of the random numbers: the same seed repeats the same run.

    Raises
    ------
    TypeError
        When a scene's class is defined, if a setting is not declared with :func:`setting`, its unit does not
        exist, or its default is not one of its own allowed values.

    Examples
    --------
    >>> class Settings(SceneSettings):
    ...     temperature: float = setting(15.0, "degC", "temperature at the start", low=-100.0, high=500.0)
    >>> settings = Settings.from_user({"temperature": "298.15 K"})
    >>> settings.temperature, settings.si.temperature, settings.changed()
    (25.0, 298.15, {'temperature': 25.0})
    """

    seed: int = setting(1, "1", "seed of the random numbers", low=0, high=2**63 - 1)
    _declared: ClassVar[dict[str, Parameter]] = {}

    def __init_subclass__(cls) -> None:
        """Check a scene's declarations as soon as its class is defined."""
        super().__init_subclass__()
        own = {name: kind for name, kind in inspect.get_annotations(cls).items() if not name.startswith("_")}
        found = cls._declared | {name: _checked(cls, name, kind) for name, kind in own.items()}
        cls._declared = found | {"seed": found.pop("seed")}  # the seed comes last

    def __init__(self, /, **values: Any) -> None:
        given = by_name(values, self._declared)
        vars(self).update({name: p.parse(given.get(name, p.default)) for name, p in self._declared.items()})
        self.check()

    def __setattr__(self, name: str, value: object) -> Never:
        raise AttributeError("settings cannot be changed")

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SceneSettings) and self.as_dict() == other.as_dict()

    def __hash__(self) -> int:
        return hash(tuple(self.as_dict().items()))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in self.as_dict().items())})"

    @classmethod
    def from_user(cls, values: Mapping[str, Any]) -> Self:
        """Return the settings that a user asked for, with the defaults for the rest.

        A name may be spelled with "-" for "_". An unknown name raises UnknownSettingError; a value raises what
        `Parameter.parse` raises; values that do not fit together raise SettingError.
        """
        return cls(**values)

    @classmethod
    def describe(cls) -> list[Parameter]:
        """Return the settings as they were declared: the scene's own, then the seed."""
        return list(cls._declared.values())

    @classmethod
    def with_defaults(cls, **defaults: Value) -> type[Self]:
        """Return the same settings with other defaults, for a scene that is a variant of another.

        Examples
        --------
        >>> SceneSettings.with_defaults(seed=7)().seed
        7
        """
        variant: type[Self] = type(cls.__name__, (cls,), {})
        for name, value in by_name(defaults, cls._declared).items():
            p = cls._declared[name]
            variant._declared[name] = replace(p, default=p.parse(value))
        return variant

    def check(self) -> None:
        """Raise the error of :meth:`refusal` where the settings do not fit together; a scene may override this."""

    def refusal(
        self, name: str, problem: str, *remedy: Given | str, at_most: float | None = None, at_least: float | None = None
    ) -> SettingError:
        """Return the error for a setting that does not go with the others.

        Parameters
        ----------
        name, problem
            The name of the setting, and what is wrong with it; the sentence puts it after the value.
        *remedy
            What else the user can do, as for :class:`~atmosbox.errors.SettingError`.
        at_most, at_least
            The highest or the lowest value that goes with the others, in the unit of the setting.

        Examples
        --------
        >>> print(SceneSettings(seed=7).refusal("seed", "is too lucky", at_most=6))
        seed = 7 is too lucky: give seed=6 or less.
        """
        if at_most is not None:
            remedy = (self._declared[name].instead(at_most), " or less", *remedy)
        if at_least is not None:
            remedy = (self._declared[name].instead(at_least), " or more", *remedy)
        return SettingError(name, self._declared[name].said(getattr(self, name)), problem, *remedy)

    @functools.cached_property
    def si(self) -> SimpleNamespace:
        """The same names with their values in SI units: degC in K, hPa in Pa, K/km in K m-1, % in 1."""
        values, to_si = self.as_dict(), conversion.to_si
        units = {p.name: p.unit for p in self.describe() if p.unit not in ("", "1")}
        return SimpleNamespace(**values | {name: to_si(float(values[name]), unit) for name, unit in units.items()})

    def as_dict(self) -> dict[str, Value]:
        """Return the values in their documented units, ready for JSON and for :meth:`from_user`."""
        return {name: getattr(self, name) for name in self._declared}

    def changed(self) -> dict[str, Value]:
        """Return the values that differ from their defaults, in their documented units."""
        return {name: value for name, value in self.as_dict().items() if value != self._declared[name].default}


def _checked(cls: type[SceneSettings], name: str, annotation: Any) -> Parameter:
    """Return the setting of a name as its class declares it; raise TypeError for the mistake of an author."""
    declared, kind = vars(cls).get(name), getattr(annotation, "__name__", str(annotation))
    where = f"The setting {name} of {cls.__qualname__}"
    if not isinstance(declared, Parameter):
        raise TypeError(f"{where} must be declared with setting(default, unit, help).")
    if kind not in ("int", "float", "bool", "str"):
        raise TypeError(f"{where} must be an int, a float, a bool or a str.")
    if bool(declared.unit) != (kind in ("int", "float")):
        raise TypeError(f'{where} must have a unit if it is a number ("1" for a pure one), else the unit "".')
    named = replace(declared, name=name, kind=kind)
    try:
        if declared.unit:
            conversion.declared_unit(declared.unit)
        return replace(named, default=named.parse(declared.default))
    except SettingError as error:
        raise TypeError(f"{where} has a unit or a default that it does not allow: {error}") from error


SceneSettings._declared = {"seed": _checked(SceneSettings, "seed", int)}
