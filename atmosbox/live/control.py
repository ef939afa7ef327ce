"""The controls on the page: knobs that change the running box, and settings that restart it."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from atmosbox.errors import SettingError
from atmosbox.scene.knob import Knob
from atmosbox.scene.settings import Parameter, Value

__all__ = ["COLLISIONS", "Control", "controls", "in_words", "number_between"]

COLLISIONS = "collisions"
"""Name of the switch for collisions, which every engine has."""

_MOST_MOLECULES = 50_000
_STEPS = 200
_WIDE = 1000.0


@dataclass(frozen=True)
class Control:
    """A knob, setting or switch that the page can change.

    Parameters
    ----------
    parameter
        Its name, unit, range and description.
    value
        Its present value.
    restarts
        Whether a change restarts the box.
    """

    parameter: Parameter
    value: Value
    restarts: bool

    @property
    def name(self) -> str:
        """Name of the control."""
        return self.parameter.name

    def parse(self, value: object) -> Value:
        """Return the requested value, in the unit of the control.

        Raises
        ------
        SettingError
            If the value is not allowed; the message says which values are.

        Examples
        --------
        >>> warmth = Control(Parameter("warmth", "degC", 20.0, 0.0, 99.0, None, "of the walls", "float"), 20.0, False)
        >>> warmth.parse("300 K")
        26.85
        """
        if isinstance(value, float) and not math.isfinite(value):
            value = str(value)
        return self.parameter.parse(value)

    def record(self) -> dict[str, Any]:
        """Return the control as data for the page.

        Examples
        --------
        >>> told = Parameter("rotation", "", True, None, None, None, "whether molecules rotate", "bool")
        >>> spin = Control(told, True, True)
        >>> spin.record()["kind"], spin.record()["label"]
        ('switch', 'whether molecules rotate')
        """
        told = self.parameter
        kind = {"bool": "switch", "str": "choice"}.get(told.kind, "number")
        made: dict[str, Any] = {
            "name": told.name,
            "label": told.help,
            "unit": told.unit,
            "kind": kind,
            "value": self.value,
            "restarts": self.restarts,
            "help": f"{told.name}: {told.allowed}",
        }
        if kind == "choice":
            made["choices"] = list(told.choices or ())
        if kind == "number":
            low, high = told.low, told.high
            wide = low is not None and high is not None and low > 0.0 and high > _WIDE * low
            made |= {"low": low, "high": high, "step": _step(told), "scale": "log" if wide else "linear"}
        return made


def _step(parameter: Parameter) -> float:
    """Return a round step for a slider: some hundreds of steps make the range, and one of them meets the default."""
    if parameter.kind == "int":
        return 1
    if parameter.low is None or parameter.high is None or parameter.high <= parameter.low:
        return 0.1
    rough = (parameter.high - parameter.low) / _STEPS
    power = 10.0 ** math.floor(math.log10(rough))
    steps = [power * each for each in (10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1)]
    above = float(parameter.default) - parameter.low
    fits = (step for step in steps if step <= rough and abs(above / step - round(above / step)) < 1e-6)
    return float(f"{next(fits, power):.6g}")


def controls(
    knobs: Iterable[Knob],
    parameters: Iterable[Parameter],
    values: Mapping[str, Value],
    *,
    collisions: bool | None,
) -> tuple[Control, ...]:
    """Return all controls: first those that act at once.

    Parameters
    ----------
    knobs
        The knobs of the box.
    parameters
        The settings of the scene; the seed, free texts and settings that have a knob are left out.
    values
        The present values of settings and knobs.
    collisions
        Whether molecules collide; None if that cannot be switched.

    Returns
    -------
    tuple of Control
        The controls in the order in which the page shows them.

    Examples
    --------
    >>> [c.name for c in controls([], [], {}, collisions=True)]
    ['collisions']
    """
    found = []
    for knob in knobs:
        words = knob.help
        told = Parameter(knob.name, knob.unit, knob.value, knob.low, knob.high, None, words, "float")
        found.append(Control(told, values.get(knob.name, knob.value), False))
    taken = {control.name for control in found} | {"seed"}
    for parameter in parameters:
        if parameter.name in taken or (parameter.kind == "str" and not parameter.choices):
            continue
        if parameter.name == "molecules" and parameter.kind == "int":
            most = max(_MOST_MOLECULES, int(values[parameter.name]))
            high = most if parameter.high is None else min(most, parameter.high)
            parameter = Parameter(
                parameter.name, parameter.unit, parameter.default, parameter.low, high, None, parameter.help, "int"
            )  # fmt: skip
        found.append(Control(parameter, values[parameter.name], True))
    if collisions is not None:
        told = Parameter(COLLISIONS, "", True, None, None, None, "whether molecules meet each other", "bool")
        found.append(Control(told, collisions, True))
    return tuple(found)


def number_between(value: object, name: str, low: float, high: float) -> float:
    """Return a number that a page has sent.

    Raises
    ------
    SettingError
        If the value is not a number, or is below `low` or above `high`.

    Examples
    --------
    >>> number_between(2, "pace", 0.25, 16.0)
    2.0
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
        raise SettingError(name, in_words(value), f"is not a number from {low:g} to {high:g}", f"give {name} = 1")
    return float(value)


def in_words(value: object) -> str:
    """Return a value that a page has sent as text for a message.

    Examples
    --------
    >>> in_words(None), in_words("air")
    ('null', 'air')
    """
    return value if isinstance(value, str) else json.dumps(value, default=str)
