"""How a class draws its prediction on a graph of the page: five places along one axis, and the range of the other."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox.page.panel import declared, plain
from atmosbox.scene.conversion import to_si

if TYPE_CHECKING:
    from atmosbox.scene.setup import Setup

_HANDLES = 5
_TIME = "elapsed_time"


def drawing(wanted: Mapping[str, Any], panels: list[dict[str, Any]], setup: Setup) -> dict[str, Any] | None:
    """Return how a class draws the variable that it predicts; None if no graph shows it from an end known beforehand.

    That is the number of the graph, the label of the curve where there are several, and for the variable and what it
    is drawn along the name, the unit in a file, and the conversion to the unit shown; with the range of the one, and
    the five places along the other.
    """
    (name, span), *others = wanted.items()
    ends = _ends(panels, setup)
    second = to_si(1.0, setup.time_unit)  # ranges of a lesson are in SI, and time is in a unit of its own
    ends |= {key: [end / (second if key == _TIME else 1.0) for end in given] for key, given in others}
    for number, panel in enumerate(panels):
        axis, other = ("x", "y") if panel["across"] else ("y", "x")
        lines = [line for line in panel["lines"] if line["role"] == "data"]
        line = next((each for each in lines if each[axis]["name"] == name and each[other]["name"] in ends), None)
        if line is None or panel["kind"] not in ("line", "profile") or panel[axis]["log"]:
            continue
        measured, along = (
            line[each] | {"unit": declared(line[each]["name"], setup.time_unit).unit} for each in (axis, other)
        )
        first, last = _shown(ends[along["name"]], along)
        spaced = np.geomspace if panel[other]["log"] else np.linspace
        return {
            "graph": number,
            "label": line["label"] if len(lines) > 1 else "",
            "measured": measured | {"range": plain(_shown(span, measured))},
            "along": along | {"places": plain(spaced(first, last, _HANDLES))},
        }
    return None


def _ends(panels: list[dict[str, Any]], setup: Setup) -> dict[str, list[float]]:
    """Return the first and the last value of time, of the height in the box, and of the variables of an ascent."""
    scale = setup.scale
    ends = {
        _TIME: [0.0, setup.duration * scale.time / to_si(1.0, setup.time_unit)],
        "height": [0.0, float(setup.parcel.length[2]) * scale.length],
    }
    for panel in panels:
        for line in panel["lines"]:
            for axis, points in panel["planned"].items():
                way, known = line[axis], points[:1] + points[-1:]
                if known:
                    ends.setdefault(way["name"], [(end - way["offset"]) / way["factor"] for end in known])
    return ends


def _shown(values: Iterable[float], way: Mapping[str, Any]) -> list[float]:
    """Return values in the unit in which a panel shows them."""
    return [value * way["factor"] + way["offset"] for value in values]
