"""The graphs of a scene as data for the page: their variables, and the conversion from SI to the units shown."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from atmosbox.file.variables import known
from atmosbox.scene.panels import ATMOSPHERE_VARIABLES, Line, Panel


class Meaning(NamedTuple):
    """The meaning of a variable: its unit in the file, and its description."""

    unit: str
    words: str


def declared(name: str, time_unit: str = "ns") -> Meaning:
    """Return the meaning of a variable from its declaration; for an undeclared name "1" and the name itself.

    "heat_from_wall[z_low]" is the part of ``heat_from_wall`` at a label.

    Examples
    --------
    >>> declared("air_pressure"), declared("elapsed_time", "ps").unit
    (Meaning(unit='Pa', words='pressure of the air on the walls'), 'ps')
    """
    name = name.partition("[")[0]
    if name == "elapsed_time":
        return Meaning(time_unit, "time")
    found = known(name)
    return Meaning("1", name.replace("_", " ")) if found is None else Meaning(found.units or "1", found.long_name)


def names(panels: Iterable[Panel]) -> tuple[str, ...]:
    """Return the variables that the graphs of the page need, each once, in order; the kind ``discs`` needs none.

    Examples
    --------
    >>> names([Panel("line", "Air", (Line("elapsed_time", "air_pressure", "walls"),)), Panel("discs", "The box")])
    ('elapsed_time', 'air_pressure')
    """
    graphs = [panel for panel in panels if panel.kind != "discs"]
    wanted = [name for panel in graphs for name in panel.variables]
    if any(panel.kind == "atmosphere" for panel in graphs):
        wanted += ATMOSPHERE_VARIABLES
    return tuple(dict.fromkeys(wanted))


def panel_record(
    panel: Panel,
    meaning: Callable[[str], Meaning],
    *,
    sentences: Sequence[str] = (),
    marks: dict[str, float] | None = None,
) -> dict[str, Any]:
    """Return a panel as data for the page.

    A value of a line is shown as ``value * factor + offset``. ``meaning`` returns the `Meaning` of a variable,
    ``sentences`` are the headline numbers of the panel, and ``marks`` pressures that a skew-T marks [hPa].

    Raises
    ------
    FileError
        If the unit of a variable cannot be converted to that of the panel.

    Examples
    --------
    >>> air = Line("elapsed_time", "air_temperature", "air")
    >>> record = panel_record(Panel("line", "Temperature", (air,), y_unit="degC"), declared)
    >>> record["y"]["unit"], record["lines"][0]["y"]
    ('°C', {'name': 'air_temperature', 'factor': 1.0, 'offset': -273.15})
    """
    from atmosbox.plot.curve import spelled

    first = panel.lines[0]
    shown = {
        "x": panel.x_unit or meaning(first.x).unit,
        "y": panel.y_unit or meaning(first.y).unit,
    }
    measured = "x" if panel.measured_across else "y"
    labels = {"x": panel.x_label or meaning(first.x).words, "y": panel.y_label or meaning(first.y).words}
    scales = {"x": (panel.x_scale, panel.x_invert), "y": (panel.y_scale, panel.y_invert)}
    return {
        "kind": panel.kind,
        "title": panel.title,
        "note": panel.note,
        "across": panel.measured_across,
        "averages": panel.averages,
        **({"along": ATMOSPHERE_VARIABLES} if panel.kind == "atmosphere" else {}),
        "sentences": list(sentences),
        "marks": marks or {},
        "start": list(panel.start),
        "guides": [list(guide) for guide in panel.guides],
        "limits": {"x": list(panel.x_limits), "y": list(panel.y_limits)},
        "areas": panel.areas,
        **{
            axis: {
                "label": labels[axis],
                "unit": spelled(shown[axis]),
                "log": scales[axis][0] == "log",
                "invert": scales[axis][1],
            }
            for axis in ("x", "y")
        },
        "lines": [_line_record(line, shown, measured, meaning) for line in panel.lines],
    }


def _line_record(line: Line, shown: dict[str, str], measured: str, meaning: Callable[[str], Meaning]) -> dict[str, Any]:
    """Return a line of a panel; each variable has the factor and the offset that give the unit shown."""
    from atmosbox.plot.curve import WORST

    def way(name: str, unit: str, *, difference: bool = False) -> dict[str, Any]:
        from atmosbox.plot.curve import convert

        zero, one = convert(np.array([0.0, 1.0]), meaning(name).unit, unit, name=name, difference=difference)
        return {"name": name, "factor": float(f"{one - zero:.12g}"), "offset": float(f"{zero:.12g}")}

    record: dict[str, Any] = {
        "label": line.label,
        "role": line.role,
        "x": way(line.x, shown["x"]),
        "y": way(line.y, shown["y"]),
    }
    if line.error is not None:
        record["error"] = way(line.error, shown[measured], difference=True)
        if line.role == "data" and meaning(line.x if measured == "x" else line.y).unit == "K":
            record["worst"] = WORST
    return record
