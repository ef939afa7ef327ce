"""The starts that a page offers: the box it was written for, and the same with other settings.

Another number of molecules, or another diameter, is another box, another frame and other curves. So each start has a
plan of its own, made here as a run would make it. Molecules lie in the page only where it cannot place them itself.
"""

from __future__ import annotations

import gzip
import json
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from atmosbox.errors import AtmosboxError
from atmosbox.lab.lab_plan import lab_plan
from atmosbox.lab.wasm_module import module_bytes
from atmosbox.live.lesson import lesson_of
from atmosbox.scene.parameter import Parameter
from atmosbox.simulation.preparation import Prepared, prepare

__all__ = ["AS_WRITTEN", "Start", "lab_starts"]

AS_WRITTEN = "as the page was written"
"""What leads back from a preset."""
_TIMES = (0.5, 2.0, 0.25, 4.0)
"""The other numbers of molecules, over that of the page; those that find no room are left out."""
_WIDER = (0.7, 1.4, 0.5, 2.0)
"""The other values of what makes molecules meet more or less often, over that of the page."""
_MEETING = ("diameter", "knudsen", "filling", "density", "pressure")
"""The settings that do so: of those that a scene has the first is offered."""
_MISSES = 2
"""How many starts may find no room before no other is tried."""
_SEEDS = 11
"""How many other seeds a page offers that cannot place molecules itself."""


class Start(NamedTuple):
    """A box at its start: what the page calls it, its settings or the title of a preset; plan and memory.

    ``first`` is the plan of the first start of the page, of which the others say only what differs; it has none.
    """

    key: str
    plan: dict[str, Any]
    memory: bytes
    first: dict[str, Any] | None = None

    def stored(self) -> bytes:
        """Return what is compressed: plan and memory."""
        return self._text() + self.memory

    def size(self) -> list[Any]:
        """Return what the page calls it, and how many bytes plan and memory have."""
        return [self.key, len(self._text()), len(self.memory)]

    def _text(self) -> bytes:
        told = self.plan if self.first is None else _news(self.plan, self.first)
        return json.dumps(told, separators=(",", ":")).encode("utf-8")


def _news(own: Any, first: Any) -> Any:
    """Return what a plan says that the first one does not; "=" stands before what replaces all that is there.

    Examples
    --------
    >>> _news({"a": 1, "b": {"c": [2, 3], "d": 4}}, {"a": 1, "b": {"c": [2, 9], "d": 4}})
    {'b': {'c': [2, 3]}}
    >>> _news({"a": {"b": 1}}, {"a": {"c": 1}})
    {'a': {'=': {'b': 1}}}
    """
    if isinstance(own, dict) and isinstance(first, dict):
        if own.keys() != first.keys():
            return {"=": own}
        return {name: _news(value, first[name]) for name, value in own.items() if value != first[name]}
    if isinstance(own, list | tuple) and isinstance(first, list | tuple) and len(own) == len(first):
        return [_news(each, other) for each, other in zip(own, first, strict=True)]
    return own


def lab_starts(
    prepared: Prepared, most: int, progress: Callable[[float, str], None] = lambda share, word: None
) -> tuple[list[Start], str]:
    """Return the starts of the page of a scene, that of its own settings first, and the name of the module of all.

    The others are half as many molecules and twice as many, the presets of the scene, smaller and larger molecules,
    then both together, and what differs more. Only those are offered whose box runs with the same kernels.

    Parameters
    ----------
    prepared
        The scene.
    most
        How many bytes module and starts may take; the first start is there in any case, and alone if this is 0.
    progress
        Called with the share of the page that is filled and a word.

    Raises
    ------
    AtmosboxError
        If the box cannot be built, or cannot run in a page.

    Examples
    --------
    >>> found, _ = lab_starts(prepare("elastic-collisions", {"molecules": 10}), 28_000)
    >>> [start.key for start in found[:2]]
    ['molecules=10, filling=15 %, seed=1', 'molecules=5, filling=15 %, seed=1']
    """
    settings = prepared.settings
    first, memory, box = lab_plan(prepared)
    offered = _offered(prepared, seeded=first["seeded"])
    own = {name: values[0] for name, values in offered.items()}
    first["start"] = own
    made = [Start(_key(own), first, _content(memory))]
    room = most - len(module_bytes(box.module, prepared.scene)) - len(gzip.compress(made[0].stored(), 9))
    presets: list[str] = []
    missed, whole = 0, max(room, 1)
    for title, values in _others(prepared, offered) if most else ():
        if missed == _MISSES:
            break
        progress(1.0 - room / whole, "making other starts")
        try:
            plan, memory, its_box = lab_plan(
                prepare(prepared.scene, settings.changed() | values, engine=prepared.engine)
            )
        except AtmosboxError:  # not every scene can have every number
            continue
        plan["start"] = own if title else own | {name: str(values[name]) for name in own if name in values}
        start = Start(title or _key(plan["start"]), plan, _content(memory), first)
        if its_box.module != box.module:
            continue
        size = len(gzip.compress(start.stored(), 9))
        if size > room:
            missed += plan["seeded"]  # all that the page places itself take about as much
            continue
        room -= size
        made.append(start)
        presets += [title] if title else []
    _offer(prepared, made, presets)
    return made, box.module


def _key(values: dict[str, str]) -> str:
    """Return what the page calls a start."""
    return ", ".join(f"{name}={value}" for name, value in values.items())


def _offered(prepared: Prepared, *, seeded: bool) -> dict[str, list[str]]:
    """Return the values that a page may offer of each setting, its own first."""
    found: dict[str, list[str]] = {}
    parameters = {told.name: told for told in prepared.settings.describe()}
    meeting = next((name for name in _MEETING if name in parameters), None)
    for told in parameters.values():
        now = getattr(prepared.settings, told.name)
        if told.name == "molecules":
            found[told.name] = [str(now), *(str(round(times * now)) for times in _TIMES)]
        elif told.name == meeting:
            found[told.name] = [_said(value, told) for value in (now, *(float(f"{t * now:.2g}") for t in _WIDER))]
        elif told.name == "seed" and not seeded:
            found[told.name] = [str(now + k) for k in range(_SEEDS + 1)]
    return found


def _said(value: float, told: Parameter) -> str:
    """Return a value with its unit."""
    return f"{value:g} {told.unit}" if told.unit != "1" else f"{value:g}"


def _others(prepared: Prepared, offered: dict[str, list[str]]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield title and settings of what else a page may offer; only a preset has a title."""
    seed: dict[str, Any] = {"seed": prepared.settings.seed}
    names = [name for name in ("molecules", *_MEETING) if name in offered]
    near, far = slice(1, 3), slice(3, None)
    for name in names[:1]:
        yield from (("", {**seed, name: value}) for value in offered[name][near])
    for preset in lesson_of(prepared.module).presets:
        yield preset.title, {**seed, **preset.values}
    for name in names[1:]:
        yield from (("", {**seed, name: value}) for value in offered[name][near])
    yield from (("", {"seed": value}) for value in offered.get("seed", [])[1:])
    for name in names[:1]:
        yield from (("", {**seed, name: value}) for value in offered[name][far])
    if len(names) == 2:
        one, two = names
        yield from (("", {**seed, one: a, two: b}) for a in offered[one][near] for b in offered[two][near])
    for name in names[1:]:
        yield from (("", {**seed, name: value}) for value in offered[name][far])


def _offer(prepared: Prepared, made: list[Start], presets: list[str]) -> None:
    """Tell all starts which others there are."""
    words = {told.name: told.help for told in prepared.settings.describe()}
    for start in made:
        told = start.plan["told"]
        told["lesson"]["presets"] = [AS_WRITTEN, *presets] if presets else []
        particles = f"{told['stage']['particle']}s"
        for name, value in start.plan["start"].items():
            values = {each.plan["start"][name] for each in made if each.key not in presets}
            if len(values) > 1:
                told["controls"].append(
                    {
                        "name": name,
                        "label": f"number of {particles}" if name == "molecules" else words[name],
                        "unit": "",
                        "kind": "choice",
                        "choices": sorted(values, key=lambda each: float(each.split()[0])),
                        "value": value,
                        "restarts": True,
                        "help": f"{particles if name == 'molecules' else name}: the box begins anew with it",
                    }
                )


def _content(memory: Any) -> bytes:
    return b"".join(content for _, content in memory.pieces)
