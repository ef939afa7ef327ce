"""What a scene offers a class: its story, a question to predict, a task, and named settings to try.

They are read from a file beside the scene, ``my_scene.live.toml``, which contains data only and no code. ::

    story = "Air that rises expands and cools. By how much does not depend on where it began."

    [predict]
    ask = "Lifted to half the pressure, air of 15 degC cools by ..."
    choices = ["5 K", "50 K"]
    right = 2
    why = "T ~ p^(2/7): 50 K."
    draw = {parcel_temperature = ["-90 degC", "30 degC"]}

    [task]
    ask = "Keep the parcel at 700 hPa."
    hint = "It is at 3 km."
    reach = {parcel_pressure = ["700 hPa", "10 hPa"]}
    frames = 8

    [[preset]]
    title = "Polar night"
    set = {temperature = "-40 degC"}

A task is done when in both halves of so many frames the mean of each variable is within the given distance of its
value: what only passes the value is not there. What a class may draw as its prediction is the first variable of
``draw``, at first in this range; a second one is what it is drawn along, as elapsed_time = ["0 ns", "2 ns"]. A preset
begins the box again with its settings, and those of the page for the rest.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from atmosbox.errors import ConfigError, FileError
from atmosbox.file.variables import variable
from atmosbox.scene.conversion import converted, from_si, number_and_unit

SUFFIX = ".live.toml"
_KNOWN: dict[str, tuple[set[str], set[str]]] = {
    "preset": ({"title", "set"}, set()),
    "predict": ({"ask", "choices", "right", "why"}, {"draw"}),
    "task": ({"ask", "hint", "reach", "frames"}, set()),
}
"""What the entries of each kind have, and what they may have besides."""


@dataclass(frozen=True)
class Preset:
    """Settings with a name: ``values`` that differ from the defaults of the scene."""

    title: str
    values: Mapping[str, Any]


@dataclass(frozen=True)
class Lesson:
    """What a scene offers a class, as data for the page.

    ``predict`` is the question with its choices and the ranges of ``draw`` in SI, ``task`` has the values to reach and
    their tolerances.
    """

    story: str = ""
    predict: Mapping[str, Any] | None = None
    task: Mapping[str, Any] | None = None
    presets: tuple[Preset, ...] = ()


def lesson_of(module: ModuleType) -> Lesson:
    """Return the lesson of a scene; an empty one if there is no such file beside the scene."""
    path = Path(str(getattr(module, "__file__", ""))).with_suffix(SUFFIX)
    if not path.is_file():
        return Lesson()
    try:
        told = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise FileError(f"{path} cannot be read: {error.strerror}.") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path} is not TOML ({error}): correct it and try again.") from error
    unknown = sorted(set(told) - {"story", *_KNOWN})
    if unknown:
        raise ConfigError(f"{path}: {unknown[0]} is unknown: give story, predict, task or preset.")
    presets = [
        Preset(str(each["title"]), dict(each["set"])) for each in _entries(path, told.get("preset", []), "preset")
    ]
    questions, tasks = (_entries(path, [told[name]] if name in told else [], name) for name in ("predict", "task"))
    for each in questions:
        if not 1 <= each["right"] <= len(each["choices"]):
            raise ConfigError(
                f"{path}: right of predict must be the number of a choice, from 1 to {len(each['choices'])}."
            )
        if "draw" in each:
            if not isinstance(each["draw"], dict) or len(each["draw"]) not in (1, 2):
                raise ConfigError(f"{path}: draw of predict must have a variable, and at most what it is drawn along.")
            each["draw"] = {name: _quantities(path, name, ends, "a prediction") for name, ends in each["draw"].items()}
    return Lesson(
        str(told.get("story", "")).strip(),
        next(iter(questions), None),
        next((_task(path, each) for each in tasks), None),
        tuple(presets),
    )


def _entries(path: Path, entries: Any, kind: str) -> list[dict[str, Any]]:
    """Return the entries of a kind; refuse one that lacks something or has something else."""
    must, may = _KNOWN[kind]
    for number, entry in enumerate(entries if isinstance(entries, list) else [None], 1):
        if not isinstance(entry, dict) or not must <= set(entry) <= must | may:
            wanted = ", ".join([*sorted(must), *(f"may have {name}" for name in may)])
            raise ConfigError(f"{path}: {kind} {number} must have {wanted}, and nothing else.")
    return list(entries)


def _task(path: Path, entry: Mapping[str, Any]) -> dict[str, Any]:
    """Return a task, with its values in SI and the conversion to the units in which they were given."""
    goals = []
    for name, wanted in entry["reach"].items():
        target, within = _quantities(path, name, wanted, "a task")
        _, unit = number_and_unit(wanted[0])
        zero = from_si(0.0, unit) if unit else 0.0
        way = {"unit": unit, "factor": from_si(1.0, unit) - zero if unit else 1.0, "offset": zero}
        goals.append({"name": name, "target": target, "within": within, **way})
    return {**entry, "reach": goals}


def _quantities(path: Path, name: str, wanted: Any, whose: str) -> tuple[float, float]:
    """Return two values of a variable in its unit; those without a unit are counts or shares."""
    try:
        units = variable(name).units or "1"
        first, last = (
            converted(float(number), unit, units) if unit else float(number)
            for number, unit in map(number_and_unit, wanted)
        )
    except (KeyError, TypeError, ValueError) as error:
        raise ConfigError(
            f"{path}: {name} of {whose} cannot be read ({error}): "
            'give a variable of the file, and two quantities as in ["300 hPa", "3 hPa"].'
        ) from error
    return first, last
