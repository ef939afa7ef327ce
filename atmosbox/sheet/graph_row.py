"""The table of a sheet that is done without commands: values that students read off the graphs of a running page."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from atmosbox.file.variables import known, variable
from atmosbox.scene.conversion import from_si, to_si
from atmosbox.scene.panels import Line, Panel
from atmosbox.sheet.sheet_run import Trial
from atmosbox.sheet.sums import bare, spelled
from atmosbox.simulation.preparation import Prepared, build

_TIME = "elapsed_time"
_FRAMES = 20
"""Number of last frames over which a value is averaged, the same as for the gauges of a page."""


def until(prepared: Prepared, said: Callable[[str], str] = str) -> str:
    """Return the sentence that tells how long to let a run play; ``said`` translates it.

    >>> from atmosbox.simulation.preparation import prepare
    >>> until(prepare("temperature", {"molecules": 20}))
    'Let each play to 20 ns, and pause.'
    """
    setup = build(prepared)
    if setup.ends:
        return said("Let each play until it stops.")
    time = setup.duration * setup.scale.time / to_si(1.0, setup.time_unit)
    return said("Let each play to {}, and pause.").format(f"{float(f'{time:.3g}'):g} {setup.time_unit}")


def graph_rows(runs: Sequence[Trial], said: Callable[[str], str] = str) -> list[dict[str, Any]]:
    """Return the rows of the table: for each measured curve its graph, its name, and a line for each run that has it.

    A line has the letter of the run and, if it has been made, the value from the graph, that of theory, and the
    difference. ``said`` translates names.
    """
    found = []
    shown = [{(line.x, line.y, line.label) for panel in _panels(run) for line in panel.lines} for run in runs]
    for panel in _panels(runs[0]):
        for line in panel.lines if panel.kind in ("line", "profile", "histogram") else ():
            if line.role != "data" or known(line.y) is None:
                continue
            name, unit = (line.x, panel.x_unit) if panel.kind == "profile" else (line.y, panel.y_unit)
            unit = spelled(unit or variable(name).units or "1")
            curve = f"{said(line.label)}, {said(_where(panel, line))}{f' [{unit}]' if unit else ''}"
            theory = _theory(panel, line)
            those = [run for run, curves in zip(runs, shown, strict=True) if (line.x, line.y, line.label) in curves]
            lines = [tuple(map(said, _line(run, panel, line, theory))) for run in those]
            found.append({"graph": said(panel.title), "curve": curve, "lines": lines})
    return found


def _panels(run: Trial) -> Sequence[Panel]:
    """Return the panels of the page of a run."""
    panels = run.prepared.module.panels
    found: Sequence[Panel] = panels(run.prepared.settings) if callable(panels) else panels
    return found


def _where(panel: Panel, line: Line) -> str:
    """Return the phrase that tells where a curve is read."""
    if panel.kind == "line" and line.x == _TIME:
        return "at the end"
    if panel.kind == "histogram":
        return "at its peak"
    if line.y == "height":
        return "at half the height"
    return "at the top" if panel.kind == "profile" else "in the middle"


def _theory(panel: Panel, line: Line) -> str | None:
    """Return the variable of the theory that belongs to a curve; None if there is no such theory."""
    name = line.x if panel.kind == "profile" else line.y
    told = [each.x if panel.kind == "profile" else each.y for each in panel.lines if each.role == "theory"]
    data = {each.x if panel.kind == "profile" else each.y for each in panel.lines if each.role == "data"}
    if f"{name}_theory" in told:
        return f"{name}_theory"
    alone = len(told) == 1 and told[0].removesuffix("_theory") not in data
    return told[0] if alone or (told and len(data) == 1) else None


def _line(run: Trial, panel: Panel, line: Line, theory: str | None) -> tuple[str, str, str, str]:
    """Return the line of a run for a curve: letter, measured value, theory, difference."""
    blank = "" if theory else "–"
    in_time = panel.kind == "line" and line.x == _TIME
    measured, told = (_last(run, panel, name) if in_time and name else None for name in (line.y, theory))
    if measured is None:
        return run.letter, "see the graph" if run.outcome else "", blank, blank
    if told is None:
        return run.letter, bare(measured), "–", "–"
    return run.letter, bare(measured), bare(told), bare(measured - told, 2)


def _last(run: Trial, panel: Panel, name: str) -> float | None:
    """Return the mean of a series over its last frames, in the unit of its graph; None if there is none."""
    dataset = run.outcome.dataset if run.outcome is not None else {}
    if name not in dataset:
        return None
    values = np.asarray(dataset[name].values[-_FRAMES:], np.float64)
    values = values[np.isfinite(values)]
    unit = panel.y_unit or dataset[name].attrs.get("units", "1")
    return float(from_si(float(values.mean()), unit)) if values.size else None
