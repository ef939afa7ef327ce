"""The starts that a page offers: the box it was written for, and the same with other numbers of molecules.

A page has no Python that could place molecules. So each start is made here, as a run would make it, and lies in the
page with the plan that belongs to it: another number of molecules is another box, another frame and other curves.
"""

from __future__ import annotations

import gzip
import json
from collections.abc import Iterator
from typing import Any, NamedTuple

from atmosbox.errors import AtmosboxError
from atmosbox.lab.lab_plan import lab_plan
from atmosbox.lab.wasm_module import module_bytes
from atmosbox.live.lesson import lesson_of
from atmosbox.simulation.preparation import Prepared, prepare

__all__ = ["AS_WRITTEN", "Start", "lab_starts"]

AS_WRITTEN = "as the page was written"
"""What leads back from a preset."""
_TIMES = (0.5, 2.0, 0.25, 4.0)
"""The other numbers of molecules, over that of the page; those that find no room are left out."""


class Start(NamedTuple):
    """A box at its start: what the page calls it, its number of molecules or the title of a preset; plan and memory."""

    key: str
    plan: dict[str, Any]
    memory: bytes

    def stored(self) -> bytes:
        """Return what is compressed: plan and memory."""
        return self._text() + self.memory

    def size(self) -> list[Any]:
        """Return what the page calls it, and how many bytes plan and memory have."""
        return [self.key, len(self._text()), len(self.memory)]

    def _text(self) -> bytes:
        return json.dumps(self.plan, separators=(",", ":")).encode("utf-8")


def lab_starts(prepared: Prepared, most: int) -> tuple[list[Start], str]:
    """Return the starts of the page of a scene, that of its own settings first, and the name of the module of all.

    The others are half as many molecules and twice as many, the presets of the scene, then a quarter and four times as
    many molecules. Only those are offered whose box runs with the same kernels.

    Parameters
    ----------
    prepared
        The scene.
    most
        How many bytes module and starts may take; the first start is there in any case, and alone if this is 0.

    Raises
    ------
    AtmosboxError
        If the box cannot be built, or cannot run in a page.

    Examples
    --------
    >>> found, _ = lab_starts(prepare("temperature", {"molecules": 20}), 80_000)
    >>> [start.key for start in found]
    ['20', '10']
    """
    plan, memory, box = lab_plan(prepared)
    made = [Start(str(plan["molecules"]), plan, _content(memory))]
    settings = prepared.settings
    room = most - len(module_bytes(box.module, prepared.scene)) - len(gzip.compress(made[0].stored(), 9))
    presets: list[str] = []
    for title, values in _others(prepared) if most else ():
        try:
            plan, memory, its_box = lab_plan(prepare(prepared.scene, settings.changed() | values))
        except AtmosboxError:  # not every scene can have every number
            continue
        start = Start(title or str(plan["molecules"]), plan, _content(memory))
        size = len(gzip.compress(start.stored(), 9))
        if its_box.module == box.module and size <= room:
            room -= size
            made.append(start)
            presets += [title] if title else []
    _offer(made, presets)
    return made, box.module


def _others(prepared: Prepared) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield title and settings of what else a page may offer; a number of molecules has no title."""
    seed = prepared.settings.seed
    number = getattr(prepared.settings, "molecules", 0)
    numbers = [("", {"seed": seed, "molecules": round(times * number)}) for times in _TIMES if number]
    yield from numbers[:2]
    for preset in lesson_of(prepared.module).presets:
        yield preset.title, {"seed": seed, **preset.values}
    yield from numbers[2:]


def _offer(made: list[Start], presets: list[str]) -> None:
    """Tell all starts which others there are."""
    numbers = sorted(int(start.key) for start in made if start.key not in presets)
    for start in made:
        told = start.plan["told"]
        told["lesson"]["presets"] = [AS_WRITTEN, *presets] if presets else []
        if len(numbers) > 1:
            particles = f"{told['stage']['particle']}s"
            told["controls"].append(
                {
                    "name": "molecules",
                    "label": f"number of {particles}",
                    "unit": "",
                    "kind": "choice",
                    "choices": [str(number) for number in numbers],
                    "value": str(start.plan["molecules"]),
                    "restarts": True,
                    "help": f"{particles}: the box begins anew with so many",
                }
            )


def _content(memory: Any) -> bytes:
    return b"".join(content for _, content in memory.pieces)
