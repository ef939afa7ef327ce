"""What a page shows of a box that runs, and gets once: its stage, its graphs, and its lesson."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.file.molecules import Molecules
from atmosbox.page import NEIGHBOURS, Stage, stage
from atmosbox.page.lesson import lesson_of
from atmosbox.page.panel import declared, panel_record, plain
from atmosbox.page.word import card_of
from atmosbox.scene import instruments
from atmosbox.scene.conversion import to_si
from atmosbox.scene.panels import without_headlines
from atmosbox.version import __version__

if TYPE_CHECKING:
    from atmosbox.scene.panels import Panel
    from atmosbox.scene.setup import Setup
    from atmosbox.simulation.preparation import Prepared

COLDER = 0.5
"""Share of the scale of speeds: if the speeds reach less of it, the page takes another scale."""

_FASTEST, _STEPS = 3.0, 60
"""The highest speed of the scale, over that of kT = m; and number of speeds that are tried for a mixture."""
_TIME = "elapsed_time"
_HANDLES = 5
"""Number of places at which a class draws its prediction."""

Array = NDArray[np.float64]


def instrument_of(setup: Setup, kind: type) -> Any:
    """Return the instrument of a kind that a box has; None if it has none."""
    return next((each for each in setup.instruments if type(each) is kind), None)


def running_panels(prepared: Prepared) -> tuple[Panel, ...]:
    """Return the graphs of a scene without what only a whole run knows; an axis of time is linear."""
    panels = prepared.module.panels
    found = map(without_headlines, panels(prepared.settings) if callable(panels) else panels)
    return tuple(
        replace(panel, x_scale="linear") if {line.x for line in panel.lines} == {_TIME} else panel
        for panel in found
        if panel is not None
    )


def lab_stage(prepared: Prepared, setup: Setup, panels: tuple[Panel, ...]) -> tuple[Stage, float]:
    """Return what a page shows of a box, and `_swift` of its molecules in m s-1 K-1/2."""
    parcel: Any = setup.parcel
    scale, module = setup.scale, prepared.module
    all_of_them = instruments.Molecules(setup.right)
    all_of_them.end_frame(parcel, parcel.snapshot())
    told = all_of_them.readings(scale, 0)
    seen = Molecules(
        discs=any(panel.kind == "discs" for panel in panels),
        time=np.zeros(1),
        **{name: told[f"molecule_{name}"] for name in ("position", "speed", "mass", "diameter")},
        water=told["species"] == 1 if "species" in told else None,
        side=told["box_side"],
        walls=instruments.wall_laws(parcel),
        wall_temperature=parcel.wall_kT()[None] * scale.temperature,
        planar=parcel.planar,
        gravity=parcel.gravity > 0.0,
        drops=told.get("drop_position"),
        neighbours=told.get("molecule_neighbour_count"),  # shown as colours, because speeds do not show drops
        right=setup.right,
    )
    gas = 2.0 * parcel.energy()[0] / ((2.0 if parcel.planar else 3.0) * max(parcel.number, 1))
    warmest = float(np.nanmax([*parcel.wall_kT(), gas]))  # kT of the gas and the walls
    fast = _swift(np.asarray(seen.mass, np.float64) / scale.mass)
    tell = functools.partial(declared, time_unit=setup.time_unit)
    made = stage(
        seen,
        title=str(getattr(module, "title", prepared.scene)),
        story=lesson_of(module).story or (module.__doc__ or "").strip().split("\n\n")[0].replace("\n", " "),
        time_unit=setup.time_unit,
        fastest=NEIGHBOURS if seen.neighbours is not None else fast * math.sqrt(warmest) * scale.velocity,
        panels=[panel_record(each, tell) for each in panels if each.kind != "discs"],
    )
    made.record.update(
        scene=prepared.scene, seed=prepared.settings.seed, engine=str(prepared.engine), version=__version__,
        card=card_of(module.__doc__ or ""),
    )  # fmt: skip
    return made, fast * scale.velocity / math.sqrt(scale.temperature)


def _swift(mass: Array) -> float:
    r"""Return the speed that hardly any molecule exceeds, over :math:`\sqrt{kT}`.

    It is :math:`3 / \sqrt{m}`, in a mixture the c at which the mean of :math:`e^{-m c^2 / 2}` is the same.

    >>> _swift(np.full(5, 4.0)), round(_swift(np.array([1.0, 9.0])), 2)
    (1.5, 2.76)
    """
    if not mass.size:
        return _FASTEST
    inverse = np.geomspace(1.0 / mass.max(), 1.0 / mass.min(), _STEPS)
    share = [float(np.exp(-0.5 * _FASTEST**2 * each * mass).mean()) for each in inverse]
    return _FASTEST * math.sqrt(np.interp(-math.exp(-0.5 * _FASTEST**2), np.negative(share), inverse))


def lab_lesson(prepared: Prepared, series: set[str], setup: Setup, panels: list[dict[str, Any]]) -> dict[str, Any]:
    """Return question and task of the scene, without a task whose variables the page does not have; no presets."""
    lesson = lesson_of(prepared.module)
    task, predict = lesson.task, dict(lesson.predict or {})
    found: dict[str, Any] = {"presets": [], "predict": predict or None, "task": None}
    if "draw" in predict:
        predict["draw"] = _drawing(predict["draw"], panels, setup)
    if task is None or not series.issuperset(goal["name"] for goal in task["reach"]):
        return found
    reach = []
    for goal in task["reach"]:
        by = to_si(1.0, setup.time_unit) if goal["name"] == _TIME else 1.0  # other variables of the page are in SI
        scaled = {"target": goal["target"] / by, "within": goal["within"] / by, "factor": goal["factor"] * by}
        reach.append(goal | scaled)
    # in an ascent values change steadily, and a mean would lag behind
    return found | {"task": {**task, "reach": reach, "steady": setup.ends}}


def _drawing(wanted: Mapping[str, Any], panels: list[dict[str, Any]], setup: Setup) -> dict[str, Any] | None:
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
        first, last = shown(ends[along["name"]], along)
        spaced = np.geomspace if panel[other]["log"] else np.linspace
        return {
            "graph": number,
            "label": line["label"] if len(lines) > 1 else "",
            "measured": measured | {"range": plain(shown(span, measured))},
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


def shown(values: Iterable[float], way: Mapping[str, Any]) -> list[float]:
    """Return values in the unit in which a panel shows them."""
    return [value * way["factor"] + way["offset"] for value in values]
