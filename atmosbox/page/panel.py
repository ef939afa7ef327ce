"""The graphs of a scene as data for the page: their variables, and the conversion from SI to the units shown."""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.file.variables import known
from atmosbox.scene.conversion import spelled
from atmosbox.scene.panels import ATMOSPHERE_VARIABLES, Line, Panel

_ALONG = tuple("parcel_pressure" if name == "environment_pressure" else name for name in ATMOSPHERE_VARIABLES)
"""On a page the picture of an ascent has the pressure of the parcel, as its barometer has."""


def plain(values: ArrayLike, figures: int = 7) -> list[float | None]:
    """Return numbers as JSON can hold them, with some significant digits; numbers that are not finite become null.

    >>> plain([1.0, math.nan, 1.0 / 3.0])
    [1.0, None, 0.3333333]
    """
    numbers = np.atleast_1d(np.asarray(values, np.float64)).ravel()
    return [float(f"{x:.{figures}g}") if math.isfinite(x) else None for x in numbers.tolist()]


class Meaning(NamedTuple):
    """The meaning of a variable: its unit in the file, and its description."""

    unit: str
    words: str


def declared(name: str, time_unit: str = "ns") -> Meaning:
    """Return the declared meaning of a variable or of a part such as "heat_from_wall[z_low]"; else its name."""
    name = name.partition("[")[0]
    if name == "elapsed_time":
        return Meaning(time_unit, "time")
    found = known(name)
    return Meaning("1", name.replace("_", " ")) if found is None else Meaning(found.units or "1", found.long_name)


def names(panels: Iterable[Panel]) -> tuple[str, ...]:
    """Return the variables that the graphs of the page need, each once, in order; the stage shows the discs."""
    graphs = [panel for panel in panels if panel.kind != "discs"]
    wanted = [name for panel in graphs for name in panel.variables]
    if any(panel.kind == "atmosphere" for panel in graphs):
        wanted += _ALONG
    return tuple(dict.fromkeys(wanted))


def panel_record(
    panel: Panel,
    meaning: Callable[[str], Meaning],
    *,
    sentences: Sequence[str] = (),
    marks: dict[str, float] | None = None,
) -> dict[str, Any]:
    """Return a panel, with its headline numbers as sentences and the levels that it marks [hPa], as data for the page.

    The value of a line is shown as ``value * factor + offset``:

    >>> air = Line("elapsed_time", "air_temperature", "air")
    >>> panel_record(Panel("line", "Temperature", (air,), y_unit="degC"), declared)["lines"][0]["y"]
    {'name': 'air_temperature', 'factor': 1.0, 'offset': -273.15}
    """
    first = panel.lines[0]
    measured = "x" if panel.measured_across else "y"
    shown, axes = {}, {}
    for axis in ("x", "y"):
        label, unit, scale, invert = (getattr(panel, f"{axis}_{part}") for part in ("label", "unit", "scale", "invert"))
        means = meaning(getattr(first, axis))
        shown[axis] = unit or means.unit
        axes[axis] = {"label": label or means.words, "unit": spelled(shown[axis])}
        axes[axis] |= {"log": scale == "log", "invert": invert}
    return {
        "kind": panel.kind,
        "title": panel.title,
        "note": panel.note,
        "across": panel.measured_across,
        "averages": panel.averages,
        **({"along": _ALONG} if panel.kind == "atmosphere" else {}),
        "sentences": list(sentences),
        "marks": marks or {},
        "start": list(panel.start),
        "guides": [list(guide) for guide in panel.guides],
        "limits": {"x": list(panel.x_limits), "y": list(panel.y_limits)},
        "areas": panel.areas,
        **axes,
        "lines": [_line_record(line, shown, measured, meaning) for line in panel.lines],
    }


def _line_record(line: Line, shown: dict[str, str], measured: str, meaning: Callable[[str], Meaning]) -> dict[str, Any]:
    """Return a line of a panel; each variable has the factor and the offset that give the unit shown."""
    from atmosbox.plot.curve import WORST, convert

    def way(name: str, unit: str, *, difference: bool = False) -> dict[str, Any]:
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
