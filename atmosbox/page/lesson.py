"""What a scene offers a class besides its knobs: named settings to try, and challenges.

They are read from a file beside the scene, ``my_scene.live.toml``, which contains data only and no code. ::

    [[preset]]
    title = "Polar night"
    set = {temperature = "-40 degC"}

    [[challenge]]
    ask = "Reach 300 hPa at -48 degC. Which start does that need?"
    hint = "A dry parcel cools as T ~ p^(2/7)."
    reach = {parcel_pressure = ["300 hPa", "4 hPa"], parcel_temperature = ["-48 degC", "1.5 K"]}

A preset begins the box again with its settings, and those of the page for the rest. A challenge is met when each
variable is within the given distance of its value.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from atmosbox.errors import ConfigError, FileError
from atmosbox.file.variables import variable
from atmosbox.scene.conversion import converted, from_si, number_and_unit

__all__ = ["Lesson", "Preset", "lesson_of"]

SUFFIX = ".live.toml"
_KNOWN = {"preset": {"title", "set"}, "challenge": {"ask", "hint", "reach"}}


@dataclass(frozen=True)
class Preset:
    """Settings with a name.

    Parameters
    ----------
    title
        Their name.
    values
        The settings that differ from the defaults of the scene.
    """

    title: str
    values: Mapping[str, Any]


@dataclass(frozen=True)
class Lesson:
    """What a scene offers a class.

    Parameters
    ----------
    presets
        Settings to try.
    challenges
        As data for the page: the question, a hint, and the values to reach with their tolerances.
    """

    presets: tuple[Preset, ...] = ()
    challenges: tuple[dict[str, Any], ...] = ()


def lesson_of(module: ModuleType) -> Lesson:
    """Return the lesson of a scene; an empty one if there is no such file beside the scene.

    Parameters
    ----------
    module
        The scene, from `atmosbox.scenarios.load`.

    Raises
    ------
    FileError
        If the file cannot be read.
    ConfigError
        If it is not TOML, or contains something that a lesson must not.

    Examples
    --------
    >>> from atmosbox import scenarios
    >>> len(lesson_of(scenarios.load("lifting-dry")).challenges)
    2
    """
    path = Path(str(getattr(module, "__file__", ""))).with_suffix(SUFFIX)
    if not path.is_file():
        return Lesson()
    try:
        told = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise FileError(f"What a class may try cannot be read from {path}: {error.strerror}.") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path} is not TOML ({error}): correct it and try again.") from error
    unknown = sorted(set(told) - set(_KNOWN))
    if unknown:
        raise ConfigError(f"{path}: {unknown[0]} is unknown: give preset or challenge.")
    presets = [Preset(str(each["title"]), dict(each["set"])) for each in _entries(path, told, "preset")]
    return Lesson(tuple(presets), tuple(_challenge(path, each) for each in _entries(path, told, "challenge")))


def _entries(path: Path, told: Mapping[str, Any], kind: str) -> list[dict[str, Any]]:
    """Return the entries of a kind; refuse one that lacks something or has something else."""
    entries = told.get(kind, [])
    for number, entry in enumerate(entries if isinstance(entries, list) else [None], 1):
        if not isinstance(entry, dict) or set(entry) != _KNOWN[kind]:
            wanted = ", ".join(sorted(_KNOWN[kind]))
            raise ConfigError(f"{path}: {kind} {number} must have {wanted}, and nothing else: write [[{kind}]].")
    return list(entries)


def _challenge(path: Path, entry: Mapping[str, Any]) -> dict[str, Any]:
    """Return a challenge, with its values in SI and the conversion to the units in which they were given."""
    goals = []
    for name, wanted in entry["reach"].items():
        try:
            units = variable(name).units or "1"
            (value, unit), (width, of_width) = (number_and_unit(each) for each in wanted)
            target, within = converted(float(value), unit, units), converted(float(width), of_width, units)
        except (KeyError, TypeError, ValueError) as error:
            raise ConfigError(
                f"{path}: {name} of a challenge cannot be read ({error}): "
                'give a variable of the file, and two quantities as in ["300 hPa", "3 hPa"].'
            ) from error
        zero = from_si(0.0, unit)
        way = {"unit": unit, "factor": from_si(1.0, unit) - zero, "offset": zero}
        goals.append({"name": name, "target": target, "within": within, **way})
    return {"ask": str(entry["ask"]), "hint": str(entry["hint"]), "reach": goals}
