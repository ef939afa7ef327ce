"""What the page offers to be changed: the knobs of a box that runs, and the settings with which it begins anew."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from atmosbox.errors import SettingError
from atmosbox.scene.knob import Knob
from atmosbox.scene.parameter import Parameter, Value

__all__ = ["COLLISIONS", "Control", "controls", "in_words", "number_between"]

COLLISIONS = "collisions"
"""The switch that every engine has."""

_MOST_MOLECULES = 50_000
_STEPS = 200
_WIDE = 1000.0


@dataclass(frozen=True)
class Control:
    """One thing that can be changed.

    Parameters
    ----------
    parameter
        Its name, unit, range and words.
    value
        What it is now.
    restarts
        Whether the box begins anew with it.
    """

    parameter: Parameter
    value: Value
    restarts: bool

    @property
    def name(self) -> str:
        """Its name."""
        return self.parameter.name

    def parse(self, value: object) -> Value:
        """Return what was asked for, in the unit of the control.

        Raises
        ------
        SettingError
            If the value is not allowed; the sentence says what is.

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
        """Return it as data for the page.

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
    """Return a round step, some hundreds of which make the range, and which meets the default."""
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
    """Return all that can be changed: first what acts at once.

    Parameters
    ----------
    knobs
        Those of the box.
    parameters
        The settings of the scene; the seed and free texts are left out, and what a knob stands for.
    values
        The settings as they are, and where the knobs stand.
    collisions
        Whether molecules meet; None where they must.

    Returns
    -------
    tuple of Control
        In the order in which the page shows them.

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
        If it is none, or lies outside.

    Examples
    --------
    >>> number_between(2, "pace", 0.25, 16.0)
    2.0
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
        raise SettingError(name, in_words(value), f"is not a number from {low:g} to {high:g}", f"give {name} = 1")
    return float(value)


def in_words(value: object) -> str:
    """Return what a page has sent, for a sentence.

    Examples
    --------
    >>> in_words(None), in_words("air")
    ('null', 'air')
    """
    return value if isinstance(value, str) else json.dumps(value, default=str)
