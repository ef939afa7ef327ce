"""What differs between runs: their settings, with a label for each run, and their headline numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import xarray as xr

from atmosbox import scenarios
from atmosbox.errors import AtmosboxError, UnitError
from atmosbox.file.provenance import parameters
from atmosbox.plot.caption import stated
from atmosbox.scene.conversion import from_si, phrase
from atmosbox.scene.settings import Parameter

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
    held = [each["settings"] if isinstance(each.get("settings"), dict) else {} for each in made]
    if len(set(scenes)) > 1:
        unlike = (Change("scene", scenes),)
        return Naming(scenes, unlike, _labels(unlike, files), same=False)
    known = _parameters(scenes[0])
    told = [{name: each.get(name) for name in _MADE_BY} | rest for each, rest in zip(made, held, strict=True)]
    changes = []
    for name in dict.fromkeys(name for each in told for name in each):
        values = tuple(_value(each.get(name), known.get(name)) for each in told)
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
    unlike = any(change.name == "scene" for change in changes)
    if unlike or not changes or (len(changes) > _MOST_SAID and len(set(files)) == len(files)):
        made = list(files)
    elif len(changes) == 1 and all(" " in value for value in changes[0].values):  # with a unit that tells what it is
        made = list(changes[0].values)
    else:
        said = ["" if change.name == "engine" else f"{change.name.replace('_', ' ')} " for change in changes]
        values = zip(*(change.values for change in changes), strict=True)
        made = [", ".join(map("".join, zip(said, each, strict=True))) for each in values]
    alike = [made.count(label) > 1 and label != file for label, file in zip(made, files, strict=True)]
    made = [f"{label} ({file})" if twin else label for label, file, twin in zip(made, files, alike, strict=True)]
    return tuple(
        f"{label} [{made[:k].count(label) + 1}]" if label in made[:k] else label for k, label in enumerate(made)
    )


@dataclass(frozen=True)
class Measured:
    """A headline number of one run.

    Parameters
    ----------
    value, error : float
        The measurement and its standard error [unit]; NaN where the run has none.
    theory : float
        The value of the textbook [unit]; NaN where there is none.

    Examples
    --------
    >>> Measured(15.0, 0.3, math.nan).value
    15.0
    """

    value: float
    error: float
    theory: float


@dataclass(frozen=True)
class Compared:
    """A headline number of several runs.

    Parameters
    ----------
    name, label : str
        Its name in the file, and its name in a table.
    unit : str
        The unit of all numbers; differences of numbers in degC are in K.
    runs : tuple of Measured
        The number of each run.

    Examples
    --------
    The second run is 20 K warmer; the standard error is 0.5 K, so the difference is 40 standard errors:

    >>> warm = Compared("t", "temperature", "degC", (Measured(5.0, 0.3, 5.1), Measured(25.0, 0.4, 24.9)))
    >>> warm.difference(1), warm.error(1), warm.sigma(1)
    (20.0, 0.5, 40.0)
    """

    name: str
    label: str
    unit: str
    runs: tuple[Measured, ...]

    def difference(self, run: int) -> float:
        """Return the number of a run minus that of the first run."""
        return self.runs[run].value - self.runs[0].value

    def error(self, run: int) -> float:
        """Return the standard error of the difference, for runs that are statistically independent."""
        return math.hypot(self.runs[run].error, self.runs[0].error)

    def sigma(self, run: int) -> float:
        """Return the difference in units of its standard error; NaN where that is not known."""
        error = self.error(run)
        return self.difference(run) / error if error > 0.0 else math.nan

    def expected(self, run: int) -> float:
        """Return the difference between the theories of a run and of the first; NaN where there is no theory."""
        return self.runs[run].theory - self.runs[0].theory


def compared(datasets: Sequence[xr.Dataset]) -> tuple[Compared, ...]:
    """Return the headline numbers that at least two runs have measured.

    Parameters
    ----------
    datasets : sequence of xarray.Dataset
        The runs.

    Returns
    -------
    tuple of Compared
        The numbers, in the units in which tables show them.

    Raises
    ------
    FileError
        If the attribute ``atmosbox_headlines`` of a file cannot be read.

    Examples
    --------
    >>> import xarray as xr
    >>> def run(value):
    ...     numbers = {"t": ((), value, {"units": "K", "display_units": "degC"}), "t_se": 0.5}
    ...     return xr.Dataset(numbers, attrs={"atmosbox_headlines": '["t"]'})
    >>> (found,) = compared([run(278.15), run(298.15)])
    >>> found.unit, found.difference(1)
    ('degC', 20.0)
    """
    named = [name for dataset in datasets for name in stated(dataset, "atmosbox_headlines", list)]
    found = [_compared(datasets, name) for name in dict.fromkeys(map(str, named))]
    return tuple(each for each in found if sum(math.isfinite(run.value) for run in each.runs) > 1)


def _compared(datasets: Sequence[xr.Dataset], name: str) -> Compared:
    """Return one headline number of all runs, in the unit of the first run that has it."""
    attrs = next((dataset[name].attrs for dataset in datasets if name in dataset.variables), {})
    unit = str(attrs.get("display_units", attrs.get("units", "1")))
    label = str(attrs.get("long_name", name.replace("_", " ")))
    return Compared(name, label, unit, tuple(_measured(dataset, name, unit) for dataset in datasets))


def _measured(dataset: xr.Dataset, name: str, unit: str) -> Measured:
    def shown(part: str, *, difference: bool = False) -> float:
        if part not in dataset.variables:
            return math.nan
        try:
            return from_si(float(dataset[part].values), unit, difference=difference)
        except UnitError:
            return math.nan

    return Measured(shown(name), shown(f"{name}_se", difference=True), shown(f"{name}_theory"))
