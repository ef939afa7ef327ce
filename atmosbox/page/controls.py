"""Beside a box that runs: its thermometer, barometer and hygrometer, its knobs and its settings."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from atmosbox.scene.knob import Knob
from atmosbox.scene.settings import Parameter, Value

if TYPE_CHECKING:
    from atmosbox.scene import SceneSettings

_FEW = 50
"""Smallest number of molecules of saturated vapour for a hygrometer; with fewer it scatters by more than a seventh."""
_GAUGES = (
    ("thermometer", ("parcel_temperature", "air_temperature", "gas_temperature"), "°C", 1.0, -273.15),
    ("barometer", ("parcel_pressure", "air_pressure"), "hPa", 0.01, 0.0),
    ("hygrometer", ("relative_humidity",), "%", 100.0, 0.0),
)
"""For each gauge its name, the variables that it can show, best first, and their unit, factor and offset from SI."""


def gauges(settings: SceneSettings, measured: Collection[str]) -> list[dict[str, Any]]:
    """Return the gauges for the measured variables; a scene that sets its temperature in kelvin shows kelvin."""
    kelvin = ("temperature", "K") in {(each.name, each.unit) for each in type(settings).describe()}
    found = []
    for name, variables, unit, factor, offset in _GAUGES:
        if (shown := next((each for each in variables if each in measured), None)) is None:
            continue
        gauge: dict[str, Any] = {"name": name, "variable": shown, "unit": unit, "factor": factor, "offset": offset}
        if name == "thermometer" and kelvin:
            gauge |= {"unit": "K", "offset": 0.0}
        if name == "hygrometer":
            gauge["few"] = ["vapor_molecule_count", _FEW]
        found.append(gauge)
    return found


_MOST_MOLECULES = 50_000
_STEPS = 200


def knob_controls(knobs: Iterable[Knob]) -> list[dict[str, Any]]:
    """Return the sliders of knobs, as data for the page."""
    given = [(Parameter(k.name, k.unit, k.value, k.low, k.high, None, k.help, "float"), k.value) for k in knobs]
    return [control(told, value, restarts=False) for told, value in given]


def setting_controls(
    parameters: Iterable[Parameter], values: Mapping[str, Value], without: Iterable[str]
) -> list[dict[str, Any]]:
    """Return sliders, switches and choices for settings, without free texts and those named in ``without``."""
    left_out = set(without)
    return [
        control(told, values[told.name], restarts=True)
        for told in parameters
        if told.name not in left_out and (told.kind != "str" or told.choices)
    ]


def control(told: Parameter, value: Value, *, restarts: bool) -> dict[str, Any]:
    """Return one control as data for the page."""
    kind = {"bool": "switch", "str": "choice"}.get(told.kind, "number")
    made: dict[str, Any] = {
        "name": told.name,
        "label": told.help,
        "unit": told.unit,
        "kind": kind,
        "value": value,
        "restarts": restarts,
        "help": f"{told.name}: {told.allowed}",
    }
    if kind == "choice":
        made["choices"] = list(told.choices or ())
    if kind == "number":
        high = told.high
        if told.name == "molecules":
            most = max(_MOST_MOLECULES, int(value))
            high = most if high is None else min(most, high)
        made |= {"low": told.low, "high": high, "step": _step(told)}
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
