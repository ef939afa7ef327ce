"""The settings that differ between runs, and labels that name only these."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import xarray as xr

from atmosbox import scenarios
from atmosbox.errors import AtmosboxError
from atmosbox.file.provenance import parameters
from atmosbox.scene.conversion import phrase
from atmosbox.scene.settings import Parameter

__all__ = ["Change", "Naming", "naming"]

_MADE_BY = ("engine", "version")
_NOT_SAID = "-"
_MOST_SAID = 2  # greatest number of changes in a label; if there are more, runs are labelled by their files


@dataclass(frozen=True)
class Change:
    """A setting, or another property, that is not the same in all runs.

    Parameters
    ----------
    name : str
        What differs: a setting, ``scene``, ``engine`` or ``version``.
    values : tuple of str
        Its value in each run, with its unit.

    Examples
    --------
    >>> str(Change("temperature", ("5 degC", "25 degC")))
    'temperature 5 degC / 25 degC'
    """

    name: str
    values: tuple[str, ...]

    def __str__(self) -> str:
        """Return the name and all values."""
        return f"{self.name.replace('_', ' ')} {' / '.join(self.values)}"


@dataclass(frozen=True)
class Naming:
    """The labels of several runs, and what differs between the runs.

    Parameters
    ----------
    scenes : tuple of str
        The scene of each run.
    changes : tuple of Change
        What differs; of runs of unlike scenes, the scene alone, because their settings mean different things.
    labels : tuple of str
        A label for each run, all different.
    same : bool
        Whether all runs hold the same numbers.

    Examples
    --------
    >>> Naming(("temperature",) * 2, (Change("seed", ("1", "2")),), ("seed 1", "seed 2"), same=False).title
    'seed 1 / 2'
    """

    scenes: tuple[str, ...]
    changes: tuple[Change, ...]
    labels: tuple[str, ...]
    same: bool

    @property
    def title(self) -> str:
        """What differs, in one line."""
        if len(set(self.scenes)) > 1:
            return "different scenes"
        if self.changes:
            return ", ".join(map(str, self.changes))
        return "the same run" if self.same else "the same settings, different results"


def naming(datasets: Sequence[xr.Dataset], files: Sequence[str]) -> Naming:
    """Return what differs between runs, and a label for each.

    Parameters
    ----------
    datasets : sequence of xarray.Dataset
        The runs.
    files : sequence of str
        Names of their files, which label runs of unlike scenes, and runs where nothing or too much differs.

    Returns
    -------
    Naming
        The labels and changes.

    Raises
    ------
    FileError
        If the parameters of a file cannot be read.

    Examples
    --------
    >>> import json, xarray as xr
    >>> def run(temperature, seed=1):
    ...     made = {"scene": "temperature", "settings": {"temperature": temperature, "seed": seed}, "engine": "exact"}
    ...     return xr.Dataset(attrs={"atmosbox_parameters": json.dumps(made)})
    >>> named = naming([run(5.0), run(25.0)], ["a", "b"])
    >>> named.title, named.labels
    ('temperature 5 degC / 25 degC', ('5 degC', '25 degC'))
    >>> naming([run(5.0), run(25.0, 2)], ["a", "b"]).labels
    ('temperature 5 degC, seed 1', 'temperature 25 degC, seed 2')
    """
    made = [parameters(dataset) for dataset in datasets]
    scenes = tuple(str(each.get("scene", "")) for each in made)
    settings = [each.get("settings") for each in made]
    held: list[Mapping[str, Any]] = [each if isinstance(each, dict) else {} for each in settings]
    if len(set(scenes)) > 1:
        unlike = (Change("scene", scenes),)
        return Naming(scenes, unlike, _labels(unlike, files), same=False)
    known = _parameters(scenes[0])
    names = list(dict.fromkeys(name for each in held for name in each))
    changes = [
        Change(name, tuple(str(each.get(name, _NOT_SAID)) for each in made))
        for name in _MADE_BY
        if len({str(each.get(name, _NOT_SAID)) for each in made}) > 1
    ]
    for name in names:
        values = tuple(_value(each.get(name), known.get(name)) for each in held)
        if len(set(values)) > 1:
            changes.append(Change(name, values))
    same = not changes and all(map(datasets[0].equals, datasets[1:]))
    return Naming(scenes, tuple(changes), _labels(changes, files), same)


def _parameters(scene: str) -> dict[str, Parameter]:
    """Return the settings of a scene that comes with atmosbox; none for a user's own scene, whose file is not run."""
    try:
        if scene not in scenarios.names():
            return {}
        return {parameter.name: parameter for parameter in scenarios.load(scene).Settings.describe()}
    except AtmosboxError:
        return {}


def _value(value: object, parameter: Parameter | None) -> str:
    """Return the value of a setting with its unit."""
    if value is None:
        return _NOT_SAID
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, int | float):
        return phrase(value, parameter.unit if parameter else "1")
    return str(value)


def _labels(changes: Sequence[Change], files: Sequence[str]) -> tuple[str, ...]:
    """Return a label for each run; labels that would be equal are made different by the name of the file."""

    def named(change: Change, run: int) -> str:
        return (
            change.values[run] if change.name == "engine" else f"{change.name.replace('_', ' ')} {change.values[run]}"
        )

    unlike = any(change.name == "scene" for change in changes)
    if unlike or not changes or (len(changes) > _MOST_SAID and len(set(files)) == len(files)):
        made = list(files)
    elif len(changes) == 1 and all(" " in value for value in changes[0].values):  # with a unit that tells what it is
        made = list(changes[0].values)
    else:
        made = [", ".join(named(change, run) for change in changes) for run in range(len(files))]
    alike = [made.count(label) > 1 and label != file for label, file in zip(made, files, strict=True)]
    made = [f"{label} ({file})" if twin else label for label, file, twin in zip(made, files, alike, strict=True)]
    return tuple(
        f"{label} [{made[:k].count(label) + 1}]" if label in made[:k] else label for k, label in enumerate(made)
    )
