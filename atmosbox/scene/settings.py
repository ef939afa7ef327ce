r"""What a user may set: declared once and checked once; each refusal is a full sentence.

A scene declares its settings as the fields of a class, and the command line, the settings file, the tables of
``atmosbox info`` and the attributes of the output are all made from that declaration::

    class Settings(SceneSettings):
        molecules: int = setting(4000, "1", "number of simulated molecules", low=1, high=10_000_000)
        temperature: float = setting(15.0, "degC", "temperature at the start", low=-100.0, high=500.0)
        rotation: bool = setting(True, "", "whether molecules rotate")
        start: str = setting("equilibrium", "", "the first frame", choices=("equilibrium", "bottom"))

Values stay in the unit in which they are documented; ``settings.si`` has them in SI units.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, Self, cast

from pydantic import BaseModel, ConfigDict, Field, create_model

from atmosbox.errors import SettingError
from atmosbox.scene.conversion import to_si
from atmosbox.scene.parameter import Kind, Parameter, Value, by_name

__all__ = ["SceneSettings", "setting"]


def setting(
    default: Value,
    unit: str,
    help: str,
    *,
    low: float | None = None,
    high: float | None = None,
    choices: tuple[str, ...] | None = None,
) -> Any:
    """Declare a setting of a scene.

    Parameters
    ----------
    default
        Its value unless the user sets it, in `unit`.
    unit
        The unit in which it is documented and a bare number is read; "1" for a pure number, empty for a
        switch or a word.
    help
        What it is, in one line.
    low, high
        The lowest and highest value allowed, in `unit`.
    choices
        The words allowed.

    Returns
    -------
    pydantic.fields.FieldInfo
        The field; typed as Any, so that ``temperature: float = setting(...)`` is right for a type checker.

    Examples
    --------
    >>> class Settings(SceneSettings):
    ...     start: str = setting("mixed", "", "the first frame", choices=("mixed", "layered"))
    >>> Settings.describe()[0].allowed
    'mixed or layered'
    """
    extra: dict[str, Any] = {"unit": unit, "minimum": low, "maximum": high, "enum": choices}
    return Field(default, description=help, json_schema_extra={k: v for k, v in extra.items() if v is not None})


class SceneSettings(BaseModel):
    """The settings of a scene, checked and unchangeable; a scene derives its own from this.

    Making one checks every value as :meth:`from_user` does.

    Attributes
    ----------
    seed
        Seed of the random numbers: the same seed repeats the same run.

    Raises
    ------
    TypeError
        When a scene's class is defined, if a field is not declared with :func:`setting`, its unit does not
        exist, or its default is not one of its own allowed values.

    Examples
    --------
    >>> class Settings(SceneSettings):
    ...     temperature: float = setting(15.0, "degC", "temperature at the start", low=-100.0, high=500.0)
    >>> settings = Settings.from_user({"temperature": "298.15 K"})
    >>> settings.temperature, settings.si.temperature, settings.changed()
    (25.0, 298.15, {'temperature': 25.0})
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    seed: int = setting(1, "1", "seed of the random numbers", low=0, high=2**63 - 1)

    def __init__(self, /, **values: Any) -> None:
        parameters = _parameters(type(self))
        given = by_name(values, parameters)
        super().__init__(**{name: p.parse(given.get(name, p.default)) for name, p in parameters.items()})
        self.check()

    @classmethod
    def __pydantic_init_subclass__(cls, **kwargs: Any) -> None:
        """Check a scene's declarations as soon as its class is defined."""
        super().__pydantic_init_subclass__(**kwargs)
        _parameters(cls)

    @classmethod
    def from_user(cls, values: Mapping[str, Any]) -> Self:
        """Return the settings that a user asked for, with the defaults for the rest.

        Parameters
        ----------
        values
            Numbers, switches and texts by name; a name may be spelled with "-" for "_".

        Raises
        ------
        UnknownSettingError
            If the scene has no setting of a name.
        UnitError
            If a number or its unit cannot be understood.
        SettingError
            If a value is not allowed, or the values do not fit together.
        """
        return cls(**values)

    @classmethod
    def describe(cls) -> list[Parameter]:
        """Return the settings as they were declared: the scene's own, then the seed."""
        return list(_parameters(cls).values())

    @classmethod
    def with_defaults(cls, **defaults: Value) -> type[Self]:
        """Return the same settings with other defaults, for a scene that is a variant of another.

        Raises
        ------
        UnknownSettingError
            If a default names no setting.

        Examples
        --------
        >>> SceneSettings.with_defaults(seed=7)().seed
        7
        """
        parameters = _parameters(cls)
        fields: dict[str, Any] = {}
        for name, value in by_name(defaults, parameters).items():
            p = parameters[name]
            same = setting(value, p.unit, p.help, low=p.low, high=p.high, choices=p.choices)
            fields[name] = (cls.model_fields[name].annotation, same)
        return cast("type[Self]", create_model(cls.__name__, __base__=cls, **fields))

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return the same settings but for some values, checked as those of a user.

        Parameters
        ----------
        update
            The values that differ, as for :meth:`from_user`.
        deep
            Of no effect: there is nothing in settings that could change.

        Raises
        ------
        SettingError
            As :meth:`from_user` does.

        Examples
        --------
        >>> SceneSettings(seed=7).model_copy(update={"seed": "8"}).seed
        8
        """
        return type(self)(**{**self.as_dict(), **by_name(update or {}, _parameters(type(self)))})

    def check(self) -> None:
        """Raise SettingError where the settings do not fit together; a scene may override this."""

    @functools.cached_property
    def si(self) -> SimpleNamespace:
        """The same names with their values in SI units: degC in K, hPa in Pa, K/km in K m-1, % in 1."""
        return SimpleNamespace(
            **{
                p.name: getattr(self, p.name) if p.unit in ("", "1") else to_si(getattr(self, p.name), p.unit)
                for p in self.describe()
            }
        )

    def as_dict(self) -> dict[str, Value]:
        """Return the values in their documented units, ready for JSON and for :meth:`from_user`."""
        return {p.name: getattr(self, p.name) for p in self.describe()}

    def changed(self) -> dict[str, Value]:
        """Return the values that differ from their defaults, in their documented units."""
        return {p.name: getattr(self, p.name) for p in self.describe() if getattr(self, p.name) != p.default}


@functools.cache
def _parameters(cls: type[SceneSettings]) -> dict[str, Parameter]:
    """Return a class's settings by name, each with its default checked."""
    kinds: dict[Any, Kind] = {int: "int", float: "float", bool: "bool", str: "str"}
    parameters: dict[str, Parameter] = {}
    for name, field in sorted(cls.model_fields.items(), key=lambda item: item[0] == "seed"):
        extra, kind = field.json_schema_extra, kinds.get(field.annotation)
        where = f"The setting {name} of {cls.__qualname__}"
        if not isinstance(extra, dict) or "unit" not in extra or field.description is None:
            raise TypeError(f"{where} must be declared with setting(default, unit, help).")
        if kind is None:
            raise TypeError(f"{where} must be an int, a float, a bool or a str.")
        unit, low, high, choices = (cast("Any", extra.get(k)) for k in ("unit", "minimum", "maximum", "enum"))
        if bool(unit) != (kind in ("int", "float")):
            raise TypeError(f'{where} must have a unit if it is a number ("1" for a pure one), else the unit "".')
        declared = Parameter(name, unit, field.default, low, high, choices, field.description, kind)
        try:
            if unit:
                to_si(1.0, unit)
            parameters[name] = replace(declared, default=declared.parse(field.default))
        except SettingError as error:
            raise TypeError(f"{where} has a unit or a default that it does not allow: {error}") from error
    return parameters
