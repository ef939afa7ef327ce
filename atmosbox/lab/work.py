"""The arguments of the kernels that a page calls, by their names in `kernels.kernel_table`."""

from __future__ import annotations

from typing import Any

from atmosbox.lab.kernels.gravity import can_set_gravity
from atmosbox.lab.kernels.moist_knobs import has_moist_knobs
from atmosbox.lab.kernels.starting import can_start
from atmosbox.lab.lab_box import LabBox

__all__ = ["arguments"]


def arguments(box: LabBox) -> dict[str, tuple[Any, ...]]:
    """Return the arguments of the kernels of a box by name.

    Examples
    --------
    >>> from atmosbox.lab.lab_box import lab_box
    >>> from atmosbox.lab.kernels.kernel_table import kernels
    >>> from atmosbox.simulation.preparation import prepare
    >>> box = lab_box(prepare("temperature", {"molecules": 20}))
    >>> set(arguments(box)) == set(kernels(box.modes, wells=box.attracts))
    True
    """
    gas, ascent, book, layout, gauges = box.gas, box.ascent, box.book, box.layout, box.gauges
    found: dict[str, tuple[Any, ...]] = {}
    if box.modes.ascends:
        found["lead"] = (gas, ascent, book, 0.0)
    if can_start(box.modes):
        found["start"] = (gas, ascent, book, box.start, 0)
    if can_set_gravity(box.modes) and not box.attracts:
        found["set_gravity"] = (gas, book, box.start, gauges, gas.box.gravity)
    found |= {
        "place": (gas, book, layout),
        "pass_time": (gas, ascent, book, layout, 0.0, 0),
        "begin": (gas, ascent, book, gauges),
        "sample": (gas, ascent, book, gauges),
        "end_frame": (gas, ascent, book, gauges),
        "note_frame": (gas, gauges, box.speeds, box.layers),
        "begin_averages_anew": (box.speeds, box.layers),
        "look": (gas, book, box.picture),
    } | (_knobs(box) if box.modes.phases else {"warm_walls": (gas.walls, 0, 6, 1.0)})
    if box.attracts:
        found |= {
            "begin": (gas, ascent, book, gauges, box.crowd),
            "end_frame": (gas, ascent, book, gauges, layout, box.crowd),
            "look": (gas, book, layout, box.crowd, box.picture),
            "attract": (gas, book, layout, 1.0),
            "warm_bath": (gas.bath, 1.0),
        }
    return found


def _knobs(box: LabBox) -> dict[str, tuple[Any, ...]]:
    """Return the arguments of the kernels that the knobs of a box with liquid call."""
    if not has_moist_knobs(box.modes):
        return {}
    gas, book = box.gas, box.book
    found: dict[str, tuple[Any, ...]] = {
        "warm_walls": (gas, book, *box.warmed, 1.0),
        "smooth_walls": (gas, *box.warmed),
    }
    return found | ({"cover_pool": (gas, book, 1.0)} if box.modes.pool else {})
