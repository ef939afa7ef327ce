"""Several runs in one figure, as a file: the curves of all runs, which differ by colour and by a second cue."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from atmosbox.errors import FileError, SettingError
from atmosbox.plot.caption import footer
from atmosbox.plot.compare.difference import Naming
from atmosbox.plot.curve import Curve, curve, unit_of
from atmosbox.plot.draw import Entry, draw_line, draw_steps, line_style
from atmosbox.plot.figure_file import write
from atmosbox.plot.layout import page
from atmosbox.plot.run_figure import explanation, holds, painter, panels_of
from atmosbox.plot.theme import DARK, DATA_COLOURS, DATA_DASHES, Theme, find
from atmosbox.plot.units import spelled
from atmosbox.scene.panels import ROLES, Line, Panel

MOST = len(DATA_COLOURS)
"""Greatest number of runs in one figure."""

_SAME = 2e-3  # calculated curves that differ by no more than this share of their range are drawn once
_DARKER = 0.6  # factor on the colour of a run, for the curves that are calculated for it


def figure(datasets: Sequence[xr.Dataset], labels: Sequence[str], title: str, theme: str = "notes") -> Figure:
    """Draw several runs into one figure.

    Parameters
    ----------
    datasets : sequence of xarray.Dataset
        The runs; the panels are those of the first.
    labels : sequence of str
        The label of each run in the legend.
    title : str
        The heading above the panels.
    theme : {"notes", "slides"}
        A figure for a page, or one for a screen.

    Returns
    -------
    matplotlib.figure.Figure
        The figure.

    Raises
    ------
    FileError
        If the runs have no panel in common.

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.scene.panels import to_json
    >>> air = Panel("line", "Temperature", (Line("elapsed_time", "t", "air"),), "time", "temperature")
    >>> runs = [
    ...     xr.Dataset(
    ...         {"t": ("elapsed_time", [288.0 + k, 290.0 + k], {"units": "K"})},
    ...         coords={"elapsed_time": ("elapsed_time", [0.0, 1.0], {"units": "ns"})},
    ...         attrs={"atmosbox_panels": to_json([air])},
    ...     )
    ...     for k in (0, 5)
    ... ]
    >>> [text.get_text() for text in figure(runs, ["cold", "warm"], "Two").axes[0].get_legend().get_texts()]
    ['cold', 'warm']
    """
    look, panels = find(theme), shared_panels(datasets)
    draw = painter(datasets, look, partial(_draw_lines, datasets, labels))
    return page(panels, look, datasets[0], draw, [], _small(datasets) + explanation(datasets[0], panels), title)


def shared_panels(datasets: Sequence[xr.Dataset]) -> tuple[Panel, ...]:
    """Return the panels of the first run that show a measured curve that all other runs have, too.

    Parameters
    ----------
    datasets : sequence of xarray.Dataset
        The runs.

    Returns
    -------
    tuple of Panel
        The panels, with their units filled in.

    Raises
    ------
    FileError
        If there is no such panel.

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.scene.panels import to_json
    >>> shared_panels([xr.Dataset(attrs={"atmosbox_panels": to_json([Panel("discs", "A box")])})])
    Traceback (most recent call last):
    atmosbox.errors.FileError: These runs have no graph in common: compare runs of one scene.
    """
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
) -> tuple[list[Entry], int]:
    """Draw the curves of all runs; return the legend entries and the number of values of the longest curve.

    Of a measured curve, colour and marker show the run, dashes show the curve. A calculated curve is drawn once if all
    runs have the same, else once for each run in a darker colour; if the scenes of the runs call it differently, as the
    dry and the moist adiabat, each has its own entry.
    """
    entries: list[Entry] = []
    most = 0
    for role in ROLES:
        lines = [line for line in panel.lines if line.role == role]
        for index, line in enumerate(lines):
            curves = {k: curve(each, panel, line) for k, each in enumerate(datasets) if holds(each, line.variables)}
            most = max([most, *(each.x.size for each in curves.values())])
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
    return entries, most


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
    """Draw several runs into one figure.

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

    Examples
    --------
    >>> save([], Naming((), (), (), same=False), "both.png")
    Traceback (most recent call last):
    atmosbox.errors.SettingError: FILE is given 0 times: give two to six runs.
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
    """Return a text in which units are spelled as they are printed.

    Examples
    --------
    >>> spoken("temperature 5 degC / 25 degC")
    'temperature 5 °C / 25 °C'
    """
    return re.sub(r"(?<=\d )\w+", lambda word: spelled(word[0]), text)
