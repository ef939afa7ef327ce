"""The page in which a scene runs, as an HTML file: the box that it was written for, and boxes with other settings.

Another number of molecules or another diameter changes the box, the length of a frame and the curves of theory. So each
start has its own plan, made here as a run would make it. The positions of molecules are stored in the page only if the
page cannot place the molecules itself.
"""

from __future__ import annotations

import base64
import gzip
import json
import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

from atmosbox.errors import AtmosboxError
from atmosbox.file.output_path import check_writable, write_whole
from atmosbox.lab.plan import lab_plan
from atmosbox.lab.wasm_module import module_bytes
from atmosbox.page import lab_page
from atmosbox.page.controls import control, setting_controls
from atmosbox.page.lesson import lesson_of
from atmosbox.scene.conversion import phrase
from atmosbox.simulation.preparation import Prepared, prepare

_MOST_BYTES = 231_000
"""Largest size of the module and the starts of a page, compressed [bytes]."""
_FOR_PRESETS = 380_000
"""How many bytes more the presets of a scene may take: the page then stays below 1.5 MB."""
AS_WRITTEN = "as the page was written"
"""Name of the choice that leads back from a preset to the settings of the page."""
_TIMES = (0.5, 2.0, 0.25, 4.0)
"""The other numbers of molecules, relative to that of the page; those for which the page has no room are left out."""
_WIDER = (0.7, 1.4, 0.5, 2.0)
"""The other values of the setting that changes the collision rate, relative to that of the page."""
_MEETING = ("diameter", "knudsen", "filling", "density", "pressure")
"""Settings that change the collision rate; the first one that the scene has is offered."""
_MISSES = 2
"""Number of starts without room in the page after which no other is tried."""
_SEEDS = 11
"""Number of other seeds that a page offers if it cannot place molecules itself."""


class Start(NamedTuple):
    """A box at its start: its key in the page (its settings, or the title of a preset), its plan and its memory.

    ``first`` is the plan of the first start of the page; the other starts store only the differences from it. It is
    None for the first start itself.
    """

    key: str
    plan: dict[str, Any]
    memory: bytes
    first: dict[str, Any] | None = None

    def stored(self) -> bytes:
        """Return the bytes to compress: plan and memory."""
        return self._text() + self.memory

    def size(self) -> list[Any]:
        """Return the key, and the sizes of plan and memory [bytes]."""
        return [self.key, len(self._text()), len(self.memory)]

    def _text(self) -> bytes:
        told = self.plan if self.first is None else _news(self.plan, self.first)
        return json.dumps(told, separators=(",", ":")).encode("utf-8")


def _news(own: Any, first: Any) -> Any:
    """Return the differences of a plan from the first one; the key "=" marks a value that replaces the whole entry.

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


def lab_starts(prepared: Prepared, most: int, progress: Callable[[float, str], None]) -> tuple[list[Start], str]:
    """Return the starts of a page, that with its own settings first, and the name of the module that all starts use.

    The other starts have half or twice as many molecules, the presets of the scene, smaller or larger molecules, then
    both together, and larger changes. Only boxes that run with the same kernels are offered, and module and starts have
    at most ``most`` bytes, or `_FOR_PRESETS` more with the presets; the first start is always included, and is the only
    one if this is 0. ``progress`` is called with the share of the page that is filled and the name of the present step.

    >>> found, _ = lab_starts(prepare("elastic-collisions", {"molecules": 10}), 33_000, lambda share, word: None)
    >>> [start.key for start in found[:2]]
    ['molecules=10, filling=15 %, seed=1', 'molecules=5, filling=15 %, seed=1']
    """
    changed = prepared.settings.changed()
    first, memory, box = lab_plan(prepared)
    offered = _offered(prepared, seeded=first["seeded"])
    first["start"] = own = {name: values[0] for name, values in offered.items()}
    made = [Start(_key(own), first, _content(memory))]
    room = most - len(module_bytes(box.module, prepared.scene)) - len(gzip.compress(made[0].stored(), 9))
    presets: list[str] = []
    missed, whole, seeds_fit = 0, max(room, 1), True
    for title, values in _others(prepared, offered) if most else ():
        if missed == _MISSES:
            break
        is_seed_alone = values.keys() == {"seed"}
        if is_seed_alone and not seeds_fit:  # those of other seeds are as large
            continue
        progress(min(1.0 - room / whole, 1.0), "making other starts")
        try:
            plan, memory, its_box = lab_plan(prepare(prepared.scene, changed | values, engine=prepared.engine))
        except AtmosboxError:  # not every scene can run with these settings
            continue
        plan["start"] = own if title else own | {name: str(values[name]) for name in own if name in values}
        start = Start(title or _key(plan["start"]), plan, _content(memory), first)
        if its_box.module != box.module:
            continue
        size = len(gzip.compress(start.stored(), 9))
        if size > room + (_FOR_PRESETS if title else 0):
            seeds_fit &= not is_seed_alone
            missed += plan["seeded"]  # starts that the page places itself all have about the same size
            continue
        room -= size
        made.append(start)
        presets += [title] if title else []
    _offer(prepared, made, presets)
    return made, box.module


def served_start(prepared: Prepared, written: Prepared) -> tuple[Start, str]:
    """Return the start of a page that Python serves, and the name of its module.

    Every setting of the scene has a control, for the page asks for the plan of a box with any others. Presets are added
    to the settings of the command, ``written``.

    >>> scene = prepare("elastic-collisions", {"molecules": 10})
    >>> start, _ = served_start(scene, scene)
    >>> [control["name"] for control in start.plan["told"]["controls"]][:3]
    ['molecules', 'mass_ratio', 'filling']
    """
    plan, memory, box = lab_plan(prepared)
    told, settings = plan["told"], prepared.settings
    without = [control["name"] for control in told["controls"]] + (["seed"] if plan["seeded"] else [])
    told["controls"] += setting_controls(settings.describe(), settings.as_dict(), without)
    base = written.settings.changed()
    presets = {AS_WRITTEN: base} | {each.title: base | dict(each.values) for each in lesson_of(prepared.module).presets}
    told["lesson"]["presets"] = list(presets) if len(presets) > 1 else []
    made = [type(settings).from_user(values) for values in presets.values()]
    plan |= {"start": {}, "settings": settings.as_dict(), "presets": [each.as_dict() for each in made]}
    return Start("", plan, _content(memory)), box.module


def _key(values: dict[str, str]) -> str:
    """Return the key of a start in the page."""
    return ", ".join(f"{name}={value}" for name, value in values.items())


def _offered(prepared: Prepared, *, seeded: bool) -> dict[str, list[str]]:
    """Return the values that a page may offer for each setting, the page's own value first."""
    found: dict[str, list[str]] = {}
    parameters = {told.name: told for told in prepared.settings.describe()}
    meeting = next((name for name in _MEETING if name in parameters), None)
    for told in parameters.values():
        now = getattr(prepared.settings, told.name)
        if told.name == "molecules":
            found[told.name] = [str(now), *(str(round(times * now)) for times in _TIMES)]
        elif told.name == meeting:
            found[told.name] = [phrase(value, told.unit) for value in (now, *(float(f"{t * now:.2g}") for t in _WIDER))]
        elif told.name == "seed" and not seeded:
            found[told.name] = [str(now + k) for k in range(_SEEDS + 1)]
    return found


def _others(prepared: Prepared, offered: dict[str, list[str]]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield titles and settings of the other starts that a page may offer; only presets have a title."""
    seed: dict[str, Any] = {"seed": prepared.settings.seed}
    numbers, meeting, seeds = (
        [{name: value} for name in names if name in offered for value in offered[name][1:]]
        for names in (("molecules",), _MEETING, ("seed",))
    )
    yield from (("", seed | each) for each in numbers[:2])
    yield from ((preset.title, {**seed, **preset.values}) for preset in lesson_of(prepared.module).presets)
    both = [one | two for one, two in product(numbers[:2], meeting[:2])]
    yield from (("", seed | each) for each in (*meeting[:2], *seeds, *numbers[2:], *both, *meeting[2:]))


def _offer(prepared: Prepared, made: list[Start], presets: list[str]) -> None:
    """Add to the plan of each start the controls that lead to the others."""
    parameters = {told.name: told for told in prepared.settings.describe()}
    for start in made:
        told = start.plan["told"]
        told["lesson"]["presets"] = [AS_WRITTEN, *presets] if presets else []
        particles = f"{told['stage']['particle']}s"
        for name, value in start.plan["start"].items():
            values = {each.plan["start"][name] for each in made if each.key not in presets}
            if len(values) > 1:
                choices = tuple(sorted(values, key=lambda each: float(each.split()[0])))
                label = f"number of {particles}" if name == "molecules" else parameters[name].help
                choice = replace(parameters[name], unit="", kind="str", choices=choices, help=label)
                help = f"{particles if name == 'molecules' else name}: changing it restarts the box"
                told["controls"].append(control(choice, value, restarts=True) | {"help": help})


def _content(memory: Any) -> bytes:
    return b"".join(content for _, content in memory.pieces)


def lab_data(starts: list[Start], module: str, scene: str, *, level: int = 9) -> tuple[Any, list[Any], str, str]:
    """Return the stage of a page, and as data for it the starts, their module, and their plans and memories.

    ``level`` says how much time to spend on compressing them, from 1 to 9.
    """
    stored = gzip.compress(b"".join(each.stored() for each in starts), level, mtime=0)
    packed = [base64.b64encode(each).decode("ascii") for each in (module_bytes(module, scene), stored)]
    return starts[0].plan["told"]["stage"], [each.size() for each in starts], packed[0], packed[1]


def lab_text(
    prepared: Prepared,
    *,
    theme: str = "auto",
    language: str = "auto",
    others: bool = True,
    progress: Callable[[float, str], None] = lambda share, word: None,
) -> str:
    """Return the HTML of the page that `save_lab` writes; refuse a scene that cannot run in a page.

    >>> from atmosbox.simulation.preparation import prepare
    >>> "WebAssembly" in lab_text(prepare("temperature", {"molecules": 20}), others=False)
    True
    """
    starts, module = lab_starts(prepared, _MOST_BYTES if others else 0, progress)
    return lab_page(*lab_data(starts, module, prepared.scene), theme=theme, language=language)


def save_lab(
    prepared: Prepared,
    path: str | os.PathLike[str],
    *,
    theme: str = "auto",
    language: str = "auto",
    others: bool = True,
    force: bool = False,
    progress: Callable[[float, str], None] = lambda share, word: None,
) -> Path:
    """Write the page in which a scene runs.

    Parameters
    ----------
    prepared
        The scene.
    path
        The file; it should end in ``.html``.
    theme : {"auto", "light", "dark"}
        The colours of the page.
    language : {"auto", "en", "de", "es"}
        Its language.
    others
        Whether the page offers other starts too, such as other numbers of molecules.
    force
        Whether a file of that name may be replaced.
    progress
        Function that is called with the share of the page that is filled and the name of the present step.

    Returns
    -------
    pathlib.Path
        The file that was written.

    Raises
    ------
    AtmosboxError
        If the scene cannot run in a page, or the file cannot be written.
    """
    target = check_writable(path, force, example="lab.html")
    text = lab_text(prepared, theme=theme, language=language, others=others, progress=progress)
    write_whole(target, text.encode("utf-8"))
    return target
