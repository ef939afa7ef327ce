"""The starts that a page offers: the box it was written for, and the same with other numbers of molecules.

A page has no Python that could place molecules. So each start is made here, as a run would make it, and lies in the
page with the plan that belongs to it: another number of molecules is another box, another frame and other curves.
"""

from __future__ import annotations

import gzip
import json
from typing import Any, NamedTuple

from atmosbox.errors import AtmosboxError
from atmosbox.lab.lab_plan import lab_plan
from atmosbox.simulation.preparation import Prepared, prepare

__all__ = ["Start", "lab_starts"]

_TIMES = (0.5, 2.0, 0.25, 4.0)
"""The other numbers of molecules, over that of the page; those that find no room are left out."""


class Start(NamedTuple):
    """A box at its start: its plan, and its memory."""

    plan: dict[str, Any]
    memory: bytes
    is_chosen: bool

    def stored(self) -> bytes:
        """Return what is compressed: of the start for which the page is written, the plan stands in the page itself."""
        return self.memory if self.is_chosen else self._text() + self.memory

    def size(self) -> list[int]:
        """Return the number of molecules, and how many bytes plan and memory have."""
        return [int(self.plan["molecules"]), len(self._text()), len(self.memory)]

    def _text(self) -> bytes:
        return json.dumps(self.plan, separators=(",", ":")).encode("utf-8")


def lab_starts(prepared: Prepared, most: int) -> tuple[list[Start], str]:
    """Return the starts of the page of a scene, that of its own settings first, and the name of the module of all.

    The others have half as many molecules, twice as many, and so on, and only those are offered whose box runs with the
    same kernels.

    Parameters
    ----------
    prepared
        The scene.
    most
        How many bytes all starts may take together, compressed; the first is there in any case, and alone if it is 0.

    Raises
    ------
    AtmosboxError
        If the box cannot be built, or cannot run in a page.

    Examples
    --------
    >>> [start.plan["molecules"] for start in lab_starts(prepare("temperature", {"molecules": 20}), 60_000)[0]]
    [20, 10, 40]
    """
    plan, memory, box = lab_plan(prepared)
    made = [Start(plan, _content(memory), True)]
    settings = prepared.settings
    room = most - len(gzip.compress(made[0].stored(), 9))
    number = getattr(settings, "molecules", 0)
    for times in _TIMES if most and number else ():
        changed = {"seed": settings.seed, "molecules": round(times * number)}
        try:
            other = prepare(prepared.scene, settings.changed() | changed)
            plan, memory, its_box = lab_plan(other)
        except AtmosboxError:  # not every scene can have every number
            continue
        start = Start(plan, _content(memory), False)
        size = len(gzip.compress(start.stored(), 9))
        if its_box.module == box.module and size <= room:
            room -= size
            made.append(start)
    offered = sorted(start.plan["molecules"] for start in made)
    if len(made) > 1:
        for start in made:
            particles = f"{start.plan['told']['stage']['particle']}s"
            start.plan["told"]["controls"].append(
                {
                    "name": "molecules",
                    "label": f"number of {particles}",
                    "unit": "",
                    "kind": "choice",
                    "choices": [str(number) for number in offered],
                    "value": str(start.plan["molecules"]),
                    "restarts": True,
                    "help": f"{particles}: the box begins anew with so many",
                }
            )
    return made, box.module


def _content(memory: Any) -> bytes:
    return b"".join(content for _, content in memory.pieces)
