"""Comparison of runs: the settings that differ, the differences of their headline numbers, and one figure."""

import math
import os
import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from atmosbox import scenarios
from atmosbox.errors import AtmosboxError, FileError, SettingError, UnitError
from atmosbox.file.provenance import parameters
from atmosbox.plot.caption import footer, stated
from atmosbox.plot.curve import Curve, curve, spelled, unit_of
from atmosbox.plot.draw import Entry, draw_line, draw_steps, line_style
from atmosbox.plot.figure_file import write
from atmosbox.plot.layout import page
from atmosbox.plot.run_figure import explanation, holds, painter, panels_of
from atmosbox.plot.theme import DARK, DATA_COLOURS, DATA_DASHES, Theme, find
from atmosbox.scene.conversion import from_si, phrase
from atmosbox.scene.panels import ROLES, Line, Panel
from atmosbox.scene.settings import Parameter

__all__ = ["Change", "Compared", "Measured", "Naming", "compared", "naming", "save"]

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
    """
    made = [parameters(dataset) for dataset in datasets]
    scenes = tuple(str(each.get("scene", "")) for each in made)
    held = [each["settings"] if isinstance(each.get("settings"), dict) else {} for each in made]
    if len(set(scenes)) > 1:
        unlike = (Change("scene", scenes),)
        return Naming(scenes, unlike, _labels(unlike, files), same=False)
    known = _parameters(scenes[0])
    told = [{name: each.get(name) for name in _MADE_BY} | rest for each, rest in zip(made, held, strict=True)]
    names = dict.fromkeys(name for each in told for name in each)
    every = [Change(name, tuple(_value(each.get(name), known.get(name)) for each in told)) for name in names]
    changes = [change for change in every if len(set(change.values)) > 1]
    same = not changes and all(map(datasets[0].equals, datasets[1:]))
    return Naming(scenes, tuple(changes), _labels(changes, files), same)


def _parameters(scene: str) -> dict[str, Parameter]:
    """Return the settings of a scene that comes with atmosbox; none for a user's own scene, whose file is not run."""
    with suppress(AtmosboxError):
        if scene in scenarios.names():
            return {parameter.name: parameter for parameter in scenarios.load(scene).Settings.describe()}
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
    """Return the headline numbers that at least two runs have measured, in the units in which tables show them.

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
        with suppress(UnitError):
            if part in dataset.variables:
                return from_si(float(dataset[part].values), unit, difference=difference)
        return math.nan

    return Measured(shown(name), shown(f"{name}_se", difference=True), shown(f"{name}_theory"))


MOST = len(DATA_COLOURS)
"""Greatest number of runs in one figure."""

_SAME = 2e-3  # calculated curves that differ by no more than this share of their range are drawn once
_DARKER = 0.6  # factor on the colour of a run, for the curves that are calculated for it


def figure(datasets: Sequence[xr.Dataset], labels: Sequence[str], title: str, theme: str = "notes") -> Figure:
    """Draw several runs into one figure, with the panels that they share and a label for each run in the legend."""
    look, panels = find(theme), shared_panels(datasets)
    draw = painter(datasets, look, partial(_draw_lines, datasets, labels))
    return page(panels, look, datasets[0], draw, [], _small(datasets) + explanation(datasets[0], panels), heading=title)


def shared_panels(datasets: Sequence[xr.Dataset]) -> tuple[Panel, ...]:
    """Return the panels of the first run that show a measured curve that all other runs have, too."""
    first = datasets[0]
    found = []
    for panel in panels_of(first):
        measured = [line.variables for line in panel.lines if line.role == "data"]
        if panel.kind == "atmosphere" or not any(all(holds(each, names) for each in datasets) for names in measured):
            continue
        if panel.kind != "skewt":  # all runs are drawn in the same units
            x_unit, y_unit = (getattr(panel, f"{axis}_unit") or unit_of(first, panel, axis) for axis in "xy")
            panel = replace(panel, x_unit=x_unit, y_unit=y_unit)
        found.append(panel)
    if not found:
        raise FileError("These runs have no graph in common: compare runs of one scene.")
    return tuple(found)


def _small(datasets: Sequence[xr.Dataset]) -> str:
    """Return one footer for all runs, in which parts that differ are written side by side."""
    parts = [footer(dataset).split(" · ") for dataset in datasets]
    if len({len(part) for part in parts}) > 1:
        return "; ".join(dict.fromkeys(" · ".join(part) for part in parts))
    return " · ".join(" / ".join(dict.fromkeys(same)) for same in zip(*parts, strict=True))


def _draw_lines(
    datasets: Sequence[xr.Dataset], names: Sequence[str], axes: Axes, panel: Panel, look: Theme
) -> list[Entry]:
    """Draw the curves of all runs, and return the legend entries.

    Of a measured curve, colour and marker show the run, dashes show the curve. A calculated curve is drawn once if all
    runs have the same, else once for each run in a darker colour; if the scenes of the runs call it differently, as the
    dry and the moist adiabat, each has its own entry.
    """
    entries: list[Entry] = []
    for role in ROLES:
        lines = [line for line in panel.lines if line.role == role]
        for index, line in enumerate(lines):
            curves = {k: curve(each, panel, line) for k, each in enumerate(datasets) if holds(each, line.variables)}
            called = {k: _called(datasets[k], panel, line) for k in curves}
            alike, laws = len(set(called.values())) < 2, [*curves.values()]
            if role != "data" and alike and all(_same(laws[0], other, panel) for other in laws[1:]):
                entries += [(draw_line(axes, panel, line, each, look, index), line.label) for each in laws[:1]]
                continue
            several = replace(panel, lines=(line, line))  # which gives the curve markers
            for run, values in curves.items():
                colour, dashes = DATA_COLOURS[run], DATA_DASHES[(run * (panel.kind == "histogram") + index) % 3]
                if role != "data":
                    dark = tuple(_DARKER * part for part in to_rgb(colour))
                    drawn = draw_line(axes, panel, line, values, look, index, color=dark)
                elif panel.kind == "histogram":
                    drawn = draw_steps(axes, panel, line, datasets[run], look, run, color=colour, linestyle=dashes)
                else:
                    mark = run + index * len(datasets)
                    drawn = draw_line(axes, several, line, values, look, mark, color=colour, linestyle=dashes)
                label = names[run] if role == "data" and len(lines) == 1 else f"{called[run]}, {names[run]}"
                if role == "data" or not alike:
                    entries.append((drawn, label))
            if role != "data" and curves and alike:
                grey = Line2D([], [], **line_style(role, look, index) | {"color": DARK})
                entries.append(((grey,), line.label))
    return entries


def _called(dataset: xr.Dataset, panel: Panel, line: Line) -> str:
    """Return the label that the panels of a run give to the variable of a line, by default that of the line."""

    def measured(which: Panel, each: Line) -> str:
        return each.x if which.measured_across else each.y

    names = (
        each.label
        for own in panels_of(dataset)
        for each in own.lines
        if each.role == line.role and measured(own, each) == measured(panel, line)
    )
    return next(names, line.label)


def _same(one: Curve, other: Curve, panel: Panel) -> bool:
    """Tell whether two curves follow the same law, even if their points are at different places."""
    columns = []
    for x, y, _ in (one, other):
        pairs = np.array([y, x] if panel.measured_across else [x, y])
        pairs = pairs[:, np.isfinite(pairs).all(axis=0)]
        columns.append(pairs[:, np.argsort(pairs[0], kind="stable")])
    (x, y), (u, v) = columns
    if not x.size or not u.size:
        return bool(x.size == u.size)
    apart = np.abs(v - np.interp(u, x, y, left=np.nan, right=np.nan))
    inside, scale = np.isfinite(apart), max(float(np.ptp(y)), 1e-6 * float(np.abs(y).max()), 1e-290)
    return bool(inside.sum() >= 0.5 * u.size and apart[inside].max() <= _SAME * scale)


def save(
    datasets: Sequence[xr.Dataset],
    names: Naming,
    path: str | os.PathLike[str],
    format: str | None = None,
    *,
    theme: str = "notes",
    force: bool = False,
) -> Path:
    """Draw several runs into one figure, and write it.

    Parameters
    ----------
    datasets : sequence of xarray.Dataset
        The runs, two to six.
    names : Naming
        The labels of the runs, and the settings that differ.
    path : str or path-like
        The file; its suffix gives the format unless ``format`` does.
    format : {"png", "svg", "pdf"}, optional
        The format, by default that of the suffix.
    theme : {"notes", "slides"}
        A figure for a page, or one for a screen.
    force : bool
        Whether a file of that name may be replaced.

    Returns
    -------
    pathlib.Path
        The file that was written.

    Raises
    ------
    FileError
        If the file exists, cannot be written, or the runs have no graph in common.
    SettingError
        If there are fewer than two or more than six runs, or the format or the theme is unknown.
    """
    if not 2 <= len(datasets) <= MOST:
        raise SettingError("FILE", None, f"is given {len(datasets)} times", "give two to six runs")
    drawing = partial(drawn, datasets, names, theme)
    return write(drawing, datasets, heading(names), path, format, theme=theme, force=force)


def drawn(datasets: Sequence[xr.Dataset], names: Naming, theme: str) -> Figure:
    """Return the figure of several runs."""
    return figure(datasets, [spoken(label) for label in names.labels], heading(names), theme)


def heading(names: Naming) -> str:
    """Return the heading of the figure of several runs: their scenes, and what differs between the runs."""
    return spoken(f"{' and '.join(dict.fromkeys(names.scenes))}: {names.title}")


def spoken(text: str) -> str:
    """Return a text in which units are spelled as they are printed."""
    return re.sub(r"(?<=\d )\w+", lambda word: spelled(word[0]), text)
